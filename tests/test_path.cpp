// The path integrator against closed forms and quadrature. Random estimates are compared by t-tests
// over renders with independent seeds.
#include "core/bsdf.h"
#include "core/error.h"
#include "tests/t_scenes.h"
#include "tests/t_statistics.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace lockstep {
namespace {

using builtin::add_material;
using builtin::add_rectangle;
using builtin::add_sphere;

constexpr double pi_double = 3.14159265358979323846;

// No test looks at more t-tests than this.
constexpr double tests_at_most = 64;
const double level = sidak(significance, tests_at_most);

struct Plan {
  const char* sampler = "random";
  int spp = 16;
  int depth = 1;
  int roulette_depth = 100;
  int seeds = 32;
};

// One channel's image mean, one entry per seed.
Moments channel_means(const Scene& scene, const Plan& plan, int channel = 0) {
  Moments m;
  RenderSettings s;
  s.spp = plan.spp;
  s.depth = plan.depth;
  s.roulette_depth = plan.roulette_depth;
  s.threads = 2;
  for (int seed = 0; seed < plan.seeds; ++seed) {
    s.seed = std::uint32_t(seed);
    m.add(channel_mean(render(scene, parse_sampler(plan.sampler), s).image, channel));
  }
  return m;
}

// `rounding` is the relative error that float arithmetic may add.
void expect_mean(const Moments& m, double expected, double rounding = 2e-5) {
  EXPECT_GT(mean_is(m, expected, rounding * expected), level)
      << "mean " << m.mean << " +- " << std::sqrt(m.mean_variance()) << ", expected " << expected;
}

// Furnaces --------------------------------------------------------------------------------------

TEST(Furnace, AWhiteConvexBodyUnderAWhiteSkyIsInvisible) {
  const Scene scene = build(builtin::make_furnace());
  for (const int depth : {1, 2, 8}) {
    for (const char* sampler : {"random", "cpt"}) {
      RenderSettings s;
      s.spp = 8;
      s.depth = depth;
      const Image image = render(scene, parse_sampler(sampler), s).image;
      for (const float x : image.pixels) ASSERT_NEAR(x, 1.0f, 2e-5f) << depth;
    }
  }
}

TEST(Furnace, AConvexBodyScattersOnceAtEveryDepth) {
  SceneDescription d = builtin::make_furnace();
  d.materials[0] = DiffuseMaterial{glm::vec3(0.8f, 0.5f, 0.0f)};
  d.environment = glm::vec3(2.0f, 3.0f, 4.0f);
  look_closely(d, {0, 0, 4}, {0, 0, 1});
  const Scene scene = build(std::move(d));
  for (const int depth : {1, 3}) {
    const Plan plan{.spp = 4, .depth = depth, .seeds = 2};
    EXPECT_NEAR(channel_means(scene, plan, 0).mean, 1.6, 1e-4);
    EXPECT_NEAR(channel_means(scene, plan, 1).mean, 1.5, 1e-4);
    EXPECT_EQ(channel_means(scene, plan, 2).mean, 0.0);
  }
}

// Everywhere inside a closed body of emission L and albedo a the radiance is L (1 + a + a^2 + ...),
// with one term more than interactions are lit.
double partial_sum(double emission, double albedo, int depth) {
  double sum = 0.0;
  for (int i = depth; i >= 0; --i) sum = sum * albedo + emission;
  return sum;
}

SceneDescription closed_sphere(float emission, float albedo) {
  SceneDescription d;
  d.name = "closed sphere";
  const int wall = add_material(d, DiffuseMaterial{glm::vec3(albedo)});
  add_sphere(d, {1, 2, 3}, 2.5f, wall, Emission{glm::vec3(emission)});
  std::get<Sphere>(d.shapes[0].geometry).emits_inwards = true;
  look_closely(d, {1.3f, 1.6f, 2.8f}, {5, 4, 1});
  return d;
}

// Edges of the box are of unequal length. Walls face inwards.
SceneDescription closed_box(float emission, float albedo, bool split_walls = false) {
  SceneDescription d;
  d.name = "closed box";
  const int wall = add_material(d, DiffuseMaterial{glm::vec3(albedo)});
  const Emission light{glm::vec3(emission)};
  const glm::vec3 x(1, 0, 0), y(0, 1.5f, 0), z(0, 0, 2);
  add_rectangle(d, -x, y, z, wall, light);
  add_rectangle(d, x, z, y, wall, light);
  add_rectangle(d, -y, z, x, wall, light);
  add_rectangle(d, y, x, z, wall, light);
  add_rectangle(d, -z, x, y, wall, light);
  add_rectangle(d, z, y, x, wall, light);
  if (split_walls) {  // a rectangle's halves as meshes of their own: triangular lights
    const std::size_t n = d.shapes.size();
    for (std::size_t i = 0; i < n; ++i) {
      Shape half = d.shapes[i];
      auto& mesh = std::get<TriangleMesh>(half.geometry);
      mesh.triangles.erase(mesh.triangles.begin());
      std::get<TriangleMesh>(d.shapes[i].geometry).triangles.pop_back();
      d.shapes.push_back(half);
    }
  }
  d.camera.camera_to_world = builtin::look_at({0.2f, -0.3f, 0.1f}, {1, 1, 1});
  d.camera.fov_degrees = 100.0f;
  d.film.width = d.film.height = 16;
  return d;
}

TEST(Furnace, InsideASphereEveryDepthAddsATerm) {
  for (const float albedo : {0.0f, 0.5f, 0.9f}) {
    const Scene scene = build(closed_sphere(0.7f, albedo));
    for (const int depth : {1, 2, 3, 6}) {
      const Plan plan{.spp = 32, .depth = depth, .seeds = 16};
      // Uniform sampling of the sphere's area has no variance here, but for diffuse bounces.
      expect_mean(channel_means(scene, plan), partial_sum(0.7, double(albedo), depth), 1e-4);
    }
  }
}

TEST(Furnace, InsideABoxEveryDepthAddsATerm) {
  for (const bool split : {false, true}) {
    const Scene scene = build(closed_box(0.7f, 0.6f, split));
    EXPECT_EQ(scene.data().lights.count, split ? 12 : 6);
    for (const int depth : {1, 2, 3, 5}) {
      const Plan plan{.spp = 16, .depth = depth};
      expect_mean(channel_means(scene, plan), partial_sum(0.7, 0.6, depth));
    }
  }
}

TEST(Furnace, EverySamplerFindsTheSameSum) {
  const Scene scene = build(closed_box(0.7f, 0.6f));
  for (const char* sampler : {"owen", "cpt", "rcs", "rcs:weight=0.3", "rcs:offset=fresh"}) {
    const Plan plan{.sampler = sampler, .spp = 8, .depth = 3, .seeds = 64};
    expect_mean(channel_means(scene, plan), partial_sum(0.7, 0.6, 3));
  }
}

TEST(Roulette, KeepsTheMean) {
  const Scene box = build(closed_box(0.7f, 0.6f));
  for (const int roulette_depth : {1, 2, 4, 100}) {
    const Plan plan{.spp = 32, .depth = 8, .roulette_depth = roulette_depth, .seeds = 64};
    expect_mean(channel_means(box, plan), partial_sum(0.7, 0.6, 8));
  }
  for (const auto& make : {builtin::make_cornell, builtin::make_spheres}) {
    const Scene scene = build(resized(make(), 24, 18));
    const auto means = [&](int roulette_depth) {
      return channel_means(scene,
                           {.spp = 48, .depth = 5, .roulette_depth = roulette_depth, .seeds = 40});
    };
    const Moments without = means(100), with = means(1);
    EXPECT_GT(equal_means(with, without), level) << with.mean << ' ' << without.mean;
  }
}

TEST(Roulette, EndsPaths) {
  const Scene scene = build(closed_box(0.7f, 0.3f));
  RenderSettings s;
  s.depth = 1000;
  s.spp = 4;
  s.roulette_depth = 1;
  const RenderResult r = render(scene, parse_sampler("random"), s);
  EXPECT_LT(r.stats.rays.bounce, 2 * r.stats.paths);  // 0.3 / 0.7 of them are expected
  EXPECT_NEAR(mean_of(r.image), 0.7 / (1.0 - 0.3), 0.05);
}

// Direct light ----------------------------------------------------------------------------------

constexpr float albedo = 0.6f;

// A floor in y = 0, of which the camera sees the origin, from the side.
SceneDescription lit_floor(const Material& material = DiffuseMaterial{glm::vec3(albedo)},
                           glm::vec3 eye = {3, 2, 1}, float half_size = 50) {
  SceneDescription d;
  d.name = "floor";
  add_rectangle(d, {0, 0, 0}, {0, 0, half_size}, {half_size, 0, 0}, add_material(d, material));
  look_closely(d, eye, {0, 0, 0});
  return d;
}

int lamp(SceneDescription& d) { return add_material(d, DiffuseMaterial{glm::vec3(0.0f)}); }

// A lamp of half sizes a and b at height h over the origin, facing down.
void add_lamp(SceneDescription& d, float a, float b, float h, Emission emission) {
  add_rectangle(d, {0, h, 0}, {a, 0, 0}, {0, 0, b}, lamp(d), emission);
}

// Form factor from a point to a parallel rectangle of half sizes a and b, centred h above it: four
// times that of the quarter with a corner above the point (Howell, catalogue of configuration
// factors, B-3).
double rectangle_form_factor(double a, double b, double h) {
  const double x = a / h, y = b / h, sx = std::sqrt(1 + x * x), sy = std::sqrt(1 + y * y);
  return 4.0 / (2.0 * pi_double) * (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy));
}

