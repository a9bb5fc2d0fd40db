#include "core/error.h"
#include "core/flatten.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lockstep {
namespace {

// The pieces for |t| below 1 and 2 of Mitchell and Netravali 1988, eq. 8.
double mitchell(double b, double c, double t) {
  const double t2 = t * t, t3 = t * t2;
  if (t < 1.0) {
    return ((12 - 9 * b - 6 * c) * t3 + (-18 + 12 * b + 6 * c) * t2 + (6 - 2 * b)) / 6.0;
  }
  if (t >= 2.0) return 0.0;
  return ((-b - 6 * c) * t3 + (6 * b + 30 * c) * t2 + (-12 * b - 48 * c) * t + (8 * b + 24 * c)) /
         6.0;
}

double sinc(double x) {
  const double t = glm::pi<double>() * x;
  return std::abs(t) < 1e-5 ? 1.0 : std::sin(t) / t;
}

// Value of the filter at x pixels from the centre, up to the radius, not normalised.
double filter_value(const PixelFilter& filter, double radius, double x) {
  switch (filter.kind) {
    case PixelFilter::Kind::Box:
      return 1.0;
    case PixelFilter::Kind::Triangle:
      return std::max(0.0, radius - std::abs(x));
    case PixelFilter::Kind::Gaussian: {
      // As pbrt: lowered so that it reaches zero at the radius.
      const double s = 2.0 * double(filter.sigma) * double(filter.sigma);
      return std::max(0.0, std::exp(-x * x / s) - std::exp(-radius * radius / s));
    }
    case PixelFilter::Kind::Mitchell:
      return mitchell(double(filter.b), double(filter.c), 2.0 * std::abs(x) / radius);
    case PixelFilter::Kind::Lanczos:
      return sinc(x) * sinc(x / double(filter.tau));
  }
  return 0.0;
}

// Sums along the axis from -radius to each of the steps, by trapezoids.
struct Integrals {
  static constexpr int steps = 1 << 14;
  std::vector<double> magnitude = std::vector<double>(steps + 1, 0.0);
  std::vector<double> value = std::vector<double>(steps + 1, 0.0);
};

double step_position(double radius, int i) { return -radius + 2.0 * radius * i / Integrals::steps; }

Integrals integrate(const PixelFilter& filter, double radius) {
  Integrals sums;
  double before = filter_value(filter, radius, -radius);
  for (int i = 1; i <= Integrals::steps; ++i) {
    const double here = filter_value(filter, radius, step_position(radius, i));
    const auto at = size_t(i);
    sums.magnitude[at] = sums.magnitude[at - 1] + std::abs(before) + std::abs(here);
    sums.value[at] = sums.value[at - 1] + before + here;
    before = here;
  }
  return sums;
}

struct FilterTable {
  std::vector<float> offsets;  // as CameraData::filter_x
  std::vector<float> weights;  // as CameraData::filter_weight_x
};

// Inverse of the cumulative distribution of the filter's magnitude at filter_cells + 1 equal steps,
// from a fine integration; one more entry repeats the last, so that u = 1 may be looked up. And
// what of the filter's own integral lies between them.
FilterTable make_filter_table(const PixelFilter& filter, double radius) {
  const Integrals sums = integrate(filter, radius);
  const std::vector<double>& cdf = sums.magnitude;
  // What lobes take away from each other would come back as noise.
  if (!(sums.value.back() > 1e-2 * cdf.back() && std::isfinite(cdf.back()))) {
    throw Error("the pixel filter's lobes cancel each other; choose other parameters for it");
  }
  FilterTable table;
  table.offsets.resize(filter_cells + 2);
  table.weights.resize(filter_cells);
  double value_below = 0.0;
  int i = 1;
  for (int cell = 0; cell <= filter_cells; ++cell) {
    const double target = cdf.back() * cell / filter_cells;
    while (i < Integrals::steps && cdf[size_t(i)] < target) ++i;
    const double width = cdf[size_t(i)] - cdf[size_t(i - 1)];
    const double rest = width > 0.0 ? (target - cdf[size_t(i - 1)]) / width : 0.0;
    const double start = step_position(radius, i - 1);
    table.offsets[size_t(cell)] = float(start + rest * 2.0 * radius / Integrals::steps);
    const double value = std::lerp(sums.value[size_t(i - 1)], sums.value[size_t(i)], rest);
    if (cell > 0) {
      const double share = (value - value_below) / sums.value.back();
      table.weights[size_t(cell - 1)] = float(share * filter_cells);
    }
    value_below = value;
  }
  table.offsets.front() = float(-radius);
  table.offsets[filter_cells] = table.offsets[filter_cells + 1] = float(radius);
  return table;
}

void flatten_filter(const PixelFilter& filter, FlatScene& flat) {
  if (filter.kind == PixelFilter::Kind::Box && filter.radius == glm::vec2(0.5f)) return;
  flat.features |= bit(Feature::FilterTable);
  FilterTable x = make_filter_table(filter, double(filter.radius.x));
  FilterTable y = make_filter_table(filter, double(filter.radius.y));
  flat.filter_x = std::move(x.offsets);
  flat.filter_y = std::move(y.offsets);
  const auto negative = [](float weight) { return weight < 0.0f; };
  if (std::none_of(x.weights.begin(), x.weights.end(), negative) &&
      std::none_of(y.weights.begin(), y.weights.end(), negative)) {
    return;
  }
  flat.features |= bit(Feature::FilterSigns);
  flat.filter_weight_x = std::move(x.weights);
  flat.filter_weight_y = std::move(y.weights);
}

}  // namespace

