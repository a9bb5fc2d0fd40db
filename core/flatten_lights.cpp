#include "core/bounds.h"
#include "core/flatten.h"
#include "core/texture.h"
#include "core/vec.h"
#include "core/warp.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lockstep {
namespace {

struct Light {
  LightKind kind{};
  glm::vec3 corner{0.0f}, edge1{0.0f}, edge2{0.0f}, normal{0.0f}, radiance{0.0f};
  float area = 0.0f;  // radius of a sphere
  float side = 1.0f;
  float power = 0.0f;
  float outline = 0.0f;  // column 19 of LightTable::rows
};

using Corners = std::array<glm::vec3, 3>;

Corners corners(const TriangleMesh& mesh, std::size_t triangle) {
  const glm::uvec3 t = mesh.triangles[triangle];
  return {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
}

Light flat_light(LightKind kind, glm::vec3 corner, glm::vec3 e1, glm::vec3 e2,
                 const Emission& emission) {
  const glm::vec3 n = glm::cross(e1, e2);
  const float parallelogram = glm::length(n);
  Light l{kind, corner, e1, e2, glm::vec3(0.0f), emission.radiance.value};
  l.area = kind == LightKind::Triangle ? 0.5f * parallelogram : parallelogram;
  if (parallelogram > 0.0f) l.normal = n / parallelogram;
  l.side = emission.two_sided ? 0.0f : 1.0f;
  l.power = luminance(emission.radiance.value) * l.area * (emission.two_sided ? 2.0f : 1.0f) *
            glm::pi<float>();
  return l;
}

Light parallelogram_light(glm::vec3 corner, glm::vec3 e1, glm::vec3 e2, const Emission& emission) {
  Light l = flat_light(LightKind::Parallelogram, corner, e1, e2, emission);
  const float lengths = glm::length(e1) * glm::length(e2);
  l.outline = std::abs(glm::dot(e1, e2)) <= 1e-4f * lengths ? 1.0f : 0.0f;
  return l;
}

// The parallelogram that two triangles sharing their diagonal make: p0, p0 + e1, p0 + e1 + e2,
// p0 + e2, if they make one. `a` is (p0, p1, p2) and `b` (p0, p2, p3) up to rotation of each.
std::optional<Light> as_parallelogram(const Corners& a, const Corners& b,
                                      const Emission& emission) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const glm::vec3 p0 = a[size_t(i)], p1 = a[size_t((i + 1) % 3)], p2 = a[size_t((i + 2) % 3)];
      const glm::vec3 q0 = b[size_t(j)], q2 = b[size_t((j + 1) % 3)], q3 = b[size_t((j + 2) % 3)];
      if (p0 != q0 || p2 != q2) continue;
      const glm::vec3 gap = (p1 - p0) + (q3 - p0) - (p2 - p0);
      const float size = glm::length(p2 - p0);
      if (glm::length(gap) <= 1e-5f * size) {
        return parallelogram_light(p0, p1 - p0, q3 - p0, emission);
      }
    }
  }
  return std::nullopt;
}

// The disk that a mesh stands for, as expand_shapes makes them and affine maps leave them: a fan of
// triangles around a centre, to a regular polygon's corners.
std::optional<Light> as_disk(const TriangleMesh& mesh, const Emission& emission) {
  const std::size_t n = mesh.triangles.size();
  if (n < 3) return std::nullopt;
  const std::vector<glm::vec3>& p = mesh.positions;
  const glm::vec3 centre = p[mesh.triangles[0].x];
  const auto corner = [&](std::size_t i) { return p[mesh.triangles[i % n].y]; };
  const auto angle = [&](std::size_t i) { return 2.0f * glm::pi<float>() * float(i) / float(n); };
  for (std::size_t i = 0; i < n; ++i) {
    const glm::uvec3 t = mesh.triangles[i];
    if (p[t.x] != centre || p[t.z] != corner(i + 1)) return std::nullopt;
  }
  glm::vec3 x(0.0f), y(0.0f);
  for (std::size_t i = 0; i < n; ++i) {
    x += 2.0f / float(n) * std::cos(angle(i)) * (corner(i) - centre);
    y += 2.0f / float(n) * std::sin(angle(i)) * (corner(i) - centre);
  }
  const float tolerance = 1e-5f * (glm::length(x) + glm::length(y));
  for (std::size_t i = 0; i < n; ++i) {
    const glm::vec3 expected = centre + std::cos(angle(i)) * x + std::sin(angle(i)) * y;
    if (!(glm::distance(corner(i), expected) <= tolerance)) return std::nullopt;
  }
  Light l = flat_light(LightKind::Disk, centre, x, y, emission);
  const float share = 0.5f * float(n) * std::sin(angle(1));  // of the parallelogram of x and y
  l.area *= share;
  l.power *= share;
  l.outline = float(n);
  return l;
}

