// Scattered measurements of an isotropic surface, in Cornell's text format.
#include "core/error.h"
#include "core/measured_file.h"
#include "core/spectrum.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace lockstep {
namespace {

constexpr std::size_t most_samples = 1 << 13;  // each cell looks at them all
constexpr std::size_t most_wavelengths = 1024;
constexpr std::uintmax_t most_bytes = 256u << 20;

// Numbers one after the other, over comments and ends of lines.
class Numbers {
 public:
  explicit Numbers(const std::string& path) : path_(path) {
    std::error_code failed;
    const std::uintmax_t bytes = std::filesystem::file_size(path, failed);
    if (!failed) in_.open(path);
    if (failed || !in_) throw Error(path + ": cannot be read; check the path");
    if (bytes > most_bytes) {
      throw Error(fmt::format("{}: has {} MiB; measured reflectance as text may have {}", path,
                              bytes >> 20, most_bytes >> 20));
    }
  }

  // False at the end of the file.
  bool find() {
    for (;;) {
      rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\v\f"), rest_.size()));
      if (!rest_.empty() && rest_[0] != '#') return true;
      if (!std::getline(in_, text_)) return false;
      rest_ = text_;
      ++line_;
    }
  }

  double next(const char* what) {
    if (!find()) fail(fmt::format("the file ends where {} should follow", what));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\v\f#"));
    const std::string_view digits = word.substr(word[0] == '+' ? 1 : 0);
    double value = 0.0;
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool whole = end == digits.data() + digits.size() && status == std::errc();
    if (!whole || !(std::abs(value) <= 1e12)) {
      std::string shown(word.substr(0, 40));
      for (char& c : shown) c = c > ' ' && c < 0x7f ? c : '?';
      fail(fmt::format("expected {}, found \"{}\"", what, shown));
    }
    rest_.remove_prefix(word.size());
    return value;
  }

  [[noreturn]] void fail(const std::string& what) const { throw error_at(path_, line_, what); }

