// Environment maps: both mappings against their definitions, radiance against a plain reference,
// samples against their density, and maps that hold nothing, a single pixel or no numbers.
#include "core/environment_map.h"
#include "core/environment_map_lookup.h"

#include "core/image.h"
#include "tests/chi_square.h"
#include "tests/t_files.h"
#include "tests/widths.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <functional>
#include <limits>

namespace lockstep::test_environment_map {
namespace {

constexpr double pi_d = 3.14159265358979323846;
constexpr SphereMapping mappings[] = {SphereMapping::LatLong, SphereMapping::EqualAreaOctahedral};

// The direction of a point of the square, by definition and in double precision.
glm::dvec3 direction_of(SphereMapping mapping, glm::dvec2 p) {
  if (mapping == SphereMapping::LatLong) {
    const double theta = pi_d * p.y, phi = 2.0 * pi_d * (p.x - 0.5);  // from -z towards +x
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
  }
  const double u = 2.0 * p.x - 1.0, v = 2.0 * p.y - 1.0, au = std::abs(u), av = std::abs(v);
  const double distance = 1.0 - au - av, r = 1.0 - std::abs(distance);
  const double phi = r > 0.0 ? ((av - au) / r + 1.0) * pi_d / 4.0 : 0.0;
  const double radius = r * std::sqrt(2.0 - r * r);
  return {std::copysign(radius * std::cos(phi), u), std::copysign(radius * std::sin(phi), v),
          std::copysign(1.0 - r * r, distance)};
}

// The inverse of direction_of.
glm::dvec2 square_of(SphereMapping mapping, glm::dvec3 w) {
  if (mapping == SphereMapping::LatLong) {
    const double theta = std::atan2(std::hypot(w.x, w.z), w.y);
    return {0.5 + std::atan2(w.x, -w.z) / (2.0 * pi_d), theta / pi_d};
  }
  const double r = std::sqrt(std::max(0.0, 1.0 - std::abs(w.z)));
  const double b = r * std::atan2(std::abs(w.y), std::abs(w.x)) * 2.0 / pi_d, a = r - b;
  const double u = w.z < 0.0 ? 1.0 - b : a, v = w.z < 0.0 ? 1.0 - a : b;
  return {0.5 + 0.5 * std::copysign(u, w.x), 0.5 + 0.5 * std::copysign(v, w.y)};
}

double solid_angle_per_area(SphereMapping mapping, glm::dvec2 p) {
  return mapping == SphereMapping::LatLong ? 2.0 * pi_d * pi_d * std::sin(pi_d * p.y) : 4.0 * pi_d;
}

glm::vec3 random_direction(std::uint32_t i, std::uint32_t seed) {
  return uniform_sphere(uniform2(i, seed));
}

double luminance_of(glm::vec3 c) { return double(luminance(c)); }

// What is inlined by force, once for all tests.
[[gnu::noinline]] glm::vec3 radiance_of(const EnvironmentMapData& map, glm::vec3 w) {
  return environment_map_radiance(map, w);
}
[[gnu::noinline]] float pdf_of(const EnvironmentMapData& map, glm::vec3 w) {
  return environment_map_pdf(map, w);
}
template <int W>
[[gnu::noinline]] MapSample<Float<W>> sample_of(const EnvironmentMapData& map, Vec2<Float<W>> u) {
  return sample_environment_map<Float<W>>(map, u);
}
template <int W>
[[gnu::noinline]] MapLight<Float<W>> light_of(const EnvironmentMapData& map,
                                              const Vec3<Float<W>>& w) {
  return evaluate_environment_map<Float<W>>(map, w);
}

class EnvironmentMaps : public TestWithFiles {
 protected:
  // An image of this function of column and row, as a map.
  using Pixel = std::function<glm::vec3(int, int)>;
  Environment environment(SphereMapping mapping, int width, int height, const Pixel& pixel) const {
    Image image(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const glm::vec3 c = pixel(x, y);
        for (int k = 0; k < 3; ++k) image.at(x, y)[k] = c[k];
      }
    }
    static int count = 0;
    Environment e;
    e.file = path(std::to_string(count++) + ".exr");
    e.where = "scene:3";
    e.mapping = mapping == SphereMapping::LatLong ? Environment::Mapping::LatLong
                                                  : Environment::Mapping::EqualAreaOctahedral;
    write_image(e.file, image);
    return e;
  }

