// Measured isotropic reflectance on a regular grid of half and difference angles (Rusinkiewicz
// 1998, "A New Change of Variables for Efficient BRDF Representation"): theta_half and phi_half
// say where the half vector lies, theta_difference and phi_difference where wi lies as seen from
// it. Isotropic: phi_half plays no part.
//
// The grid folds phi_difference into [0, pi / 2]: half a turn more swaps wo and wi, which makes
// every table reciprocal, and the other sign mirrors both at the plane of incidence. What a file
// says otherwise about such pairs is averaged.
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace lockstep {

// Cells along sqrt(theta_half / (pi / 2)), dense where highlights are, theta_difference and
// phi_difference, each from 0 to a right angle; values stand for the cells' middles.
inline constexpr int measured_halves = 90, measured_differences = 90, measured_azimuths = 15;
inline constexpr int measured_cells = measured_halves * measured_differences * measured_azimuths;

// Rows of four floats: 0 share of directions drawn by the half vector; then one per ring of half
// vectors, the cells of one theta_half: 0 probability of the rings before, 1 of this one,
// 2 1 - cos(theta_half) where it begins, 3 what that grows by within; then RGB in 1/sr per cell,
// theta_half slowest, phi_difference fastest.
inline constexpr int measured_rings_at = 4;
inline constexpr int measured_cells_at = measured_rings_at + 4 * measured_halves;
inline constexpr int measured_floats = measured_cells_at + 4 * measured_cells;

// More than that, of 2 MB each, are refused.
inline constexpr std::size_t most_measured_tables = 256;

struct MeasuredTable {
  std::vector<float> values;  // measured_floats
};

// RGB per cell, to become a table; negative red: nothing is known.
struct MeasuredCells {
  std::vector<glm::vec3> rgb = std::vector<glm::vec3>(measured_cells, glm::vec3(-1.0f));

  static std::size_t index(int half, int difference, int azimuth) {
    return (std::size_t(half) * measured_differences + std::size_t(difference)) *
               measured_azimuths +
           std::size_t(azimuth);
  }
};

struct DirectionPair {
  glm::vec3 wo, wi;  // unit; below the surface where z < 0
};

// The directions at a place in the grid, in cells from its corner; and at the middle of a cell.
DirectionPair directions_at(double half, double difference, double azimuth);
DirectionPair directions_of_cell(int half, int difference, int azimuth);

// Unknown cells, as those below the horizon, get the value of the next smaller theta_half. Throws
// Error where nothing is known or a value is not finite, `name` first.
MeasuredTable make_measured_table(MeasuredCells cells, const std::string& name);

// The largest share of light that the table reflects in any channel, over all directions of the
// light, and from which of them, in degrees from the normal; to some tenths of a per cent.
struct MeasuredAlbedo {
  double largest = 0.0, degrees = 0.0;
};
MeasuredAlbedo largest_albedo(const MeasuredTable& table);

}  // namespace lockstep
