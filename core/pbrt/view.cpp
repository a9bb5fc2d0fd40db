#include "core/pbrt/view.h"

#include <cmath>

namespace lockstep::pbrt {

namespace {

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
      set.any("alpha") != nullptr || (version != Version::v4 && set.any("sigma") == nullptr);
  const float alpha = set.get_float("alpha", 2.0f);
  const float sigma = by_alpha ? 1.0f / std::sqrt(2.0f * alpha) : set.get_float("sigma", 0.5f);
  if (!(sigma > 0.0f && std::isfinite(sigma))) {
    fail(set.where(), set.owner() + " needs a width above 0");
  }
  return sigma;
}

// A parameter of Mitchell's filter. Far from [0, 1] its lobes nearly cancel each other.
float get_spline(const ParameterSet& set, const char* name) {
  const float value = set.get_float(name, 1.0f / 3.0f);
  if (!(value >= -2.0f && value <= 2.0f)) {
    fail(set.where(), set.owner() + " needs " + name + " between -2 and 2");
  }
  return value;
}

PixelFilter default_filter(Version version) {
  if (version != Version::v4) return {PixelFilter::Kind::Box, glm::vec2(0.5f), 0.5f};
  return {PixelFilter::Kind::Gaussian, glm::vec2(1.5f), 0.5f};
}

}  // namespace

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
  if (set->any("cropwindow") != nullptr || set->any("pixelbounds") != nullptr) {
    warnings.add(set->where(), "Film: a part of the image is not supported; all of it is rendered");
  }
  set->ignore({"filename", "savefp16", "diagonal", "coordsystem", "cropwindow", "pixelbounds"});
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
    const float radius = version != Version::v4 ? 2.0f : 1.5f;
    filter = {PixelFilter::Kind::Gaussian, get_radius(*set, radius), get_sigma(version, *set)};
  } else if (type == "mitchell") {
    filter = {PixelFilter::Kind::Mitchell, get_radius(*set, 2.0f)};
    filter.b = get_spline(*set, "B");
    filter.c = get_spline(*set, "C");
  } else if (type == "sinc" && version != Version::v2) {  // v2's has another window
    filter = {PixelFilter::Kind::Lanczos, get_radius(*set, 4.0f)};
    filter.tau = set->get_float("tau", filter.tau);
    if (!(filter.tau > 0.0f)) fail(set->where(), set->owner() + " needs a tau above 0");
  } else {
    warnings.add(set->where(),
                 "PixelFilter \"" + type + "\" is not supported; pbrt's default filter is used");
    return default_filter(version);
  }
  set->warn_unused(warnings);
  return filter;
}

}  // namespace lockstep::pbrt