  static glm::vec3 noise(int x, int y) {
    const glm::vec3 v = uniform3(std::uint32_t(x), std::uint32_t(y));
    return {v.x, v.y * v.y, v.z};
  }
  // Dark, but for some pixels that differ by orders of magnitude.
  static glm::vec3 uneven(int x, int y) {
    const glm::vec3 v = uniform3(std::uint32_t(x), std::uint32_t(y + 100));
    return v.x < 0.5f ? glm::vec3(0.0f) : glm::vec3(v.y, v.z, 1.0f) * std::exp(6.0f * v.y);
  }
  Environment uneven_map(SphereMapping mapping) const {
    Environment e = mapping == SphereMapping::LatLong ? environment(mapping, 11, 6, uneven)
                                                      : environment(mapping, 8, 8, uneven);
    const float c = 0.6f, s = 0.8f;
    e.to_world = glm::mat3(c, 0.0f, s, 0.0f, -1.0f, 0.0f, -s, 0.0f, c);
    return e;
  }
};

TEST(SphereMapping, KnownDirectionsAreWhereTheyBelong) {
  const auto expect_at = [](SphereMapping mapping, glm::vec3 w, glm::vec2 p) {
    const glm::vec2 found = square_of_direction(mapping, w);
    EXPECT_NEAR(found.x, p.x, 1e-6f);
    EXPECT_NEAR(found.y, p.y, 1e-6f);
  };
  const SphereMapping lat_long = SphereMapping::LatLong;
  expect_at(lat_long, {0, 0, -1}, {0.5f, 0.5f});
  expect_at(lat_long, {1, 0, 0}, {0.75f, 0.5f});
  expect_at(lat_long, {-1, 0, 0}, {0.25f, 0.5f});
  expect_at(lat_long, {0, 1, 0}, {0.5f, 0.0f});
  expect_at(lat_long, normalize(glm::vec3(0, -1, -1)), {0.5f, 0.75f});
  const SphereMapping octahedral = SphereMapping::EqualAreaOctahedral;
  expect_at(octahedral, {0, 0, 1}, {0.5f, 0.5f});
  expect_at(octahedral, {1, 0, 0}, {1.0f, 0.5f});
  expect_at(octahedral, {0, 1, 0}, {0.5f, 1.0f});
  expect_at(octahedral, {-1, 0, 0}, {0.0f, 0.5f});
  expect_at(octahedral, normalize(glm::vec3(1, 1, 0)), {0.75f, 0.75f});
  EXPECT_EQ(octahedral_direction(Vec2<float>(0.0f, 1.0f)).z, -1.0f);
}

TEST(SphereMapping, SquareAndSphereAreInverses) {
  for (const SphereMapping mapping : mappings) {
    for (std::uint32_t i = 0; i < 20000; ++i) {
      const glm::vec2 p = uniform2(i, 1);
      const glm::dvec3 w = direction_of(mapping, glm::dvec2(p));
      const glm::vec2 back = square_of_direction(mapping, glm::vec3(w));
      const glm::dvec3 there = direction_of(mapping, glm::dvec2(back));
      ASSERT_LT(glm::length(there - w), 6e-7) << p.x << ", " << p.y;
      if (mapping == SphereMapping::LatLong) {
        const double s = std::sin(0.5 * pi_d * double(p.y)), c = std::cos(0.5 * pi_d * double(p.y));
        const glm::vec3 found = direction_of_latitude(p.x, float(s * s), float(c * c));
        ASSERT_LT(glm::length(glm::dvec3(found) - w), 6e-7) << p.x << ", " << p.y;
      } else {
        ASSERT_LT(glm::length(glm::dvec3(octahedral_direction(p)) - w), 6e-7);
      }
    }
    // Close to the poles, where digits are easily lost.
    for (std::uint32_t i = 0; i < 2000; ++i) {
      const glm::vec2 u = uniform2(i, 2);
      const float size = std::exp(-12.0f * u.x), sign = i % 2 ? 1.0f : -1.0f;
      const float x = size * std::cos(7.0f * u.y), y = size * std::sin(7.0f * u.y);
      const float z = sign * std::sqrt(1.0f - size * size);
      const bool lat_long = mapping == SphereMapping::LatLong;
      const glm::vec3 w = lat_long ? glm::vec3(x, z, y) : glm::vec3(x, y, z);
      const glm::vec2 p = square_of_direction(mapping, w);
      const glm::dvec3 off = direction_of(mapping, glm::dvec2(p)) - glm::dvec3(w);
      ASSERT_LT(glm::length(off), 1e-6) << size;
    }
  }
}

TEST(Atan, IsAccurate) {
  for (std::uint32_t i = 0; i < 100000; ++i) {
    const glm::vec2 p = glm::vec2(uniform2(i, 3)) * 2.0f - 1.0f;
    const double expected = std::atan2(double(p.y), double(p.x)) / (2.0 * pi_d);
    ASSERT_NEAR(double(atan2_turns(p.y, p.x)), expected, 6e-8);
  }
  EXPECT_EQ(atan2_turns(0.0f, 0.0f), 0.0f);
  EXPECT_EQ(atan2_turns(1.0f, 0.0f), 0.25f);
  EXPECT_EQ(atan2_turns(0.0f, -1.0f), 0.5f);
}

TEST_F(EnvironmentMaps, PixelCentresAreSeenInTheirDirections) {
  for (const SphereMapping mapping : mappings) {
    const int width = 16, height = mapping == SphereMapping::LatLong ? 8 : 16;
    Environment e = environment(mapping, width, height, noise);
    e.radiance = glm::vec3(2.0f, 1.0f, 0.5f);
    const EnvironmentMap map(e);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const glm::dvec3 w = direction_of(mapping, {(x + 0.5) / width, (y + 0.5) / height});
        const glm::vec3 found = radiance_of(map.view(), glm::vec3(w));
        const glm::vec3 expected = noise(x, y) * e.radiance;
        EXPECT_LT(glm::length(found - expected), 2e-5f) << x << ", " << y;
      }
    }
  }
}

