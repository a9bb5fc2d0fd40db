#include "core/flatten.h"

#include "core/coincidence.h"
#include "core/error.h"
#include "core/fresnel.h"

#include <algorithm>
#include <bit>
#include <stdexcept>

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
  append(r.parameters, m.reflectance.value);
  return r;
}
MaterialRow row(const ConductorMaterial& m) {
  MaterialRow r{MaterialKind::Conductor, {}};
  append(r.parameters, m.eta.value);
  append(r.parameters, m.k.value);
  r.parameters.insert(r.parameters.end(), {m.alpha.x, m.alpha.y});
  return r;
}
MaterialRow row(const CoatedMaterial& m) {
  MaterialRow r{MaterialKind::Coated, {}};
  append(r.parameters, m.diffuse.value);
  append(r.parameters, m.specular.value);
  r.parameters.insert(r.parameters.end(),
                      {m.alpha, m.eta, m.layered ? 1.0f : 0.0f, inner_reflectance(m.eta)});
  return r;
}

// substitute_unsupported() has replaced the others.
template <class Model>
MaterialRow row(const Model&) {
  throw std::logic_error("a material model without a kernel");
}

void append_material(FlatScene& flat, const Material& material) {
  MaterialRow r = std::visit([](const auto& m) { return row(m); }, material.model);
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
  const int flags = (mesh ? 0 : geometry_is_sphere) |
                    (mesh && !mesh->normals.empty() ? geometry_is_smooth : 0) |
                    flat.material_kinds[size_t(shape.material)] << geometry_kind_shift;
  flat.geometry_rows.insert(flat.geometry_rows.end(),
                            {mesh ? g.first_triangle : 0, shape.material, -1, flags});
}

// What the shapes need.
FeatureMask shape_features(const FlatScene& flat) {
  FeatureMask set = 0;
  for (std::size_t i = 3; i < flat.geometry_rows.size(); i += geometry_stride) {
    const int flags = flat.geometry_rows[i];
    if (flags & geometry_is_sphere) set |= bit(Feature::Spheres);
    if (flags & geometry_is_smooth) set |= bit(Feature::SmoothNormals);
    set |= bit(material_feature(MaterialKind(flags >> geometry_kind_shift)));
  }
  return set;
}

FeatureMask light_features(const FlatScene& flat) {
  FeatureMask set = flat.light_kinds.size() > 1 ? bit(Feature::LightChoice) : 0u;
  for (const std::int32_t kind : flat.light_kinds) set |= bit(light_feature(LightKind(kind)));
  return set;
}

// Normals for every vertex as soon as one mesh has them; the others' stay unused.
void append_normals(FlatScene& flat, const SceneDescription& description) {
  if (!(flat.features & bit(Feature::SmoothNormals))) return;
  for (const Shape& shape : description.shapes) {
    const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
    if (!mesh) continue;
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
      append(flat.normals, mesh->normals.empty() ? glm::vec3(0.0f, 0.0f, 1.0f) : mesh->normals[i]);
    }
  }
}

// Embree reads 16 bytes per vertex, kernels rows of four values. Lanes on spheres look up the first
// triangle.
void pad(FlatScene& flat) {
  append(flat.positions, glm::vec3(0.0f));
  if (!flat.normals.empty()) append(flat.normals, glm::vec3(0.0f));
  flat.triangles.insert(flat.triangles.end(), 4, 0);
  flat.material_parameters.insert(flat.material_parameters.end(), 3, 0.0f);
}

// Exact sizes: large arrays that grow by doubling would take up to twice their memory.
void reserve(const SceneDescription& description, FlatScene& flat) {
  std::size_t vertices = 0, triangles = 0;
  bool smooth = false;
  for (const Shape& shape : description.shapes) {
    const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
    if (!mesh) continue;
    vertices += mesh->positions.size();
    triangles += mesh->triangles.size();
    smooth = smooth || !mesh->normals.empty();
  }
  flat.positions.reserve(3 * vertices + 3);
  if (smooth) flat.normals.reserve(3 * vertices + 3);
  flat.triangles.reserve(3 * triangles + 4);
}

}  // namespace

FlatScene flatten(const SceneDescription& description) {
  FlatScene flat;
  reserve(description, flat);
  for (const Material& m : description.materials) append_material(flat, m);
  for (const Shape& shape : description.shapes) append_shape(flat, shape);
  flat.features = shape_features(flat);
  append_normals(flat, description);
  flatten_lights(description, flat);
  flat.features |= light_features(flat);
  flat.coincident = find_coincident_triangles(flat.positions.data(), flat.triangles.data(),
                                              flat.triangles.size() / 3);
  pad(flat);
  flatten_camera(description.camera, description.film, flat);
  return flat;
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
  for (const auto* values : {&flat.triangles, &flat.geometry_rows, &flat.material_kinds}) {
    add(*values);
  }
  return hash;
}

std::size_t memory_bytes(const FlatScene& flat) {
  const auto sum = [](const auto&... arrays) {
    return (0u + ... + (arrays.capacity() * sizeof(arrays[0])));
  };
  return sum(flat.positions, flat.normals, flat.triangles, flat.geometries, flat.geometry_rows,
             flat.coincident, flat.spheres, flat.material_kinds, flat.material_parameters,
             flat.light_of_primitive, flat.light_kinds, flat.light_rows, flat.light_cdf,
             flat.filter_x, flat.filter_y);
}

SceneData view(const FlatScene& flat) {
  SceneData d;
  d.triangles = flat.triangles.data();
  d.positions = flat.positions.data();
  d.normals = flat.normals.data();
  d.light_of_primitive = flat.light_of_primitive.data();
  if (!flat.coincident.empty()) d.coincident = flat.coincident.data();
  d.geometry = {flat.geometry_rows.data(), flat.spheres.data()};
  d.materials = {flat.material_parameters.data()};
  d.lights = {int(flat.light_kinds.size()), flat.light_rows.data(), flat.light_cdf.data()};
  d.camera = flat.camera;
  if (!flat.filter_x.empty()) {
    d.camera.filter_x = flat.filter_x.data();
    d.camera.filter_y = flat.filter_y.data();
  }
  d.environment = flat.environment_light;
  d.features = flat.features;
  return d;
}

}  // namespace lockstep
