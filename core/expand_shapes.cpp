#include "core/expand_shapes.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

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

// Disks become meshes, and in objects spheres do: instances may stretch them.
void make_meshes(std::vector<Shape>& shapes, bool spheres) {
  for (Shape& shape : shapes) {
    if (const auto* disk = std::get_if<Disk>(&shape.geometry)) shape.geometry = disk_mesh(*disk);
    const auto* sphere = std::get_if<Sphere>(&shape.geometry);
    if (!sphere || !spheres) continue;
    TriangleMesh mesh = tessellated_sphere(sphere->radius, 64);
    for (glm::vec3& p : mesh.positions) p += sphere->center;
    shape.geometry = std::move(mesh);
  }
}

// Embree needs the inverse.
bool is_invertible(const glm::mat4& m) {
  const float determinant = glm::determinant(glm::mat3(m));
  const float inverse = 1.0f / determinant;
  return std::isfinite(determinant) && std::isfinite(inverse);
}

// Gives instances of objects that are placed once, and those that flatten their object, shapes of
// their own: rays then need no transform, and memory hardly more.
void place_copies(SceneDescription& scene) {
  std::vector<int> uses(scene.objects.size(), 0);
  for (const Instance& instance : scene.instances) ++uses[size_t(instance.object)];
  std::vector<Instance> kept;
  for (const Instance& instance : scene.instances) {
    if (uses[size_t(instance.object)] > 1 && is_invertible(instance.to_world)) {
      kept.push_back(instance);
      continue;
    }
    for (Shape shape : scene.objects[size_t(instance.object)].shapes) {
      apply_transform(std::get<TriangleMesh>(shape.geometry), instance.to_world);
      scene.shapes.push_back(std::move(shape));
    }
  }
  scene.instances = std::move(kept);
  std::vector<bool> used(scene.objects.size(), false);
  for (const Instance& instance : scene.instances) used[size_t(instance.object)] = true;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) scene.objects[i].shapes.clear();
  }
}

}  // namespace

void expand_shapes(SceneDescription& scene) {
  make_meshes(scene.shapes, false);
  for (ObjectDescription& object : scene.objects) make_meshes(object.shapes, true);
  place_copies(scene);
}

}  // namespace lockstep
