#include "core/boundary_albedo.h"

#include "core/bsdf/dielectric.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace lockstep {
namespace {

struct Shares {
  float reflected = 0.0f, passed = 0.0f;
};

// Means over normals visible from wo, of white facets. The nodes are a Fibonacci lattice, of which
// no line parallel to an axis holds two: it resolves where total reflection begins. There are more
// of them near u.x = 1, whence smooth surfaces get the few normals that lose.
Shares boundary_shares(float cos_o, float alpha, float eta) {
  const int nodes = eta < 1.0f ? 2584 : 610, step = eta < 1.0f ? 1597 : 377;
  const Ggx<float> ggx{{alpha, alpha}};
  const glm::vec3 wo(std::sqrt(1.0f - cos_o * cos_o), 0.0f, cos_o);
  const double g1 = double(ggx.g1(wo));
  double reflected = 0.0, passed = 0.0, weights = 0.0;
  for (int i = 0; i < nodes; ++i) {
    const float t = (float(i) + 0.5f) / float(nodes);
    weights += double(t);
    const Vec2<float> u(1.0f - t * t, float(i * step % nodes) / float(nodes));
    const glm::vec3 m = ggx.sample_visible_normal(wo, u);
    const float cos_m = std::clamp(dot(wo, m), 1e-6f, 1.0f);
    const Crossing<float> c = cross_boundary(cos_m, eta);
    const glm::vec3 up = reflect(wo, m), down = refract(wo, m, cos_m, c.g, eta);
    const double scale = double(t) / g1, r = double(c.reflectance);
    if (up.z > 0.0f) reflected += scale * r * double(ggx.g2(wo, up));
    if (r < 1.0 && down.z < 0.0f) passed += scale * (1.0 - r) * double(ggx.g2(wo, down));
  }
  return {float(reflected / weights), float(passed / weights)};
}

// The cosine and alpha of a node; neither is 0.
float at_node(int i) {
  const float root = float(i) / ggx_albedo_cells;
  return std::max(root * root, 1e-4f);
}

// One part's values at the nodes, cosines along rows.
constexpr int row_nodes = ggx_albedo_cells + 1;
using NodeValues = std::vector<float>;

void store_cells(const NodeValues& values, float* rows) {
  for (int row = 0; row < ggx_albedo_cells; ++row) {
    for (int column = 0; column < ggx_albedo_cells; ++column) {
      const float* corner = values.data() + row * row_nodes + column;
      for (const float value : {corner[0], corner[1], corner[row_nodes], corner[row_nodes + 1]}) {
        *rows++ = value;
      }
    }
  }
}

// Cosine-weighted mean of f(x), x the square root of the cosine, over all directions.
template <class F>
double diffuse_mean(const F& f) {
  constexpr int steps = 16 * ggx_albedo_cells;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double x = (i + 0.5) / steps;
    sum += 4.0 * x * x * x * f(x) / steps;
  }
  return sum;
}

// As kernels interpolate it between a row's nodes.
double diffuse_mean_of_row(const float* row) {
  return diffuse_mean([&](double x) {
    const double place = x * ggx_albedo_cells;
    const auto cell = std::size_t(place);
    const double low = double(row[cell]), high = double(row[cell + 1]);
    return low + (place - double(cell)) * (high - low);
  });
}

void make_table(float eta, float* out) {
  constexpr int part = 4 * ggx_albedo_cells * ggx_albedo_cells;
  NodeValues outside(row_nodes * row_nodes), inside(outside), reflected(outside);
  tbb::parallel_for(0, row_nodes * row_nodes, [&](int i) {
    const float cos_o = at_node(i % row_nodes), alpha = at_node(i / row_nodes);
    const Shares above = boundary_shares(cos_o, alpha, eta);
    const Shares below = boundary_shares(cos_o, alpha, 1.0f / eta);
    outside[std::size_t(i)] = above.reflected + above.passed;
    inside[std::size_t(i)] = below.reflected + below.passed;
    reflected[std::size_t(i)] = above.reflected / outside[std::size_t(i)];
  });
  store_cells(outside, out);
  store_cells(inside, out + part);
  store_cells(reflected, out + 2 * part);
  const double smooth =
      diffuse_mean([&](double x) { return double(cross_boundary(float(x * x), eta).reflectance); });
  // Of diffuse light, both sides let the same through, over eta^2 (Egan and Hilgeman 1973).
  const auto difference = [&](int row) {
    const double rough = diffuse_mean_of_row(reflected.data() + row * row_nodes);
    return float((rough - smooth) / (double(eta) * double(eta)));
  };
  for (int row = 0; row < ggx_albedo_cells; ++row) {
    float* ends = out + 3 * part + 4 * row;
    ends[0] = difference(row), ends[1] = difference(row + 1);
  }
}

}  // namespace

std::size_t boundary_table_for(float eta, std::vector<float>& etas) {
  const float within = eta > 1.0f / 16.0f ? std::min(eta, 16.0f) : 1.0f / 16.0f;
  const auto nearest = std::min_element(etas.begin(), etas.end(), [&](float a, float b) {
    return std::abs(a - within) < std::abs(b - within);
  });
  const auto number = std::size_t(nearest - etas.begin());
  if (etas.size() == most_boundary_tables || (number < etas.size() && *nearest == within)) {
    return number;
  }
  etas.push_back(within);
  return etas.size() - 1;
}

std::vector<float> make_boundary_albedo(const std::vector<float>& etas) {
  std::vector<float> tables(etas.size() * 4 * boundary_albedo_rows);
  for (std::size_t i = 0; i < etas.size(); ++i) {
    make_table(etas[i], tables.data() + i * 4 * boundary_albedo_rows);
  }
  return tables;
}

}  // namespace lockstep
