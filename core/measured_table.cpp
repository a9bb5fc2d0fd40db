#include "core/measured_table.h"

#include "core/bsdf/measured.h"
#include "core/error.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lockstep {
namespace {

constexpr double right_angle = 1.5707963267948966;

double theta_half(double cell) {
  const double x = cell / measured_halves;
  return right_angle * x * x;
}
double theta_difference(double cell) { return right_angle * cell / measured_differences; }
double phi_difference(double cell) { return right_angle * cell / measured_azimuths; }

bool is_known(glm::vec3 rgb) { return rgb.x >= 0.0f; }

void check(const MeasuredCells& cells, const std::string& name) {
  const auto is_number = [](glm::vec3 v) {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
  };
  if (!std::all_of(cells.rgb.begin(), cells.rgb.end(), is_number)) {
    throw Error(name + ": holds values that are not finite numbers; check the file");
  }
  if (std::none_of(cells.rgb.begin(), cells.rgb.end(), is_known)) {
    throw Error(name + ": holds no measurement of light above the surface; check the file");
  }
}

// Along one axis: from the known cell before, those before the first from that.
template <class At>
void fill_line(int count, const At& at) {
  int first = 0;
  while (first < count && !is_known(at(first))) ++first;
  if (first == count) return;
  for (int i = 0; i < first; ++i) at(i) = at(first);
  for (int i = first + 1; i < count; ++i) {
    if (!is_known(at(i))) at(i) = at(i - 1);
  }
}

void fill_unknown(MeasuredCells& cells) {
  const auto at = [&](int h, int d, int p) -> glm::vec3& {
    return cells.rgb[MeasuredCells::index(h, d, p)];
  };
  for (int d = 0; d < measured_differences; ++d) {
    for (int p = 0; p < measured_azimuths; ++p) {
      fill_line(measured_halves, [&](int h) -> glm::vec3& { return at(h, d, p); });
    }
  }
  for (int h = 0; h < measured_halves; ++h) {
    for (int d = 0; d < measured_differences; ++d) {
      fill_line(measured_azimuths, [&](int p) -> glm::vec3& { return at(h, d, p); });
    }
    for (int p = 0; p < measured_azimuths; ++p) {
      fill_line(measured_differences, [&](int d) -> glm::vec3& { return at(h, d, p); });
    }
  }
}

// The light that each ring of half vectors scatters between all pairs of directions:
// f cos_i cos_o d(wi) d(wo), where d(wi) d(wo) = 4 cos(theta_difference) d(h) d(wd).
std::vector<double> ring_shares(const MeasuredCells& cells) {
  std::vector<double> shares(measured_halves);
  double all = 0.0;
  for (int h = 0; h < measured_halves; ++h) {
    const double ring = std::cos(theta_half(h)) - std::cos(theta_half(h + 1));
    for (int d = 0; d < measured_differences; ++d) {
      const double angle = theta_difference(d + 0.5);
      for (int p = 0; p < measured_azimuths; ++p) {
        const DirectionPair pair = directions_of_cell(h, d, p);
        const double cosines = double(std::max(pair.wo.z, 0.0f) * std::max(pair.wi.z, 0.0f));
        const double f = double(luminance<float>(cells.rgb[MeasuredCells::index(h, d, p)]));
        shares[std::size_t(h)] += ring * f * cosines * std::cos(angle) * std::sin(angle);
      }
    }
    all += shares[std::size_t(h)];
  }
  for (double& s : shares) s = all > 0.0 ? s / all : 1.0 / measured_halves;
  return shares;
}

// Probabilities are differences of the rounded sums: exactly those that samples have.
void append_rings(const MeasuredCells& cells, std::vector<float>& values) {
  double before = 0.0;
  const std::vector<double> shares = ring_shares(cells);
  for (int h = 0; h < measured_halves; ++h) {
    const double after = h + 1 < measured_halves ? before + shares[std::size_t(h)] : 1.0;
    const double begin = 2.0 * std::pow(std::sin(0.5 * theta_half(h)), 2.0);
    const double end = 2.0 * std::pow(std::sin(0.5 * theta_half(h + 1)), 2.0);
    values.insert(values.end(),
                  {float(before), float(after) - float(before), float(begin), float(end - begin)});
    before = after;
  }
}

MeasuredBsdf<float> bsdf_of(const MeasuredTable& table) {
  return {table.values.data(), 0, table.values[0]};
}

// Mean of the samples' weights and of the squares of their luminance, for light from one direction.
struct Moments {
  glm::dvec3 mean{0.0};
  double square = 0.0;
};

// `samples` is a multiple of ten: each technique gets its share of them, well spread (multiples of
// the plastic number's powers).
Moments sample_moments(const MeasuredBsdf<float>& bsdf, double degrees, int samples) {
  const float angle = float(degrees) * pi / 180.0f;
  const glm::vec3 wo(std::sin(angle), 0.0f, std::cos(angle));
  const auto by_half = int(std::lround(double(bsdf.half_share) * samples));
  Moments m;
  for (int i = 0; i < samples; ++i) {
    const auto multiple = [i](double step) {
      const double x = (i + 0.5) * step;
      return float(std::min(x - std::floor(x), 1.0 - 0x1p-24));
    };
    const Vec2<float> u(multiple(0.7548776662466927), multiple(0.5698402909980532));
    const auto s = sample(bsdf, wo, i < by_half ? 0.0f : 1.0f, u);
    if (!(s.pdf > 0.0f)) continue;
    m.mean += glm::dvec3(s.weight) / double(samples);
    m.square += std::pow(double(luminance<float>(s.weight)), 2.0) / samples;
  }
  return m;
}

// The share of half vectors with the least noise, of a few.
float best_half_share(MeasuredTable table) {
  float best = 0.5f;
  double least = std::numeric_limits<double>::infinity();
  for (const float share : {0.1f, 0.3f, 0.5f, 0.7f, 0.9f}) {
    table.values[0] = share;
    double noise = 0.0;
    for (const double degrees : {10.0, 40.0, 65.0}) {
      const Moments m = sample_moments(bsdf_of(table), degrees, 2000);
      const double mean = double(luminance<float>(glm::vec3(m.mean)));
      noise += mean > 0.0 ? m.square / (mean * mean) : 0.0;
    }
    if (noise < least) least = noise, best = share;
  }
  return best;
}

}  // namespace

