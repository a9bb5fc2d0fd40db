#include "core/flatten.h"

#include "core/error.h"
#include "core/fresnel.h"

#include <algorithm>
#include <bit>

namespace lockstep {
namespace {

void append(std::vector<float>& out, glm::vec3 v) { out.insert(out.end(), {v.x, v.y, v.z}); }

// Reflectance of diffuse light that meets a dielectric interface from its dense side
// (1 - r_in) = (1 - r_out) / eta^2, with r_out the cosine-weighted mean of Fresnel's formula.
float inner_reflectance(float eta) {
  constexpr int steps = 512;
  double outer = 0.0;
  for (int i = 0; i < steps; ++i) {
    const float cos_i = (float(i) + 0.5f) / steps;
    outer += 2.0 * cos_i * fresnel_dielectric(cos_i, eta) / steps;
  }
  return float(1.0 - (1.0 - outer) / (double(eta) * double(eta)));
}

struct MaterialRow {
  MaterialKind kind;
  std::vector<float> parameters;
};

MaterialRow row(const DiffuseMaterial& m) {
  MaterialRow r{MaterialKind::Diffuse, {}};
  append(r.parameters, m.reflectance);
  return r;
}
MaterialRow row(const ConductorMaterial& m) {
  MaterialRow r{MaterialKind::Conductor, {}};
  append(r.parameters, m.eta);
  append(r.parameters, m.k);
  r.parameters.insert(r.parameters.end(), {m.alpha.x, m.alpha.y});
  return r;
}
MaterialRow row(const CoatedMaterial& m) {
  MaterialRow r{MaterialKind::Coated, {}};
  append(r.parameters, m.diffuse);
  append(r.parameters, m.specular);
  r.parameters.insert(r.parameters.end(),
                      {m.alpha, m.eta, m.layered ? 1.0f : 0.0f, inner_reflectance(m.eta)});
  return r;
}

void append_material(FlatScene& flat, const Material& material) {
  MaterialRow r = std::visit([](const auto& m) { return row(m); }, material);
  r.parameters.resize(material_stride, 0.0f);
  flat.material_kinds.push_back(std::int32_t(r.kind));
  flat.material_parameters.insert(flat.material_parameters.end(), r.parameters.begin(),
                                  r.parameters.end());
}

void append_mesh(FlatScene& flat, const TriangleMesh& mesh) {
  const auto first_vertex = std::int32_t(flat.positions.size() / 3);
  for (const glm::vec3 p : mesh.positions) append(flat.positions, p);
  for (const glm::uvec3 t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) flat.triangles.push_back(first_vertex + std::int32_t(t[k]));
  }
}

void append_shape(FlatScene& flat, const Shape& shape) {
  const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
  FlatGeometry g{std::int32_t(flat.triangles.size() / 3), 0, mesh == nullptr};
  if (mesh) {
    g.triangle_count = std::int32_t(mesh->triangles.size());
    append_mesh(flat, *mesh);
    flat.spheres.insert(flat.spheres.end(), 4, 0.0f);
  } else {
    const auto& sphere = std::get<Sphere>(shape.geometry);
    append(flat.spheres, sphere.center);
    flat.spheres.push_back(sphere.radius);
  }
  flat.geometries.push_back(g);
  flat.first_triangle.push_back(mesh ? g.first_triangle : 0);
  flat.material.push_back(shape.material);
  flat.first_light.push_back(-1);
  flat.is_sphere.push_back(g.is_sphere);
  flat.is_smooth.push_back(mesh && !mesh->normals.empty());
}

// Normals for every vertex as soon as one mesh has them; the others' stay unused.
void append_normals(FlatScene& flat, const SceneDescription& description) {
  if (std::ranges::count(flat.is_smooth, 1) == 0) return;
  flat.normals.reserve(flat.positions.size());
  for (const Shape& shape : description.shapes) {
    const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
    if (!mesh) continue;
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
      append(flat.normals, mesh->normals.empty() ? glm::vec3(0.0f, 0.0f, 1.0f) : mesh->normals[i]);
    }
  }
}

}  // namespace

