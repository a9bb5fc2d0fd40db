// Brightness, size, number and distance of lights.
#include "experiments/stress/parts.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace lockstep::stress {
namespace {

using builtin::add_rectangle;
using builtin::add_sphere;

constexpr double kAlbedo = double(floor_albedo);

using Make = std::function<SceneDescription(const std::string&)>;

// Brightness ------------------------------------------------------------------------------------

StressCase lamp_of(float radiance) {
  return {fmt::format("radiance-{:.0e}", radiance), "light",
          fmt::format("a lamp of radiance {:.0e}", radiance), kFormFactor,
          StressScene{.make =
                          [radiance](const std::string&) {
                            SceneDescription scene = lit_floor();
                            add_lamp(scene, 0.5f, 0.5f, 1.0f, glm::vec3(radiance));
                            return scene;
                          },
                      .expected = double(radiance) * kAlbedo * rectangle_form_factor(0.5, 0.5, 1.0),
                      .rounding = 1e-3}};
}

constexpr float kMixture[] = {1e-30f, 1.0f, 1e30f};

glm::vec3 primary(int channel) {
  glm::vec3 c(0.0f);
  c[channel] = 1.0f;
  return c;
}

// Three lamps side by side over the floor, or each of them in a channel of its own.
SceneDescription lamps_of_all_kinds(bool coloured) {
  SceneDescription scene = lit_floor();
  const int lamp = black(scene);
  for (int i = 0; i < 3; ++i) {
    add_rectangle(scene, {float(i - 1), 1, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}, lamp,
                  Emission{coloured ? kMixture[i] * primary(i) : glm::vec3(kMixture[i])});
  }
  look_straight(scene, {1, 2, 3}, {0, 0, 0}, 1e-3f);  // past the lamps
  return scene;
}

// The lamps themselves, from below.
SceneDescription lamps_seen() {
  SceneDescription scene = lamps_of_all_kinds(false);
  look_straight(scene, {0, 0.5f, 0.001f}, {0, 1, 0}, 1.0f, 48, 16);
  scene.camera.camera_to_world = glm::mat4(glm::vec4(1, 0, 0, 0), glm::vec4(0, 0, -1, 0),
                                           glm::vec4(0, 1, 0, 0), glm::vec4(0, 0.5f, 0, 1));
  return scene;
}

// The mean of the channels, each as a multiple of what its lamp should give.
double mean_of_channels(const Image& image) {
  const double middle = rectangle_form_factor(0.5, 0.5, 1.0);
  const double beside = 0.5 * (rectangle_form_factor(1.5, 0.5, 1.0) - middle);
  double sum = 0.0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double factor = i % 3 == 1 ? middle : beside;
    sum += double(image.pixels[i]) / (double(kMixture[i % 3]) * kAlbedo * factor);
  }
  return sum / double(image.pixels.size());
}

// The mean of the three thirds, each as a multiple of its lamp's radiance.
double mean_of_thirds(const Image& image) {
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      sum += double(image.at(x, y)[0]) / double(kMixture[x / (image.width / 3)]);
    }
  }
  return sum / double(image.width * image.height);
}

std::vector<StressCase> brightness() {
  // The middle lamp lies over the point, the bright one beside it: half of what both lamps beside
  // each other would give. A quarter rectangle with a corner over the point has form factor F / 4.
  const double wide = rectangle_form_factor(1.5, 0.5, 1.0),
               narrow = rectangle_form_factor(0.5, 0.5, 1.0);
  const auto overflowing = [](const std::string&) {
    SceneDescription scene = closed_box(3e38f, 1.0f);
    return scene;
  };
  return {
      {"radiance-mixture-lit", "light", "lamps of radiance 1e-30, 1 and 1e30 over a floor",
       "form factors of the lamps; the brightest decides",
       StressScene{.make = [](const std::string&) { return lamps_of_all_kinds(false); },
                   .expected = 1e30 * kAlbedo * 0.5 * (wide - narrow),
                   .rounding = 1e-3}},
      {"radiance-mixture-coloured", "light",
       "red of 1e-30, green of 1 and blue of 1e30 over a floor",
       "form factors of the lamps by channel; depth 2, so that chance finds the dim ones too",
       StressScene{.make = [](const std::string&) { return lamps_of_all_kinds(true); },
                   .rounding = 1e-3,
                   .spp = 64,
                   .depth = 2,
                   .measure = mean_of_channels}},
      {"radiance-mixture-seen", "light", "lamps of radiance 1e-30, 1 and 1e30 in one image",
       "each third of the image shows its lamp's radiance",
       StressScene{.make = [](const std::string&) { return lamps_seen(); },
                   .measure = mean_of_thirds}},
      {"radiance-overflow", "light", "a white furnace of radiance 3e38",
       "the second bounce exceeds float: such samples are counted, and none reaches the image",
       StressScene{
           .make = overflowing, .expected = 3e38, .rounding = 1.0, .depth = 3, .overflows = true}},
  };
}

// Sun and sky -----------------------------------------------------------------------------------

constexpr double kSunAngle = 0.25 * pi_double / 180.0;  // half of what it is seen under

