#include "core/scene.h"

#include "core/boundary_albedo.h"
#include "core/coincidence.h"
#include "core/environment_map.h"
#include "core/error.h"
#include "core/expand_shapes.h"
#include "core/flatten.h"
#include "core/ggx_albedo.h"
#include "core/opacity.h"
#include "core/texture_store.h"

#include <tbb/parallel_invoke.h>

#include <atomic>
#include <optional>
#include <utility>

namespace lockstep {
namespace {

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<RTCDeviceTy, DeviceRelease>;
using SceneHandle = std::unique_ptr<RTCSceneTy, SceneRelease>;

// On some CPUs Embree traces single rays with narrower instructions than packets, for the sake of
// their clock rate; then single rays and packets would round differently.
std::string device_settings(const std::string& isa) {
  if (isa.empty()) return "";
  const char* registers = isa == "avx512" ? "simd512" : isa == "avx2" ? "simd256" : "simd128";
  return "isa=" + isa + ",frequency_level=" + registers;
}

void check(RTCDevice device) {
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
    throw Error("Embree failed with error " + std::to_string(int(error)) +
                (error == RTC_ERROR_OUT_OF_MEMORY ? ": not enough memory for this scene" : ""));
  }
}

// Embree starts its threads with the device: where they find no memory, it calls that unknown.
std::string why_no_device(const std::string& embree_isa) {
  const RTCError error = rtcGetDeviceError(nullptr);
  return "Embree cannot start" + (embree_isa.empty() ? "" : " for instruction set " + embree_isa) +
         (error == RTC_ERROR_UNSUPPORTED_CPU
              ? ", which this CPU lacks; choose another --isa"
              : " (error " + std::to_string(int(error)) +
                    "): not enough memory or threads; give this process more");
}

bool has_environment_map(const SceneDescription& description) {
  return description.environment &&
         description.environment->mapping != Environment::Mapping::Constant;
}

// One Embree geometry per shape, over the shared vertex and index arrays.
void attach_shape(RTCDevice device, RTCScene scene, const FlatScene& flat, unsigned id,
                  Holes& holes) {
  const FlatGeometry& g = flat.geometries[id];
  RTCGeometry geometry = nullptr;
  if (g.is_sphere) {
    geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                               flat.spheres.data(), id * 4 * sizeof(float), 4 * sizeof(float), 1);
  } else {
    geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               flat.positions.data(), 0, 3 * sizeof(float),
                               flat.positions.size() / 3 - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               flat.triangles.data(), size_t(g.first_triangle) * 3 * sizeof(int),
                               3 * sizeof(int), size_t(g.triangle_count));
  }
  const std::int32_t material = flat.geometry_rows[id * geometry_stride + 1];
  if (flat.opacities[std::size_t(material)].has_holes()) set_holes(geometry, holes);
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

SceneHandle new_scene(RTCDevice device, bool robust) {
  SceneHandle scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
  return scene;
}

void attach_instance(RTCDevice device, RTCScene scene, RTCScene object, const glm::mat4& to_world,
                     unsigned id) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, object);
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &to_world[0][0]);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

}  // namespace

// Embree asks before it allocates and tells when it frees, from any thread.
struct EmbreeMemory {
  std::atomic<std::ptrdiff_t> bytes = 0, peak = 0;

  static bool count(void* self, ssize_t bytes, bool) {
    auto& m = *static_cast<EmbreeMemory*>(self);
    const std::ptrdiff_t now = m.bytes += bytes;
    for (std::ptrdiff_t peak = m.peak; now > peak && !m.peak.compare_exchange_weak(peak, now);) {
    }
    return true;
  }
};

struct Scene::Storage {
  EmbreeMemory embree_memory;    // outlives the device
  SceneDescription description;  // without its geometry, which `flat` holds
  TextureStore textures;
  TextureTable texture_table;
  std::optional<EnvironmentMap> environment_map;
  std::vector<float> ggx_albedo;       // see core/ggx_albedo.h
  std::vector<float> boundary_albedo;  // see core/boundary_albedo.h
  FlatScene flat;
  std::vector<Holes> holes;  // per geometry
  DeviceHandle device;
  SceneHandle scene;
  std::vector<SceneHandle> objects;
  SceneData data;
  std::uint64_t fingerprint = 0;