TEST_F(EnvironmentMaps, RadianceIsContinuousAcrossSeamsAndPoles) {
  for (const SphereMapping mapping : mappings) {
    const int width = 16, height = mapping == SphereMapping::LatLong ? 8 : 16;
    const EnvironmentMap map(environment(mapping, width, height, noise));
    for (std::uint32_t i = 0; i < 4000; ++i) {
      // Around the edges of the square: its u = 0, and for the octahedron all of its edges.
      const float along = uniform2(i, 4).x;
      const glm::dvec2 edge[] = {{0.0, along}, {along, 0.0}, {along, 1.0}};
      const glm::dvec3 w = direction_of(mapping, edge[i % 3]);
      const glm::dvec3 step = 1e-5 * glm::dvec3(random_direction(i, 5));
      const glm::vec3 a = radiance_of(map.view(), glm::vec3(glm::normalize(w - step)));
      const glm::vec3 b = radiance_of(map.view(), glm::vec3(glm::normalize(w + step)));
      // At the poles of a map by latitude radiance depends on the longitude, which jumps.
      if (mapping == SphereMapping::LatLong && std::abs(w.y) > 0.999) continue;
      ASSERT_LT(glm::length(a - b), 4e-3f) << i;
    }
  }
}

// Half a turn on, the other side of the pole shows the same texels.
TEST_F(EnvironmentMaps, RadianceIsContinuousThroughThePoles) {
  for (const int width : {16, 2}) {
    const EnvironmentMap map(environment(SphereMapping::LatLong, width, 8, noise));
    for (std::uint32_t i = 0; i < 1000; ++i) {
      const double phi = 2.0 * pi_d * double(uniform2(i, 15).x), size = 1e-4;
      const glm::vec3 w(size * std::sin(phi), i % 2 ? 1.0 : -1.0, size * std::cos(phi));
      const glm::vec3 a = radiance_of(map.view(), w);
      const glm::vec3 b = radiance_of(map.view(), glm::vec3(-w.x, w.y, -w.z));
      ASSERT_LT(glm::length(a - b), 4e-3f) << i;
    }
  }
}

// Sampling --------------------------------------------------------------------------------------

TEST_F(EnvironmentMaps, SamplesHaveTheirDensity) {
  constexpr int tests = 4;
  for (const SphereMapping mapping : mappings) {
    for (const bool bright : {false, true}) {
      Environment e = uneven_map(mapping);
      if (bright) {
        e = environment(mapping, 9, 9, [](int x, int y) { return glm::vec3(x == 7 && y == 1); });
      }
      const EnvironmentMap map(e);
      const EnvironmentMapData data = map.view();
      // Whole parts of the grid's cells, so that the density jumps at their edges only.
      CellCounts counts(3 * data.columns, 3 * data.rows);
      for (std::uint32_t i = 0; i < 1u << 17; ++i) {
        const MapSample<float> s = sample_of<1>(data, uniform2(i, 6));
        counts.add(square_of(mapping, glm::transpose(e.to_world) * s.wi));
      }
      const DensityTest test = counts.test([&](glm::dvec2 p) {
        const glm::vec3 w = e.to_world * glm::vec3(direction_of(mapping, p));
        return double(pdf_of(data, w)) * solid_angle_per_area(mapping, p);
      });
      EXPECT_GT(test.chi_square.p_value, sidak_significance(tests))
          << int(mapping) << bright << ": chi-square " << test.chi_square.statistic << " with "
          << test.chi_square.degrees << " degrees of freedom";
      EXPECT_NEAR(test.mass, 1.0, 1e-4);
    }
  }
}

