// Reflectances, roughnesses and indices of refraction at their ends, and textures that hold what is
// no colour.
#include "experiments/stress/parts.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace lockstep::stress {
namespace {

using builtin::add_material;
using builtin::add_rectangle;

// Furnaces --------------------------------------------------------------------------------------

StressCase furnace(const char* name, float albedo, bool sphere, bool roulette) {
  const auto make = [=](const std::string&) {
    SceneDescription scene = sphere ? closed_sphere(1.0f, albedo) : closed_box(1.0f, albedo);
    scene.film.width = scene.film.height = 4;
    return scene;
  };
  return {name, "material",
          fmt::format("closed {} of albedo {:.8g} to depth 1000{}", sphere ? "sphere" : "box",
                      double(albedo), roulette ? ", with roulette" : ""),
          "1 + a + a^2 + ... to depth 1000: 1 / (1 - a) but for the rest",
          StressScene{.make = make,
                      .expected = partial_sum(1.0, double(albedo), 1000),
                      .rounding = 5e-4,
                      .spp = roulette ? 256 : 4,
                      .depth = 1000,
                      .roulette_depth = roulette ? 5 : 1 << 20}};
}

// Rough metal -----------------------------------------------------------------------------------

ConductorMaterial white_metal(float alpha) {
  ConductorMaterial metal;
  metal.eta = glm::vec3(0.0f);  // without a real part of the index all is reflected
  metal.k = glm::vec3(1.0f);
  metal.alpha = glm::vec2(alpha);
  return metal;
}

// Share of light that GGX facets of reflectance 1 send on after one reflection (Heitz 2014, eq. 99
// for the masking), by the midpoint rule over slopes: with r the slope over alpha and w^2 = 1 / (1
// + r^2), D cos dm is w dw dphi / pi.
double ggx_albedo(double alpha, double cos_o) {
  constexpr int steps = 700;
  const double sin_o = std::sqrt(1.0 - cos_o * cos_o);
  const auto lambda = [&](double cosine) {
    const double tan2 = (1.0 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan2) - 1.0);
  };
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double w = (i + 0.5) / steps, slope = alpha * std::sqrt(1.0 - w * w) / w;
    for (int j = 0; j < steps; ++j) {
      const double phi = 2.0 * pi_double * (j + 0.5) / steps;
      const double cos_m = 1.0 / std::sqrt(1.0 + slope * slope);
      const double facing = cos_m * (slope * std::cos(phi) * sin_o + cos_o);
      const double cos_i = 2.0 * facing * cos_m - cos_o;
      if (facing <= 0.0 || cos_i <= 0.0) continue;
      sum +=
          2.0 * w * facing / (cos_o * cos_m) / (1.0 + lambda(cos_o) + lambda(std::min(cos_i, 1.0)));
    }
  }
  return sum / double(steps) / double(steps);
}

// A large square in y = 0 of this material, in a sky of radiance 1, seen `degrees` off its normal.
SceneDescription square_in_sky(const Material& material, double degrees) {
  SceneDescription scene;
  scene.name = "square";
  add_rectangle(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, add_material(scene, material));
  scene.environment = glm::vec3(1.0f);
  const double a = degrees * pi_double / 180.0;
  look_straight(scene, {float(std::sin(a)), float(std::cos(a)), 0}, {0, 0, 0}, 1e-3f);
  return scene;
}

StressCase grazing_metal(float alpha) {
  const double degrees = 89.0, cos_o = std::cos(degrees * pi_double / 180.0);
  const bool mirror = alpha < 1e-3f;
  return {
      fmt::format("grazing-metal-{:.0e}", alpha), "material",
      fmt::format("metal of roughness {:.0e} at 89 degrees", alpha),
      mirror ? "a mirror of reflectance 1 shows the sky"
             : "quadrature over the facets' slopes in double precision",
      StressScene{
          .make = [alpha](const std::string&) { return square_in_sky(white_metal(alpha), 89.0); },
          .expected = mirror ? 1.0 : ggx_albedo(double(alpha), cos_o),
          .rounding = 2e-3}};
}