TEST(DirectLight, OfARectangle) {
  for (const auto& [a, b, h] :
       {std::array{1.0f, 1.0f, 1.0f}, std::array{0.5f, 0.2f, 1.4f}, std::array{4.0f, 0.1f, 0.7f}}) {
    SceneDescription d = lit_floor();
    add_lamp(d, a, b, h, {glm::vec3(5.0f)});
    const Scene scene = build(std::move(d));
    ASSERT_EQ(scene.data().lights.count, 1);
    for (const int depth : {1, 2}) {  // the lamp is black: no interreflection
      expect_mean(channel_means(scene, {.depth = depth}),
                  5.0 * double(albedo) * rectangle_form_factor(double(a), double(b), double(h)),
                  1e-3);
    }
  }
}

TEST(DirectLight, OfTriangles) {
  SceneDescription d = lit_floor();
  TriangleMesh fan;  // four triangles about the lamp's middle
  fan.positions = {{0, 1, 0}, {1, 1, 0.5f}, {1, 1, -0.5f}, {-1, 1, -0.5f}, {-1, 1, 0.5f}};
  fan.triangles = {{0, 1, 2}, {0, 3, 4}, {0, 2, 3}, {0, 4, 1}};
  for (auto& t : fan.triangles) std::swap(t.y, t.z);
  const int black = lamp(d);
  builtin::add_mesh(d, fan, black);
  d.shapes.back().emission = Emission{glm::vec3(5.0f), true};
  const Scene scene = build(std::move(d));
  ASSERT_EQ(scene.data().lights.count, 4);
  const double expected = 5.0 * double(albedo) * rectangle_form_factor(1.0, 0.5, 1.0);
  expect_mean(channel_means(scene, {.spp = 32}), expected, 1e-3);
}