  void find_coincident() {
    flat.coincident =
        find_coincident_triangles(flat.positions.data(), flat.triangles.data(), triangle_count());
  }

  std::uint64_t fingerprint_of_all() const {
    std::uint64_t all = lockstep::fingerprint(flat) ^ textures.fingerprint() * 3u;
    if (environment_map) all ^= environment_map->fingerprint() * 5u;
    return description.robust_intersection ? all : all * 7u;
  }

  std::size_t triangle_count() const { return (flat.triangles.size() - 4) / 3; }  // padding aside

  void attach_shapes(RTCScene to, unsigned first, unsigned count) {
    for (unsigned id = first; id < first + count; ++id) {
      holes[id] = {&flat, &texture_table, id};
      attach_shape(device.get(), to, flat, id, holes[id]);
    }
  }

  // Instances are numbered after all shapes.
  void build() {
    const auto all = unsigned(flat.geometries.size());
    holes.resize(all);
    attach_shapes(scene.get(), 0, flat.objects.empty() ? all : flat.objects[0].first_geometry);
    for (const FlatObject& object : flat.objects) {
      objects.push_back(new_scene(device.get(), description.robust_intersection));
      attach_shapes(objects.back().get(), object.first_geometry, object.geometry_count);
      rtcCommitScene(objects.back().get());
    }
    for (std::size_t i = 0; i < flat.instances.size(); ++i) {
      const FlatInstance& instance = flat.instances[i];
      attach_instance(device.get(), scene.get(), objects[std::size_t(instance.object)].get(),
                      instance.to_world, all + unsigned(i));
    }
    rtcCommitScene(scene.get());
  }
};

Scene::Scene(SceneDescription description, const std::string& embree_isa)
    : storage_(std::make_unique<Storage>()) {
  Storage& s = *storage_;
  if (description.shapes.empty() && description.instances.empty() && description.lights.empty() &&
      !description.environment) {
    throw Error(description.name + ": nothing to render: no shape and no light");
  }
  expand_shapes(description);
  s.textures = TextureStore(description.textures);
  s.texture_table = s.textures.table();
  glm::vec3 environment_radiance(0.0f);
  if (has_environment_map(description)) {
    s.environment_map.emplace(*description.environment);
    environment_radiance = s.environment_map->mean_radiance();
  }
  s.flat = flatten(description, environment_radiance, s.texture_table);
  if (s.flat.features & bit(Feature::Compensation)) {
    s.ggx_albedo = make_ggx_albedo();
    s.boundary_albedo = make_boundary_albedo(s.flat.boundary_etas);
  }
  description.shapes.clear();
  description.objects.clear();
  description.textures.clear();
  description.measured.clear();
  s.description = std::move(description);

  s.device.reset(rtcNewDevice(device_settings(embree_isa).c_str()));
  if (!s.device) throw Error(why_no_device(embree_isa));
  rtcSetDeviceMemoryMonitorFunction(s.device.get(), EmbreeMemory::count, &s.embree_memory);
  s.scene = new_scene(s.device.get(), s.description.robust_intersection);
  tbb::parallel_invoke([&] { s.find_coincident(); },
                       [&] { s.fingerprint = s.fingerprint_of_all(); });
  s.build();
  check(s.device.get());

  s.data = view(s.flat);
  s.data.embree_scene = s.scene.get();
  s.data.textures = s.texture_table;
  if (!s.ggx_albedo.empty()) s.data.materials.ggx_albedo = s.ggx_albedo.data();
  if (!s.boundary_albedo.empty()) s.data.materials.boundary_albedo = s.boundary_albedo.data();
  if (s.environment_map) s.data.environment_map = s.environment_map->view();
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;

const SceneDescription& Scene::description() const { return storage_->description; }
const SceneData& Scene::data() const { return storage_->data; }
FeatureMask Scene::features() const { return storage_->data.features; }
std::size_t Scene::triangle_count() const { return storage_->triangle_count(); }
SceneMemory Scene::memory() const {
  std::size_t images = storage_->textures.memory_bytes();
  if (storage_->environment_map) images += storage_->environment_map->memory_bytes();
  return {memory_bytes(storage_->flat), images, std::size_t(storage_->embree_memory.bytes),
          std::size_t(storage_->embree_memory.peak)};
}
std::uint64_t Scene::fingerprint() const { return storage_->fingerprint; }

}  // namespace lockstep
