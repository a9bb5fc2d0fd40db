// RGL's files of measured reflectance, written from a function.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace lockstep {

// A container of arrays, as core/tensor_file.h describes it.
class TensorWriter {
 public:
  void add(const std::string& name, std::vector<std::uint64_t> shape,
           const std::vector<float>& values) {
    fields_.push_back({name, std::move(shape), 10, std::string(4 * values.size(), '\0')});
    std::memcpy(fields_.back().bytes.data(), values.data(), 4 * values.size());
  }
  void add_text(const std::string& name, const std::string& text) {
    fields_.push_back({name, {text.size()}, 1, text});
  }

  std::string bytes() const {
    std::string header("tensor_file\0\1\0", 14);
    append(header, std::uint32_t(fields_.size()));
    std::uint64_t at = header.size();
    for (const Field& f : fields_) at += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
    std::string data;
    for (const Field& f : fields_) {
      append(header, std::uint16_t(f.name.size()));
      header += f.name;
      append(header, std::uint16_t(f.shape.size()));
      append(header, f.type);
      append(header, std::uint64_t(at + data.size()));
      for (const std::uint64_t n : f.shape) append(header, n);
      data += f.bytes;
    }
    return header + data;
  }

 private:
  struct Field {
    std::string name;
    std::vector<std::uint64_t> shape;
    std::uint8_t type;
    std::string bytes;
  };
  template <class T>
  static void append(std::string& to, T value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  std::vector<Field> fields_;
};

// What a file is made from. Densities and areas are of any shape: they cancel out.
struct RglSource {
  std::function<glm::dvec3(glm::dvec3 wi, glm::dvec3 wo)> f;
  int azimuths = 1, elevations = 16;  // of wi; more than 2 azimuths, from -pi: anisotropic
  double turn_covered = 6.283185307179586;
  int grid = 32;        // nodes along each side
  int wavelengths = 0;  // 0: RGB; else equal values at all of them, of red
};

inline double rgl_normals(double x, double y) { return 0.3 + 2.0 * x * x + 0.2 * y; }
inline double rgl_area(double x) { return 1.0 - 0.4 * x; }
inline double rgl_visible(double x, double y, double theta) {
  return 0.3 + x * (1.0 + theta) + 0.5 * std::sin(5.0 * y + theta) * std::sin(5.0 * y + theta);
}

// Where the integral of f from 0 reaches the share u of that up to 1.
template <class F>
double rgl_quantile(const F& f, double u) {
  constexpr int steps = 200;
  double values[steps], all = 0.0, sum = 0.0;
  for (int i = 0; i < steps; ++i) all += values[i] = f((i + 0.5) / steps);
  for (int i = 0; i < steps; ++i) {
    if (sum + values[i] >= u * all) return (i + (u * all - sum) / values[i]) / steps;
    sum += values[i];
  }
  return 1.0;
}

// Where rows of the unit square go, so that their density is that of all `density` at y.
template <class F>
std::vector<double> rgl_rows(const F& density, std::size_t n) {
  const auto row = [&](double y) {
    double sum = 0.0;
    for (int i = 0; i < 20; ++i) sum += density((i + 0.5) / 20, y);
    return sum;
  };
  std::vector<double> rows;
  for (std::size_t i = 0; i < n; ++i) rows.push_back(rgl_quantile(row, double(i) / double(n - 1)));
  return rows;
}

inline std::string rgl_bytes(const RglSource& source) {
  constexpr double pi_here = 3.14159265358979323846;
  const auto n = std::size_t(source.grid);
  std::vector<float> phi, theta, normals, area, visible, colors;
  for (int i = 0; i < source.azimuths; ++i) {
    phi.push_back(source.azimuths < 2
                      ? 0.0f
                      : float(-pi_here + source.turn_covered * i / (source.azimuths - 1)));
  }
  for (int i = 0; i < source.elevations; ++i) {
    theta.push_back(float(1.5 * i / (source.elevations - 1)));
  }
  const auto node = [&](std::size_t i) { return double(i) / double(n - 1); };
  for (std::size_t i = 0; i < n * n; ++i) {
    normals.push_back(float(rgl_normals(node(i % n), node(i / n))));
    area.push_back(float(rgl_area(node(i % n))));
  }
  const int planes = source.wavelengths > 0 ? source.wavelengths : 3;
  for (const float phi_i : phi) {
    for (const float theta_i : theta) {
      const auto density = [&](double x, double y) { return rgl_visible(x, y, double(theta_i)); };
      const glm::dvec3 wi(std::sin(theta_i) * std::cos(phi_i), std::sin(theta_i) * std::sin(phi_i),
                          std::cos(theta_i));
      const std::vector<double> rows = rgl_rows(density, n);
      std::vector<glm::dvec3> values;
      for (std::size_t i = 0; i < n * n; ++i) {
        visible.push_back(float(density(node(i % n), node(i / n))));
        const double y = rows[i / n];
        const glm::dvec2 at(rgl_quantile([&](double x) { return density(x, y); }, node(i % n)), y);
        const double theta_m = 0.5 * pi_here * at.x * at.x;
        const double phi_m =
            2.0 * pi_here * (at.y - 0.5) + (source.azimuths > 2 ? 0.0 : double(phi_i));
        const glm::dvec3 m(std::sin(theta_m) * std::cos(phi_m), std::sin(theta_m) * std::sin(phi_m),
                           std::cos(theta_m));
        const glm::dvec3 wo = 2.0 * glm::dot(m, wi) * m - wi;
        const double elevation = std::sqrt(double(theta_i) / (0.5 * pi_here));
        const double scale =
            std::max(wo.z, 0.0) * 4.0 * rgl_area(elevation) / rgl_normals(at.x, at.y);
        values.push_back(source.f(wi, wo) * scale);
      }
      for (int plane = 0; plane < planes; ++plane) {
        for (const glm::dvec3& v : values) {
          colors.push_back(float(v[source.wavelengths > 0 ? 0 : plane]));
        }
      }
    }
  }
  TensorWriter file;
  const std::uint64_t side = n;
  file.add_text("description", "from a function");
  file.add("phi_i", {phi.size()}, phi);
  file.add("theta_i", {theta.size()}, theta);
  file.add("ndf", {side, side}, normals);
  file.add("sigma", {side, side}, area);
  file.add("vndf", {phi.size(), theta.size(), side, side}, visible);
  const char* name = source.wavelengths > 0 ? "spectra" : "rgb";
  file.add(name, {phi.size(), theta.size(), std::uint64_t(planes), side, side}, colors);
  if (source.wavelengths > 0) {
    std::vector<float> nm;
    for (int i = 0; i < planes; ++i) nm.push_back(400.0f + 300.0f * float(i) / float(planes - 1));
    file.add("wavelengths", {std::uint64_t(planes)}, nm);
  }
  return file.bytes();
}

}  // namespace lockstep