TEST(DirectLight, OfADisk) {
  for (const auto& [radius, h] : {std::array{0.5f, 1.0f}, std::array{2.0f, 1.5f}}) {
    SceneDescription d = lit_floor();
    d.shapes.push_back({Disk{{0, h, 0}, {0, -1, 0}, radius}, lamp(d), Emission{glm::vec3(5.0f)}});
    const Scene scene = build(std::move(d));
    ASSERT_EQ(scene.data().lights.count, 1);
    const double r2 = double(radius) * double(radius), h2 = double(h) * double(h);
    for (const int depth : {1, 2}) {  // 1e-3: it is a polygon of the same area
      expect_mean(channel_means(scene, {.depth = depth}), 5.0 * double(albedo) * r2 / (r2 + h2),
                  1e-3);
    }
  }
}

TEST(DirectLight, OfASphere) {
  // E = pi L (R / D)^2 cos(theta) while the whole sphere is above the horizon.
  for (const auto& [x, y, radius] :
       {std::array{0.0f, 2.0f, 0.5f}, std::array{1.0f, 1.0f, 0.6f}, std::array{0.0f, 1.0f, 0.95f},
        std::array{3.0f, 4.0f, 0.01f}}) {
    SceneDescription d = lit_floor(DiffuseMaterial{glm::vec3(albedo)}, {-3, 0.7f, 3});
    add_sphere(d, {x, y, 0}, radius, lamp(d), Emission{glm::vec3(5.0f)});
    const Scene scene = build(std::move(d));
    const double distance = std::hypot(double(x), double(y));
    const double expected = 5.0 * double(albedo) * double(radius) * double(radius) /
                            (distance * distance) * double(y) / distance;
    for (const int depth : {1, 2})
      expect_mean(channel_means(scene, {.depth = depth}), expected, 2e-3);
  }
}

TEST(DirectLight, OfASphereFromInside) {
  SceneDescription d = lit_floor();
  add_sphere(d, {0.5f, 1, 0.2f}, 40, lamp(d), Emission{glm::vec3(5.0f)});
  std::get<Sphere>(d.shapes.back().geometry).emits_inwards = true;
  expect_mean(channel_means(build(std::move(d)), {.spp = 64}), 5.0 * double(albedo), 1e-4);
}

TEST(DirectLight, OfAConstantEnvironment) {
  SceneDescription d = lit_floor();
  d.environment = glm::vec3(5.0f);
  for (const int depth : {1, 2}) {
    const Plan plan{.depth = depth};
    expect_mean(channel_means(build(d), plan), 5.0 * double(albedo));
  }
}

