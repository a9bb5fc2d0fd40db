// RGL's measured materials: the reader gives back the function that a file was made from.
#include "core/measured_file.h"
#include "tests/t_pbrt.h"
#include "tests/t_rgl.h"

#include <gtest/gtest.h>

namespace lockstep::test_rgl {
namespace {

glm::vec3 cell(const MeasuredTable& table, int half, int difference, int azimuth) {
  const float* rgb =
      table.values.data() + measured_cells_at + 4 * MeasuredCells::index(half, difference, azimuth);
  return {rgb[0], rgb[1], rgb[2]};
}

glm::dvec3 glossy(glm::dvec3 wi, glm::dvec3 wo) {
  const double h = std::max(glm::normalize(wi + wo).z, 0.0);
  return glm::dvec3(0.1, 0.08, 0.05) + glm::dvec3(0.2, 0.25, 0.15) * std::pow(h, 12.0);
}

class RglFiles : public Pbrt {
 protected:
  // The largest relative error over cells whose directions are at most 70 degrees from the normal.
  double largest_error(const MeasuredTable& table,
                       const std::function<glm::dvec3(glm::dvec3, glm::dvec3)>& f) const {
    double largest = 0.0;
    for (int h = 0; h < measured_halves; h += 3) {
      for (int d = 0; d < measured_differences; d += 3) {
        for (int p = 0; p < measured_azimuths; p += 2) {
          const DirectionPair pair = directions_of_cell(h, d, p);
          if (std::min(pair.wo.z, pair.wi.z) < 0.34f) continue;
          const glm::dvec3 expected = f(glm::dvec3(pair.wi), glm::dvec3(pair.wo));
          const glm::dvec3 found(cell(table, h, d, p));
          for (int c = 0; c < 3; ++c) {
            largest = std::max(largest, std::abs(found[c] - expected[c]) / expected[c]);
          }
        }
      }
    }
    return largest;
  }
  std::string error_of_bytes(const std::string& bytes) const {
    write("a.bsdf", bytes);
    return message_of([&] { read_measured_file(path("a.bsdf")); });
  }
};

TEST_F(RglFiles, GiveBackTheFunctionTheyWereMadeFrom) {
  const MeasuredFile file = read_measured_file(write("a.bsdf", rgl_bytes({glossy})));
  EXPECT_EQ(file.warning, "");
  EXPECT_LT(largest_error(file.table, glossy), 0.03);
}

TEST_F(RglFiles, SpectraBecomeRgb) {
  const MeasuredFile file =
      read_measured_file(write("a.bsdf", rgl_bytes({.f = glossy, .wavelengths = 7})));
  const auto grey = [](glm::dvec3 wi, glm::dvec3 wo) { return glm::dvec3(glossy(wi, wo).x); };
  EXPECT_LT(largest_error(file.table, grey), 0.03);
}

// Reflects more along x than along y. A file for half a turn of wi repeats itself.
TEST_F(RglFiles, AnisotropicOnesGiveTheMeanOverOrientations) {
  const auto brushed = [](glm::dvec3 wi, glm::dvec3 wo) {
    const glm::dvec3 h = glm::normalize(wi + wo);
    return glm::dvec3(0.2 + 0.1 * (h.x * h.x - h.y * h.y), 0.2, 0.2 + 0.1 * h.x * h.y);
  };
  const auto flat = [](glm::dvec3, glm::dvec3) { return glm::dvec3(0.2); };
  for (const double covered : {2.0 * M_PI, M_PI}) {
    RglSource source{.f = brushed, .azimuths = 1 + int(covered * 8.0 / M_PI), .elevations = 8};
    source.turn_covered = covered;
    source.grid = 24;
    const MeasuredFile file = read_measured_file(write("a.bsdf", rgl_bytes(source)));
    EXPECT_NE(file.warning.find("anisotropic"), std::string::npos) << file.warning;
    EXPECT_LT(largest_error(file.table, flat), 0.06) << covered;
  }
}

TEST_F(RglFiles, BadOnesAreRefusedInOneLine) {
  RglSource small{.f = glossy, .elevations = 3};
  small.grid = 5;
  const std::string bytes = rgl_bytes(small);
  for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 40) {
    const std::string message = error_of_bytes(bytes.substr(0, size));
    ASSERT_FALSE(message.empty()) << size;
    ASSERT_EQ(message.find('\n'), std::string::npos) << message;
  }
  expect_one_line_with(error_of_bytes("tensor_file\0\2\0"), "is no file of RGL's tensors");
  const auto with = [&](const char* name, char by) {
    std::string changed = bytes;
    changed[changed.find(name)] = by;
    return error_of_bytes(changed);
  };
  expect_one_line_with(with("vndf", 'V'), "has no field \"vndf\"");
  expect_one_line_with(with("rgb", 'R'), "has no field \"spectra\"");
  std::string claims = bytes;
  const std::size_t at = claims.find("vndf") + 4 + 2 + 1 + 8;
  claims.replace(at, 8, 8, '\x7f');
  expect_one_line_with(error_of_bytes(claims), "dimensions that the file cannot hold");
  RglSource wild = small;
  wild.f = [](glm::dvec3, glm::dvec3) { return glm::dvec3(NAN); };
  expect_one_line_with(error_of_bytes(rgl_bytes(wild)), "holds the value");
}

TEST_F(RglFiles, AreReadByPbrtScenes) {
  RglSource small{.f = glossy, .elevations = 3};
  small.grid = 5;
  write("a.bsdf", rgl_bytes(small));
  const SceneDescription scene =
      read_world("Material \"measured\" \"string filename\" \"a.bsdf\" Shape \"sphere\"");
  EXPECT_EQ(model_of<MeasuredMaterial>(scene, 0).table, 0);
  EXPECT_EQ(scene.measured.size(), 1u);
  EXPECT_EQ(scene.warnings.size(), 0u);
}

}  // namespace
}  // namespace lockstep::test_rgl