FlatScene flatten(const SceneDescription& description) {
  FlatScene flat;
  for (const Material& m : description.materials) append_material(flat, m);
  for (const Shape& shape : description.shapes) append_shape(flat, shape);
  append_normals(flat, description);
  flatten_lights(description, flat);
  // Embree reads 16 bytes per vertex; kernels may look up triangle 0 for lanes on spheres.
  append(flat.positions, glm::vec3(0.0f));
  flat.triangles.insert(flat.triangles.end(), 3, 0);
  flatten_camera(description.camera, description.film, flat);
  return flat;
}

Features find_features(const SceneDescription& description, const FlatScene& flat) {
  const auto has_kind = [&](const std::vector<std::int32_t>& kinds, auto kind) {
    return std::ranges::find(kinds, std::int32_t(kind)) != kinds.end();
  };
  const auto has_material = [&](MaterialKind kind) {
    return std::ranges::any_of(description.shapes, [&](const Shape& s) {
      return flat.material_kinds[size_t(s.material)] == std::int32_t(kind);
    });
  };
  Features f;
  f.smooth_normals = !flat.normals.empty();
  f.spheres = has_kind(flat.is_sphere, 1);
  f.diffuse = has_material(MaterialKind::Diffuse);
  f.conductor = has_material(MaterialKind::Conductor);
  f.coated = has_material(MaterialKind::Coated);
  f.environment = flat.environment_light >= 0;
  f.area_lights = flat.light_kinds.size() > (f.environment ? 1u : 0u);
  f.many_lights = flat.light_kinds.size() > 1;
  f.filter_table = !flat.camera.box_filter;
  return f;
}

std::uint64_t fingerprint(const FlatScene& flat) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a, a word at a time
  const auto add = [&](const auto& values) {
    hash = (hash ^ values.size()) * 0x100000001b3u;
    for (const auto value : values) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x100000001b3u;
      hash ^= hash >> 29;
    }
  };
  const CameraData& c = flat.camera;
  std::vector<float> camera{float(c.width), float(c.height)};
  for (const glm::vec3 v : {c.origin, c.right, c.down, c.corner}) append(camera, v);
  using Floats = std::initializer_list<const std::vector<float>*>;
  for (const auto* values :
       Floats{&flat.positions, &flat.normals, &flat.spheres, &flat.material_parameters,
              &flat.light_rows, &flat.filter_x, &flat.filter_y, &camera}) {
    add(*values);
  }
  for (const auto* values :
       {&flat.triangles, &flat.first_triangle, &flat.material, &flat.first_light, &flat.is_sphere,
        &flat.is_smooth, &flat.material_kinds, &flat.light_kinds}) {
    add(*values);
  }
  return hash;
}

SceneData view(const FlatScene& flat, const Features& features) {
  SceneData d;
  d.triangles = flat.triangles.data();
  d.positions = flat.positions.data();
  d.normals = flat.normals.data();
  d.light_of_primitive = flat.light_of_primitive.data();
  d.geometry = {flat.first_triangle.data(), flat.material.data(),  flat.first_light.data(),
                flat.is_sphere.data(),      flat.is_smooth.data(), flat.spheres.data()};
  d.materials = {flat.material_kinds.data(), flat.material_parameters.data()};
  d.lights = {int(flat.light_kinds.size()), flat.light_kinds.data(), flat.light_rows.data(),
              flat.light_cdf.data()};
  d.camera = flat.camera;
  d.camera.filter_x = flat.filter_x.data();
  d.camera.filter_y = flat.filter_y.data();
  d.environment = flat.environment_light;
  d.smooth_normals = features.smooth_normals;
  d.spheres = features.spheres;
  d.area_lights = features.area_lights;
  d.has_material[int(MaterialKind::Diffuse)] = features.diffuse;
  d.has_material[int(MaterialKind::Conductor)] = features.conductor;
  d.has_material[int(MaterialKind::Coated)] = features.coated;
  return d;
}

}  // namespace lockstep