TEST(DirectLight, OfSeveralLightsAddsUp) {
  SceneDescription d = lit_floor();
  add_lamp(d, 0.5f, 0.5f, 2.0f, {glm::vec3(4.0f)});
  const float side = 2.5f;
  add_sphere(d, {-side, 1.5f, 0}, 0.5f, lamp(d), Emission{glm::vec3(30.0f)});
  add_sphere(d, {0, 1.5f, -side}, 0.25f, lamp(d), Emission{glm::vec3(1.0f)});
  const Scene scene = build(std::move(d));
  ASSERT_EQ(scene.data().lights.count, 3);
  const double d2 = 2.5 * 2.5 + 1.5 * 1.5, cos_theta = 1.5 / std::sqrt(d2);
  const double expected =
      double(albedo) * (4.0 * rectangle_form_factor(0.5, 0.5, 2.0) + 30.0 * 0.25 / d2 * cos_theta +
                        1.0 * 0.0625 / d2 * cos_theta);
  for (const char* sampler : {"random", "owen"}) {
    for (const int depth : {1, 2}) {
      const Plan plan{.sampler = sampler, .spp = 64, .depth = depth};
      expect_mean(channel_means(scene, plan), expected, 1e-3);
    }
  }
}

// A square of emission L over the floor blocks as much of the sky as it lights itself.
TEST(DirectLight, IsBlockedByWhatIsInTheWay) {
  SceneDescription d = lit_floor();
  d.environment = glm::vec3(2.0f);
  add_rectangle(d, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, lamp(d));
  const double open = 1.0 - rectangle_form_factor(1.0, 1.0, 1.0);
  expect_mean(channel_means(build(d), {.spp = 64}), 2.0 * double(albedo) * open, 1e-3);
  d.shapes.back().emission = Emission{glm::vec3(2.0f)};
  expect_mean(channel_means(build(d), {.spp = 64}), 2.0 * double(albedo), 1e-3);
}

// Rays leave a surface just outside the rounding error of its own coordinates: neither a scene far
// from the origin nor a camera far from the scene moves what lies close above a surface.
TEST(RayOffset, IsSmallFarFromTheOriginAndFromTheCamera) {
  const auto mean_at = [](glm::vec3 origin, float camera_distance) {
    SceneDescription d = lit_floor();
    add_lamp(d, 0.5f, 0.5f, 0.125f, {glm::vec3(5.0f)});
    for (Shape& shape : d.shapes) {
      for (glm::vec3& p : std::get<TriangleMesh>(shape.geometry).positions) p += origin;
    }
    const glm::vec3 from = glm::normalize(glm::vec3(-1.0f, 0.05f, 0.0f)) * camera_distance;
    look_closely(d, origin + from, origin);
    d.camera.fov_degrees = 0.02f / camera_distance;
    RenderSettings settings;
    settings.spp = 64;
    settings.depth = 1;
    return mean_of(render(build(std::move(d)), parse_sampler("owen"), settings).image);
  };
  const double expected = mean_at(glm::vec3(0.0f), 1.0f);
  ASSERT_GT(expected, 1.0);
  EXPECT_NEAR(mean_at(glm::vec3(8192.0f, 0.0f, 0.0f), 1.0f) / expected, 1.0, 2e-2);
  EXPECT_NEAR(mean_at(glm::vec3(0.0f, 8192.0f, 0.0f), 1.0f) / expected, 1.0, 2e-2);
  EXPECT_NEAR(mean_at(glm::vec3(0.0f), 20000.0f) / expected, 1.0, 1e-2);
}

// Points on tilted lights are rounded to coordinates off their plane: shadow rays end before it.
// Rays leave 0.005 above the floor here.
TEST(RayOffset, DoesNotHideTiltedLightsFarFromTheOrigin) {
  SceneDescription d = lit_floor();
  add_lamp(d, 0.5f, 0.5f, 1.0f, {glm::vec3(5.0f)});
  const glm::mat3 tilt(glm::rotate(glm::mat4(1.0f), 0.7f, glm::vec3(0.6f, 0.0f, 0.8f)));
  const glm::vec3 place(8000.0f, -5000.0f, 3000.0f);
  for (Shape& shape : d.shapes) {
    for (glm::vec3& p : std::get<TriangleMesh>(shape.geometry).positions) p = tilt * p + place;
  }
  look_closely(d, tilt * glm::vec3(3, 2, 1) + place, place);
  const double expected = 5.0 * double(albedo) * rectangle_form_factor(0.5, 0.5, 1.0);
  expect_mean(channel_means(build(std::move(d)), {.sampler = "owen", .spp = 64}), expected, 0.012);
}

