#include "core/flatten.h"

#include "core/fingerprint.h"

#include <tbb/parallel_invoke.h>
#include <glm/gtc/matrix_inverse.hpp>

#include <algorithm>
#include <array>

namespace lockstep {
namespace {

void append(std::vector<float>& out, glm::vec3 v) { out.insert(out.end(), {v.x, v.y, v.z}); }

void append_values(const std::vector<glm::vec3>& from, std::vector<float>& out) {
  if (!from.empty()) out.insert(out.end(), &from[0].x, &from[0].x + 3 * from.size());
}

// The scene's own shapes, then each object's: in the order of their numbers.
template <class F>
void for_each_shape(const SceneDescription& description, const F& f) {
  for (const Shape& shape : description.shapes) f(shape);
  for (const ObjectDescription& object : description.objects) {
    for (const Shape& shape : object.shapes) f(shape);
  }
}

template <class F>
void for_each_mesh(const SceneDescription& description, const F& f) {
  for_each_shape(description, [&](const Shape& shape) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) f(*mesh);
  });
}

void append_positions(const SceneDescription& description, std::vector<float>& positions) {
  for_each_mesh(description,
                [&](const TriangleMesh& mesh) { append_values(mesh.positions, positions); });
}

// Indices count over the vertices of all meshes.
void append_triangles(const SceneDescription& description, std::vector<std::int32_t>& triangles) {
  std::int32_t first_vertex = 0;
  for_each_mesh(description, [&](const TriangleMesh& mesh) {
    for (const glm::uvec3 t : mesh.triangles) {
      const glm::ivec3 moved = first_vertex + glm::ivec3(t);
      triangles.insert(triangles.end(), {moved.x, moved.y, moved.z});
    }
    first_vertex += std::int32_t(mesh.positions.size());
  });
}

void append_shape(FlatScene& flat, const Shape& shape, bool one_sided) {
  const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
  FlatGeometry g{0, 0, mesh == nullptr};
  if (!flat.geometries.empty()) {
    g.first_triangle =
        flat.geometries.back().first_triangle + flat.geometries.back().triangle_count;
  }
  if (mesh) {
    g.triangle_count = std::int32_t(mesh->triangles.size());
    flat.spheres.insert(flat.spheres.end(), 4, 0.0f);
  } else {
    const auto& sphere = std::get<Sphere>(shape.geometry);
    append(flat.spheres, sphere.center);
    flat.spheres.push_back(sphere.radius);
  }
  flat.geometries.push_back(g);
  const auto flag = [](bool set, GeometryFlag f) { return set ? int(f) : 0; };
  const int flags =
      flag(!mesh, geometry_is_sphere) | flag(mesh && !mesh->normals.empty(), geometry_is_smooth) |
      flag(mesh && !mesh->uvs.empty(), geometry_has_uvs) | flag(one_sided, geometry_is_one_sided) |
      flat.material_kinds[size_t(shape.material)] << geometry_kind_shift;
  flat.geometry_rows.insert(flat.geometry_rows.end(),
                            {mesh ? g.first_triangle : 0, shape.material, -1, flags});
}

void append_instance_row(const glm::mat4& to_world, FlatScene& flat) {
  const glm::mat3 linear(to_world);
  const glm::mat3 normals = glm::inverseTranspose(linear);
  const float side = glm::determinant(linear) < 0.0f ? -1.0f : 1.0f;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      flat.instance_rows.push_back(to_world[column][row]);
    }
  }
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) flat.instance_rows.push_back(normals[column][row]);
    flat.instance_rows.push_back(row == 0 ? side : 0.0f);
  }
}

void append_instances(const SceneDescription& description, FlatScene& flat) {
  auto first = std::uint32_t(description.shapes.size());
  for (const ObjectDescription& object : description.objects) {
    const auto count = std::uint32_t(object.shapes.size());
    flat.objects.push_back({first, count});
    first += count;
  }
  append_instance_row(glm::mat4(1.0f), flat);
  for (const Instance& instance : description.instances) {
    flat.instances.push_back({instance.object, instance.to_world});
    append_instance_row(instance.to_world, flat);
  }
}

// What hits on the shapes need: of materials that no shape has, nothing.
FeatureMask material_features_of(const SceneDescription& description, const FlatScene& flat) {
  std::vector<bool> used(description.materials.size(), false);
  std::vector<int> open;
  for_each_shape(description, [&](const Shape& shape) { open.push_back(shape.material); });
  FeatureMask set = 0;
  while (!open.empty()) {
    const auto material = std::size_t(open.back());
    open.pop_back();
    if (used[material]) continue;
    used[material] = true;
    set |= flat.material_features[material];
    if (const auto* mix = std::get_if<MixMaterial>(&description.materials[material].model)) {
      open.insert(open.end(), {mix->first, mix->second});
    }
  }
  return set;
}