StressCase coated_mirror() {
  PrincipledMaterial m;
  m.metallic = 1.0f;
  m.alpha = 0.0f;
  m.coat = 1.0f;
  m.coat_alpha = 0.0f;
  return {
      "coat-on-mirror", "material", "a smooth clear coat on a white mirror, at 80 degrees",
      "what the coat does not reflect the mirror does, but for 2e-3: of a lobe this wide the coat "
      "takes its share at the more grazing of both directions",
      StressScene{.make = [m](const std::string&) { return square_in_sky(m, 80.0); },
                  .rounding = 4e-3}};
}

// Glass -----------------------------------------------------------------------------------------

constexpr float kWall = 3.0f;

// A black wall in z = `z` that shines towards +z.
void add_wall(SceneDescription& scene, float z) {
  add_rectangle(scene, {0, 0, z}, {50, 0, 0}, {0, 50, 0}, black(scene), Emission{glm::vec3(kWall)});
}

// A slab of glass of thickness 1 before a wall, seen along its normal.
SceneDescription slab(const DielectricMaterial& glass) {
  SceneDescription scene;
  scene.name = "slab";
  const int m = add_material(scene, glass);
  add_rectangle(scene, {0, 0, 0}, {50, 0, 0}, {0, 50, 0}, m);
  add_rectangle(scene, {0, 0, -1}, {0, 50, 0}, {50, 0, 0}, m);
  add_wall(scene, -3.0f);
  look_straight(scene, {0, 0, 1}, {0, 0, 0}, 1.0f);
  return scene;
}

StressCase slab_of(const char* name, float eta, int depth) {
  DielectricMaterial glass;
  glass.eta = eta;
  const double r = std::pow((double(eta) - 1.0) / (double(eta) + 1.0), 2.0);
  return {name, "material", fmt::format("a slab of index {:.8g}", double(eta)),
          "all orders of reflection inside: (1 - R) / (1 + R) of the light passes",
          StressScene{.make = [glass](const std::string&) { return slab(glass); },
                      .expected = double(kWall) * (1.0 - r) / (1.0 + r),
                      .spp = eta > 10.0f ? 512 : 64,
                      .depth = depth}};
}

// From within glass at 60 degrees its boundary shows the floor below, and nothing of the sky.
SceneDescription totally_reflecting() {
  SceneDescription scene;
  scene.name = "total reflection";
  add_rectangle(scene, {0, 0, 0}, {50, 0, 0}, {0, 50, 0},
                add_material(scene, DielectricMaterial{}));
  add_wall(scene, -3.0f);
  scene.environment = glm::vec3(7.0f);
  look_straight(scene, {-std::sqrt(3.0f), 0, -1}, {0, 0, 0}, 0.5f);
  return scene;
}

std::vector<StressCase> glass() {
  DielectricMaterial ink;
  ink.absorption = glm::vec3(1e30f);
  return {
      slab_of("index-1", 1.0f, 8),
      slab_of("index-1.000001", 1.000001f, 8),
      slab_of("index-100", 100.0f, 400),
      {"total-reflection", "material", "glass from within, beyond the critical angle",
       "the boundary is a mirror: it shows the wall",
       StressScene{.make = [](const std::string&) { return totally_reflecting(); },
                   .expected = double(kWall),
                   .depth = 4}},
      {"absorption-1e30", "material", "glass that absorbs 1e30 per unit of length",
       "nothing passes: exactly 0",
       StressScene{.make = [ink](const std::string&) { return slab(ink); },
                   .expected = 0.0,
                   .rounding = 0.0,
                   .depth = 8}},
  };
}

// Textures --------------------------------------------------------------------------------------

constexpr float kStored[] = {std::numeric_limits<float>::quiet_NaN(),
                             std::numeric_limits<float>::infinity(), -2.0f, 0.5f};
constexpr double kLargestHalf = 65504.0;