// A lamp that touches the floor beside the point in view, 2e-4 away from it.
TEST(DirectLight, OfASphereThatTouchesTheFloor) {
  SceneDescription d = lit_floor(DiffuseMaterial{glm::vec3(albedo)}, {0, 0.03f, 3}, 4.0f);
  add_sphere(d, {0.02f, 1, 0}, 1.0f, lamp(d), Emission{glm::vec3(5.0f)});
  d.camera.fov_degrees = 1e-4f;
  expect_mean(channel_means(build(std::move(d)), {.spp = 64}),
              5.0 * double(albedo) / std::pow(1.0004, 1.5), 5e-3);
}

// What a light's row says is the probability with which samples of 24 bits choose it.
TEST(Lights, AreChosenWithTheProbabilityTheyState) {
  SceneDescription d = lit_floor();
  for (int i = 0; i < 300; ++i) {
    add_sphere(d, {float(i), 3.0f, 0.0f}, 0.1f, lamp(d),
               Emission{glm::vec3(i == 7 ? 1e-9f : 1.0f)});
  }
  const Scene scene = build(std::move(d));
  const LightTable& lights = scene.data().lights;
  ASSERT_EQ(lights.count, 300);
  for (int i = 0; i < lights.count; ++i) {
    const float probability = lights.rows[i * light_stride + 7];
    EXPECT_EQ(probability, lights.cdf[i + 1] - lights.cdf[i]);
    EXPECT_GE(probability, 0x1p-24f) << "a light that shines must be found";
    EXPECT_EQ(lights.cdf[i] * 0x1p24f, std::floor(lights.cdf[i] * 0x1p24f));
  }
}

// An ellipse of 20 triangles; `moved` is the way that one corner is put out of place.
TriangleMesh ellipse(float moved) {
  TriangleMesh fan;
  fan.positions.emplace_back(0.1f, 1.0f, 0.2f);
  for (unsigned i = 0; i < 20; ++i) {
    const float a = float(i) * 0.1f * pi;
    fan.positions.push_back(fan.positions[0] + std::cos(a) * glm::vec3(1.0f, 0.2f, 0.0f) -
                            std::sin(a) * glm::vec3(0.3f, 0.1f, 2.0f));
    fan.triangles.emplace_back(0u, 1u + i, 1u + (i + 1u) % 20u);
  }
  fan.positions[5].y += moved;
  return fan;
}

TEST(Lights, AFanThatIsADiskIsOneLight) {
  for (const bool disk : {true, false}) {
    SceneDescription d = lit_floor();
    const TriangleMesh fan = ellipse(disk ? 0.0f : 0.01f);
    builtin::add_mesh(d, fan, lamp(d));
    d.shapes.back().emission = Emission{glm::vec3(5.0f)};
    const Scene scene = build(std::move(d));
    const LightTable& lights = scene.data().lights;
    ASSERT_EQ(lights.count, disk ? 1 : 20);
    if (!disk) continue;
    float area = 0.0f;
    for (const glm::uvec3 t : fan.triangles) {
      const glm::vec3 p = fan.positions[t.x];
      area += 0.5f * glm::length(glm::cross(fan.positions[t.y] - p, fan.positions[t.z] - p));
    }
    EXPECT_NEAR(lights.rows[3], area, 1e-5f * area);
    EXPECT_EQ(lights.rows[15], float(int(LightKind::Disk)));
  }
}

TEST(Emission, LeavesOneSideOnly) {
  SceneDescription d = lit_floor();
  add_rectangle(d, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, lamp(d), Emission{glm::vec3(5.0f)});  // up
  for (const int depth : {1, 3}) {
    EXPECT_EQ(channel_means(build(d), {.depth = depth, .seeds = 2}).mean, 0.0);
  }
  d.shapes.back().emission->two_sided = true;
  expect_mean(channel_means(build(d), {}), 5.0 * double(albedo) * rectangle_form_factor(1, 1, 1),
              1e-3);
}

