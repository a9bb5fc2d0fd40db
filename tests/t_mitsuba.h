// Scenes of Mitsuba for tests of its reader.
#pragma once

#include "core/mitsuba/reader.h"
#include "tests/t_description.h"
#include "tests/t_files.h"

#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace lockstep {

class Mitsuba : public TestWithFiles {
 protected:
  // What <scene> holds, of Mitsuba 3 and of 0.5.
  SceneDescription read(const std::string& text, const std::string& version = "3.0.0") const {
    return read_mitsuba(
        write("scene.xml", "<scene version=\"" + version + "\">\n" + text + "\n</scene>\n"));
  }
  SceneDescription read_old(const std::string& text) const { return read(text, "0.5.0"); }
  std::string error_of(const std::string& text) const {
    return message_of([&] { read(text); });
  }
};

inline std::string with_bsdf(const std::string& bsdf) {
  return "<shape type=\"rectangle\">" + bsdf + "</shape>";
}

// Six corners of two squares at right angles that share an edge, as an OBJ file has them.
inline const std::string roof = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 -1\nv 1 0 -1\n";

// Where a point falls on the film, in pixels from its top left corner.
inline glm::vec2 pixel_of(const SceneDescription& scene, glm::vec3 p) {
  const CameraDescription& c = scene.camera;
  const glm::vec3 local(glm::inverse(c.camera_to_world) * glm::vec4(p, 1.0f));
  const float shorter = float(std::min(scene.film.width, scene.film.height));
  glm::vec2 at;  // in units of the shorter side, right and up, from the camera's axis
  if (c.projection == CameraDescription::Projection::Perspective) {
    at = glm::vec2(local) / local.z / (2.0f * std::tan(0.5f * glm::radians(c.fov_degrees)));
  } else {
    at = glm::vec2(local) / c.extent;
  }
  at -= c.shift;
  return {0.5f * float(scene.film.width) + at.x * shorter,
          0.5f * float(scene.film.height) - at.y * shorter};
}

}  // namespace lockstep
