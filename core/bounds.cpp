#include "core/bounds.h"

#include <glm/exponential.hpp>

namespace lockstep {
namespace {

void grow(Bounds& bounds, const std::vector<Shape>& shapes) {
  for (const Shape& shape : shapes) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
      for (const glm::vec3 p : mesh->positions) bounds.grow(p);
    } else if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
      bounds.grow(sphere->center, glm::vec3(sphere->radius));
    } else if (const auto* disk = std::get_if<Disk>(&shape.geometry)) {
      const glm::vec3 n = disk->normal;
      bounds.grow(disk->center, disk->radius * glm::sqrt(glm::max(1.0f - n * n, 0.0f)));
    }
  }
}

void grow(Bounds& bounds, const Bounds& object, const glm::mat4& to_world) {
  if (object.empty()) return;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(corner & 1 ? object.hi.x : object.lo.x,
                      corner & 2 ? object.hi.y : object.lo.y,
                      corner & 4 ? object.hi.z : object.lo.z);
    bounds.grow(glm::vec3(to_world * glm::vec4(p, 1.0f)));
  }
}

}  // namespace

Bounds bounds_of(const SceneDescription& scene) {
  Bounds all;
  grow(all, scene.shapes);
  std::vector<Bounds> objects(scene.objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) grow(objects[i], scene.objects[i].shapes);
  for (const Instance& instance : scene.instances) {
    grow(all, objects[size_t(instance.object)], instance.to_world);
  }
  return all;
}

}  // namespace lockstep
