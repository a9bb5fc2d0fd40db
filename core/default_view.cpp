#include "core/default_view.h"

#include "core/builtin/parts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lockstep {
namespace {

struct Bounds {
  glm::vec3 lo{std::numeric_limits<float>::max()}, hi{-std::numeric_limits<float>::max()};

  bool empty() const { return lo.x > hi.x; }
  void grow(glm::vec3 p, float radius = 0.0f) {
    lo = glm::min(lo, p - radius);
    hi = glm::max(hi, p + radius);
  }
};

void grow(Bounds& bounds, const std::vector<Shape>& shapes) {
  for (const Shape& shape : shapes) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
      for (const glm::vec3 p : mesh->positions) bounds.grow(p);
    } else if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
      bounds.grow(sphere->center, sphere->radius);
    } else if (const auto* disk = std::get_if<Disk>(&shape.geometry)) {
      bounds.grow(disk->center, disk->radius);
    }
  }
}

Bounds bounds_of(const SceneDescription& scene) {
  Bounds all;
  grow(all, scene.shapes);
  std::vector<Bounds> objects(scene.objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) grow(objects[i], scene.objects[i].shapes);
  for (const Instance& instance : scene.instances) {
    const Bounds& object = objects[size_t(instance.object)];
    if (object.empty()) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 p(corner & 1 ? object.hi.x : object.lo.x,
                        corner & 2 ? object.hi.y : object.lo.y,
                        corner & 4 ? object.hi.z : object.lo.z);
      all.grow(glm::vec3(instance.to_world * glm::vec4(p, 1.0f)));
    }
  }
  return all;
}

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
    radius = glm::length(0.5f * bounds.hi - 0.5f * bounds.lo);
  }
  if (!(radius > 0.0f && std::isfinite(radius))) radius = 1.0f;

  CameraDescription camera;
  camera.fov_degrees = 40.0f;
  const float distance = radius / std::sin(0.5f * glm::radians(camera.fov_degrees));
  const glm::vec3 eye = center + distance * glm::normalize(glm::vec3(1.0f, 0.6f, 1.0f));
  camera.camera_to_world = builtin::look_at(eye, center);
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
