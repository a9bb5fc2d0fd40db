#include "core/pbrt/view.h"

#include <glm/matrix.hpp>

#include <cmath>

namespace lockstep::pbrt {

namespace {

void warn_of_lens(const ParameterSet& set, Warnings& warnings) {
  if (set.get_float("lensradius", 0.0f) > 0.0f) {
    warnings.add(set.where(), "Camera: a thin lens is not supported; a pinhole is used");
  }
  if (set.any("frameaspectratio") != nullptr || set.any("screenwindow") != nullptr) {
    warnings.add(set.where(),
                 "Camera: frameaspectratio and screenwindow are not supported; the "
                 "film's shape decides");
  }
  set.ignore({"focaldistance", "frameaspectratio", "screenwindow", "shutteropen", "shutterclose"});
}

// v4 says xradius where v3 says xwidth; both mean half the filter's extent.
glm::vec2 get_radius(const ParameterSet& set, float fallback) {
  const auto along = [&](const char* v4_name, const char* v3_name) {
    const float radius = set.get_float(v4_name, set.get_float(v3_name, fallback));
    if (!(radius > 0.0f && radius <= 64.0f)) {
      fail(set.where(), set.owner() + " needs radii between 0 and 64 pixels");
    }
    return radius;
  };
  return {along("xradius", "xwidth"), along("yradius", "ywidth")};
}

float get_sigma(Version version, const ParameterSet& set) {
  // v3 has exp(-alpha x^2), v4 a standard deviation.
  const bool by_alpha =
      set.any("alpha") != nullptr || (version == Version::v3 && set.any("sigma") == nullptr);
  const float alpha = set.get_float("alpha", 2.0f);
  const float sigma = by_alpha ? 1.0f / std::sqrt(2.0f * alpha) : set.get_float("sigma", 0.5f);
  if (!(sigma > 0.0f && std::isfinite(sigma))) {
    fail(set.where(), set.owner() + " needs a width above 0");
  }
  return sigma;
}

PixelFilter default_filter(Version version) {
  if (version == Version::v3) return {PixelFilter::Kind::Box, glm::vec2(0.5f), 0.5f};
  return {PixelFilter::Kind::Gaussian, glm::vec2(1.5f), 0.5f};
}

}  // namespace

CameraDescription make_camera(const std::string& type, const glm::dmat4& world_to_camera,
                              const ParameterSet& set, Warnings& warnings) {
  if (type != "perspective") {
    warnings.add(set.where(),
                 "Camera \"" + type + "\" is not supported; a perspective camera is used");
  }
  CameraDescription camera;
  camera.camera_to_world = glm::mat4(glm::inverse(world_to_camera));
  camera.fov_degrees = set.get_float("fov", 90.0f);
  if (set.any("halffov") != nullptr) camera.fov_degrees = 2.0f * set.get_float("halffov", 45.0f);
  if (!(camera.fov_degrees > 0.0f && camera.fov_degrees < 180.0f)) {
    fail(set.where(), "Camera needs a fov between 0 and 180 degrees");
  }
  warn_of_lens(set, warnings);
  set.warn_unused(warnings);
  return camera;
}

FilmDescription make_film(Version version, const ParameterSet* set, Warnings& warnings) {
  FilmDescription film;
  film.width = version == Version::v4 ? 1280 : 640;
  film.height = version == Version::v4 ? 720 : 480;
  if (set == nullptr) return film;
  film.width = set->get_int("xresolution", film.width);
  film.height = set->get_int("yresolution", film.height);
  constexpr int largest = 65536;
  if (film.width < 1 || film.height < 1 || film.width > largest || film.height > largest) {
    fail(set->where(), "Film needs a resolution between 1 and " + std::to_string(largest));
  }
  set->ignore({"filename", "savefp16", "diagonal", "coordsystem"});
  set->warn_unused(warnings);
  return film;
}

PixelFilter make_filter(Version version, const std::string& type, const ParameterSet* set,
                        Warnings& warnings) {
  if (set == nullptr) return default_filter(version);
  PixelFilter filter;
  if (type == "box") {
    filter = {PixelFilter::Kind::Box, get_radius(*set, 0.5f), 0.5f};
  } else if (type == "triangle") {
    filter = {PixelFilter::Kind::Triangle, get_radius(*set, 2.0f), 0.5f};
  } else if (type == "gaussian") {
    const float radius = version == Version::v3 ? 2.0f : 1.5f;
    filter = {PixelFilter::Kind::Gaussian, get_radius(*set, radius), get_sigma(version, *set)};
  } else {
    warnings.add(set->where(),
                 "PixelFilter \"" + type + "\" is not supported; pbrt's default filter is used");
    return default_filter(version);
  }
  set->warn_unused(warnings);
  return filter;
}

}  // namespace lockstep::pbrt