// Sum over the cells of the grid; every cell's density is looked up in its middle.
TEST_F(EnvironmentMaps, DensityIntegratesToOne) {
  for (const SphereMapping mapping : mappings) {
    const EnvironmentMap map(uneven_map(mapping));
    EnvironmentMapData data = map.view();
    data.to_world = glm::mat3(1.0f);
    double sum = 0.0;
    for (int row = 0; row < data.rows; ++row) {
      const double top = pi_d * row / data.rows, bottom = pi_d * (row + 1) / data.rows;
      const double solid_angle =
          mapping == SphereMapping::LatLong
              ? 2.0 * pi_d / data.columns * (std::cos(top) - std::cos(bottom))
              : 4.0 * pi_d / (data.rows * data.columns);
      for (int column = 0; column < data.columns; ++column) {
        const glm::dvec2 p((column + 0.5) / data.columns, (row + 0.5) / data.rows);
        const glm::vec3 w(direction_of(mapping, p));
        sum += solid_angle * double(pdf_of(data, w));
      }
    }
    EXPECT_NEAR(sum, 1.0, 1e-6);
  }
}

TEST_F(EnvironmentMaps, SamplesAgreeWithLookupsToTheLastBit) {
  for (const SphereMapping mapping : mappings) {
    const EnvironmentMap map(uneven_map(mapping));
    const EnvironmentMapData data = map.view();
    int lost = 0;
    for (std::uint32_t i = 0; i < 50000; ++i) {
      const MapSample<float> s = sample_of<1>(data, uniform2(i, 7));
      ASSERT_TRUE(same_value(s.pdf, pdf_of(data, s.wi)));
      ASSERT_TRUE(same_value(s.radiance, radiance_of(data, s.wi)));
      ASSERT_NEAR(length(s.wi), 1.0f, 1e-6f);
      lost += !(s.pdf > 0.0f);
    }
    EXPECT_EQ(lost, 0);
  }
}

// Where radiance is found at all, sampling must be able to find it: maps with one bright pixel,
// next to edges too, and larger than the grid of cells.
TEST_F(EnvironmentMaps, NoRadianceHasDensityZero) {
  struct Place {
    int width, height, x, y;
  };
  for (const SphereMapping mapping : mappings) {
    const bool lat_long = mapping == SphereMapping::LatLong;
    const std::vector<Place> places =
        lat_long
            ? std::vector<Place>{{16, 8, 5, 3}, {16, 8, 0, 0}, {15, 8, 14, 7}, {1100, 520, 800, 3}}
            : std::vector<Place>{
                  {16, 16, 5, 3}, {16, 16, 0, 9}, {15, 15, 14, 14}, {777, 777, 0, 400}};
    for (const Place& p : places) {
      const EnvironmentMap map(environment(mapping, p.width, p.height, [&](int x, int y) {
        return glm::vec3(x == p.x && y == p.y ? 1000.0f : 0.0f);
      }));
      const EnvironmentMapData data = map.view();
      EXPECT_LE(data.columns, 1024);
      EXPECT_LE(data.rows, 512);
      int seen = 0;
      const glm::dvec2 centre((p.x + 0.5) / p.width, (p.y + 0.5) / p.height);
      for (std::uint32_t i = 0; i < 20000; ++i) {
        glm::dvec2 at =
            centre + (glm::dvec2(uniform2(i, 8)) - 0.5) * 3.0 / glm::dvec2(p.width, p.height);
        const glm::dvec3 w = i % 4 ? direction_of(mapping, glm::clamp(at, 0.0, 1.0))
                                   : glm::dvec3(random_direction(i, 9));
        const MapLight<float> light = light_of<1>(data, glm::vec3(w));
        if (light.radiance.x > 0.0f) {
          ++seen;
          ASSERT_GT(light.pdf, 0.0f) << p.width << ": " << p.x << ", " << p.y;
        }
      }
      EXPECT_GT(seen, 2000);
    }
  }
}

