// Files of measured reflectance: what tables they become, how scenes with them render, and what is
// said of bad ones.
#include "core/measured_file.h"
#include "tests/t_measured.h"
#include "tests/t_pbrt.h"
#include "tests/t_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

namespace lockstep::test_measured {
namespace {

constexpr float inverse_pi = 0.318309886f;

// RGB of a cell of a finished table.
glm::vec3 cell(const MeasuredTable& table, int half, int difference, int azimuth) {
  const float* rgb =
      table.values.data() + measured_cells_at + 4 * MeasuredCells::index(half, difference, azimuth);
  return {rgb[0], rgb[1], rgb[2]};
}

bool above_horizon(int half, int difference, int azimuth) {
  const auto [wo, wi] = directions_of_cell(half, difference, azimuth);
  return wo.z > 0.0f && wi.z > 0.0f;
}

template <class F>
void for_some_cells(F f) {
  for (int h = 0; h < measured_halves; h += 11) {
    for (int d = 0; d < measured_differences; d += 11) {
      for (int p = 0; p < measured_azimuths; p += 7) {
        if (above_horizon(h, d, p)) f(h, d, p);
      }
    }
  }
}

// MERL's cells: the number in the file at (theta_half, theta_difference, phi_difference).
using MerlFunction = std::function<double(int channel, int h, int d, int p)>;

std::string merl_bytes(const MerlFunction& f) {
  const std::int32_t size[3] = {90, 90, 180};
  std::string bytes(sizeof(size) + sizeof(double) * 3 * 90 * 90 * 180, '\0');
  std::memcpy(bytes.data(), size, sizeof(size));
  char* at = bytes.data() + sizeof(size);
  for (int channel = 0; channel < 3; ++channel) {
    for (int i = 0; i < 90 * 90 * 180; ++i, at += sizeof(double)) {
      const double value = f(channel, i / (90 * 180), i / 180 % 90, i % 180);
      std::memcpy(at, &value, sizeof(value));
    }
  }
  return bytes;
}

// What makes reflectance 1 of MERL's numbers.
double merl_unit(int channel) {
  constexpr double factors[] = {1.0, 1.15, 1.66};
  return 1500.0 / factors[channel];
}

// Measurements over a grid of angles, with the same value at all of three wavelengths.
std::string brdf_text(double value) {
  std::string text = "# a surface\n\n3 # wavelengths\n400 550\n700\n";
  for (int i = 1; i < 9; ++i) {
    for (int o = 0; o < 9; ++o) {
      for (int p = 0; p < 5; ++p) {
        const std::string v = std::to_string(value);
        text += std::to_string(0.17 * i) + " 0 " + std::to_string(0.17 * o) + " " +
                std::to_string(-0.78 * p) + " " + v + " " + v + " " + v + "\n";
      }
    }
  }
  return text;
}

class MeasuredFiles : public Pbrt {
 protected:
  std::string error_in(const std::string& name, const std::string& bytes) const {
    write(name, bytes);
    return message_of([&] { read_measured_file(path(name)); });
  }
  void expect_text_error(const std::string& text, const std::string& part) const {
    expect_one_line_with(error_in("a.brdf", text), part);
  }
};

TEST_F(MeasuredFiles, TextOfEqualValuesGivesThemEverywhere) {
  const MeasuredFile file = read_measured_file(write("a.BRDF", brdf_text(0.2)));
  EXPECT_EQ(file.warning, "");
  for_some_cells(
      [&](int h, int d, int p) { expect_near(cell(file.table, h, d, p), glm::vec3(0.2f), 1e-6f); });
}

// Three measurements: a cell's value lies among the means, weighted by exp(-100 distance^2) in the
// coordinates of the format, at places in the cell. These are close together almost everywhere.
TEST_F(MeasuredFiles, TextIsInterpolatedInItsOwnCoordinates) {
  const double rows[3][4] = {{0.3, 0.0, 0.35, 3.0}, {0.4, 0.2, 0.3, -2.9}, {0.35, 0.0, 0.3, 2.6}};
  const double values[3] = {1.0, 5.0, 2.0};
  std::string text = "1\n555\n";
  for (int i = 0; i < 3; ++i) {
    for (const double x : rows[i]) text += std::to_string(x) + " ";
    text += std::to_string(values[i]) + "\n";
  }
  const MeasuredTable table = read_measured_file(write("a.brdf", text)).table;
  const auto position = [](double theta_i, double theta_o, double phi) {
    return glm::dvec3(std::sin(theta_i) * std::sin(theta_o), std::acos(std::cos(phi)) / M_PI,
                      std::cos(theta_i) * std::cos(theta_o));
  };
  const auto mean_at = [&](glm::dvec3 at) {
    double sum = 0.0, weights = 0.0;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 off = position(rows[i][0], rows[i][2], rows[i][1] - rows[i][3]) - at;
      const double weight = std::exp(-100.0 * glm::dot(off, off));
      sum += weight * values[i], weights += weight;
    }
    return sum / weights;
  };
  int cells = 0, narrow = 0;
  for_some_cells([&](int h, int d, int p) {
    double low = 1e9, high = 0.0;
    for (int i = 0; i < 125; ++i) {
      const auto [wo, wi] =
          directions_at(h + i / 25 * 0.25, d + i / 5 % 5 * 0.25, p + i % 5 * 0.25);
      const double mean = mean_at(position(
          std::acos(std::min(double(wi.z), 1.0)), std::acos(std::min(double(wo.z), 1.0)),
          std::atan2(double(wi.y), double(wi.x)) - std::atan2(double(wo.y), double(wo.x))));
      low = std::min(low, mean), high = std::max(high, mean);
    }
    ++cells;
    narrow += high < 1.1 * low;
    EXPECT_GE(cell(table, h, d, p).x, low * (1.0 - 1e-4)) << h << ' ' << d << ' ' << p;
    EXPECT_LE(cell(table, h, d, p).x, high * (1.0 + 1e-4)) << h << ' ' << d << ' ' << p;
  });
  EXPECT_GT(narrow, cells / 2);
}

// Longer waves are red.
TEST_F(MeasuredFiles, TextHasColors) {
  std::string text = "3\n450 550 650\n";
  for (const char* angles : {"0.1 0 0.1 0 ", "0.5 0 0.5 3 ", "1 0 1 2 "}) {
    text += std::string(angles) + "0.05 0.1 0.3\n";
  }
  const MeasuredTable table = read_measured_file(write("a.brdf", text)).table;
  const glm::vec3 rgb = cell(table, 3, 5, 2);
  EXPECT_GT(rgb.x, 2.0f * rgb.y);
  EXPECT_GT(rgb.y, 1.2f * rgb.z);
  EXPECT_GT(rgb.z, 0.02f);
}

TEST_F(MeasuredFiles, BadTextGivesOneLine) {
  const std::string head = "2\n400 700\n";
  const std::string row = "0.1 0 0.2 0 1 1\n";
  expect_text_error("", "a.brdf:0: the file ends where the number of wavelengths should follow");
  expect_text_error("0\n", "a.brdf:1: 0 is no number of wavelengths");
  expect_text_error("-3\n", "a.brdf:1: -3 is no number of wavelengths");
  expect_text_error("2.5\n", "a.brdf:1: 2.5 is no number of wavelengths");
  expect_text_error("1e9\n", "is no number of wavelengths from 1 to 1024");
  expect_text_error("2\n400\n", "a.brdf:2: the file ends where a wavelength should follow");
  expect_text_error("2\n-400 700\n", "a.brdf:2: the wavelength -400 nm is not above 0");
  expect_text_error("2\n700 400\n", "the wavelength 400 nm does not exceed the one before");
  expect_text_error("2\n400 nan\n", "a.brdf:2: expected a wavelength, found \"nan\"");
  expect_text_error(head + row + row, "at least 3 measurements are needed");
  expect_text_error(head + row + row + "0.1 0 0.2\n",
                    "a.brdf:5: the file ends where phi of the viewer should follow");
  expect_text_error(head + row + row + "0.1 0 0.2 0 1\n",
                    "the file ends where a value per wavelength should follow");
  expect_text_error(head + row + row + "2 0 0.2 0 1 1\n", "a.brdf:5: theta of the light is 2");
  expect_text_error(head + row + row + "0.1 0 -0.2 0 1 1\n", "theta of the viewer is -0.2");
  expect_text_error(head + row + row + "0.1 0 0.2 0 1 inf\n", "found \"inf\"");
  expect_text_error(head + row + row + "0.1 0 0.2 0 1 1e300\n", "found \"1e300\"");
  expect_text_error(head + row + row + "0.1 0 0.2 0 1 \x01\xff\n", "found \"??\"");
  std::string many = head;
  for (int i = 0; i <= 1 << 13; ++i) many += row;
  expect_text_error(many, "more than 8192 measurements");
  expect_one_line_with(message_of([&] { read_measured_file(path("none.brdf")); }),
                       "none.brdf: cannot be read");
  expect_one_line_with(lockstep::error_of([] { read_measured_file("/dev/zero"); }),
                       "/dev/zero: cannot");
}

// Each of ours is the mean of the file's cells that it covers and of those mirrored at the plane of
// incidence.
TEST_F(MeasuredFiles, MerlsCellsAreMerged) {
  const auto number = [](int channel, int h, int d, int p) {
    return merl_unit(channel) * (1.0 + 0.01 * h + 0.002 * d * d + 0.003 * p + 0.1 * channel);
  };
  const MeasuredTable table = read_measured_file(write("a.binary", merl_bytes(number))).table;
  constexpr int ds = 90 / measured_differences, ps = 90 / measured_azimuths;
  for_some_cells([&](int h, int d, int p) {
    for (int c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (int i = d * ds; i < (d + 1) * ds; ++i) {
        for (int j = p * ps; j < (p + 1) * ps; ++j) {
          sum += number(c, h, i, j) + number(c, h, i, 179 - j);
        }
      }
      const double expected = sum / (2.0 * ds * ps * merl_unit(c));
      EXPECT_NEAR(cell(table, h, d, p)[c], expected, 1e-5 * expected);
    }
  });
}

TEST_F(MeasuredFiles, MerlsCellsWithoutDataTakeTheNeighbours) {
  const auto holes = [](int channel, int h, int d, int) {
    return h > 40 || d < 12 ? -1.0 : merl_unit(channel) * 0.1;
  };
  const MeasuredTable table = read_measured_file(write("a.binary", merl_bytes(holes))).table;
  for_some_cells(
      [&](int h, int d, int p) { expect_near(cell(table, h, d, p), glm::vec3(0.1f), 1e-6f); });
  const auto none = [](int, int, int, int) { return -1.0; };
  expect_one_line_with(error_in("b.binary", merl_bytes(none)), "b.binary: holds no measurement");
}

TEST_F(MeasuredFiles, BadTablesGiveOneLine) {
  const std::string good = merl_bytes([](int, int, int, int) { return 1.0; });
  expect_one_line_with(error_in("a.binary", ""), "a.binary: is no measured reflectance of 90 x");
  expect_one_line_with(error_in("a.binary", "abcdefghijklmnop"), "a.binary: is no measured");
  expect_one_line_with(error_in("a.binary", good.substr(0, 1000)),
                       "a.binary: has 1000 bytes where 90 x 90 x 180 cells take 34992012");
  expect_one_line_with(error_in("a.binary", good + "x"), "has 34992013 bytes");
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e300,
                           -std::numeric_limits<double>::infinity()}) {
    std::string bytes = good;
    std::memcpy(bytes.data() + 12 + 8 * 1'000'000, &bad, sizeof(bad));
    expect_one_line_with(error_in("a.binary", bytes), "a.binary: holds the value");
  }
}

