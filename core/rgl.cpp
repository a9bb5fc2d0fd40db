// RGL's measured materials (Dupuy and Jakob 2018, "An Adaptive Parameterization for Efficient
// Material Acquisition and Rendering", section 4), in linear RGB or as spectra.
//
// For each direction wi of some elevations and azimuths the file tabulates the reflectance over the
// unit square: a point of it, warped by the density of normals visible from wi, is a half vector m,
// and the number there is f cos_o 4 sigma(wi) / D(m). Angles are stored as sqrt(theta / (pi / 2))
// and phi / (2 pi) + 1/2; of isotropic surfaces phi of m is that from wi on.
#include "core/error.h"
#include "core/measured_file.h"
#include "core/spectrum.h"
#include "core/tensor_file.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lockstep {
namespace {

constexpr double full_turn = 6.283185307179586;

// Where a coordinate lies between the values of an axis, of which there may be one.
struct AxisPlace {
  std::size_t first = 0;
  double within = 0.0;  // to the next
};

AxisPlace place_on(const std::vector<float>& axis, double x) {
  if (axis.size() < 2) return {};
  const auto above = std::upper_bound(axis.begin() + 1, axis.end() - 1, float(x));
  const double low = double(above[-1]), high = double(above[0]);
  return {std::size_t(above - axis.begin()) - 1, std::clamp((x - low) / (high - low), 0.0, 1.0)};
}

// A node of the regular grid over [0, 1], and how far to the next.
AxisPlace place_in_grid(double x, std::size_t nodes) {
  const double at = std::clamp(x, 0.0, 1.0) * double(nodes - 1);
  const auto first = std::min(std::size_t(at), nodes - 2);
  return {first, at - double(first)};
}

// Slices of a stack of grids, with weights that sum to 1.
struct Blend {
  std::array<std::size_t, 4> slice{};
  std::array<double, 4> weight{};
};

double between(double a, double b, double t) { return a + t * (b - a); }

// Grids over the unit square, rows along y, one after the other, `channels` values per node.
struct Grids {
  std::size_t width = 0, height = 0, channels = 1;
  std::vector<float> values;

  double value(const Blend& blend, std::size_t x, std::size_t y, std::size_t channel = 0) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (blend.weight[i] == 0.0) continue;
      const std::size_t node = (blend.slice[i] * height + y) * width + x;
      sum += blend.weight[i] * double(values[node * channels + channel]);
    }
    return sum;
  }
  double at(const Blend& blend, glm::dvec2 p, std::size_t channel = 0) const {
    const AxisPlace x = place_in_grid(p.x, width), y = place_in_grid(p.y, height);
    const auto row = [&](std::size_t j) {
      return between(value(blend, x.first, j, channel), value(blend, x.first + 1, j, channel),
                     x.within);
    };
    return between(row(y.first), row(y.first + 1), y.within);
  }
};

constexpr Blend only_slice{{0, 0, 0, 0}, {1.0, 0.0, 0.0, 0.0}};

// The map from densities, linear between nodes, to the unit square: y by the density of rows, then
// x by that along the row.
struct Warp {
  Grids density;    // each slice of mean 1
  Grids along_row;  // integral from the row's left end
  Grids over_rows;  // and of rows from the lowest; width 1

  glm::dvec2 inverse(const Blend& blend, glm::dvec2 p) const {
    const std::size_t last = density.width - 1;
    const AxisPlace x = place_in_grid(p.x, density.width), y = place_in_grid(p.y, density.height);
    const auto between_rows = [&](const Grids& grids, std::size_t column) {
      return between(grids.value(blend, column, y.first), grids.value(blend, column, y.first + 1),
                     y.within);
    };
    // Of x in [0, t], a linear density from a to b has the integral t (a + t (b - a) / 2).
    const auto part = [](double a, double b, double t) { return t * (a + 0.5 * t * (b - a)); };
    const double row = between_rows(along_row, last);
    const double left =
        between_rows(along_row, x.first) +
        part(between_rows(density, x.first), between_rows(density, x.first + 1), x.within) /
            double(last);
    const double below = over_rows.value(blend, 0, y.first) +
                         part(along_row.value(blend, last, y.first),
                              along_row.value(blend, last, y.first + 1), y.within) /
                             double(density.height - 1);
    return {row > 0.0 ? left / row : 0.5, below};
  }
};