// A sun of radiance 1e9 at 60 degrees above the horizon, in a sky of radiance 1.
SceneDescription sun_and_sky() {
  SceneDescription scene = lit_floor();
  const double distance = 1e4, height = std::sqrt(0.75);
  add_sphere(scene, glm::vec3(float(0.5 * distance), float(height * distance), 0.0f),
             float(std::sin(kSunAngle) * distance), black(scene), Emission{glm::vec3(1e9f)});
  scene.environment = glm::vec3(1.0f);
  return scene;
}

std::vector<StressCase> sun() {
  const double from_sun = 1e9 * std::sin(kSunAngle) * std::sin(kSunAngle) * std::sqrt(0.75);
  const auto shaded = [](const std::string&) {
    SceneDescription scene = sun_and_sky();
    add_rectangle(scene, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, black(scene));
    return scene;
  };
  return {
      {"sun-and-sky", "light", "a sun of half a degree with 1e9 in a sky of 1",
       "a (L_sky + L_sun sin^2(angle) cos(zenith))",
       StressScene{.make = [](const std::string&) { return sun_and_sky(); },
                   .expected = kAlbedo * (1.0 + from_sun),
                   .rounding = 1e-3}},
      {"sky-in-the-suns-shadow", "light", "a sky of 1 beside a hidden sun of 1e9",
       "the sky but for the part that the roof hides; depth 2, so that chance finds it too",
       StressScene{.make = shaded,
                   .expected = kAlbedo * (1.0 - rectangle_form_factor(1.0, 1.0, 1.0)),
                   .rounding = 1e-3,
                   .spp = 256,
                   .depth = 2}},
  };
}

// Small and near --------------------------------------------------------------------------------

constexpr glm::vec3 kBeside{-3.0f, 0.7f, 3.0f};

// E = pi L (R / D)^2 cos while the whole sphere is above the horizon.
StressCase sphere_at(const char* name, const char* extreme, glm::vec3 eye, float x, float y,
                     float radius, float radiance) {
  const auto make = [=](const std::string&) {
    SceneDescription scene = lit_floor();
    look_straight(scene, eye, {0, 0, 0}, 1e-5f);
    add_sphere(scene, {x, y, 0}, radius, black(scene), Emission{glm::vec3(radiance)});
    return scene;
  };
  const double d2 = double(x) * double(x) + double(y) * double(y);
  return {name, "light", extreme, "irradiance of a sphere wholly above the horizon",
          StressScene{.make = make,
                      .expected = kAlbedo * double(radiance) * double(radius) * double(radius) /
                                  d2 * double(y) / std::sqrt(d2),
                      .rounding = 5e-3,
                      .spp = 64}};
}

// From a point to a perpendicular rectangle of this height and half width whose foot is at
// distance c: twice Howell's B-4.
double perpendicular_form_factor(double height, double half_width, double c) {
  const double x = height / half_width, y = c / half_width, r = std::sqrt(x * x + y * y);
  return (std::atan(1.0 / y) - y / r * std::atan(1.0 / r)) / pi_double;
}

// A lamp that stands on the floor, `c` beside the point in view.
StressCase standing_lamp(float c) {
  const auto make = [c](const std::string&) {
    SceneDescription scene = lit_floor();
    add_rectangle(scene, {-c, 0.5f, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}, black(scene),
                  Emission{glm::vec3(5.0f)});
    look_straight(scene, {3, 2, 1}, {0, 0, 0}, 1e-3f * c);
    return scene;
  };
  return {
      fmt::format("touching-lamp-{:.0e}", c), "light",
      fmt::format("a lamp that stands on the floor, {:.0e} beside it", c),
      "form factor of a perpendicular rectangle, Howell's B-4; half of the floor's sky up close",
      StressScene{.make = make,
                  .expected = 5.0 * kAlbedo * perpendicular_form_factor(1.0, 0.5, double(c)),
                  .rounding = 2e-2,
                  .spp = 64,
                  .depth = 2}};
}

std::vector<StressCase> small_and_near() {
  const auto near_point = [](const std::string&) {
    SceneDescription scene = lit_floor(1.0f);
    scene.lights = {PointLight{{0, 1e-3f, 0}, glm::vec3(1e-6f)}};
    look_straight(scene, {3, 2, 1}, {0, 0, 0}, 1e-7f);
    return scene;
  };
  const auto grazing_sun = [](const std::string&) {
    SceneDescription scene = lit_floor();
    const float a = 0.01f * float(pi_double) / 180.0f;
    scene.lights = {DistantLight{{-std::cos(a), -std::sin(a), 0.0f}, glm::vec3(1e4f)}};
    return scene;
  };
  return {
      sphere_at("sphere-light-1e-06", "a sphere light of radius 1e-6 and radiance 1e12", kBeside,
                0.5f, 1.0f, 1e-6f, 1e12f),
      sphere_at("sphere-light-grazing",
                "a sphere light that just clears the horizon, seen at 88 degrees", kBeside, 3.0f,
                0.1f, 0.0999f, 1e3f),
      sphere_at("sphere-touches-floor", "a sphere light on the floor, 0.02 beside where it touches",
                glm::vec3(0, 0.03f, 3), 0.02f, 1.0f, 1.0f, 5.0f),
      standing_lamp(1e-2f),
      standing_lamp(1e-4f),
      {"point-light-near", "light", "a point light 1e-3 above the floor", "a / pi I / d^2",
       StressScene{
           .make = near_point, .expected = kAlbedo / pi_double, .rounding = 3e-3, .spp = 4}},
      {"sun-at-horizon", "light", "a sun a hundredth of a degree above the horizon",
       "a / pi E cos(zenith)",
       StressScene{.make = grazing_sun,
                   .expected = 1e4 * kAlbedo / pi_double * std::sin(0.01 * pi_double / 180.0),
                   .rounding = 1e-3,
                   .spp = 4}},
  };
}

