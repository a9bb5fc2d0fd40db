#include "core/ggx_albedo.h"

#include "core/microfacet.h"

#include <algorithm>
#include <cmath>

namespace lockstep {
namespace {

// Mean of G2 / G1 over normals visible from wo: the weight of a sample whose facets are white.
// Midpoint rule, with more nodes near u.x = 1, whence smooth surfaces get the few normals that
// lose.
float single_scattering(float cos_o, float alpha) {
  constexpr int steps = 32, azimuths = 12;  // of half a turn
  const Ggx<float> ggx{{alpha, alpha}};
  const glm::vec3 wo(std::sqrt(1.0f - cos_o * cos_o), 0.0f, cos_o);
  const float g1 = ggx.g1(wo);
  double sum = 0.0, weights = 0.0;
  for (int i = 0; i < steps; ++i) {
    const float t = (float(i) + 0.5f) / steps;
    const double weight = double(t * t);
    weights += azimuths * weight;
    for (int j = 0; j < azimuths; ++j) {
      const Vec2<float> u(1.0f - t * t * t, 0.5f * (float(j) + 0.5f) / azimuths);
      const glm::vec3 wi = reflect(wo, ggx.sample_visible_normal(wo, u));
      if (wi.z > 0.0f) sum += weight * double(ggx.g2(wo, wi) / g1);
    }
  }
  return float(sum / weights);
}

}  // namespace

std::vector<float> make_ggx_albedo() {
  constexpr int nodes = ggx_albedo_cells + 1;
  std::vector<float> values;
  for (int row = 0; row < nodes; ++row) {
    for (int column = 0; column < nodes; ++column) {
      const float x = float(column) / ggx_albedo_cells, y = float(row) / ggx_albedo_cells;
      values.push_back(single_scattering(std::max(x * x, 1e-4f), std::max(y * y, 1e-4f)));
    }
  }
  std::vector<float> rows;
  for (int row = 0; row < ggx_albedo_cells; ++row) {
    for (int column = 0; column < ggx_albedo_cells; ++column) {
      const float* corner = values.data() + row * nodes + column;
      rows.insert(rows.end(), {corner[0], corner[1], corner[nodes], corner[nodes + 1]});
    }
  }
  return rows;
}

}  // namespace lockstep
