// What a scene consists of, as its file says: what `lockstep info` shows.
#pragma once

#include "core/bounds.h"
#include "core/read_scene.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lockstep {

struct ShapeCounts {
  std::size_t meshes = 0, spheres = 0, disks = 0;
  std::size_t triangles = 0, vertices = 0;  // of the meshes

  std::size_t shapes() const { return meshes + spheres + disks; }
};

struct MaterialCounts {
  std::string_view model;
  int count = 0;
  int textured = 0;  // whose model refers to a texture
  int opacity = 0, normal_map = 0, bump = 0;
};

struct TextureCount {
  std::string_view kind;
  int count = 0;
};

// An image as it is kept in memory, without smaller levels; or why it cannot be read.
struct ImageReport {
  std::string file;    // relative to the scene's folder where it lies in there
  std::string stored;  // "8-bit sRGB", "half", ...
  int width = 0, height = 0;
  std::size_t memory_bytes = 0;
  std::string error;
};

struct EmitterCounts {
  ShapeCounts counts;
  int two_sided = 0, textured = 0;
};

struct LightCounts {
  int point = 0, spot = 0, distant = 0;
};

struct EnvironmentReport {
  Environment environment;
  ImageReport image;        // of a map
  glm::vec3 mean_radiance;  // over the sphere
};

struct SceneReport {
  std::string scene;  // as named on the command line
  SceneFormat format{};
  double read_seconds = 0.0;   // without the images
  double image_seconds = 0.0;  // of textures and environment

  ShapeCounts own;      // outside objects
  ShapeCounts objects;  // each object once
  ShapeCounts placed;   // of all instances
  std::size_t object_count = 0, instance_count = 0;
  Bounds bounds;  // where instances are, of the boxes around their objects
  std::size_t geometry_bytes = 0;

  std::vector<MaterialCounts> materials;  // of the models that occur
  std::vector<TextureCount> textures;     // of the kinds that occur
  std::vector<ImageReport> images;        // in the order of their first use

  EmitterCounts emitters;
  LightCounts lights;
  std::optional<EnvironmentReport> environment;

  CameraDescription camera;
  FilmDescription film;
  RenderDefaults defaults;
  std::vector<std::string> warnings;
};

// Reads the scene, a built-in one or a file, and all its images. Images that cannot be read are
// part of the report. Throws what read_scene() throws.
SceneReport report_scene(const std::string& scene);

// For people: aligned lines, sections apart.
std::string report_text(const SceneReport& report);

// The same for scripts; lengths, colours and the camera as core/scene_description.h has them.
nlohmann::ordered_json report_json(const SceneReport& report);

}  // namespace lockstep