// Many, none and maps ---------------------------------------------------------------------------

// One lamp in `columns` x `rows` pieces.
StressCase lamp_in_pieces(int columns, int rows) {
  const auto make = [=](const std::string&) {
    SceneDescription scene = lit_floor();
    TriangleMesh mesh;
    const auto at = [&](int i, int j) {
      return glm::vec3(float(i) / float(columns) - 0.5f, 1.0f, float(j) / float(rows) - 0.5f);
    };
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
    builtin::add_mesh(scene, mesh, black(scene));
    scene.shapes.back().emission = Emission{glm::vec3(5.0f)};
    return scene;
  };
  return {fmt::format("lights-{}", columns * rows), "light",
          fmt::format("a lamp in {} pieces, each a light", columns * rows),
          "form factor of the whole lamp, Howell's B-3",
          StressScene{.make = make,
                      .expected = 5.0 * kAlbedo * rectangle_form_factor(0.5, 0.5, 1.0),
                      .rounding = 1e-3,
                      .spp = 64}};
}

// A map of radiance 1 with one texel of 1e8. Bilinear interpolation spreads it as a product of
// hats; on a floor that faces the map's upper pole only the row matters.
constexpr int kMapWidth = 64, kMapHeight = 32, kHotRow = 9;
constexpr double kHot = 1e8;

double irradiance_of_hot_texel() {
  constexpr int steps = 4000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double v = (kHotRow - 0.5 + 2.0 * (i + 0.5) / steps) / kMapHeight;
    const double hat = 1.0 - std::abs(v * kMapHeight - 0.5 - kHotRow);
    sum += hat * std::sin(pi_double * v) * std::cos(pi_double * v);
  }
  const double row = sum * 2.0 / steps / kMapHeight;
  return (kHot - 1.0) * 2.0 * pi_double * pi_double * row / kMapWidth;
}

StressCase hot_texel() {
  const auto make = [](const std::string& folder) {
    SceneDescription scene = lit_floor();
    scene.environment.emplace();
    scene.environment->mapping = Environment::Mapping::LatLong;
    scene.environment->file = write_exr(
        folder, "hot-texel", kMapWidth, kMapHeight,
        [](int x, int y) { return glm::vec3(x == 20 && y == kHotRow ? float(kHot) : 1.0f); });
    return scene;
  };
  return {"environment-hot-texel", "light", "an environment map with one texel of 1e8",
          "quadrature of the interpolated texel, a (1 + E / pi)",
          StressScene{.make = make,
                      .expected = kAlbedo * (1.0 + irradiance_of_hot_texel() / pi_double),
                      .rounding = 2e-3,
                      .spp = 64}};
}

// Error messages that say what is not supported.
template <class F>
StressFinding refused(F f, const std::string& part_of_message) {
  StressFinding finding{.expected = 1.0};
  try {
    f();
  } catch (const std::exception& error) {
    finding.refusal = error.what();
    finding.got = finding.refusal.find(part_of_message) != std::string::npos ? 1.0 : 0.0;
  }
  return finding;
}

std::vector<StressCase> none() {
  return {
      {"no-light", "light", "a scene without any light", "nothing shines: exactly 0",
       StressScene{.make = [](const std::string&) { return lit_floor(); },
                   .expected = 0.0,
                   .rounding = 0.0,
                   .depth = 4}},
      {"no-shape-no-light", "light", "a scene of nothing at all", "refused in one line",
       StressComputation{.run =
                             [](const StressSetting&) {
                               return refused(
                                   [] {
                                     SceneDescription scene;
                                     scene.name = "empty";
                                     Scene(std::move(scene), embree_isa(choose_isa()));
                                   },
                                   "nothing to render");
                             }}},
  };
}

}  // namespace

std::vector<StressCase> light_cases() {
  std::vector<StressCase> cases{lamp_of(1e-30f), lamp_of(1e30f)};
  for (auto&& group : {brightness(), sun(), small_and_near(), none()}) {
    cases.insert(cases.end(), group.begin(), group.end());
  }
  cases.push_back(lamp_in_pieces(1, 1));
  cases.push_back(lamp_in_pieces(400, 250));
  cases.push_back(hot_texel());
  return cases;
}

}  // namespace lockstep::stress
