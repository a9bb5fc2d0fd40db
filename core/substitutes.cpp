#include "core/substitutes.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace lockstep {
namespace {

// How often each thing was replaced, in words.
using Counts = std::map<std::string, int>;

void untexture(ColorInput& input, Counts& counts) {
  if (input.texture < 0) return;
  input = ColorInput(0.5f * input.value);
  ++counts["textures are not rendered yet; half of what scales them is used"];
}

void untexture(FloatInput& input, Counts& counts) {
  if (input.texture < 0) return;
  input = FloatInput(input.value * std::pow(0.5f, input.power));
  ++counts["textures are not rendered yet; half of what scales them is used"];
}

// Microfacets as kernels have them need some roughness: a mirror's reflection blurs by a pixel or
// so.
constexpr float least_alpha = 1e-3f;
float roughened(float alpha) { return std::max(alpha, least_alpha); }
glm::vec2 roughened(glm::vec2 alpha) { return {roughened(alpha.x), roughened(alpha.y)}; }

MaterialModel substitute(DiffuseMaterial m, Counts& counts) {
  untexture(m.reflectance, counts);
  if (m.sigma != FloatInput(0.0f)) ++counts["rough diffuse materials are rendered as Lambert's"];
  m.sigma = FloatInput(0.0f);
  return m;
}

// Kernels have no colour beside the indices of refraction: indices that reflect as much at normal
// incidence.
void fold_specular(ConductorMaterial& m) {
  const glm::vec3 eta = m.eta.value, k = m.k.value;
  const glm::vec3 below = (eta - 1.0f) * (eta - 1.0f) + k * k;
  const glm::vec3 metal = below / (below + 4.0f * eta);
  const glm::vec3 r = glm::clamp(metal * m.specular.value, glm::vec3(0.0f), glm::vec3(0.9999f));
  m.eta = ColorInput(glm::vec3(1.0f));
  m.k = ColorInput(2.0f * glm::sqrt(r) / glm::sqrt(1.0f - r));
  m.specular = ColorInput{};
}

MaterialModel substitute(ConductorMaterial m, Counts& counts) {
  untexture(m.eta, counts);
  untexture(m.k, counts);
  untexture(m.specular, counts);
  if (m.specular != ColorInput{}) fold_specular(m);
  untexture(m.alpha_scale, counts);
  m.alpha = roughened(m.alpha * m.alpha_scale.value);
  m.alpha_scale = FloatInput{};
  return m;
}

MaterialModel substitute(CoatedMaterial m, Counts& counts) {
  untexture(m.diffuse, counts);
  untexture(m.specular, counts);
  untexture(m.alpha_scale, counts);
  m.alpha = roughened(m.alpha * m.alpha_scale.value);
  m.alpha_scale = FloatInput{};
  return m;
}

MaterialModel substitute(const PrincipledMaterial& m, Counts& counts) {
  ++counts["principled materials are rendered as coated diffuse ones"];
  FloatInput alpha = m.alpha;
  untexture(alpha, counts);
  CoatedMaterial coated;
  coated.diffuse = m.base_color;
  coated.alpha = alpha.value;
  coated.eta = m.eta;
  return substitute(coated, counts);
}

MaterialModel substitute(const DielectricMaterial&, Counts& counts) {
  ++counts["dielectric materials are not rendered yet; a diffuse grey is used"];
  return DiffuseMaterial{};
}

MaterialModel substitute(const DiffuseTransmissionMaterial& m, Counts& counts) {
  ++counts["light through diffuse materials is not rendered yet; they only reflect"];
  return substitute(DiffuseMaterial{m.reflectance, 0.0f}, counts);
}

void substitute_material(std::vector<Material>& materials, std::size_t i, Counts& counts) {
  Material& m = materials[i];
  if (m.opacity != FloatInput(1.0f)) ++counts["opacity is not rendered yet"];
  if (m.normal_map >= 0 || m.bump) ++counts["normal and bump maps are not rendered yet"];
  // A mix refers to a material, which may be a mix again, but never in a circle.
  MaterialModel model = m.model;
  while (const auto* mix = std::get_if<MixMaterial>(&model)) {
    ++counts["of mixed materials only the first is rendered"];
    MaterialModel first = materials[size_t(mix->first)].model;
    model = std::move(first);
  }
  const auto replaced = [&](const auto& known) -> MaterialModel {
    if constexpr (std::is_same_v<std::decay_t<decltype(known)>, MixMaterial>) {
      return known;
    } else {
      return substitute(known, counts);
    }
  };
  m = Material{};
  m.model = std::visit(replaced, model);
}

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

void substitute_environment(SceneDescription& scene, Counts& counts) {
  if (scene.environment && scene.environment->mapping != Environment::Mapping::Constant) {
    ++counts["environment maps are not rendered yet; a constant one is used"];
    scene.environment = Environment(0.5f * scene.environment->radiance);
  }
}

void substitute_camera(CameraDescription& camera, Counts& counts) {
  if (camera.projection == CameraDescription::Projection::Orthographic) {
    ++counts["orthographic cameras are not rendered yet; a perspective one is used"];
  }
  if (camera.lens_radius > 0.0f) ++counts["lenses are not rendered yet; a pinhole is used"];
  camera.projection = CameraDescription::Projection::Perspective;
  camera.lens_radius = 0.0f;
}

}  // namespace

void substitute_unsupported(SceneDescription& scene) {
  Counts counts;
  // Mixes refer to others: these are replaced last.
  for (const bool mixes : {true, false}) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
      const bool is_mix = std::holds_alternative<MixMaterial>(scene.materials[i].model);
      if (is_mix == mixes) substitute_material(scene.materials, i, counts);
    }
  }
  place_instances(scene);
  for (Shape& shape : scene.shapes) {
    if (const auto* disk = std::get_if<Disk>(&shape.geometry)) shape.geometry = disk_mesh(*disk);
    if (shape.emission) untexture(shape.emission->radiance, counts);
  }
  substitute_environment(scene, counts);
  substitute_camera(scene.camera, counts);
  scene.textures.clear();
  for (const auto& [what, times] : counts) {
    scene.warnings.push_back(fmt::format("{}: {} ({}x)", scene.name, what, times));
  }
}

}  // namespace lockstep