TEST_F(MeasuredFiles, MoreLightThanThereIsGivesAWarning) {
  const MeasuredFile file = read_measured_file(write("a.brdf", brdf_text(1.3 * inverse_pi)));
  expect_one_line_with(file.warning, "a.brdf: reflects 130 % of the light");
  expect_near(cell(file.table, 4, 4, 4), glm::vec3(1.3f * inverse_pi), 1e-5f);
}

// Lambert's model in either format, against the diffuse material: under a sky, where the two draw
// other directions, and a light to one side. Means of renders with other seeds, each test of 256 at
// the significance of t_images.h.
TEST_F(MeasuredFiles, LambertsModelRendersAsDiffuse) {
  write("a.brdf", brdf_text(0.5 * 0.3183098862));
  write("a.binary", merl_bytes([](int c, int, int, int) { return merl_unit(c) * 0.5 / M_PI; }));
  for (const char* name : {"a.brdf", "a.binary"}) {
    SceneDescription d = square(MeasuredMaterial{0});
    d.measured.push_back(read_measured_file(path(name)).table);
    expect_every_pixel(observe(build(d), {.spp = 64, .seeds = 12}), 0.5 * double(sky), 1e-4);
    d.environment.reset();
    d.lights = {PointLight{{1.0f, 0.5f, 2.0f}, glm::vec3(3.0f)}};
    const Image measured = rendered(build(d), {.spp = 64});
    d.materials[0] = DiffuseMaterial{glm::vec3(0.5f)};
    const Image diffuse = rendered(build(d), {.spp = 64});
    EXPECT_NEAR(mean_of(measured), mean_of(diffuse), 1e-5 * mean_of(diffuse)) << name;
  }
}

