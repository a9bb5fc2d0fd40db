#include "core/expand_shapes.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace lockstep {
namespace {

TriangleMesh disk_mesh(const Disk& disk) {
  constexpr int corners = 128;
  // Of the disk's area.
  const double angle = 2.0 * std::numbers::pi / corners;
  const auto radius = float(double(disk.radius) * std::sqrt(angle / std::sin(angle)));
  const glm::vec3 n = disk.normal;
  const glm::vec3 x =
      glm::normalize(glm::cross(n, std::abs(n.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
  const glm::vec3 y = glm::cross(n, x);
  TriangleMesh mesh;
  mesh.positions.push_back(disk.center);
  for (unsigned i = 0; i < corners; ++i) {
    const auto a = float(angle * double(i));
    mesh.positions.push_back(disk.center + radius * (std::cos(a) * x + std::sin(a) * y));
    mesh.triangles.emplace_back(0u, 1u + i, 1u + (i + 1u) % corners);
  }
  return mesh;
}

void place_instances(SceneDescription& scene) {
  for (const Instance& instance : scene.instances) {
    for (Shape shape : scene.objects[size_t(instance.object)].shapes) {
      if (const auto* disk = std::get_if<Disk>(&shape.geometry)) shape.geometry = disk_mesh(*disk);
      if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
        TriangleMesh mesh = tessellated_sphere(sphere->radius, 64);
        for (glm::vec3& p : mesh.positions) p += sphere->center;
        shape.geometry = std::move(mesh);
      }
      apply_transform(std::get<TriangleMesh>(shape.geometry), instance.to_world);
      scene.shapes.push_back(std::move(shape));
    }
  }
  scene.instances.clear();
  scene.objects.clear();
}

}  // namespace

void expand_shapes(SceneDescription& scene) {
  place_instances(scene);
  for (Shape& shape : scene.shapes) {
    if (const auto* disk = std::get_if<Disk>(&shape.geometry)) shape.geometry = disk_mesh(*disk);
  }
}

}  // namespace lockstep