TEST(Emission, IsSeenDirectlyFromItsSide) {
  for (const bool two_sided : {false, true}) {
    SceneDescription d;
    d.name = "lamp";
    add_rectangle(d, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, lamp(d),
                  Emission{glm::vec3(5.0f, 2.0f, 0.0f), two_sided});
    look_closely(d, {0.1f, 0, 3}, {0.2f, 0.1f, 0});
    const Scene front = build(d);
    EXPECT_FLOAT_EQ(float(channel_means(front, {.seeds = 1}, 0).mean), 5.0f);
    EXPECT_FLOAT_EQ(float(channel_means(front, {.seeds = 1}, 1).mean), 2.0f);
    look_closely(d, {0.1f, 0, -3}, {0.2f, 0.1f, 0});
    EXPECT_FLOAT_EQ(float(channel_means(build(d), {.seeds = 1}, 0).mean), two_sided ? 5.0f : 0.0f);
  }
  for (const bool inwards : {false, true}) {
    SceneDescription d;
    d.name = "bulb";
    add_sphere(d, {0, 0, 0}, 1, lamp(d), Emission{glm::vec3(5.0f)});
    std::get<Sphere>(d.shapes[0].geometry).emits_inwards = inwards;
    look_closely(d, {0, 0, 3}, {0, 0, 0});
    EXPECT_FLOAT_EQ(float(channel_means(build(d), {.seeds = 1}).mean), inwards ? 0.0f : 5.0f);
    look_closely(d, {0, 0, 0.5f}, {0, 1, 0});
    EXPECT_FLOAT_EQ(float(channel_means(build(d), {.seeds = 1}).mean), inwards ? 5.0f : 0.0f);
  }
}

// Depth -----------------------------------------------------------------------------------------

// A black lamp of radius r in the middle of a hollow sphere of radius R and albedo a. With
// f = (r / R)^2 every point of the wall receives E = pi L f from the lamp, and sees the wall itself
// with a share 1 - f of its cosine-weighted hemisphere: order i adds a^i L f (1 - f)^(i - 1).
TEST(Depth, EachInteractionIsLitOnceMore) {
  for (const double r : {0.5, 1.2}) {
    SceneDescription d;
    d.name = "integrating sphere";
    add_sphere(d, {0, 0, 0}, 2, add_material(d, DiffuseMaterial{glm::vec3(0.8f)}));
    add_sphere(d, {0, 0, 0}, float(r), lamp(d), Emission{glm::vec3(3.0f)});
    look_closely(d, {-1.5f, 0.5f, 0}, {-1.6f, -0.5f, 1.2f});
    const Scene scene = build(std::move(d));
    const double f = r * r / 4.0;
    double expected = 0.0, term = 0.8 * 3.0 * f;
    for (int depth = 1; depth <= 6; ++depth) {
      expected += term;
      term *= 0.8 * (1.0 - f);
      if (depth == 5) continue;
      expect_mean(channel_means(scene, {.spp = 64, .depth = depth}), expected, 2e-3);
    }
  }
}

// Multiple importance sampling ------------------------------------------------------------------

// Radiance that `bsdf` sends to wo from directions within a cone about `axis`, where the radiance
// is 1; all in the local frame. A midpoint rule with steps that are finer towards the axis.
template <class Bsdf>
std::array<double, 3> quadrature(const Bsdf& bsdf, glm::dvec3 axis, glm::dvec3 wo, double cos_max,
                                 int n = 500) {
  const glm::dvec3 helper = std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 a = glm::normalize(glm::cross(helper, axis)), b = glm::cross(axis, a);
  std::array<double, 3> sum{};
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) / n, below = (1.0 - cos_max) * t * t * t * t;  // 1 - cos
    const double z = 1.0 - below, r = std::sqrt(below * (2.0 - below));
    for (int j = 0; j < n; ++j) {
      const double phi = 2.0 * pi_double * (j + 0.5) / n;
      const glm::dvec3 w = r * std::cos(phi) * a + r * std::sin(phi) * b + z * axis;
      if (w.z <= 0.0) continue;
      const auto f = eval(bsdf, Vec3<float>(float(wo.x), float(wo.y), float(wo.z)),
                          Vec3<float>(float(w.x), float(w.y), float(w.z)));
      const double weight = t * t * t;
      sum[0] += weight * double(f.f_cos.x);
      sum[1] += weight * double(f.f_cos.y);
      sum[2] += weight * double(f.f_cos.z);
    }
  }
  for (double& s : sum) s *= 4.0 * (1.0 - cos_max) * 2.0 * pi_double / (double(n) * n);
  return sum;
}

// The floor's material by itself, as the kernels see it.
template <class F>
auto with_bsdf(const Scene& scene, const Material& material, F f) {
  if (std::holds_alternative<ConductorMaterial>(material.model)) {
    return f(load_conductor(scene.data().materials, std::int32_t(0)));
  }
  return f(load_coated(scene.data().materials, std::int32_t(0)));
}

// World axes of the floor to a local frame with z up. All materials here are isotropic.
glm::dvec3 local(glm::dvec3 v) { return glm::normalize(glm::dvec3(v.z, v.x, v.y)); }

