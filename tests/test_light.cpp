// Lights: directions sampled against the density that hit_light gives for them, sides, degenerate
// views and widths.
#include "tests/t_light_map.h"

#include <gtest/gtest.h>

#include <limits>

namespace lockstep::test_light {
namespace {

bool inside_unit_square(glm::dvec2 p) {
  constexpr double rounding = 1e-3;
  return p.x > -rounding && p.x < 1.0 + rounding && p.y > -rounding && p.y < 1.0 + rounding;
}

DensityTest test_density(const LightCase& c, std::uint32_t seed) {
  const LightScene scene({c});
  const LightMap map(c);
  CellCounts counts(24, 24);
  for (std::uint32_t i = 0; i < sample_count; ++i) {
    const LightSample<float> s = sample_case(scene, c, uniform2(i, seed));
    const glm::dvec2 p = map.to_square(glm::dvec3(s.wi));
    s.pdf > 0.0f && inside_unit_square(p) ? counts.add(p) : counts.add_lost();
  }
  return counts.test([&](glm::dvec2 p) {
    const LightMap::Target t = map.at(p);
    const Emitted<float> e = hit_case(scene, c, glm::vec3(t.wi), float(t.distance));
    return e.radiance.x > 0.0f ? double(e.pdf / choice) * t.solid_angle_per_area : 0.0;
  });
}

TEST(Light, SampledDirectionsHaveTheDensityOfHits) {
  const auto lights = cases();
  std::uint32_t seed = 0;
  for (const LightCase& c : lights) {
    const DensityTest test = test_density(c, ++seed);
    EXPECT_GT(test.chi_square.p_value, sidak_significance(int(lights.size())))
        << c.name << ": chi-square " << test.chi_square.statistic << " with "
        << test.chi_square.degrees << " degrees of freedom";
    EXPECT_NEAR(test.mass, 1.0, 1e-3) << c.name;
    EXPECT_NEAR(test.valid_share, 1.0, 1e-4) << c.name;
  }
}

TEST(Light, SamplesLieOnTheLightAndAgreeWithHits) {
  for (const LightCase& c : cases()) {
    const LightScene scene({c});
    int failures = 0;
    for (std::uint32_t i = 0; i < 4096 && failures < 3; ++i) {
      const LightSample<float> s = sample_case(scene, c, uniform2(i, 20));
      if (!(s.pdf > 0.0f)) continue;
      const Emitted<float> e = hit_case(scene, c, s.wi, s.distance);
      const glm::dvec3 end =
          glm::dvec3(c.point) + double(s.distance) * glm::dvec3(s.wi) - glm::dvec3(c.corner);
      const double off = c.is_sphere() ? glm::length(end) / double(c.radius) - 1.0
                                       : glm::dot(end, glm::normalize(c.cross_edges()));
      // Positions are rounded in proportion to the distance, densities where the light is grazed.
      const double reach =
          1.0 + glm::length(glm::dvec3(c.point)) / double(c.is_sphere() ? c.radius : 1.0f);
      const double kept_off = c.is_sphere() ? 0x1p-18 : 0.0;  // so that it does not hide itself
      if (std::abs(off) < 2e-6 * reach + kept_off && std::abs(e.pdf / s.pdf - 1.0f) < 5e-3f &&
          e.radiance == s.radiance && std::abs(length(s.wi) - 1.0f) < 1e-6f) {
        continue;
      }
      ++failures;
      ADD_FAILURE() << c.name << ", sample " << i << ": off the light by " << off << ", pdf "
                    << s.pdf << " against " << e.pdf;
    }
  }
}

// Shadow rays end 2^-12 of their length before the light. That of a near sphere has lost more
// digits than that to rounding; only at the rim, where a ray just grazes, may they reach it.
TEST(Light, ANearSphereDoesNotHideItself) {
  for (const float distance : {1.2f, 1.01f, 1.0002f, 1.00002f}) {
    const LightCase c = sphere("sphere", 1.0f, distance, 1.0f);
    const LightScene scene({c});
    int hidden = 0, samples = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
      const LightSample<float> s = sample_case(scene, c, uniform2(i, 3));
      if (!(s.pdf > 0.0f)) continue;
      ++samples;
      hidden += double(s.distance) * (1.0 - 0x1p-12) > sphere_distance(c, glm::dvec3(s.wi));
    }
    EXPECT_LT(hidden, 2e-3 * samples) << distance;
    EXPECT_GT(samples, 19000);
  }
}

TEST(Light, ShinesOnItsSideOnly) {
  const glm::vec3 front(0.2f, 0.3f, -1.0f), back(0.2f, 0.3f, 5.0f);
  struct Case {
    LightCase light;
    bool lit;
  };
  const Case sides[] = {
      {parallelogram("front", front, 1.0f), true},   {parallelogram("back", back, 1.0f), false},
      {parallelogram("front", front, -1.0f), false}, {parallelogram("back", back, -1.0f), true},
      {parallelogram("both", front, 0.0f), true},    {parallelogram("both", back, 0.0f), true},
      {triangle("front", front, 1.0f), true},        {triangle("back", back, 1.0f), false},
      {triangle("both", back, 0.0f), true},          {sphere("outside", 1.0f, 2.0f, 1.0f), true},
      {sphere("outside", 1.0f, 2.0f, -1.0f), false}, {sphere("inside", 1.0f, 0.5f, -1.0f), true},
      {sphere("inside", 1.0f, 0.5f, 1.0f), false},   {sphere("both", 1.0f, 0.5f, 0.0f), true},
      {sphere("both", 1.0f, 2.0f, 0.0f), true}};
  for (const auto& [light, lit] : sides) {
    const LightScene scene({light});
    const LightMap map(light);
    for (std::uint32_t i = 0; i < 200; ++i) {
      EXPECT_EQ(sample_case(scene, light, uniform2(i, 40)).pdf > 0.0f, lit)
          << light.name << " " << light.side;
      const auto target = map.at(glm::dvec2(uniform2(i, 41)));
      const auto hit = hit_case(scene, light, glm::vec3(target.wi), float(target.distance));
      EXPECT_EQ(hit.radiance.x, lit ? 3.0f : 0.0f) << light.name << " " << light.side;
    }
  }
}

TEST(Light, DegenerateViewsAreMasked) {
  // In the light's plane, on the light, and a light without area.
  LightCase edge_on{"edge on",
                    LightKind::Parallelogram,
                    {1.0f, 0.0f, 0.0f},
                    {1.0f, 0.0f, 0.0f},
                    {0.0f, 1.0f, 0.0f},
                    0.0f,
                    0.0f};
  LightCase on_it = edge_on, inside = edge_on;
  on_it.corner = glm::vec3(0.0f);
  inside.corner = glm::vec3(-0.5f, -0.25f, 0.0f);
  LightCase rectangle_edge_on = edge_on, rectangle_on_it = on_it, rectangle_inside = inside;
  rectangle_edge_on.outline = rectangle_on_it.outline = rectangle_inside.outline = 1.0f;
  LightCase triangle_inside = inside;
  triangle_inside.kind = LightKind::Triangle;
  for (const LightCase& c : {edge_on, on_it, inside, rectangle_edge_on, rectangle_on_it,
                             rectangle_inside, triangle_inside}) {
    const LightScene scene({c});
    for (const Vec2<float> u : {Vec2<float>(0.0f, 0.0f), Vec2<float>(0.5f, 0.25f)}) {
      EXPECT_EQ(sample_case(scene, c, u).pdf, 0.0f) << c.name;
    }
  }
}

TEST(Light, EnvironmentFollowsTheCosine) {
  LightCase c{"environment", LightKind::Environment};
  LightScene scene({c});
  const Frame<float> frame = frame_around(normalize(glm::vec3(0.4f, -0.7f, 0.2f)));
  const DirectionMap map{glm::dvec3(frame.z)};
  CellCounts counts(32, 32);
  for (std::uint32_t i = 0; i < sample_count; ++i) {
    const auto s = sample_lanes<1>(scene, 0, c.point, frame, uniform2(i, 50));
    ASSERT_NEAR(s.pdf, choice * cosine_hemisphere_pdf(dot(s.wi, frame.z)), 1e-6f);
    ASSERT_EQ(s.distance, std::numeric_limits<float>::infinity());
    counts.add(map.to_square(s.wi));
  }
  const DensityTest test = counts.test([&](glm::dvec2 p) {
    const float cosine = dot(glm::vec3(map.to_direction(p)), frame.z);
    return double(cosine_hemisphere_pdf(cosine)) * map.solid_angle_per_area(p);
  });
  EXPECT_GT(test.chi_square.p_value, test_significance);
}

template <int W>
void expect_same_bits_at_width(const LightScene& scene) {
  using V = Float<W>;
  const auto n = std::uint32_t(scene.data.lights.count);
  const Frame<float> frame = frame_around(normalize(glm::vec3(0.1f, 0.2f, 0.9f)));
  const Frame<V> wide_frame{splat<V>(frame.x), splat<V>(frame.y), splat<V>(frame.z)};
  for (std::uint32_t first = 0; first < 8192; first += W) {
    std::int32_t index[W];
    float u[W], v[W], point[3][W];
    for (int k = 0; k < W; ++k) {
      const std::uint32_t i = first + std::uint32_t(k);
      index[k] = std::int32_t(pcg3d(i, 2u, 3u).x % n);
      u[k] = uniform2(i, 70).x, v[k] = uniform2(i, 70).y;
      const glm::vec3 p = uniform3(i, 71) * 4.0f - 2.0f;
      for (int axis = 0; axis < 3; ++axis) point[axis][k] = p[axis];
    }
    const Int<W> at = load<Int<W>>(index);
    const Vec3<V> p(load<V>(point[0]), load<V>(point[1]), load<V>(point[2]));
    const auto wide = sample_lanes<W>(scene, at, p, wide_frame, Vec2<V>(load<V>(u), load<V>(v)));
    const auto wide_hit = hit_lanes<W>(scene, at, p, wide.wi, wide.distance);
    for (int k = 0; k < W; ++k) {
      const auto one = sample_lanes<1>(scene, index[k], lane(p, k), frame, {u[k], v[k]});
      const auto hit = hit_lanes<1>(scene, index[k], lane(p, k), one.wi, one.distance);
      ASSERT_TRUE(same_value(lane(wide.wi, k), one.wi)) << "W=" << W;
      ASSERT_TRUE(same_value(wide.distance[k], one.distance)) << "W=" << W;
      ASSERT_TRUE(same_value(lane(wide.radiance, k), one.radiance)) << "W=" << W;
      ASSERT_TRUE(same_value(wide.pdf[k], one.pdf)) << "W=" << W;
      ASSERT_TRUE(same_value(lane(wide_hit.radiance, k), hit.radiance)) << "W=" << W;
      ASSERT_TRUE(same_value(wide_hit.pdf[k], hit.pdf)) << "W=" << W;
    }
  }
}

TEST(Light, HasTheSameBitsAtEveryWidth) {
  auto lights = cases();
  lights.push_back({"environment", LightKind::Environment});
  const LightScene mixed(lights);
  for_each_width([&](auto width) { expect_same_bits_at_width<width()>(mixed); });
}

}  // namespace
}  // namespace lockstep::test_light