// A highlight, once by light sampling and once by what rays find: a sphere of light and the same
// radiance from a map of the sky would differ if the density were not that of the samples.
TEST_F(MeasuredFiles, DirectionsAndLightsAgree) {
  const auto glossy = [](glm::vec3 wo, glm::vec3 wi) {
    return glm::vec3(0.05f + std::pow(glm::normalize(wo + wi).z, 30.0f));
  };
  SceneDescription d = square(MeasuredMaterial{0});
  d.measured.push_back(make_measured_table(cells_of(glossy), "glossy"));
  const Observed sky_alone = observe(build(d), {.sampler = "random", .spp = 256, .seeds = 24});
  // Light from a ball around it all, chosen as a light.
  d.environment.reset();
  const int black = builtin::add_material(d, DiffuseMaterial{glm::vec3(0.0f)});
  d.shapes.push_back(Shape{Sphere{{0, 0, 0}, 50.0f, true}, black, Emission{glm::vec3(sky)}});
  look_straight(d, {0, 0, 3}, {0, 0, 0}, 2.0f, 8, 8);
  const Observed ball = observe(build(d), {.sampler = "random", .spp = 256, .seeds = 24});
  EXPECT_GT(equal_means(sky_alone.mean, ball.mean, 1e-4 * sky_alone.mean.mean), level)
      << sky_alone.mean.mean << " against " << ball.mean.mean;
}