// Lights of a mesh; `of_primitive` gets each triangle's light, counted from `first`.
std::vector<Light> mesh_lights(const TriangleMesh& mesh, const Emission& emission, int first,
                               std::vector<std::int32_t>& of_primitive) {
  if (auto disk = as_disk(mesh, emission)) {
    of_primitive.insert(of_primitive.end(), mesh.triangles.size(), first);
    return {*disk};
  }
  std::vector<Light> lights;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto index = first + std::int32_t(lights.size());
    const Corners a = corners(mesh, i);
    of_primitive.push_back(index);
    if (i + 1 < mesh.triangles.size()) {
      if (auto light = as_parallelogram(a, corners(mesh, i + 1), emission)) {
        lights.push_back(*light);
        of_primitive.push_back(index);
        ++i;
        continue;
      }
    }
    lights.push_back(flat_light(LightKind::Triangle, a[0], a[1] - a[0], a[2] - a[0], emission));
  }
  return lights;
}

Light sphere_light(const Sphere& sphere, const Emission& emission) {
  Light l{LightKind::Sphere, sphere.center};
  l.radiance = emission.radiance.value;
  l.area = sphere.radius;
  l.side = emission.two_sided ? 0.0f : sphere.emits_inwards ? -1.0f : 1.0f;
  l.power = luminance(emission.radiance.value) * 4.0f * glm::pi<float>() * glm::pi<float>() *
            sphere.radius * sphere.radius * (emission.two_sided ? 2.0f : 1.0f);
  return l;
}

float scene_radius(const SceneDescription& description) {
  const Bounds bounds = bounds_of(description);
  return bounds.empty() ? 1.0f : 0.5f * glm::length(bounds.hi - bounds.lo);
}

// Flux of the environment through the scene's bounding sphere; radiance: of a map its mean.
Light environment_light(LightKind kind, glm::vec3 radiance, float radius) {
  Light l{kind};
  l.radiance = radiance;
  l.power = luminance(radiance) * 4.0f * glm::pi<float>() * glm::pi<float>() * radius * radius;
  return l;
}

Light delta_light(const PointLight& p, float) {
  Light l{LightKind::Point, p.position};
  l.radiance = p.intensity;
  l.power = luminance(p.intensity) * 4.0f * glm::pi<float>();
  return l;
}

Light delta_light(const SpotLight& s, float) {
  Light l{LightKind::Spot, s.position};
  l.edge1 = {s.cos_inner, s.cos_outer, float(int(s.falloff))};
  l.edge2 = {std::acos(s.cos_inner), std::acos(s.cos_outer), 0.0f};
  l.normal = s.direction;
  l.radiance = s.intensity;
  l.power = luminance(s.intensity) * 2.0f * glm::pi<float>() *
            (1.0f - 0.5f * (s.cos_inner + s.cos_outer));
  return l;
}

Light delta_light(const DistantLight& d, float radius) {
  Light l{LightKind::Distant};
  l.normal = d.direction;
  l.radiance = d.irradiance;
  l.power = luminance(d.irradiance) * glm::pi<float>() * radius * radius;
  return l;
}

// Points of a triangle at which its texture is looked up to weigh its light; fewer each where there
// are many triangles.
constexpr std::size_t most_lookups = 1 << 22, lookups_per_triangle = 64;

