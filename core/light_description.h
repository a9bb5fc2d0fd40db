// Lights that are not surfaces, as scene files state them. World space; linear RGB.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <string>
#include <variant>

namespace lockstep {

struct PointLight {
  glm::vec3 position{0.0f};
  glm::vec3 intensity{1.0f};  // W/sr
};

// Full intensity within the inner cone, none outside the outer one.
struct SpotLight {
  enum class Falloff {
    Smoothstep,  // of the cosine (pbrt-v4)
    Quartic,     // fourth power of the linear falloff in the cosine (pbrt-v3)
    Squared,     // second power of it (glTF)
    LinearAngle  // linear in the angle (Mitsuba)
  };
  glm::vec3 position{0.0f};
  glm::vec3 direction{0.0f, 0.0f, 1.0f};  // unit, from the light
  glm::vec3 intensity{1.0f};              // on the axis, W/sr
  float cos_inner = 1.0f, cos_outer = 0.0f;
  Falloff falloff = Falloff::Smoothstep;
};

struct DistantLight {
  glm::vec3 direction{0.0f, 0.0f, -1.0f};  // unit, in which the light travels
  glm::vec3 irradiance{1.0f};              // on a plane that faces it, W/m^2
};

using LightSource = std::variant<PointLight, SpotLight, DistantLight>;

// Radiance from infinitely far away.
struct Environment {
  enum class Mapping {
    Constant,             // no image
    LatLong,              // y up; the middle column is the direction -z, +x lies right of it
    EqualAreaOctahedral,  // z up; a square (Clarberg 2008, as pbrt-v4 has it)
  };
  glm::vec3 radiance{1.0f};  // or what the image is multiplied with
  Mapping mapping = Mapping::Constant;
  std::string file;          // of the image
  glm::mat3 to_world{1.0f};  // from the mapping's own frame; may mirror
  std::string where;         // "file:line", for errors

  Environment() = default;
  Environment(glm::vec3 constant) : radiance(constant) {}
};

}  // namespace lockstep