TEST_F(MeasuredFiles, AreReadOnceByScenes) {
  write("a.brdf", brdf_text(0.1));
  const std::string material = "Material \"measured\" \"string filename\" \"a.brdf\" ";
  const SceneDescription scene = read_world(material + triangle + material + triangle);
  EXPECT_EQ(scene.measured.size(), 1u);
  EXPECT_EQ(model_of<MeasuredMaterial>(scene, 1).table, 0);
  EXPECT_EQ(scene.warnings.size(), 0u);
  EXPECT_TRUE(Scene(scene, embree_isa(choose_isa())).features() & bit(Feature::Measured));
}

TEST_F(MeasuredFiles, ThatScenesCannotHaveAreNamed) {
  const auto scene = [](const std::string& parameters) {
    return "WorldBegin\nMaterial \"measured\" " + parameters + triangle;
  };
  expect_one_line_with(Pbrt::error_of(scene("")), "needs \"string filename\"");
  expect_one_line_with(Pbrt::error_of(scene("\"string filename\" \"b.brdf\" ")),
                       "b.brdf: cannot be read");
  expect_one_line_with(Pbrt::error_of(scene("\"string filename\" \"b.bsdf\" ")),
                       "b.bsdf: cannot be read");
  SceneDescription wrong = square(MeasuredMaterial{3});
  expect_one_line_with(lockstep::error_of([&] { build(wrong); }), "measured table 3");
}

}  // namespace
}  // namespace lockstep::test_measured