FeatureMask geometry_features(const FlatScene& flat) {
  FeatureMask set = 0;
  for (std::size_t i = 3; i < flat.geometry_rows.size(); i += geometry_stride) {
    const int flags = flat.geometry_rows[i];
    if (flags & geometry_is_sphere) set |= bit(Feature::Spheres);
    if (flags & geometry_is_smooth) set |= bit(Feature::SmoothNormals);
  }
  if (!flat.instances.empty()) set |= bit(Feature::Instances);
  return set;
}

FeatureMask light_features(const FlatScene& flat) {
  FeatureMask set = flat.light_kinds.size() > 1 ? bit(Feature::LightChoice) : 0u;
  for (const std::int32_t kind : flat.light_kinds) set |= bit(light_feature(LightKind(kind)));
  return set;
}

bool is_trilinear(const Texture& texture, const std::vector<bool>& found) {
  const auto any_of = [&](const auto&... inputs) {
    const auto is = [&](int t) {
      return t >= 0 && std::size_t(t) < found.size() && found[std::size_t(t)];
    };
    return (... || is(inputs.texture));
  };
  if (const auto* image = std::get_if<ImageTexture>(&texture)) {
    return image->filter == TextureFilter::Trilinear;
  }
  if (const auto* board = std::get_if<CheckerboardTexture>(&texture)) {
    return any_of(board->even, board->odd);
  }
  if (const auto* product = std::get_if<ProductTexture>(&texture)) {
    return any_of(product->a, product->b);
  }
  const auto& mix = std::get<MixTexture>(texture);
  return any_of(mix.a, mix.b, mix.amount);
}

// Which textures need a footprint: images, then what refers to them, however deep.
std::vector<bool> trilinear_textures(const std::vector<Texture>& textures) {
  std::vector<bool> found(textures.size(), false);
  for (bool more = true; more;) {
    more = false;
    for (std::size_t i = 0; i < textures.size(); ++i) {
      if (found[i] || !is_trilinear(textures[i], found)) continue;
      found[i] = more = true;
    }
  }
  return found;
}

// Of materials and lights; opacity is looked up without a footprint.
FeatureMask texture_features(const SceneDescription& description, const FlatScene& flat) {
  constexpr FeatureMask readers =
      feature_set(Feature::Textures, Feature::SurfaceMaps, Feature::TexturedLights);
  if (!(flat.features & readers)) return 0;
  const std::vector<bool> trilinear = trilinear_textures(description.textures);
  const auto& bindings = flat.texture_bindings;
  const bool any = std::any_of(bindings.begin(), bindings.end(), [&](const TextureBinding& b) {
    return std::size_t(b.texture) < trilinear.size() && trilinear[std::size_t(b.texture)];
  });
  return any ? bit(Feature::Trilinear) : 0u;
}

// Normals for every vertex as soon as one mesh has them; the others' stay unused.
void append_normals(FlatScene& flat, const SceneDescription& description) {
  if (!(flat.features & bit(Feature::SmoothNormals))) return;
  for_each_mesh(description, [&](const TriangleMesh& mesh) {
    append_values(mesh.normals, flat.normals);
    for (std::size_t i = mesh.normals.size(); i < mesh.positions.size(); ++i) {
      append(flat.normals, glm::vec3(0.0f, 0.0f, 1.0f));
    }
  });
}

// Of every vertex as soon as anything reads them.
void append_uvs(FlatScene& flat, const SceneDescription& description) {
  constexpr FeatureMask readers =
      uv_features | feature_set(Feature::Opacity, Feature::TexturedLights);
  if (!(flat.features & readers)) return;
  for_each_mesh(description, [&](const TriangleMesh& mesh) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const glm::vec2 uv = mesh.uvs.empty() ? glm::vec2(0.0f) : mesh.uvs[i];
      flat.uvs.insert(flat.uvs.end(), {uv.x, uv.y});
    }
  });
  flat.uvs.insert(flat.uvs.end(), 6, 0.0f);  // for lanes on spheres, and to read four at a time
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
  for_each_mesh(description, [&](const TriangleMesh& mesh) {
    vertices += mesh.positions.size();
    triangles += mesh.triangles.size();
    smooth = smooth || !mesh.normals.empty();
  });
  flat.positions.reserve(3 * vertices + 3);
  if (smooth) flat.normals.reserve(3 * vertices + 3);
  flat.triangles.reserve(3 * triangles + 4);
}

// All but the arrays of positions and triangles.
void flatten_rest(const SceneDescription& description, glm::vec3 environment_radiance,
                  const TextureTable& textures, FlatScene& flat) {
  flatten_materials(description, flat);
  for_each_shape(description, [&](const Shape& shape) {
    append_shape(flat, shape, !description.materials[size_t(shape.material)].two_sided);
  });
  append_instances(description, flat);
  flat.features = geometry_features(flat) | material_features_of(description, flat);
  append_normals(flat, description);
  flatten_lights(description, environment_radiance, textures, flat);
  flat.features |= light_features(flat);
  flat.features |= texture_features(description, flat);
  append_uvs(flat, description);
}

}  // namespace