using UvTriangle = std::array<glm::vec2, 3>;

// As load_uv_corners() has them.
UvTriangle uv_corners(const TriangleMesh& mesh, std::size_t triangle) {
  if (mesh.uvs.empty()) return {glm::vec2(0.0f), glm::vec2(1.0f, 0.0f), glm::vec2(1.0f)};
  const glm::uvec3 t = mesh.triangles[triangle];
  return {mesh.uvs[t.x], mesh.uvs[t.y], mesh.uvs[t.z]};
}

glm::vec3 mean_color(const TextureTable& textures, const Emission& emission, const UvTriangle& uvs,
                     std::size_t lookups) {
  if (textures.nodes == nullptr) return glm::vec3(1.0f);
  glm::vec3 sum(0.0f);
  for (std::size_t i = 0; i < lookups; ++i) {
    // Multiples of the plastic number's powers are well spread over the square.
    const auto multiple = [i](double step) {
      const double x = (double(i) + 0.5) * step;
      return float(x - std::floor(x));
    };
    const Vec2<float> b =
        uniform_triangle(Vec2<float>(multiple(0.7548776662466927), multiple(0.5698402909980532)));
    const glm::vec2 uv = uvs[0] + b.x * (uvs[1] - uvs[0]) + b.y * (uvs[2] - uvs[0]);
    const Rgba<float> texel = lookup(textures, emission.radiance.texture, uv);
    sum += glm::vec3(texel.r, texel.g, texel.b);
  }
  return sum / float(lookups);
}

// Every triangle is a light by itself, with the power of the texture's mean over it.
std::vector<Light> textured_lights(const TriangleMesh& mesh, const Emission& emission,
                                   const TextureTable& textures, int first, FlatScene& flat) {
  const auto binding = float(flat.texture_bindings.size());
  flat.texture_bindings.push_back(binding_of(emission.radiance, 0));
  flat.features |= bit(Feature::TexturedLights);
  const std::size_t count = mesh.triangles.size();
  const std::size_t lookups = std::clamp<std::size_t>(
      most_lookups / std::max<std::size_t>(count, 1), 1, lookups_per_triangle);
  std::vector<Light> lights;
  for (std::size_t i = 0; i < count; ++i) {
    flat.light_of_primitive.push_back(first + std::int32_t(i));
    const Corners a = corners(mesh, i);
    const UvTriangle uvs = uv_corners(mesh, i);
    Light l = flat_light(LightKind::Triangle, a[0], a[1] - a[0], a[2] - a[0], emission);
    const float plain = luminance(emission.radiance.value);
    const float mean =
        luminance(emission.radiance.value * mean_color(textures, emission, uvs, lookups));
    l.power *= plain > 0.0f && std::isfinite(mean) ? std::max(mean, 0.0f) / plain : 0.0f;
    for (const glm::vec2 uv : uvs) flat.glow_rows.insert(flat.glow_rows.end(), {uv.x, uv.y});
    flat.glow_rows.insert(flat.glow_rows.end(), {binding, 0.0f});
    l.outline = float(flat.glow_rows.size() / glow_stride);
    lights.push_back(l);
  }
  return lights;
}

// Whether the triangles of a shape with textured emission are chosen as lights: not where they have
// holes, which light sampling does not see, nor more than a float can number.
bool are_chosen(const Shape& shape, const FlatScene& flat) {
  const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
  constexpr std::size_t most = 1 << 24;
  return mesh && !flat.opacities[std::size_t(shape.material)].has_holes() &&
         flat.glow_rows.size() / glow_stride + mesh->triangles.size() < most;
}

// Other textured emission is found by paths that hit it, never chosen; its lights keep their
// shape's normal and side.
void make_glow(const Emission& emission, std::vector<Light>& lights, FlatScene& flat) {
  const auto binding = float(flat.texture_bindings.size());
  flat.texture_bindings.push_back(binding_of(emission.radiance, 0));
  for (Light& l : lights) {
    if (l.kind == LightKind::Sphere) {
      flat.features |= bit(Feature::SphereLights);
    } else {
      l.area = 0.0f;
    }
    l.kind = LightKind::Glow;
    l.edge1.x = binding;
    l.power = 0.0f;
  }
}

