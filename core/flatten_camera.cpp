#include "core/flatten.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace lockstep {
namespace {

// Value of the filter at x pixels from the centre, not normalised.
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
  }
  return 0.0;
}

// Inverse of the filter's cumulative distribution at filter_cells + 1 equal steps, from a fine
// trapezoidal integration. One more entry repeats the last, so that u = 1 may be looked up.
std::vector<float> inverse_distribution(const PixelFilter& filter, double radius) {
  constexpr int steps = 1 << 14;
  std::vector<double> cdf(steps + 1, 0.0);
  const auto at = [&](int i) { return -radius + 2.0 * radius * i / steps; };
  for (int i = 1; i <= steps; ++i) {
    cdf[size_t(i)] = cdf[size_t(i - 1)] + filter_value(filter, radius, at(i - 1)) +
                     filter_value(filter, radius, at(i));
  }
  std::vector<float> inverse(filter_cells + 2);
  int i = 1;
  for (int cell = 0; cell <= filter_cells; ++cell) {
    const double target = cdf.back() * cell / filter_cells;
    while (i < steps && cdf[size_t(i)] < target) ++i;
    const double width = cdf[size_t(i)] - cdf[size_t(i - 1)];
    const double rest = width > 0.0 ? (target - cdf[size_t(i - 1)]) / width : 0.0;
    inverse[size_t(cell)] = float(at(i - 1) + rest * 2.0 * radius / steps);
  }
  inverse.front() = float(-radius);
  inverse[filter_cells] = inverse[filter_cells + 1] = float(radius);
  return inverse;
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
    c.corner = position + rotation * glm::vec3(corner, 0.0f);
  } else {
    c.origin = position;
    c.corner = rotation * glm::vec3(corner, 1.0f);
    c.focal_distance = camera.focal_distance;
  }
  if (camera.lens_radius > 0.0f && !orthographic) {
    flat.features |= bit(Feature::Lens);
    c.lens_x = rotation * glm::vec3(camera.lens_radius, 0.0f, 0.0f);
    c.lens_y = rotation * glm::vec3(0.0f, camera.lens_radius, 0.0f);
  }

  const PixelFilter& filter = film.filter;
  if (filter.kind == PixelFilter::Kind::Box && filter.radius == glm::vec2(0.5f)) return;
  flat.features |= bit(Feature::FilterTable);
  flat.filter_x = inverse_distribution(filter, filter.radius.x);
  flat.filter_y = inverse_distribution(filter, filter.radius.y);
}

}  // namespace lockstep
