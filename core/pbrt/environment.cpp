#include "core/pbrt/lights.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <numbers>

namespace lockstep::pbrt {

namespace {

// The mapping and what turns its frame into that of pbrt's light.
struct Map {
  Environment::Mapping mapping = Environment::Mapping::Constant;
  const Parameter* file = nullptr;
  glm::dmat3 to_light{1.0};
};

// Until v3 "mapname" is a latitude-longitude map with z up, whose columns start at +x and turn
// towards +y: its middle column is -x, and a quarter to the right of that lies -y.
Map find_map(const ParameterSet& set) {
  const auto named = [&](const char* name) -> const Parameter* {
    const Parameter* p = set.find(name, {"string"});
    if (p != nullptr && p->strings.size() != 1) {
      fail(set.where(*p), "\"string " + p->name + "\" must name one image file");
    }
    return p != nullptr && !p->strings[0].empty() ? p : nullptr;
  };
  if (const Parameter* p = named("filename")) {
    return {Environment::Mapping::EqualAreaOctahedral, p};
  }
  if (const Parameter* p = named("mapname")) {
    const glm::dvec3 x(0.0, -1.0, 0.0), y(0.0, 0.0, 1.0), z(1.0, 0.0, 0.0);
    return {Environment::Mapping::LatLong, p, glm::dmat3(x, y, z)};
  }
  return {};
}

bool is_orthonormal(const glm::dmat3& m) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      if (std::abs(glm::dot(m[i], m[j]) - (i == j ? 1.0 : 0.0)) > 1e-3) return false;
    }
  }
  return true;
}

Environment make_environment(const ParameterSet& set, const glm::dmat4& light_to_world,
                             Library& library) {
  Environment environment(get_light_color(set, "L", library));
  const Map map = find_map(set);
  const float illuminance = set.get_float("illuminance", -1.0f);
  if (illuminance > 0.0f && map.file == nullptr) {
    environment.radiance *= illuminance * std::numbers::inv_pi_v<float>;  // of half the sky
  } else if (illuminance > 0.0f) {
    library.warnings.add(set.where(),
                         "the illuminance of an environment map is not supported; scale is used");
  }
  if (map.file == nullptr) return environment;
  const Location where = set.where(*map.file);
  environment.mapping = map.mapping;
  environment.file = resolve(library, where.file, map.file->strings[0]);
  environment.where = where.file + ":" + std::to_string(where.line);
  // Directions have no length: without the transform's scale.
  glm::dmat3 m = glm::dmat3(light_to_world) * map.to_light;
  m /= std::cbrt(std::abs(glm::determinant(m)));
  if (!is_orthonormal(m)) {
    library.warnings.add(set.where(),
                         "the transform of an environment map may only turn, mirror "
                         "and scale evenly; the nearest that does is used");
  }
  environment.to_world = glm::mat3(m);
  return environment;
}

bool is_map(const Environment& e) { return e.mapping != Environment::Mapping::Constant; }

}  // namespace

void add_environment(const ParameterSet& set, const glm::dmat4& light_to_world, Library& library,
                     std::optional<Environment>& environment) {
  const Environment added = make_environment(set, light_to_world, library);
  set.ignore({"nsamples", "samples"});
  set.warn_unused(library.warnings);
  if (!environment) {
    environment = added;
  } else if (!is_map(*environment) && !is_map(added)) {
    environment->radiance += added.radiance;
  } else {
    library.warnings.add(set.where(),
                         "beside an environment map no other infinite light is supported; the "
                         "first map alone is used");
    if (!is_map(*environment)) environment = added;
  }
}

}  // namespace lockstep::pbrt
