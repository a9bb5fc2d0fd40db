#include "core/pbrt/view.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace lockstep::pbrt {

namespace {

using Projection = CameraDescription::Projection;

// Takes a uniform scale out of `m` and returns it; other matrices stay as they are.
float take_scale(glm::dmat4& m) {
  const glm::dvec3 lengths(glm::length(m[0]), glm::length(m[1]), glm::length(m[2]));
  const double scale = lengths.x;
  const auto differs = [&](double a, double b) { return std::abs(a - b) > 1e-4 * scale; };
  if (differs(lengths.y, scale) || differs(lengths.z, scale)) return 1.0f;
  if (std::abs(scale - 1.0) < 1e-4) return 1.0f;  // rounding in the file
  for (int i = 0; i < 3; ++i) m[i] /= scale;
  return static_cast<float>(scale);
}

float get_fov(const ParameterSet& set) {
  const float fov = set.any("halffov") != nullptr ? 2.0f * set.get_float("halffov", 45.0f)
                                                  : set.get_float("fov", 90.0f);
  if (!(fov > 0.0f && fov < 180.0f)) {
    fail(set.where(), "Camera needs a fov between 0 and 180 degrees");
  }
  return fov;
}

float get_length(const ParameterSet& set, const char* name, float fallback, float scale) {
  const float length = set.get_float(name, fallback) * scale;
  if (length >= 0.0f && std::isfinite(length)) return length;
  fail(set.where(), "Camera needs a " + std::string(name) + " of 0 or more");
}

glm::vec4 default_bounds(float aspect) {
  if (aspect > 1.0f) return {-aspect, aspect, -1.0f, 1.0f};
  return {-1.0f, 1.0f, -1.0f / aspect, 1.0f / aspect};
}

}  // namespace

CameraDescription make_camera(const std::string& type, const glm::dmat4& world_to_camera,
                              const ParameterSet& set, Warnings& warnings) {
  CameraDescription camera;
  glm::dmat4 camera_to_world = glm::inverse(world_to_camera);
  const float scale = take_scale(camera_to_world);
  camera.camera_to_world = glm::mat4(camera_to_world);
  camera.fov_degrees = get_fov(set);
  camera.extent = 2.0f * scale;
  if (type == "orthographic") {
    camera.projection = Projection::Orthographic;
  } else if (type != "perspective") {
    warnings.add(set.where(),
                 "Camera \"" + type + "\" is not supported; a perspective camera is used");
  }
  camera.lens_radius = get_length(set, "lensradius", 0.0f, scale);
  // pbrt-v2 has 1e30, which means the same.
  camera.focal_distance = std::min(get_length(set, "focaldistance", 1e6f, 1.0f), 1e9f) * scale;
  if (camera.lens_radius > 0.0f && !(camera.focal_distance > 0.0f)) {
    fail(set.where(), "Camera needs a focaldistance above 0");
  }
  set.ignore({"shutteropen", "shutterclose", "frameaspectratio", "screenwindow"});
  set.warn_unused(warnings);
  return camera;
}

ScreenWindow make_window(const ParameterSet& set) {
  ScreenWindow window;
  window.where = set.where();
  if (set.any("frameaspectratio") != nullptr) {
    window.aspect = set.get_float("frameaspectratio", 1.0f);
    if (!(window.aspect > 1e-3f && window.aspect < 1e3f)) {
      fail(set.where(), "Camera needs a frameaspectratio between 0.001 and 1000");
    }
  }
  const Parameter* p = set.find("screenwindow", {"float"});
  if (p == nullptr) return window;
  if (p->numbers.size() != 4) fail(set.where(*p), "\"float screenwindow\" must have four values");
  window.bounds = glm::vec4(p->numbers[0], p->numbers[1], p->numbers[2], p->numbers[3]);
  const glm::vec4 b = *window.bounds;
  const auto fits = [](float size) { return size > 1e-6f && size < 1e6f; };
  if (!fits(b.y - b.x) || !fits(b.w - b.z)) {
    fail(set.where(*p),
         "\"float screenwindow\" must be x from, x to, y from, y to, less than a million apart");
  }
  return window;
}

void apply_window(const ScreenWindow& window, const FilmDescription& film, Warnings& warnings,
                  CameraDescription& camera) {
  if (!window.bounds && window.aspect == 0.0f) return;
  const float film_aspect = static_cast<float>(film.width) / static_cast<float>(film.height);
  const glm::vec4 b =
      window.bounds.value_or(default_bounds(window.aspect > 0.0f ? window.aspect : film_aspect));
  const float width = b.y - b.x, height = b.w - b.z;
  if (std::abs(width / height / film_aspect - 1.0f) > 0.01f) {
    warnings.add(window.where,
                 "Camera: pixels that are not square are not supported; what the "
                 "image shows along its longer side differs");
  }
  const float shorter = film.width < film.height ? width : height;
  const float half = std::tan(0.5f * glm::radians(camera.fov_degrees)) * 0.5f * shorter;
  camera.fov_degrees = glm::degrees(2.0f * std::atan(half));
  camera.extent *= 0.5f * shorter;
  camera.shift = glm::vec2(b.x + b.y, b.z + b.w) / (2.0f * shorter);
}

}  // namespace lockstep::pbrt
