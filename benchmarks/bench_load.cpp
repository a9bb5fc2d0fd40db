// What loading a scene of meshes takes, against the least that a renderer on Embree could do: read
// the files' bytes, and have Embree build its structures over arrays that are already there. The
// two are timed in turn, files in the system's cache. Counters, medians over the repeats:
//   ratio               read_scene() and Scene() / the least; quartiles beside it,
//   bytes, build        seconds of the least's two parts,
//   read_scene, scene   and of ours.
#include "bench_main.h"
#include "bench_statistics.h"
#include "core/embree.h"
#include "core/read_scene.h"
#include "core/scene.h"
#include "packets/isa.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace lockstep {
namespace {

constexpr int repeats = 7;

// --- The scene, in memory and in files

// `files` height fields of columns x rows cells, two triangles each, in rows of 20.
struct Extent {
  int files, columns, rows;
};

struct Arrays {
  std::vector<float> positions;  // and one vertex of padding for Embree
  std::vector<std::uint32_t> triangles;
};

Arrays height_field(const Extent& e, int file) {
  Arrays a;
  for (int j = 0; j <= e.rows; ++j) {
    for (int i = 0; i <= e.columns; ++i) {
      const double x = double(i) / e.columns + file % 20, y = double(j) / e.rows + file / 20;
      const double z = 0.1 * std::sin(9.0 * x) * std::cos(7.0 * y) + 0.01 * std::sin(95.0 * x * y);
      a.positions.insert(a.positions.end(), {float(x), float(y), float(z)});
    }
  }
  for (int j = 0; j < e.rows; ++j) {
    for (int i = 0; i < e.columns; ++i) {
      const auto corner = std::uint32_t(j * (e.columns + 1) + i);
      const std::uint32_t across = corner + std::uint32_t(e.columns) + 2;
      a.triangles.insert(a.triangles.end(),
                         {corner, corner + 1, across, corner, across, across - 1});
    }
  }
  a.positions.insert(a.positions.end(), 3, 0.0f);
  return a;
}

std::size_t vertex_count(const Arrays& a) { return a.positions.size() / 3 - 1; }

void write_ply(const std::filesystem::path& path, const Arrays& a) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << vertex_count(a)
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
       << a.triangles.size() / 3 << "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto write = [&](const void* bytes, std::size_t count) {
    file.write(static_cast<const char*>(bytes), std::streamsize(count));
  };
  write(a.positions.data(), vertex_count(a) * 3 * sizeof(float));
  for (std::size_t i = 0; i < a.triangles.size(); i += 3) {
    file.put(3);
    write(&a.triangles[i], 3 * sizeof(std::uint32_t));
  }
}

// A scene in a directory of its own, which goes with it.
class SceneFiles {
 public:
  explicit SceneFiles(const Extent& extent)
      : directory_(std::filesystem::temp_directory_path() /
                   fmt::format("lockstep-bench-load-{}", getpid())) {
    std::filesystem::create_directories(directory_);
    std::ofstream scene(scene_path());
    scene << "WorldBegin\nLightSource \"point\"\n";
    for (int i = 0; i < extent.files; ++i) {
      const std::string name = fmt::format("{}.ply", i);
      meshes_.push_back(height_field(extent, i));
      paths_.push_back((directory_ / name).string());
      write_ply(paths_.back(), meshes_.back());
      scene << "Shape \"plymesh\" \"string filename\" \"" << name << "\"\n";
    }
  }
  SceneFiles(const SceneFiles&) = delete;
  SceneFiles& operator=(const SceneFiles&) = delete;
  ~SceneFiles() {
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
  }

  std::string scene_path() const { return (directory_ / "scene.pbrt").string(); }
  const std::vector<std::string>& mesh_paths() const { return paths_; }
  const std::vector<Arrays>& meshes() const { return meshes_; }

 private:
  std::filesystem::path directory_;
  std::vector<std::string> paths_;
  std::vector<Arrays> meshes_;
};

// --- The least

void read_bytes(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    std::vector<char> bytes(std::filesystem::file_size(path));
    std::ifstream(path, std::ios::binary).read(bytes.data(), std::streamsize(bytes.size()));
    benchmark::DoNotOptimize(bytes.data());
  }
}

// With the flags of core/scene.cpp.
void build(const std::vector<Arrays>& meshes, const std::string& embree_isa) {
  const RTCDevice device = rtcNewDevice(embree_isa.empty() ? "" : ("isa=" + embree_isa).c_str());
  const RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  for (const Arrays& a : meshes) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               a.positions.data(), 0, 3 * sizeof(float), vertex_count(a));
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               a.triangles.data(), 0, 3 * sizeof(std::uint32_t),
                               a.triangles.size() / 3);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene);
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}

// --- Both

template <class F>
double seconds(const F& f) {
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Times {
  std::vector<double> bytes, build, read_scene, scene;
};

void time_least(const SceneFiles& files, const std::string& isa, Times& times) {
  times.bytes.push_back(seconds([&] { read_bytes(files.mesh_paths()); }));
  times.build.push_back(seconds([&] { build(files.meshes(), isa); }));
}

// As for the least, the time to release what Embree built counts.
void time_ours(const SceneFiles& files, const std::string& isa, Times& times) {
  SceneDescription description;
  times.read_scene.push_back(seconds([&] { description = read_scene(files.scene_path()); }));
  times.scene.push_back(seconds([&] { const Scene scene(std::move(description), isa); }));
}

void measure(benchmark::State& loop, const Extent& extent) {
  const SceneFiles files(extent);
  const std::string isa = embree_isa(choose_isa());
  Times times;
  std::vector<double> ratio, total;
  for (auto _ : loop) {
    for (int repeat = 0; repeat < repeats; ++repeat) {
      if (repeat % 2 == 0) time_least(files, isa, times);
      time_ours(files, isa, times);
      if (repeat % 2 == 1) time_least(files, isa, times);
      total.push_back(times.read_scene.back() + times.scene.back());
      ratio.push_back(total.back() / (times.bytes.back() + times.build.back()));
    }
    loop.SetIterationTime(median(total));
  }
  loop.counters["ratio"] = median(ratio);
  loop.counters["ratio_q1"] = quantile(ratio, 0.25);
  loop.counters["ratio_q3"] = quantile(ratio, 0.75);
  loop.counters["bytes"] = median(times.bytes);
  loop.counters["build"] = median(times.build);
  loop.counters["read_scene"] = median(times.read_scene);
  loop.counters["scene"] = median(times.scene);
}

void register_all() {
  for (const Extent& e : {Extent{1, 1000, 500}, Extent{200, 50, 50}}) {
    const std::string label = fmt::format("load/files:{}/triangles:{}/{}", e.files,
                                          e.files * 2 * e.columns * e.rows, name(choose_isa()));
    benchmark::RegisterBenchmark(label.c_str(), measure, e)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  }
}

}  // namespace
}  // namespace lockstep

int main(int argc, char** argv) {
  return lockstep::run_benchmarks(argc, argv, lockstep::register_all);
}