DirectionPair directions_at(double half, double difference, double azimuth) {
  const double h = theta_half(half), d = theta_difference(difference);
  const double p = phi_difference(azimuth);
  const glm::dvec3 normal(std::sin(h), 0.0, std::cos(h));
  const glm::dvec3 meridian(std::cos(h), 0.0, -std::sin(h)), parallel(0.0, 1.0, 0.0);
  const glm::dvec3 across = std::sin(d) * (std::cos(p) * meridian + std::sin(p) * parallel);
  return {glm::vec3(std::cos(d) * normal - across), glm::vec3(std::cos(d) * normal + across)};
}

DirectionPair directions_of_cell(int half, int difference, int azimuth) {
  return directions_at(half + 0.5, difference + 0.5, azimuth + 0.5);
}

MeasuredTable make_measured_table(MeasuredCells cells, const std::string& name) {
  check(cells, name);
  fill_unknown(cells);
  MeasuredTable table;
  table.values.reserve(measured_floats);
  table.values.assign(measured_rings_at, 0.0f);
  append_rings(cells, table.values);
  for (const glm::vec3 v : cells.rgb) {
    table.values.insert(table.values.end(), {v.x, std::max(v.y, 0.0f), std::max(v.z, 0.0f), 0.0f});
  }
  table.values[0] = best_half_share(table);
  return table;
}

MeasuredAlbedo largest_albedo(const MeasuredTable& table) {
  MeasuredAlbedo albedo;
  for (const double degrees : {0.0, 20.0, 40.0, 55.0, 65.0, 75.0, 80.0, 85.0}) {
    const glm::dvec3 mean = sample_moments(bsdf_of(table), degrees, 10'000).mean;
    const double largest = std::max({mean.x, mean.y, mean.z});
    if (largest > albedo.largest) albedo = {largest, degrees};
  }
  return albedo;
}

}  // namespace lockstep