// Probabilities in proportion to power (alike where no light has a usable one), in whole steps of
// the 2^-24 that a sample resolves, at least one: what a row states is exactly what is drawn.
std::vector<double> light_cdf(const std::vector<Light>& lights) {
  double total = 0.0;
  for (const Light& l : lights) total += double(l.power);
  const bool usable = total > 0.0 && std::isfinite(total);
  std::vector<double> weights;
  for (const Light& l : lights) weights.push_back(usable ? double(l.power) / total : 1.0);
  const double step = 0x1p-24;
  double sum = 0.0, below = 0.0;
  for (double& w : weights) {
    if (w > 0.0) w += step;
    sum += w;
  }
  std::vector<double> cdf{0.0};
  for (const double w : weights) {
    below += w / sum;
    cdf.push_back(std::floor(below / step + 1e-6) * step);
  }
  cdf.back() = 1.0;
  return cdf;
}

void append_rows(const std::vector<Light>& lights, FlatScene& flat) {
  const std::vector<double> cdf = light_cdf(lights);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& l = lights[i];
    flat.light_kinds.push_back(std::int32_t(l.kind));
    flat.light_cdf.push_back(float(cdf[i]));
    const auto append = [&](glm::vec3 v, float last) {
      flat.light_rows.insert(flat.light_rows.end(), {v.x, v.y, v.z, last});
    };
    append(l.corner, l.area);
    append(l.edge1, float(cdf[i + 1] - cdf[i]));
    append(l.edge2, l.side);
    append(l.normal, float(int(l.kind)));
    append(l.radiance, l.outline);
  }
  flat.light_cdf.push_back(1.0f);
}

}  // namespace

void flatten_lights(const SceneDescription& description, glm::vec3 environment_radiance,
                    const TextureTable& textures, FlatScene& flat) {
  std::vector<Light> lights;
  for (std::size_t g = 0; g < description.shapes.size(); ++g) {
    const Shape& shape = description.shapes[g];
    if (!shape.emission || shape.emission->radiance.value == glm::vec3(0.0f)) continue;
    flat.geometry_rows[g * geometry_stride + 2] = std::int32_t(flat.light_of_primitive.size());
    const int first = int(lights.size());
    const bool textured = shape.emission->radiance.texture >= 0;
    const bool chosen = textured && are_chosen(shape, flat);
    std::vector<Light> added;
    if (chosen) {
      added = textured_lights(std::get<TriangleMesh>(shape.geometry), *shape.emission, textures,
                              first, flat);
    } else if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
      added = mesh_lights(*mesh, *shape.emission, first, flat.light_of_primitive);
    } else {
      flat.light_of_primitive.push_back(first);
      added.push_back(sphere_light(std::get<Sphere>(shape.geometry), *shape.emission));
    }
    if (textured && !chosen) make_glow(*shape.emission, added, flat);
    lights.insert(lights.end(), added.begin(), added.end());
  }
  const bool from_afar =
      description.environment ||
      std::any_of(description.lights.begin(), description.lights.end(),
                  [](const LightSource& l) { return std::holds_alternative<DistantLight>(l); });
  const float radius = from_afar ? scene_radius(description) : 1.0f;
  if (description.environment && description.environment->radiance != glm::vec3(0.0f)) {
    const bool constant = description.environment->mapping == Environment::Mapping::Constant;
    flat.environment_light = std::int32_t(lights.size());
    lights.push_back(
        constant
            ? environment_light(LightKind::Environment, description.environment->radiance, radius)
            : environment_light(LightKind::EnvironmentMap, environment_radiance, radius));
  }
  for (const LightSource& source : description.lights) {
    lights.push_back(std::visit([&](const auto& s) { return delta_light(s, radius); }, source));
  }
  append_rows(lights, flat);
  flat.glow_rows.insert(flat.glow_rows.end(), glow_stride, 0.0f);
}

}  // namespace lockstep