// Irradiance-like integrals by sampling against midpoint sums over the square.
TEST_F(EnvironmentMaps, EstimatesMatchIntegrals) {
  for (const SphereMapping mapping : mappings) {
    Environment e = uneven_map(mapping);
    const EnvironmentMap map(e);
    const EnvironmentMapData data = map.view();
    double expected = 0.0;
    constexpr int n = 600;
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const glm::dvec2 p((x + 0.5) / n, (y + 0.5) / n);
        const double area = solid_angle_per_area(mapping, p);
        const glm::vec3 local(direction_of(mapping, p));
        const glm::vec3 w = e.to_world * local;
        const double value = luminance_of(radiance_of(data, w));
        expected += value * area * (1.0 + double(w.x)) / (double(n) * n);
      }
    }
    double sum = 0.0, squares = 0.0;
    constexpr std::uint32_t samples = 1 << 16;
    for (std::uint32_t i = 0; i < samples; ++i) {
      const MapSample<float> s = sample_of<1>(data, uniform2(i, 10));
      const double x = luminance_of(s.radiance) / double(s.pdf) * (1.0 + double(s.wi.x));
      sum += x / samples, squares += x * x / samples;
    }
    const double sigma = std::sqrt((squares - sum * sum) / samples);
    EXPECT_NEAR(sum, expected, 4.5 * sigma + 1e-3 * expected);
    // In proportion to radiance, but for what interpolation does within a cell.
    EXPECT_LT(std::sqrt(squares - sum * sum), 1.2 * sum);
    const double mean = luminance_of(map.mean_radiance()) * 4.0 * pi_d;
    EXPECT_GT(mean, 0.0);
  }
}

// Special maps ----------------------------------------------------------------------------------

TEST_F(EnvironmentMaps, ConstantMapIsUniform) {
  for (const SphereMapping mapping : mappings) {
    const EnvironmentMap map(environment(mapping, 8, 8, [](int, int) { return glm::vec3(3.0f); }));
    for (std::uint32_t i = 0; i < 1000; ++i) {
      const auto light = light_of<1>(map.view(), random_direction(i, 11));
      EXPECT_NEAR(light.pdf, 0.25f * inv_pi, 1e-5f);
      EXPECT_NEAR(light.radiance.y, 3.0f, 1e-5f);
    }
    EXPECT_NEAR(map.mean_radiance().z, 3.0f, 1e-5f);
  }
}

TEST_F(EnvironmentMaps, BlackMapIsSampledUniformly) {
  for (const SphereMapping mapping : mappings) {
    for (const bool tinted : {false, true}) {
      Environment e =
          environment(mapping, 6, 6, [&](int, int) { return glm::vec3(0.0f, tinted, 0.0f); });
      e.radiance = glm::vec3(1.0f, 0.0f, 1.0f);
      const EnvironmentMap map(e);
      glm::dvec3 mean(0.0);
      for (std::uint32_t i = 0; i < 4000; ++i) {
        const MapSample<float> s = sample_of<1>(map.view(), uniform2(i, 12));
        EXPECT_NEAR(s.pdf, 0.25f * inv_pi, 1e-8f);
        EXPECT_EQ(s.radiance, glm::vec3(0.0f));
        mean += glm::dvec3(s.wi) / 4000.0;
      }
      EXPECT_LT(glm::length(mean), 0.05);
      EXPECT_EQ(map.mean_radiance(), glm::vec3(0.0f));
    }
  }
}

TEST_F(EnvironmentMaps, PolesSeamsAndBadNumbersAreFinite) {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  for (const SphereMapping mapping : mappings) {
    const EnvironmentMap map(environment(mapping, 4, 4, [](int x, int y) {
      return glm::vec3(x == y ? std::nanf("") : -1.0f, x == 1 ? infinite : 1.0f, 0.5f);
    }));
    const EnvironmentMapData data = map.view();
    const float values[] = {0.0f, 1.0f, -1.0f, -0.0f, 1e-30f, infinite, std::nanf("")};
    for (const float x : values) {
      for (const float y : values) {
        for (const float z : values) {
          const auto light = light_of<1>(data, Vec3<float>(x, y, z));
          for (const float v : {light.radiance.x, light.radiance.y, light.radiance.z, light.pdf}) {
            ASSERT_TRUE(std::isfinite(v) && v >= 0.0f) << x << ", " << y << ", " << z;
          }
        }
      }
    }
    for (const float x : {0.0f, 0x1p-24f, 0.5f, one_minus_epsilon}) {
      for (const float y : {0.0f, 0x1p-24f, 0.5f, one_minus_epsilon}) {
        const MapSample<float> s = sample_of<1>(data, Vec2<float>(x, y));
        EXPECT_NEAR(length(s.wi), 1.0f, 1e-6f);
        EXPECT_TRUE(std::isfinite(s.pdf) && std::isfinite(s.radiance.y));
      }
    }
  }
}