 private:
  std::string path_;
  std::ifstream in_;
  std::string text_;
  std::string_view rest_;
  int line_ = 0;
};

std::vector<double> read_wavelengths(Numbers& in) {
  const double count = in.next("the number of wavelengths");
  if (!(count >= 1.0 && count <= double(most_wavelengths)) || count != std::floor(count)) {
    in.fail(fmt::format("{} is no number of wavelengths from 1 to {}", count, most_wavelengths));
  }
  std::vector<double> wavelengths;
  while (wavelengths.size() < std::size_t(count)) {
    const double w = in.next("a wavelength");
    if (!(w > 0.0)) in.fail(fmt::format("the wavelength {} nm is not above 0", w));
    if (!wavelengths.empty() && !(w > wavelengths.back())) {
      in.fail(fmt::format("the wavelength {} nm does not exceed the one before", w));
    }
    wavelengths.push_back(w);
  }
  return wavelengths;
}

// Polar angle of a direction above the surface.
double read_theta(Numbers& in, const char* what) {
  const double theta = in.next(what);
  if (!(theta >= 0.0 && theta <= 1.5708)) {
    in.fail(fmt::format("{} is {}; it lies between 0 and pi / 2", what, theta));
  }
  return theta;
}

// Where two directions lie in pbrt-v2's coordinates.
glm::vec3 position_of(double theta_i, double theta_o, double phi) {
  const double turns = std::abs(phi) / 6.283185307179586;
  const double share = turns - std::floor(turns);
  return {std::sin(theta_i) * std::sin(theta_o), 2.0 * std::min(share, 1.0 - share),
          std::cos(theta_i) * std::cos(theta_o)};
}

struct Samples {
  std::vector<float> x, y, z;  // positions
  std::vector<glm::vec3> rgb;
};

void read_sample(Numbers& in, const std::vector<double>& wavelengths, Samples& samples) {
  const double theta_i = read_theta(in, "theta of the light"), phi_i = in.next("phi of the light");
  const double theta_o = read_theta(in, "theta of the viewer");
  const double phi_o = in.next("phi of the viewer");
  const glm::vec3 at = position_of(theta_i, theta_o, phi_i - phi_o);
  samples.x.push_back(at.x), samples.y.push_back(at.y), samples.z.push_back(at.z);
  std::vector<glm::dvec2> spectrum;
  for (const double w : wavelengths) spectrum.emplace_back(w, in.next("a value per wavelength"));
  samples.rgb.push_back(
      spectrum_to_rgb([&](double w) { return interpolate(spectrum, w); }, ColorUse::Reflectance));
}

Samples read_samples(const std::string& path) {
  Numbers in(path);
  const std::vector<double> wavelengths = read_wavelengths(in);
  Samples samples;
  while (in.find()) {
    if (samples.rgb.size() == most_samples) {
      in.fail(fmt::format("more than {} measurements; leave out some", most_samples));
    }
    read_sample(in, wavelengths, samples);
  }
  if (samples.rgb.size() < 3) in.fail("at least 3 measurements are needed");
  return samples;
}

// Spheres around a point, each twice the last one's square of radius; the first that holds more
// than two samples is the neighbourhood.
constexpr int spheres = 13;
constexpr float first_square = 1e-3f;

glm::vec3 mean_around(const Samples& samples, glm::vec3 at, std::vector<float>& squares) {
  const std::size_t count = samples.rgb.size();
  for (std::size_t i = 0; i < count; ++i) {
    const float x = samples.x[i] - at.x, y = samples.y[i] - at.y, z = samples.z[i] - at.z;
    squares[i] = x * x + y * y + z * z;
  }
  float third[3] = {1e9f, 1e9f, 1e9f};  // the nearest three, in order
  for (const float s : squares) {
    if (s >= third[2]) continue;
    third[2] = s;
    if (third[2] < third[1]) std::swap(third[1], third[2]);
    if (third[1] < third[0]) std::swap(third[0], third[1]);
  }
  float limit = first_square;
  for (int i = 0; i < spheres && limit <= third[2]; ++i) limit *= 2.0f;
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (squares[i] >= limit) continue;
    // From the nearest: the same mean, and never a sum of nothing but zeros.
    const double weight = std::exp(-100.0 * double(squares[i] - third[0]));
    sum += weight * glm::dvec3(samples.rgb[i]);
    weights += weight;
  }
  return sum / weights;
}

// The mean over a cell, of a few places: between far measurements values change abruptly.
glm::vec3 mean_in_cell(const Samples& samples, int h, int d, int p, std::vector<float>& squares) {
  constexpr double places[4][3] = {
      {0.125, 0.375, 0.625}, {0.375, 0.875, 0.125}, {0.625, 0.125, 0.875}, {0.875, 0.625, 0.375}};
  glm::vec3 sum(0.0f);
  float count = 0.0f;
  for (const auto& place : places) {
    const auto [wo, wi] = directions_at(h + place[0], d + place[1], p + place[2]);
    if (!(wo.z > 0.0f && wi.z > 0.0f)) continue;
    const double phi =
        std::atan2(double(wi.y), double(wi.x)) - std::atan2(double(wo.y), double(wo.x));
    const auto theta = [](glm::vec3 w) { return std::acos(std::min(double(w.z), 1.0)); };
    sum += mean_around(samples, position_of(theta(wi), theta(wo), phi), squares);
    count += 1.0f;
  }
  return count > 0.0f ? sum / count : glm::vec3(-1.0f);
}

}  // namespace

MeasuredCells read_measured_samples(const std::string& path) {
  const Samples samples = read_samples(path);
  MeasuredCells cells;
  tbb::parallel_for(0, measured_halves, [&](int h) {
    std::vector<float> squares(samples.rgb.size());
    for (int d = 0; d < measured_differences; ++d) {
      for (int p = 0; p < measured_azimuths; ++p) {
        cells.rgb[MeasuredCells::index(h, d, p)] = mean_in_cell(samples, h, d, p, squares);
      }
    }
  });
  return cells;
}

}  // namespace lockstep
