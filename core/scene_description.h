// A scene as its author wrote it, whatever the file format: what readers produce and
// core/scene.h turns into arrays for the kernels.
//
// Conventions: right-handed or left-handed world as the file has it; positions in world space;
// a triangle's geometric normal is normalize(cross(p1 - p0, p2 - p0)), and emission leaves from
// that side; colours are linear Rec. 709 RGB; lengths in the file's unit.
#pragma once

#include "core/camera_description.h"
#include "core/light_description.h"
#include "core/material.h"
#include "core/measured_table.h"
#include "core/mesh.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace lockstep {

// Radiance leaving a surface, W/(m^2 sr) per RGB channel; one-sided unless said otherwise.
struct Emission {
  ColorInput radiance{glm::vec3(0.0f)};
  bool two_sided = false;
};

struct Sphere {
  glm::vec3 center{0.0f};
  float radius = 1.0f;
  bool emits_inwards = false;
};

// One-sided like a triangle: its geometric normal is `normal`.
struct Disk {
  glm::vec3 center{0.0f};
  glm::vec3 normal{0.0f, 0.0f, 1.0f};  // unit
  float radius = 1.0f;
};

using Geometry = std::variant<TriangleMesh, Sphere, Disk>;

// One piece of geometry with its material; `material` indexes SceneDescription::materials.
struct Shape {
  Geometry geometry;
  int material = 0;
  std::optional<Emission> emission;
};

// Shapes in a space of their own, to be placed any number of times. They do not emit.
struct ObjectDescription {
  std::vector<Shape> shapes;
};

struct Instance {
  int object = 0;  // index of SceneDescription::objects
  glm::mat4 to_world{1.0f};
};

// What the scene's author asked for; the command line overrides each.
struct RenderDefaults {
  int spp = 16;
  int depth = 5;  // surface interactions that are lit; 1 is direct light only
};

struct SceneDescription {
  std::string name;
  std::vector<Texture> textures;
  std::vector<MeasuredTable> measured;
  std::vector<Material> materials;
  std::vector<Shape> shapes;
  std::vector<ObjectDescription> objects;
  std::vector<Instance> instances;
  std::vector<LightSource> lights;
  std::optional<Environment> environment;
  CameraDescription camera;
  FilmDescription film;
  RenderDefaults defaults;
  bool compensate_microfacets = false;  // light lost between facets is put back
  bool robust_intersection = true;      // else rays may slip through where triangles meet
  std::vector<std::string> warnings;    // one line each, "file:line: what was not understood"
};

}  // namespace lockstep