void flatten_camera(const CameraDescription& camera, const FilmDescription& film, FlatScene& flat) {
  CameraData& c = flat.camera;
  c.width = film.width;
  c.height = film.height;
  const bool orthographic = camera.projection == CameraDescription::Projection::Orthographic;
  // Of the image's shorter side, on the plane z = 1.
  const float shorter =
      orthographic ? 0.5f * camera.extent : std::tan(0.5f * glm::radians(camera.fov_degrees));
  const float size = float(std::min(film.width, film.height));
  const glm::vec2 half(shorter * float(film.width) / size, shorter * float(film.height) / size);
  const glm::vec2 shift = 2.0f * shorter * camera.shift;
  const glm::mat3 rotation(camera.camera_to_world);
  const glm::vec3 position(camera.camera_to_world[3]);
  c.right = rotation * glm::vec3(2.0f * half.x / float(film.width), 0.0f, 0.0f);
  c.down = rotation * glm::vec3(0.0f, -2.0f * half.y / float(film.height), 0.0f);
  const glm::vec2 corner(shift.x - half.x, shift.y + half.y);
  if (orthographic) {
    flat.features |= bit(Feature::Orthographic);
    c.origin = glm::normalize(rotation * glm::vec3(0.0f, 0.0f, 1.0f));
    c.footprint = footprint_scale * glm::length(c.right);
    c.corner = position + rotation * glm::vec3(corner, 0.0f);
  } else {
    c.origin = position;
    const glm::vec3 forward = rotation * glm::vec3(0.0f, 0.0f, 1.0f);
    c.footprint = footprint_scale * glm::length(c.right) / glm::length(forward);
    c.corner = rotation * glm::vec3(corner, 1.0f);
    c.focal_distance = camera.focal_distance;
  }
  if (camera.lens_radius > 0.0f && !orthographic) {
    flat.features |= bit(Feature::Lens);
    c.lens_x = rotation * glm::vec3(camera.lens_radius, 0.0f, 0.0f);
    c.lens_y = rotation * glm::vec3(0.0f, camera.lens_radius, 0.0f);
  }
  flatten_filter(film.filter, flat);
}

}  // namespace lockstep