std::vector<Material> glossy_materials() {
  std::vector<Material> list;
  for (const float alpha : {0.05f, 0.2f, 0.5f, 1.0f}) {
    ConductorMaterial metal;
    metal.alpha = glm::vec2(alpha);
    list.emplace_back(metal);
  }
  for (const bool layered : {true, false}) {
    list.emplace_back(CoatedMaterial{glm::vec3(0.5f, 0.2f, 0.0f), glm::vec3(layered ? 1.0f : 0.3f),
                                     0.1f, 1.5f, layered});
  }
  return list;
}

// The lamp stands where the floor mirrors the camera, so that both techniques matter.
TEST(Mis, GlossySurfacesUnderSphereLights) {
  const glm::vec3 eye(-3, 3, 0), centre(2, 2.2f, 0.1f);
  for (const Material& material : glossy_materials()) {
    for (const float radius : {0.02f, 0.3f, 1.5f}) {
      SceneDescription d = lit_floor(material, eye);
      add_sphere(d, centre, radius, lamp(d), Emission{glm::vec3(5.0f)});
      const Scene scene = build(std::move(d));
      const double distance = double(glm::length(centre));
      const double sin2 = double(radius * radius) / (distance * distance);
      const auto expected = with_bsdf(scene, material, [&](const auto& bsdf) {
        return quadrature(bsdf, local(centre), local(eye), std::sqrt(1.0 - sin2));
      });
      for (int c = 0; c < 3; ++c) {
        SCOPED_TRACE("material " + std::to_string(material.model.index()) + " radius " +
                     std::to_string(radius) + " channel " + std::to_string(c));
        expect_mean(channel_means(scene, {.spp = 64, .seeds = 24}, c), 5.0 * expected[size_t(c)],
                    4e-3);
      }
    }
  }
}

TEST(Mis, GlossySurfacesUnderASky) {
  const glm::vec3 eye(-3, 2, 0);
  for (const Material& material : glossy_materials()) {
    SceneDescription d = lit_floor(material, eye);
    d.environment = glm::vec3(5.0f);
    const Scene scene = build(std::move(d));
    // About the mirror direction, where the integrand has its peak.
    const auto expected = with_bsdf(scene, material, [&](const auto& bsdf) {
      return quadrature(bsdf, local(glm::vec3(3, 2, 0)), local(eye), -1.0, 1000);
    });
    for (int c = 0; c < 3; ++c) {
      SCOPED_TRACE("material " + std::to_string(material.model.index()));
      expect_mean(channel_means(scene, {.spp = 64, .seeds = 24}, c), 5.0 * expected[size_t(c)],
                  3e-3);
    }
  }
}

// Several lights of all kinds at once: the choice of light belongs to both densities.
TEST(Mis, GlossySurfacesUnderSeveralLights) {
  const glm::vec3 eye(-3, 3, 0), lamp_centre(2, 2.2f, 0.1f), other(0.5f, 2.0f, 1.5f);
  ConductorMaterial metal;
  metal.alpha = glm::vec2(0.3f);
  SceneDescription d = lit_floor(metal, eye);
  add_sphere(d, lamp_centre, 0.5f, lamp(d), Emission{glm::vec3(5.0f)});
  add_sphere(d, other, 0.4f, lamp(d), Emission{glm::vec3(20.0f)});
  const Scene scene = build(std::move(d));
  const auto part = [&](glm::vec3 centre, double radius) {
    const double distance = double(glm::length(centre));
    const double cos_max = std::sqrt(1.0 - radius * radius / (distance * distance));
    return quadrature(load_conductor(scene.data().materials, std::int32_t(0)), local(centre),
                      local(eye), cos_max)[0];
  };
  const double expected = 5.0 * part(lamp_centre, 0.5) + 20.0 * part(other, 0.4);
  for (const int depth : {1, 2}) {
    const Plan plan{.spp = 128, .depth = depth};
    expect_mean(channel_means(scene, plan), expected, 3e-3);
  }
}

TEST(Mis, GlossySurfacesUnderASkyAndALamp) {
  const glm::vec3 eye(-3, 3, 0), centre(2, 2.2f, 0.1f);
  ConductorMaterial metal;
  metal.alpha = glm::vec2(0.4f);
  SceneDescription d = lit_floor(metal, eye, 3);  // so that both lights are chosen often
  d.environment = glm::vec3(5.0f);
  add_sphere(d, centre, 1.0f, lamp(d), Emission{glm::vec3(60.0f)});
  const Scene scene = build(std::move(d));
  const auto part = [&](glm::vec3 axis, double cos_max) {
    return quadrature(load_conductor(scene.data().materials, std::int32_t(0)), local(axis),
                      local(eye), cos_max)[0];
  };
  const double distance = double(glm::length(centre));
  const double expected = 5.0 * part({3, 3, 0}, -1.0) +
                          (60.0 - 5.0) * part(centre, std::sqrt(1.0 - 1.0 / (distance * distance)));
  expect_mean(channel_means(scene, {.spp = 256, .seeds = 64}), expected, 2e-3);
}

