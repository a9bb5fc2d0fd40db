#include "core/default_view.h"

#include "core/bounds.h"
#include "core/builtin/parts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lockstep {
namespace {

bool has_light(const SceneDescription& scene) {
  return scene.environment || !scene.lights.empty() ||
         std::any_of(scene.shapes.begin(), scene.shapes.end(),
                     [](const Shape& shape) { return shape.emission.has_value(); });
}

}  // namespace

void add_default_camera(SceneDescription& scene) {
  const Bounds bounds = bounds_of(scene);
  glm::vec3 center(0.0f);
  float radius = 1.0f;
  if (!bounds.empty()) {
    center = 0.5f * bounds.lo + 0.5f * bounds.hi;
    // In double: the squares of large coordinates leave float's range.
    radius = float(0.5 * glm::length(glm::dvec3(bounds.hi) - glm::dvec3(bounds.lo)));
  }
  if (!(radius > 0.0f && radius < 1e30f)) radius = 1.0f;

  CameraDescription camera;
  camera.fov_degrees = 40.0f;
  const float distance = radius / std::sin(0.5f * glm::radians(camera.fov_degrees));
  const glm::vec3 aside = glm::normalize(glm::vec3(1.0f, 0.6f, 1.0f));
  camera.camera_to_world = builtin::look_at(aside, glm::vec3(0.0f));
  camera.camera_to_world[3] = glm::vec4(center + distance * aside, 1.0f);
  camera.focal_distance = distance;
  scene.camera = camera;
  scene.warnings.push_back(scene.name + ": the file has no camera; one that frames all is used");
}

void add_default_light(SceneDescription& scene) {
  if (has_light(scene)) return;
  scene.environment = Environment(glm::vec3(1.0f));
  scene.warnings.push_back(scene.name +
                           ": the file has no light; an environment of radiance 1 is used");
}

void add_default_view(SceneDescription& scene) {
  add_default_camera(scene);
  add_default_light(scene);
}

}  // namespace lockstep
