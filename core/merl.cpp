// MERL's tables: three int32 dimensions, then a table of doubles per channel, little endian, with
// theta_half slowest; rows of theta_half grow as its square root (Matusik et al. 2003).
#include "core/error.h"
#include "core/measured_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace lockstep {
namespace {

constexpr int halves = 90, differences = 90, azimuths = 180;
constexpr std::uintmax_t header_bytes = 3 * sizeof(std::int32_t);
constexpr std::uintmax_t file_bytes =
    header_bytes + sizeof(double) * 3 * halves * differences * azimuths;

// What the red, green and blue table's numbers stand for, in 1/sr.
constexpr std::array<double, 3> scale = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};

// Whole cells of the file make up each of ours, and phi_difference is folded at a right angle.
constexpr int merged_differences = differences / measured_differences;
constexpr int merged_azimuths = azimuths / 2 / measured_azimuths;
static_assert(halves == measured_halves && differences % measured_differences == 0 &&
              azimuths / 2 % measured_azimuths == 0);

std::ifstream open(const std::string& path) {
  std::error_code failed;
  const std::uintmax_t bytes = std::filesystem::file_size(path, failed);
  std::ifstream in;
  if (!failed) in.open(path, std::ios::binary);
  if (failed || !in) throw Error(path + ": cannot be read; check the path");
  std::array<std::int32_t, 3> size{};
  in.read(reinterpret_cast<char*>(size.data()), header_bytes);
  if (!in || size != std::array<std::int32_t, 3>{halves, differences, azimuths}) {
    throw Error(path + ": is no measured reflectance of 90 x 90 x 180 cells, as MERL's files hold");
  }
  if (bytes != file_bytes) {
    throw Error(
        fmt::format("{}: has {} bytes where 90 x 90 x 180 cells take {}; get the file again", path,
                    bytes, file_bytes));
  }
  return in;
}

// Of one channel: sums and numbers of the cells with data, for one theta_half.
struct Sums {
  std::array<double, measured_differences * measured_azimuths> sum{};
  std::array<int, measured_differences * measured_azimuths> count{};
};

Sums read_half(std::ifstream& in, const std::string& path) {
  std::vector<double> row(differences * azimuths);
  in.read(reinterpret_cast<char*>(row.data()), std::streamsize(row.size() * sizeof(double)));
  if (!in) throw Error(path + ": cannot be read to its end");
  Sums sums;
  for (int d = 0; d < differences; ++d) {
    for (int p = 0; p < azimuths; ++p) {
      const double value = row[std::size_t(d * azimuths + p)];
      if (!std::isfinite(value) || value > 1e12) {
        throw Error(fmt::format("{}: holds the value {}; get the file again", path, value));
      }
      if (value < 0.0) continue;
      const int folded = std::min(p, azimuths - 1 - p) / merged_azimuths;
      const auto at = std::size_t(d / merged_differences * measured_azimuths + folded);
      sums.sum[at] += value;
      ++sums.count[at];
    }
  }
  return sums;
}

}  // namespace

MeasuredCells read_merl(const std::string& path) {
  std::ifstream in = open(path);
  MeasuredCells cells;
  for (int channel = 0; channel < 3; ++channel) {
    for (int h = 0; h < halves; ++h) {
      const Sums sums = read_half(in, path);
      for (std::size_t i = 0; i < sums.sum.size(); ++i) {
        if (sums.count[i] == 0) continue;
        cells.rgb[std::size_t(h) * sums.sum.size() + i][channel] =
            float(scale[std::size_t(channel)] * sums.sum[i] / sums.count[i]);
      }
    }
  }
  return cells;
}

}  // namespace lockstep