Warp make_warp(const TensorFile& file, Grids density) {
  const std::size_t w = density.width, h = density.height, slices = density.values.size() / (w * h);
  Warp warp{{},
            {w, h, 1, std::vector<float>(density.values.size())},
            {1, h, 1, std::vector<float>(slices * h)}};
  for (std::size_t slice = 0; slice < slices; ++slice) {
    float* const values = density.values.data() + slice * w * h;
    const auto integrate = [&] {
      double all = 0.0;
      for (std::size_t y = 0; y < h; ++y) {
        double sum = 0.0, before = 0.0;
        float* const row = warp.along_row.values.data() + (slice * h + y) * w;
        for (std::size_t x = 0; x < w; ++x) {
          const double value = double(values[y * w + x]);
          if (x > 0) sum += 0.5 * (before + value) / double(w - 1);
          row[x] = float(sum), before = value;
        }
        if (y > 0) all += 0.5 * (double(row[w - 1]) + double(row[-1])) / double(h - 1);
        warp.over_rows.values[slice * h + y] = float(all);
      }
      return all;
    };
    const double all = integrate();
    if (!(all > 1e-30)) file.fail("field \"vndf\" has a density of visible normals that is 0");
    for (std::size_t i = 0; i < w * h; ++i) values[i] = float(double(values[i]) / all);
    integrate();
  }
  warp.density = std::move(density);
  return warp;
}

class RglMaterial {
 public:
  explicit RglMaterial(const TensorFile& file);

  bool is_isotropic() const { return phi_.size() <= 2; }

  // In 1/sr; both directions lie above the surface.
  glm::dvec3 reflectance(glm::dvec3 wi, glm::dvec3 wo) const;

 private:
  void read_axis(const TensorFile& file, const char* name, std::vector<float>& axis) const;
  void read_colors(const TensorFile& file);
  Grids read_grids(const TensorFile& file, const char* name, std::size_t dimensions) const;
  Blend blend_at(double phi, double theta) const;

  std::vector<float> phi_, theta_;  // of the directions that are tabulated
  int symmetry_ = 1;                // parts of a turn that repeat each other
  Grids normals_, area_;            // D over m, sigma over wi
  Warp visible_normals_;
  Grids colors_;
};

void RglMaterial::read_axis(const TensorFile& file, const char* name,
                            std::vector<float>& axis) const {
  axis = file.floats(name, 1).values;
  if (std::adjacent_find(axis.begin(), axis.end(), std::greater_equal<>()) != axis.end()) {
    file.fail(fmt::format("field \"{}\" does not increase", name));
  }
}

// Of one slice or, with more dimensions, one per azimuth and elevation of wi.
Grids RglMaterial::read_grids(const TensorFile& file, const char* name,
                              std::size_t dimensions) const {
  FloatTensor tensor = file.floats(name, dimensions);
  const std::vector<std::size_t>& shape = tensor.shape;
  const std::size_t width = shape[dimensions - 1], height = shape[dimensions - 2];
  if (width < 2 || height < 2) file.fail(fmt::format("field \"{}\" is no grid", name));
  if (dimensions > 2 && (shape[0] != phi_.size() || shape[1] != theta_.size())) {
    file.fail(fmt::format("field \"{}\" does not fit \"phi_i\" and \"theta_i\"", name));
  }
  for (float& value : tensor.values) {
    if (value < 0.0f && dimensions < 5) {
      file.fail(fmt::format("field \"{}\" holds values below 0; get the file again", name));
    }
  }
  return {width, height, 1, std::move(tensor.values)};
}

// Colours of nodes, from planes of "rgb" or of the wavelengths of "spectra".
void RglMaterial::read_colors(const TensorFile& file) {
  const bool rgb = file.has("rgb");
  const char* const name = rgb ? "rgb" : "spectra";
  const Grids source = read_grids(file, name, 5);
  const std::size_t nodes = source.width * source.height;
  const std::size_t slices = phi_.size() * theta_.size();
  const std::size_t planes = source.values.size() / (nodes * slices);
  std::vector<float> wavelengths{700.0f, 550.0f, 450.0f};
  if (!rgb) read_axis(file, "wavelengths", wavelengths);
  if (planes != wavelengths.size()) {
    file.fail(fmt::format("field \"{}\" has {} planes; {} are expected", name, planes,
                          wavelengths.size()));
  }
  colors_ = {source.width, source.height, 3, {}};
  colors_.values.resize(3 * nodes * slices);
  tbb::parallel_for(std::size_t(0), slices, [&](std::size_t slice) {
    std::vector<glm::dvec2> spectrum;
    for (const float w : wavelengths) spectrum.emplace_back(w, 0.0);
    for (std::size_t node = 0; node < nodes; ++node) {
      for (std::size_t plane = 0; plane < planes; ++plane) {
        spectrum[plane].y = double(source.values[(slice * planes + plane) * nodes + node]);
      }
      const glm::vec3 color =
          rgb ? glm::vec3(spectrum[0].y, spectrum[1].y, spectrum[2].y)
              : spectrum_to_rgb([&](double w) { return interpolate(spectrum, w); },
                                ColorUse::Reflectance);
      for (std::size_t c = 0; c < 3; ++c) {
        colors_.values[3 * (slice * nodes + node) + c] = color[glm::length_t(c)];
      }
    }
  });
}

