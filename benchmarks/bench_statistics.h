// Medians and quartiles of repeated measurements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lockstep {

// The value below which the share q of the values lies, the nearest one; there must be some.
inline double quantile(std::vector<double> values, double q) {
  const auto rank = std::ptrdiff_t(q * double(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[std::size_t(rank)];
}

inline double median(const std::vector<double>& values) { return quantile(values, 0.5); }

}  // namespace lockstep
