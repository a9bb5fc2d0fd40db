// Camera rays: the field of view, the pixel grid, and the density of the pixel filters.
#include "core/camera.h"

#include "core/error.h"
#include "core/flatten.h"
#include "tests/chi_square.h"
#include "tests/widths.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace lockstep::test_camera {
namespace {

constexpr std::uint32_t sample_count = 1 << 17;

// A flattened camera whose tables point into `flat`.
struct FlatCamera {
  FlatScene flat;
  CameraData data;

  FlatCamera(const CameraDescription& camera, const FilmDescription& film) {
    flatten_camera(camera, film, flat);
    data = flat.camera;
    data.filter_x = flat.filter_x.data();
    data.filter_y = flat.filter_y.data();
    data.filter_weight_x = flat.filter_weight_x.data();
    data.filter_weight_y = flat.filter_weight_y.data();
  }
  FlatCamera(const FlatCamera&) = delete;
};

constexpr Vec2<float> corner_of_box{0.0f, 0.0f};

template <class V>
Vec3<V> camera_direction(const CameraData& camera, V column, V row, const Vec2<V>& u) {
  return pinhole_ray(camera, image_point(camera, column, row, u)).direction;
}

TEST(Camera, FieldOfViewSpansTheShorterAxis) {
  for (const glm::ivec2 size : {glm::ivec2(640, 480), glm::ivec2(300, 900), glm::ivec2(64, 64)}) {
    for (const float fov : {20.0f, 60.0f, 90.0f, 120.0f}) {
      CameraDescription description;
      description.fov_degrees = fov;
      FilmDescription film{size.x, size.y, {}};
      const FlatCamera camera(description, film);
      const auto through = [&](float x, float y) {
        return camera_direction(camera.data, x, y, corner_of_box);
      };
      const float w = float(size.x), h = float(size.y), shorter = std::min(w, h);
      const float tangent = std::tan(0.5f * glm::radians(fov));
      const glm::vec3 centre = through(0.5f * w, 0.5f * h);
      EXPECT_LT(length(centre - glm::vec3(0.0f, 0.0f, 1.0f)), 1e-6f);
      // Left and up are -x and +y of camera space; rows run downwards.
      const glm::vec3 top_left = through(0.0f, 0.0f), bottom_right = through(w, h);
      EXPECT_NEAR(top_left.x / top_left.z, -tangent * w / shorter, 1e-5f * w / shorter);
      EXPECT_NEAR(top_left.y / top_left.z, tangent * h / shorter, 1e-5f * h / shorter);
      EXPECT_NEAR(bottom_right.x / bottom_right.z, tangent * w / shorter, 1e-5f * w / shorter);
      EXPECT_NEAR(bottom_right.y / bottom_right.z, -tangent * h / shorter, 1e-5f * h / shorter);
      EXPECT_NEAR(length(top_left), 1.0f, 1e-6f);
    }
  }
}

// A camera somewhere else, and the inverse of its projection.
CameraDescription moved_camera() {
  CameraDescription camera;
  camera.fov_degrees = 50.0f;
  camera.camera_to_world =
      glm::rotate(glm::translate(glm::mat4(1.0f), glm::vec3(3.0f, -2.0f, 5.0f)), 2.0f,
                  glm::vec3(0.6f, 0.0f, 0.8f));
  return camera;
}

glm::dvec2 pixel_position(const CameraDescription& camera, const FilmDescription& film,
                          glm::vec3 direction) {
  const glm::dmat3 rotation(glm::mat3(camera.camera_to_world));
  const glm::dvec3 d = glm::transpose(rotation) * glm::dvec3(direction);
  const double tangent = std::tan(0.5 * glm::radians(double(camera.fov_degrees)));
  const double scale = 0.5 * std::min(film.width, film.height) / tangent;
  return {0.5 * film.width + scale * d.x / d.z, 0.5 * film.height - scale * d.y / d.z};
}

TEST(Camera, BoxFilterStaysInItsPixelAndIsUniform) {
  const CameraDescription description = moved_camera();
  const FilmDescription film{320, 200, {}};
  const FlatCamera camera(description, film);
  ASSERT_EQ(camera.data.filter_x, nullptr);
  EXPECT_EQ(camera.data.origin, glm::vec3(3.0f, -2.0f, 5.0f));
  constexpr double rounding = 1e-4;
  CellCounts counts(16, 16);
  for (std::uint32_t i = 0; i < sample_count; ++i) {
    const float column = float(i % 320), row = float(i / 320 % 200);
    const glm::vec3 d = camera_direction(camera.data, column, row, uniform2(i, 1));
    const glm::dvec2 p = pixel_position(description, film, d) - glm::dvec2(column, row);
    ASSERT_TRUE(p.x > -rounding && p.x < 1.0 + rounding) << p.x;
    ASSERT_TRUE(p.y > -rounding && p.y < 1.0 + rounding) << p.y;
    counts.add(p);
  }
  const DensityTest test = counts.test([](glm::dvec2) { return 1.0; });
  EXPECT_GT(test.chi_square.p_value, test_significance);
}

double normal_distribution(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// Of Mitchell and Netravali's cubic filters, and of sinc(x) sinc(x / tau).
double lobed_filter(const PixelFilter& filter, double radius, double x) {
  if (filter.kind == PixelFilter::Kind::Lanczos) {
    const auto sinc = [](double t) {
      return t == 0.0 ? 1.0 : std::sin(glm::pi<double>() * t) / (glm::pi<double>() * t);
    };
    return sinc(x) * sinc(x / double(filter.tau));
  }
  const double t = 2.0 * std::abs(x) / radius, b = double(filter.b), c = double(filter.c);
  // By what B-spline and cardinal spline are made of.
  const double near = std::max(0.0, 1.0 - t), far = std::max(0.0, 2.0 - t);
  const double spline = (far * far * far - 4.0 * near * near * near) / 6.0;
  const double sharp = t < 1.0 ? 1.0 - 2.0 * t * t + t * t * t : -(t - 1.0) * far * far;
  const double flat = t < 1.0 ? 1.0 - 3.0 * t * t + 2.0 * t * t * t : 0.0;
  return b * spline + c * (sharp - flat) + (1.0 - b) * flat;
}

// Sums of a filter with lobes from -radius up to each of many steps.
struct LobedFilter {
  static constexpr int steps = 1 << 16;
  std::vector<double> magnitude{0.0}, value{0.0};

  LobedFilter(const PixelFilter& filter, double radius) {
    for (int i = 0; i < steps; ++i) {
      const double f = lobed_filter(filter, radius, radius * ((2.0 * i + 1.0) / steps - 1.0));
      magnitude.push_back(magnitude.back() + std::abs(f));
      value.push_back(value.back() + f);
    }
  }
  static double share(const std::vector<double>& sums, double position) {
    const double at = std::clamp(position, 0.0, 1.0) * steps;
    const int i = std::min(int(at), steps - 1);
    return std::lerp(sums[size_t(i)], sums[size_t(i + 1)], at - i) / sums.back();
  }
};

// Share of the filter's weight that lies below x, in closed form where there is one.
double filter_distribution(const PixelFilter& filter, double radius, double x) {
  x = std::clamp(x, -radius, radius);
  if (filter.kind == PixelFilter::Kind::Box) return 0.5 + 0.5 * x / radius;
  if (filter.kind == PixelFilter::Kind::Triangle) {
    const double tail = 0.5 * (1.0 - std::abs(x) / radius) * (1.0 - std::abs(x) / radius);
    return x < 0.0 ? tail : 1.0 - tail;
  }
  if (filter.kind != PixelFilter::Kind::Gaussian) {
    static std::map<std::pair<float, double>, LobedFilter> known;
    const std::pair key(filter.kind == PixelFilter::Kind::Lanczos ? filter.tau : -filter.c, radius);
    const auto& sums = known.try_emplace(key, filter, radius).first->second;
    return LobedFilter::share(sums.magnitude, 0.5 + 0.5 * x / radius);
  }
  // A Gaussian lowered by its value at the radius.
  const double s = double(filter.sigma), edge = std::exp(-0.5 * radius * radius / (s * s));
  const auto weight_below = [&](double t) {
    const double gauss = normal_distribution(t / s) - normal_distribution(-radius / s);
    return s * std::sqrt(2.0 * glm::pi<double>()) * gauss - edge * (t + radius);
  };
  return weight_below(x) / weight_below(radius);
}

// With negative lobes.
std::vector<PixelFilter> lobed_filters() {
  using Kind = PixelFilter::Kind;
  PixelFilter mitchell{Kind::Mitchell, glm::vec2(2.0f)}, catmull_rom = mitchell;
  catmull_rom.b = 0.0f, catmull_rom.c = 0.5f;
  PixelFilter lanczos{Kind::Lanczos, glm::vec2(4.0f, 3.0f)};
  return {mitchell, catmull_rom, lanczos};
}

std::vector<PixelFilter> filters() {
  using Kind = PixelFilter::Kind;
  std::vector<PixelFilter> all = lobed_filters();
  all.insert(all.begin(), {{Kind::Triangle, glm::vec2(1.0f)},
                           {Kind::Triangle, glm::vec2(2.0f, 1.5f)},
                           {Kind::Gaussian, glm::vec2(1.5f), 0.5f},
                           {Kind::Gaussian, glm::vec2(2.0f, 1.0f), 1.0f},
                           {Kind::Box, glm::vec2(1.0f, 0.5f)}});
  return all;
}

TEST(Camera, FilterTableInvertsTheDistribution) {
  for (const PixelFilter& filter : filters()) {
    const FlatCamera camera({}, {64, 64, filter});
    ASSERT_NE(camera.data.filter_x, nullptr);
    const auto expect_inverse = [&](const float* table, float radius) {
      float previous = -radius;
      for (int i = 0; i < 1 << 14; ++i) {
        const float u = float(i) * 0x1p-14f;
        const float x = filter_offset(table, u);
        EXPECT_GE(x, previous);
        previous = x;
        // Exact at the table's knots, linear between them.
        const bool knot = i % ((1 << 14) / filter_cells) == 0;
        EXPECT_NEAR(filter_distribution(filter, double(radius), double(x)), double(u),
                    knot ? 2e-6 : 0.4 / filter_cells);
      }
      EXPECT_EQ(filter_offset(table, 0.0f), -radius);
      EXPECT_LE(filter_offset(table, one_minus_epsilon), radius);
      EXPECT_NEAR(filter_offset(table, 0.5f), 0.0f, 1e-4f);
    };
    expect_inverse(camera.data.filter_x, filter.radius.x);
    expect_inverse(camera.data.filter_y, filter.radius.y);
  }
}

// Positions through the true distributions along x and y must be uniform, in cells that do not
// resolve the table's own.
TEST(Camera, SamplesFollowTheFilter) {
  const CameraDescription description = moved_camera();
  std::uint32_t seed = 10;
  for (const PixelFilter& filter : filters()) {
    const FilmDescription film{64, 48, filter};
    const FlatCamera camera(description, film);
    CellCounts counts(16, 16);
    ++seed;
    for (std::uint32_t i = 0; i < sample_count; ++i) {
      const glm::vec3 d = camera_direction(camera.data, 20.0f, 30.0f, uniform2(i, seed));
      const glm::dvec2 offset = pixel_position(description, film, d) - glm::dvec2(20.5, 30.5);
      ASSERT_LT(std::abs(offset.x), double(filter.radius.x) + 1e-4);
      ASSERT_LT(std::abs(offset.y), double(filter.radius.y) + 1e-4);
      counts.add({filter_distribution(filter, double(filter.radius.x), offset.x),
                  filter_distribution(filter, double(filter.radius.y), offset.y)});
    }
    const DensityTest test = counts.test([](glm::dvec2) { return 1.0; });
    EXPECT_GT(test.chi_square.p_value, sidak_significance(int(filters().size())))
        << "filter " << int(filter.kind) << ": chi-square " << test.chi_square.statistic << " with "
        << test.chi_square.degrees << " degrees of freedom";
  }
}

// What a sample of each cell counts makes up for the sign that sampling cannot have: constants and
// ramps stay what they are, and so does every part of the filter.
TEST(Camera, WeightsGiveFiltersTheirNegativeLobes) {
  for (const PixelFilter& filter : lobed_filters()) {
    const FlatCamera camera({}, {64, 64, filter});
    EXPECT_TRUE(camera.flat.features & bit(Feature::FilterSigns));
    const auto expect_weights = [&](const float* offsets, const float* weights, double radius) {
      const LobedFilter sums(filter, radius);
      const double all = sums.magnitude.back() / sums.value.back();
      double mean = 0.0, ramp = 0.0;
      int between = 0;
      for (int i = 0; i < filter_cells; ++i) {
        const double weight = double(weights[i]);
        mean += weight / filter_cells;
        ramp += weight * 0.5 * (double(offsets[i]) + double(offsets[i + 1])) / filter_cells;
        const auto below = [&](float offset) {
          return LobedFilter::share(sums.value, 0.5 + 0.5 * double(offset) / radius);
        };
        const double share = below(offsets[i + 1]) - below(offsets[i]);
        EXPECT_NEAR(weight, share * filter_cells, 2e-3);
        if (std::abs(std::abs(weight) - all) > 1e-2) ++between;  // where the sign changes
      }
      EXPECT_NEAR(mean, 1.0, 1e-6);
      EXPECT_NEAR(ramp, 0.0, 1e-5);
      EXPECT_LE(between, filter.kind == PixelFilter::Kind::Lanczos ? 8 : 2);
      EXPECT_GT(all, 1.05);
    };
    expect_weights(camera.data.filter_x, camera.data.filter_weight_x, double(filter.radius.x));
    expect_weights(camera.data.filter_y, camera.data.filter_weight_y, double(filter.radius.y));
  }
  for (const PixelFilter& filter : filters()) {
    const bool lobes = filter.kind >= PixelFilter::Kind::Mitchell;
    const FlatCamera camera({}, {64, 64, filter});
    EXPECT_EQ((camera.flat.features & bit(Feature::FilterSigns)) != 0, lobes);
    EXPECT_EQ(camera.data.filter_weight_x != nullptr, lobes);
  }
  // The cubic B-spline has none.
  PixelFilter spline = lobed_filters()[0];
  spline.b = 1.0f, spline.c = 0.0f;
  EXPECT_FALSE(FlatCamera({}, {64, 64, spline}).flat.features & bit(Feature::FilterSigns));
}

TEST(Camera, FiltersThatCancelThemselvesAreErrors) {
  PixelFilter filter{PixelFilter::Kind::Mitchell, glm::vec2(2.0f)};
  for (const float c : {1e4f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    filter.c = c;
    EXPECT_THROW(FlatCamera({}, {64, 64, filter}), Error);
  }
}

TEST(Camera, WeightsHaveTheSameBitsAtEveryWidth) {
  const FlatCamera camera({}, {64, 64, lobed_filters()[2]});
  for_each_width([&](auto width) {
    constexpr int W = width();
    using V = Float<W>;
    for (std::uint32_t first = 0; first < 1024; first += W) {
      float u[W], v[W];
      for (int k = 0; k < W; ++k) {
        const Vec2<float> at = uniform2(first + std::uint32_t(k), 4);
        u[k] = at.x, v[k] = at.y;
      }
      u[0] = 0.0f, v[0] = one_minus_epsilon;
      const V wide = filter_weight(camera.data, Vec2<V>(load<V>(u), load<V>(v)));
      for (int k = 0; k < W; ++k) {
        ASSERT_TRUE(same_value(wide[k], filter_weight(camera.data, Vec2<float>(u[k], v[k]))));
      }
    }
  });
}

TEST(Camera, HasTheSameBitsAtEveryWidth) {
  for (const PixelFilter& filter : {PixelFilter{}, filters()[2]}) {
    const FlatCamera camera(moved_camera(), {320, 200, filter});
    for_each_width([&](auto width) {
      constexpr int W = width();
      using V = Float<W>;
      for (std::uint32_t first = 0; first < 4096; first += W) {
        float column[W], row[W], u[W], v[W];
        for (int k = 0; k < W; ++k) {
          const std::uint32_t i = first + std::uint32_t(k);
          column[k] = float(i % 320), row[k] = float(i / 320);
          u[k] = uniform2(i, 2).x, v[k] = uniform2(i, 2).y;
        }
        u[0] = 0.0f, v[0] = one_minus_epsilon;
        const Vec3<V> wide = camera_direction(camera.data, load<V>(column), load<V>(row),
                                              Vec2<V>(load<V>(u), load<V>(v)));
        for (int k = 0; k < W; ++k) {
          ASSERT_TRUE(same_value(lane(wide, k), camera_direction(camera.data, column[k], row[k],
                                                                 Vec2<float>(u[k], v[k]))))
              << "W=" << W;
        }
      }
    });
  }
}

// Rays through a lens meet where the pinhole's ray crosses the plane in focus, spread over the lens
// in proportion to area.
TEST(Camera, LensIsSharpAtItsFocalDistance) {
  CameraDescription description = moved_camera();
  description.lens_radius = 0.25f;
  description.focal_distance = 7.0f;
  const FlatCamera camera(description, {320, 200, {}});
  EXPECT_TRUE(camera.flat.features & bit(Feature::Lens));
  const glm::mat3 rotation(description.camera_to_world);
  const glm::vec3 forward = rotation * glm::vec3(0, 0, 1);
  CellCounts counts(16, 16);
  for (std::uint32_t i = 0; i < sample_count; ++i) {
    const Vec2<float> point(float(i % 320), float(i / 320 % 200));
    const CameraRay<float> sharp = pinhole_ray(camera.data, point);
    const CameraRay<float> ray = lens_ray(camera.data, point, uniform2(i, 3));
    const glm::vec3 focus =
        sharp.origin + sharp.direction * (7.0f / glm::dot(sharp.direction, forward));
    const glm::vec3 to_focus = glm::normalize(focus - ray.origin);
    ASSERT_LT(glm::length(to_focus - ray.direction), 1e-5f);
    const glm::vec3 on_lens = glm::transpose(rotation) * (ray.origin - camera.data.origin);
    ASSERT_NEAR(on_lens.z, 0.0f, 1e-5f);
    const double r = std::hypot(double(on_lens.x), double(on_lens.y)) / 0.25;
    ASSERT_LT(r, 1.0 + 1e-5);
    const double turns = std::atan2(double(on_lens.y), double(on_lens.x)) / glm::two_pi<double>();
    counts.add({std::min(r * r, 1.0 - 1e-9), turns - std::floor(turns)});
  }
  const DensityTest test = counts.test([](glm::dvec2) { return 1.0; });
  EXPECT_GT(test.chi_square.p_value, test_significance);
}

TEST(Camera, OrthographicRaysRunSideBySide) {
  CameraDescription description;
  description.camera_to_world = glm::translate(glm::mat4(1.0f), glm::vec3(1.0f, 2.0f, 3.0f));
  description.projection = CameraDescription::Projection::Orthographic;
  description.extent = 4.0f;
  const FlatCamera camera(description, {300, 100, {}});
  EXPECT_TRUE(camera.flat.features & bit(Feature::Orthographic));
  const CameraRay<float> first = orthographic_ray(camera.data, Vec2<float>(0.0f, 0.0f));
  const CameraRay<float> last = orthographic_ray(camera.data, Vec2<float>(300.0f, 100.0f));
  EXPECT_LT(glm::length(first.origin - glm::vec3(1.0f - 6.0f, 2.0f + 2.0f, 3.0f)), 1e-5f);
  EXPECT_LT(glm::length(last.origin - glm::vec3(1.0f + 6.0f, 2.0f - 2.0f, 3.0f)), 1e-5f);
  EXPECT_EQ(first.direction, glm::vec3(0, 0, 1));
  EXPECT_EQ(last.direction, first.direction);
}

TEST(Camera, ShiftMovesTheCentreOfTheImage) {
  CameraDescription description;
  description.fov_degrees = 90.0f;
  description.shift = {0.25f, -0.5f};
  const FlatCamera camera(description, {200, 100, {}});
  const glm::vec3 d = pinhole_ray(camera.data, Vec2<float>(100.0f, 50.0f)).direction;
  // The shorter side is 2 long at z = 1.
  EXPECT_NEAR(d.x / d.z, 0.5f, 1e-6f);
  EXPECT_NEAR(d.y / d.z, -1.0f, 1e-6f);
}

}  // namespace
}  // namespace lockstep::test_camera