RglMaterial::RglMaterial(const TensorFile& file) {
  read_axis(file, "phi_i", phi_);
  read_axis(file, "theta_i", theta_);
  normals_ = read_grids(file, "ndf", 2);
  area_ = read_grids(file, "sigma", 2);
  visible_normals_ = make_warp(file, read_grids(file, "vndf", 4));
  read_colors(file);
  if (is_isotropic()) return;
  symmetry_ = int(std::lround(full_turn / double(phi_.back() - phi_.front())));
  if (symmetry_ != 1 && symmetry_ != 2 && symmetry_ != 4) {
    file.fail("field \"phi_i\" covers neither a turn nor a half or a quarter of one");
  }
}

Blend RglMaterial::blend_at(double phi, double theta) const {
  const AxisPlace p = place_on(phi_, phi), t = place_on(theta_, theta);
  const std::size_t across = phi_.size() > 1 ? theta_.size() : 0, up = theta_.size() > 1 ? 1 : 0;
  const std::size_t corner = p.first * theta_.size() + t.first;
  return {{corner, corner + up, corner + across, corner + across + up},
          {(1.0 - p.within) * (1.0 - t.within), (1.0 - p.within) * t.within,
           p.within * (1.0 - t.within), p.within * t.within}};
}

double theta_of(glm::dvec3 w) { return std::atan2(std::hypot(w.x, w.y), w.z); }

// The place of a direction in a grid over all those above the surface.
glm::dvec2 place_of(double theta, double phi) {
  const double turns = phi / full_turn + 0.5;
  return {std::sqrt(theta * 4.0 / full_turn), turns - std::floor(turns)};
}

glm::dvec3 RglMaterial::reflectance(glm::dvec3 wi, glm::dvec3 wo) const {
  // Measured were azimuths from -pi to 0, or to -pi / 2.
  if (symmetry_ == 2 && wi.y > 0.0) wi.x = -wi.x, wi.y = -wi.y, wo.x = -wo.x, wo.y = -wo.y;
  if (symmetry_ == 4 && wi.x > 0.0) wi.x = -wi.x, wo.x = -wo.x;
  if (symmetry_ == 4 && wi.y > 0.0) wi.y = -wi.y, wo.y = -wo.y;
  const glm::dvec3 m = glm::normalize(wi + wo);
  const double phi = std::atan2(wi.y, wi.x), theta = theta_of(wi);
  const Blend blend = blend_at(phi, theta);
  const glm::dvec2 at = place_of(theta_of(m), std::atan2(m.y, m.x) - (is_isotropic() ? phi : 0.0));
  const glm::dvec2 node = visible_normals_.inverse(blend, at);
  const double area = area_.at(only_slice, place_of(theta, phi));
  const double factor = normals_.at(only_slice, at) / std::max(4.0 * area * wo.z, 1e-6);
  glm::dvec3 color;
  for (std::size_t c = 0; c < 3; ++c) {
    color[glm::length_t(c)] = std::max(colors_.at(blend, node, c), 0.0) * factor;
  }
  return color;
}

glm::dvec3 rotated(glm::vec3 w, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * double(w.x) - s * double(w.y), s * double(w.x) + c * double(w.y), double(w.z)};
}

// With the directions swapped, too, as files are not quite reciprocal; of surfaces with a grain the
// mean over its orientations.
glm::vec3 mean_reflectance(const RglMaterial& material, const DirectionPair& pair) {
  const int orientations = material.is_isotropic() ? 1 : 8;
  glm::dvec3 sum(0.0);
  for (int i = 0; i < orientations; ++i) {
    const double angle = full_turn * (i + 0.5) / orientations;
    const glm::dvec3 wo = rotated(pair.wo, angle), wi = rotated(pair.wi, angle);
    sum += material.reflectance(wi, wo) + material.reflectance(wo, wi);
  }
  return glm::vec3(sum / (2.0 * orientations));
}

}  // namespace

RglCells read_rgl(const std::string& path) {
  const RglMaterial material{TensorFile(path)};
  RglCells result;
  result.isotropic = material.is_isotropic();
  tbb::parallel_for(0, measured_halves, [&](int h) {
    for (int d = 0; d < measured_differences; ++d) {
      for (int p = 0; p < measured_azimuths; ++p) {
        const DirectionPair pair = directions_of_cell(h, d, p);
        if (!(pair.wo.z > 0.0f && pair.wi.z > 0.0f)) continue;
        result.cells.rgb[MeasuredCells::index(h, d, p)] = mean_reflectance(material, pair);
      }
    }
  });
  return result;
}

}  // namespace lockstep
