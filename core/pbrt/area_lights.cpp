#include "core/pbrt/lights.h"
#include "core/pbrt/textures.h"

#include <glm/geometric.hpp>

#include <numbers>
#include <variant>

namespace lockstep::pbrt {

namespace {

double area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a = mesh.positions[t.x];
    const glm::dvec3 u = glm::dvec3(mesh.positions[t.y]) - a;
    const glm::dvec3 v = glm::dvec3(mesh.positions[t.z]) - a;
    sum += 0.5 * glm::length(glm::cross(u, v));
  }
  return sum;
}

double area(const Sphere& sphere) {
  const double r = double(sphere.radius);
  return 4.0 * std::numbers::pi * r * r;
}

double area(const Disk& disk) {
  const double r = double(disk.radius);
  return std::numbers::pi * r * r;
}

}  // namespace

std::shared_ptr<AreaLight> make_area_light(const std::string& type, const ParameterSet& set,
                                           Library& library) {
  if (type != "diffuse" && type != "area") {
    library.warnings.add(set.where(),
                         "AreaLightSource \"" + type + "\" is not supported; it is left out");
    return nullptr;
  }
  AreaLight light;
  if (const Parameter* file = set.find("filename", {"string"})) {
    if (set.any("L") != nullptr) {
      fail(set.where(*file), set.owner() + " has both \"L\" and \"filename\"; give one of them");
    }
    light.image = named_image(library, set, *file);
  }
  light.emission.radiance = get_light_color(set, "L", library);
  light.emission.two_sided = set.get_bool("twosided", false);
  light.power = set.get_float("power", -1.0f);
  if (light.power > 0.0f && light.image) {
    library.warnings.add(set.where(), "the power of area lights with an image is not supported");
    light.power = -1.0f;
  }
  set.ignore({"nsamples", "samples"});
  set.warn_unused(library.warnings);
  if (light.emission.radiance.value == glm::vec3(0.0f)) return nullptr;
  return std::make_shared<AreaLight>(std::move(light));
}

Emission emission_of(AreaLight& light, Library& library) {
  Emission emission = light.emission;
  if (light.image) {
    if (light.texture < 0) light.texture = add_texture(library, *light.image);
    emission.radiance.texture = light.texture;
  }
  return emission;
}

void set_power(float power, const Geometry& geometry, Emission& emission) {
  if (power <= 0.0f) return;
  const double sides = emission.two_sided ? 2.0 : 1.0;
  const double surface = std::visit([](const auto& shape) { return area(shape); }, geometry);
  const double unit_power = sides * surface * std::numbers::pi;
  if (unit_power > 0.0) emission.radiance.value *= float(double(power) / unit_power);
}

}  // namespace lockstep::pbrt