// Four texels of these values; returns the texture's index.
int odd_texture(SceneDescription& scene, const std::string& folder) {
  ImageTexture t;
  t.file = write_exr(folder, "odd-texels", 2, 2,
                     [](int x, int y) { return glm::vec3(kStored[2 * y + x]); });
  t.filter = TextureFilter::Nearest;
  scene.textures.push_back(t);
  return int(scene.textures.size()) - 1;
}

// Filled by a square of half size 1 with texture coordinates, from above.
SceneDescription textured_square(const Material& material, const SceneDescription& with) {
  SceneDescription scene = with;
  scene.name = "odd texture";
  add_rectangle(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, add_material(scene, material));
  set_uvs(scene.shapes.back());
  scene.environment = glm::vec3(1.0f);
  look_straight(scene, {0, 1, 0}, {0, 0, 0}, 2.0f);
  scene.camera.camera_to_world = glm::mat4(glm::vec4(1, 0, 0, 0), glm::vec4(0, 0, -1, 0),
                                           glm::vec4(0, -1, 0, 0), glm::vec4(0, 1, 0, 1));
  return scene;
}

double share_outside_unit(const Image& image) {
  int outside = 0;
  for (const float x : image.pixels) outside += !(x >= 0.0f && x <= 1.0001f);
  return double(outside) / double(image.pixels.size());
}

std::vector<StressCase> textures() {
  const auto albedo = [](const std::string& folder) {
    SceneDescription scene;
    const int t = odd_texture(scene, folder);
    return textured_square(DiffuseMaterial{ColorInput(glm::vec3(1.0f), t)}, scene);
  };
  const auto roughness = [](const std::string& folder) {
    SceneDescription scene;
    ConductorMaterial metal = white_metal(1.0f);
    metal.alpha_scale.texture = odd_texture(scene, folder);
    return textured_square(metal, scene);
  };
  const auto opacity = [](const std::string& folder) {
    SceneDescription scene;
    Material m = DiffuseMaterial{glm::vec3(0.25f)};
    m.opacity.texture = odd_texture(scene, folder);
    return textured_square(m, scene);
  };
  return {
      {"texture-albedo-odd", "material", "a reflectance of NaN, infinity, -2 and 0.5",
       "NaN and negative count as 0, infinity as the largest half, 65504",
       StressScene{.make = albedo, .expected = (kLargestHalf + 0.5) / 4.0, .rounding = 2e-4}},
      {"texture-roughness-odd", "material", "a roughness of NaN, infinity, -2 and 0.5",
       "no light is gained: no pixel lies outside [0, 1]",
       StressScene{.make = roughness,
                   .expected = 0.0,
                   .rounding = 0.0,
                   .depth = 2,
                   .measure = share_outside_unit}},
      {"texture-opacity-odd", "material", "an opacity of NaN, infinity, -2 and 0.5",
       "holes where NaN or negative, wholly there where infinite: (1 + .25 + 1 + .625) / 4",
       StressScene{.make = opacity,
                   .expected = (1.0 + 0.25 + 1.0 + 0.625) / 4.0,
                   .rounding = 1e-3,
                   .spp = 64,
                   .depth = 2}},
  };
}

}  // namespace

std::vector<StressCase> material_cases() {
  std::vector<StressCase> cases{
      furnace("furnace-box-0", 0.0f, false, false),
      furnace("furnace-box-1", 1.0f, false, false),
      furnace("furnace-box-almost-1", 1.0f - 1e-7f, false, false),
      furnace("furnace-sphere-1", 1.0f, true, false),
      furnace("furnace-box-0.9-roulette", 0.9f, false, true),
  };
  for (const float alpha : {1e-4f, 1e-3f, 0.1f, 1.0f}) cases.push_back(grazing_metal(alpha));
  cases.push_back(coated_mirror());
  for (auto&& group : {glass(), textures()}) {
    cases.insert(cases.end(), group.begin(), group.end());
  }
  return cases;
}

}  // namespace lockstep::stress