FlatScene flatten(const SceneDescription& description, glm::vec3 environment_radiance,
                  const TextureTable& textures) {
  FlatScene flat;
  reserve(description, flat);
  tbb::parallel_invoke([&] { append_positions(description, flat.positions); },
                       [&] { append_triangles(description, flat.triangles); },
                       [&] { flatten_rest(description, environment_radiance, textures, flat); });
  pad(flat);
  flatten_camera(description.camera, description.film, flat);
  return flat;
}

std::uint64_t fingerprint(const FlatScene& flat) {
  Fingerprint print;
  const CameraData& camera = flat.camera;
  for (const glm::vec3 v :
       {camera.origin, camera.right, camera.down, camera.corner, camera.lens_x, camera.lens_y}) {
    print.add_all(std::array{v.x, v.y, v.z});
  }
  print.add_all(std::array{float(camera.width), float(camera.height), camera.focal_distance,
                           camera.footprint});
  print.add_all(std::array{std::int32_t(flat.features), std::int32_t(flat.features >> 32),
                           flat.environment_light});
  using Floats = std::initializer_list<const std::vector<float>*>;
  for (const auto* values :
       Floats{&flat.positions, &flat.normals, &flat.uvs, &flat.spheres, &flat.material_parameters,
              &flat.measured, &flat.light_rows, &flat.glow_rows, &flat.light_cdf, &flat.filter_x,
              &flat.filter_y, &flat.filter_weight_x, &flat.filter_weight_y}) {
    print.add_all(*values);
  }
  using Integers = std::initializer_list<const std::vector<std::int32_t>*>;
  for (const auto* values : Integers{&flat.triangles, &flat.geometry_rows, &flat.material_kinds,
                                     &flat.material_maps, &flat.light_of_primitive}) {
    print.add_all(*values);
  }
  for (const FlatInstance& instance : flat.instances) {
    print.add(std::int32_t(instance.object));
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r) print.add(instance.to_world[c][r]);
    }
  }
  const auto add_binding = [&](const TextureBinding& b) {
    print.add_all(std::array{b.texture, b.column, b.columns, std::int32_t(b.is_color), b.channel});
    print.add_all(std::array{b.power, b.scale.x, b.scale.y, b.scale.z});
  };
  for (const TextureBinding& b : flat.texture_bindings) add_binding(b);
  for (const Opacity& o : flat.opacities) {
    print.add_all(std::array{o.value, o.cutoff});
    add_binding(o.binding);
  }
  return print.value();
}

std::size_t memory_bytes(const FlatScene& flat) {
  const auto sum = [](const auto&... arrays) {
    return (0u + ... + (arrays.capacity() * sizeof(arrays[0])));
  };
  return sum(flat.positions, flat.normals, flat.uvs, flat.triangles, flat.geometries,
             flat.geometry_rows, flat.coincident, flat.spheres, flat.material_kinds,
             flat.material_parameters, flat.measured, flat.material_maps, flat.texture_bindings,
             flat.opacities, flat.light_of_primitive, flat.light_kinds, flat.light_rows,
             flat.glow_rows, flat.light_cdf, flat.filter_x, flat.filter_y, flat.filter_weight_x,
             flat.filter_weight_y);
}

SceneData view(const FlatScene& flat) {
  SceneData d;
  d.triangles = flat.triangles.data();
  d.positions = flat.positions.data();
  d.normals = flat.normals.data();
  d.uvs = flat.uvs.data();
  d.light_of_primitive = flat.light_of_primitive.data();
  if (!flat.coincident.empty()) d.coincident = flat.coincident.data();
  d.instances = {std::int32_t(flat.geometries.size()), flat.instance_rows.data()};
  d.geometry = {flat.geometry_rows.data(), flat.spheres.data()};
  d.materials = {flat.material_parameters.data(),
                 flat.material_kinds.data(),
                 flat.material_maps.data(),
                 flat.texture_bindings.data(),
                 nullptr,
                 nullptr,
                 flat.measured.data(),
                 std::int32_t(flat.measured.size() / measured_floats)};
  d.lights = {int(flat.light_kinds.size()), flat.light_rows.data(), flat.light_cdf.data(),
              flat.glow_rows.data()};
  d.camera = flat.camera;
  if (!flat.filter_x.empty()) {
    d.camera.filter_x = flat.filter_x.data();
    d.camera.filter_y = flat.filter_y.data();
  }
  if (!flat.filter_weight_x.empty()) {
    d.camera.filter_weight_x = flat.filter_weight_x.data();
    d.camera.filter_weight_y = flat.filter_weight_y.data();
  }
  d.environment = flat.environment_light;
  d.features = flat.features;
  return d;
}

}  // namespace lockstep
