// Traversal alone: rays per second of CPU time by kind of ray, packet width and Embree's coherent
// flag. The rays are those that the path integrator traces, recorded from its own stages, with
// lanes over 4x4 pixels; the sampler decides how far neighbouring bounce rays part.
#include "core/read_scene.h"
#include "core/scene.h"
#include "packets/path.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <map>
#include <memory>
#include <vector>

namespace lockstep {
namespace {

constexpr const char* scene_name = "reef";
constexpr std::uint32_t seed = 1;
constexpr int image_size = 256;
constexpr Isa isa = native_lanes == 16 ? Isa::Avx512 : native_lanes == 8 ? Isa::Avx2 : Isa::Sse4;

const Scene& scene() {
  static const Scene built = [] {
    SceneDescription description = read_scene(scene_name);
    description.film.width = description.film.height = image_size;
    return Scene(std::move(description), embree_isa(isa));
  }();
  return built;
}

// One entry per wave.
struct Recording {
  std::vector<RayQueue> camera, bounce;
  std::vector<ShadowQueue> shadows;
};

void record_wave(const TileJob& job, Wave& wave, Recording& out) {
  constexpr int W = native_lanes;
  TileCounts counts;
  list_paths(job, wave.paths);
  generate_camera_rays<W>(job, wave);
  out.camera.push_back(wave.rays[0]);
  intersect<W>(scene().data(), true, wave.rays[0], wave.hits, counts);
  const ShadeContext c{&scene().data(), &job, &wave, 0, false};
  wave.rays[1].count = wave.shadows.count = 0;
  shade_kind<W, MaterialKind::Diffuse>(c);
  shade_kind<W, MaterialKind::Conductor>(c);
  shade_kind<W, MaterialKind::Coated>(c);
  out.bounce.push_back(wave.rays[1]);
  out.shadows.push_back(wave.shadows);
}

SamplerState state_of(const std::string& text) {
  const SamplerSpec spec = parse_sampler(text);
  SamplerState state;
  state.seed = seed;
  state.shared = spec.shared;
  state.sequence = spec.sequence;
  state.perturbation = spec.perturbation;
  state.weight = spec.weight;
  return state;
}

const Recording& recording(const std::string& sampler) {
  static std::map<std::string, Recording> all;
  const auto [entry, is_new] = all.try_emplace(sampler);
  if (!is_new) return entry->second;
  const SamplerState state = state_of(sampler);
  std::vector<double> sum(image_size * image_size * 3);
  std::vector<std::uint32_t> count(image_size * image_size);
  TileJob job{&scene().data(), &state, {}, {image_size, sum.data(), count.data()}};
  job.samples = wave_paths / (tile_size * tile_size);
  const auto wave = std::make_unique<Wave>();
  for (job.y0 = 0; job.y0 < image_size; job.y0 += tile_size) {
    for (job.x0 = 0; job.x0 < image_size; job.x0 += tile_size) {
      job.x1 = job.x0 + tile_size, job.y1 = job.y0 + tile_size;
      record_wave(job, *wave, entry->second);
    }
  }
  return entry->second;
}

template <class Queue>
double total(const std::vector<Queue>& queues) {
  double rays = 0.0;
  for (const Queue& q : queues) rays += q.count;
  return rays;
}

void report(benchmark::State& loop, double rays, const TileCounts& counts) {
  loop.counters["rays"] = benchmark::Counter(rays, benchmark::Counter::kIsIterationInvariantRate);
  loop.counters["lanes"] = double(counts.active_lanes) / double(counts.lanes);
}

template <int W>
void closest_hits(benchmark::State& loop, std::string sampler, bool bounce, bool coherent) {
  const Recording& r = recording(sampler);
  const std::vector<RayQueue>& queues = bounce ? r.bounce : r.camera;
  const auto hits = std::make_unique<HitArray>();
  TileCounts counts;
  for (auto _ : loop) {
    for (const RayQueue& q : queues) intersect<W>(scene().data(), coherent, q, *hits, counts);
    benchmark::ClobberMemory();
  }
  report(loop, total(queues), counts);
}

template <int W>
void shadow_rays(benchmark::State& loop, std::string sampler, bool coherent) {
  const Recording& r = recording(sampler);
  const auto paths = std::make_unique<PathTable>();
  TileCounts counts;
  for (auto _ : loop) {
    for (const ShadowQueue& q : r.shadows) {
      trace_shadows<W>(scene().data(), coherent, q, *paths, counts);
    }
    benchmark::ClobberMemory();
  }
  report(loop, total(r.shadows), counts);
}

template <int W>
void register_width() {
  for (const std::string sampler : {"cpt", "rcs:weight=0.125,offset=fresh", "owen"}) {
    for (const bool coherent : {false, true}) {
      const auto add = [&](std::string_view kind, auto function, auto... arguments) {
        const std::string label =
            fmt::format("traversal/{}/{}/{}/{}/width:{}/coherent:{}/seed:{}", scene_name, kind,
                        sampler, name(isa), W, int(coherent), seed);
        benchmark::RegisterBenchmark(label.c_str(), function, sampler, arguments..., coherent)
            ->Unit(benchmark::kMillisecond)
            ->MinTime(0.3);
      };
      add("camera", closest_hits<W>, false);
      add("shadow", shadow_rays<W>);
      add("bounce1", closest_hits<W>, true);
    }
  }
}

}  // namespace
}  // namespace lockstep

int main(int argc, char** argv) {
  using namespace lockstep;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  register_width<1>();
  register_width<4>();
  register_width<8>();
  register_width<16>();
  benchmark::RunSpecifiedBenchmarks();
}