TEST_F(EnvironmentMaps, MapsTurnAndMirror) {
  for (const SphereMapping mapping : mappings) {
    const glm::vec3 local(0.36f, -0.48f, 0.8f);
    for (const float sign : {1.0f, -1.0f}) {
      Environment e = environment(mapping, 8, 8, noise);
      const EnvironmentMap plain(e);
      // Scaled: only the directions of the axes count.
      e.to_world =
          5.0f * glm::mat3(0.0f, 0.6f, 0.8f, 1.0f, 0.0f, 0.0f, 0.0f, sign * 0.8f, -sign * 0.6f);
      EXPECT_TRUE(keeps_angles(e.to_world));
      const EnvironmentMap turned(e);
      const glm::vec3 there = e.to_world * local * 0.2f;
      const glm::vec3 a = radiance_of(plain.view(), local);
      const glm::vec3 b = radiance_of(turned.view(), there);
      EXPECT_LT(glm::length(a - b), 1e-5f);
      EXPECT_NE(plain.fingerprint(), turned.fingerprint());
    }
  }
  EXPECT_FALSE(keeps_angles(glm::mat3(2.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f)));
  EXPECT_FALSE(keeps_angles(glm::mat3(0.0f)));
}

TEST_F(EnvironmentMaps, BadMapsAreErrors) {
  const auto error = [](const Environment& e) {
    const std::string message = error_of([&] { EnvironmentMap map(e); });
    expect_one_line_with(message, "scene:3: " + e.file + ": ");
    return message;
  };
  Environment e = environment(SphereMapping::EqualAreaOctahedral, 8, 4, noise);
  expect_one_line_with(error(e), "square");
  e.mapping = Environment::Mapping::LatLong;
  e.to_world = glm::mat3(0.0f);
  expect_one_line_with(error(e), "inverse");
  e.to_world = glm::mat3(std::nanf(""));
  error(e);
  e.to_world = glm::mat3(1.0f);
  EXPECT_EQ(error_of([&] { EnvironmentMap map(e); }), "");
  e.file = path("missing.exr");
  error(e);
  e.file = write("text.hdr", "no image");
  error(e);
}

// Widths ----------------------------------------------------------------------------------------

template <int W>
void expect_same_bits(const EnvironmentMapData& data) {
  using V = Float<W>;
  for (std::uint32_t first = 0; first < 1024; first += W) {
    float u[W], v[W], w[3][W];
    for (int k = 0; k < W; ++k) {
      const std::uint32_t i = first + std::uint32_t(k);
      u[k] = uniform2(i, 13).x, v[k] = uniform2(i, 13).y;
      for (int axis = 0; axis < 3; ++axis) w[axis][k] = random_direction(i, 14)[axis];
    }
    const auto s = sample_of<W>(data, Vec2<V>(load<V>(u), load<V>(v)));
    const Vec3<V> wi(load<V>(w[0]), load<V>(w[1]), load<V>(w[2]));
    const auto light = light_of<W>(data, wi);
    for (int k = 0; k < W; ++k) {
      const auto one = sample_of<1>(data, Vec2<float>(u[k], v[k]));
      const auto one_light = light_of<1>(data, lane(wi, k));
      ASSERT_TRUE(same_value(lane(s.wi, k), one.wi)) << "W=" << W;
      ASSERT_TRUE(same_value(lane(s.radiance, k), one.radiance)) << "W=" << W;
      ASSERT_TRUE(same_value(s.pdf[k], one.pdf)) << "W=" << W;
      ASSERT_TRUE(same_value(lane(light.radiance, k), one_light.radiance)) << "W=" << W;
      ASSERT_TRUE(same_value(light.pdf[k], one_light.pdf)) << "W=" << W;
    }
  }
}

TEST_F(EnvironmentMaps, EveryWidthGivesTheSameBits) {
  for (const SphereMapping mapping : mappings) {
    const EnvironmentMap map(uneven_map(mapping));
    for_each_width([&](auto width) { expect_same_bits<width()>(map.view()); });
  }
}

}  // namespace
}  // namespace lockstep::test_environment_map