// A closed room of metal and light: two sizes of tiling of the same emitting wall agree.
TEST(Mis, DoesNotDependOnHowALightIsCutUp) {
  ConductorMaterial metal;
  metal.alpha = glm::vec2(0.25f);
  std::vector<Moments> means;
  for (const bool split : {false, true}) {
    SceneDescription d = closed_box(0.5f, 0.0f, split);
    d.materials[0] = metal;
    means.push_back(channel_means(build(std::move(d)), {.spp = 16, .depth = 3, .seeds = 64}));
  }
  EXPECT_GT(equal_means(means[0], means[1], 1e-4), level) << means[0].mean << ' ' << means[1].mean;
}

// Samples that are not finite ---------------------------------------------------------------------

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

void expect_counted(SceneDescription d, const char* what) {
  const Scene scene = build(resized(std::move(d), 20, 20));
  for (const int width : {1, 4, 16}) {
    RenderSettings s;
    s.spp = 2;
    s.depth = 2;
    s.width = width;
    const RenderResult r = render(scene, parse_sampler("random"), s);
    EXPECT_GT(r.stats.nonfinite, 0u) << what;
    EXPECT_LE(r.stats.nonfinite, r.stats.paths) << what;
    ASSERT_FALSE(r.stats.bad_samples.empty()) << what;
    EXPECT_LE(r.stats.bad_samples.size(), r.stats.nonfinite);
    for (const BadSample& bad : r.stats.bad_samples) {
      EXPECT_TRUE(bad.x >= 0 && bad.x < 20 && bad.y >= 0 && bad.y < 20 && bad.sample < 2u) << what;
    }
    for (const float x : r.image.pixels) ASSERT_TRUE(std::isfinite(x)) << what;
  }
}

TEST(NonFinite, LightIsCountedWhereItIsSeenAndWhereItShines) {
  for (const float value : {infinite, not_a_number}) {
    for (const bool all_channels : {true, false}) {
      const glm::vec3 radiance(1.0f, value, all_channels ? value : 1.0f);
      const char* what = std::isnan(value) ? "NaN" : "infinity";
      SceneDescription seen;
      seen.name = "seen lamp";
      add_rectangle(seen, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, lamp(seen), Emission{radiance});
      look_closely(seen, {0, 0, 3}, {0, 0, 0});
      expect_counted(seen, what);

      SceneDescription shining = lit_floor();
      add_lamp(shining, 1, 1, 1, {radiance});
      expect_counted(shining, what);

      SceneDescription sky = lit_floor();
      sky.environment = radiance;
      expect_counted(sky, what);
      look_closely(sky, {0, 1, 0}, {0, 2, 0.1f});
      expect_counted(sky, what);
    }
  }
}

TEST(NonFinite, SamplesAreLocatedAndLeftOut) {
  // The lamp covers the middle of an image that is white elsewhere.
  SceneDescription d;
  d.name = "bad lamp";
  add_rectangle(d, {0, 0, 0}, {0.25f, 0, 0}, {0, 0.25f, 0}, lamp(d), Emission{glm::vec3(infinite)});
  d.environment = glm::vec3(1.0f);
  d.camera.camera_to_world = builtin::look_at({0, 0, 1}, {0, 0, 0});
  const Scene scene = build(resized(std::move(d), 40, 40));
  RenderSettings s;
  s.spp = 3;
  const RenderResult r = render(scene, parse_sampler("owen"), s);
  EXPECT_EQ(r.stats.nonfinite, 10u * 10u * 3u);
  for (const BadSample& bad : r.stats.bad_samples) {
    EXPECT_TRUE(bad.x >= 15 && bad.x < 25 && bad.y >= 15 && bad.y < 25);
  }
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const bool bad = x >= 15 && x < 25 && y >= 15 && y < 25;
      ASSERT_EQ(r.image.at(x, y)[0], bad ? 0.0f : 1.0f) << x << ' ' << y;
    }
  }
}

TEST(NonFinite, OrdinaryScenesHaveNone) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Scene scene = build(resized(builtin.make(), 64, 48));
    RenderSettings s;
    s.spp = 4;
    s.depth = 6;
    const RenderResult r = render(scene, parse_sampler("random"), s);
    EXPECT_EQ(r.stats.nonfinite, 0u) << builtin.name;
    for (const float x : r.image.pixels) ASSERT_TRUE(std::isfinite(x) && x >= 0.0f) << builtin.name;
  }
}

}  // namespace
}  // namespace lockstep
