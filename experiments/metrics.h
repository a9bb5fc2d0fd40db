// The metrics that every comparison reports, as one table: `lockstep metrics`, errors.csv and the
// report follow from it. To add a metric, write its function and add a row in metrics.cpp.
#pragma once

#include "core/image.h"

#include <string_view>
#include <vector>

namespace lockstep {

struct Metric {
  std::string_view name;   // key in CSV and JSON
  std::string_view title;  // for people
  std::string_view unit;   // empty where it has none
  bool lower_is_better = true;
  double (*evaluate)(const Image& reference, const Image& test);
};

const std::vector<Metric>& metrics();

// All metrics, in the table's order. Throws Error where the images differ in size or hold a value
// that is not finite; `reference_name` and `test_name` are for its message.
std::vector<double> evaluate_metrics(const Image& reference, const Image& test,
                                     std::string_view reference_name = "reference",
                                     std::string_view test_name = "test");

}  // namespace lockstep
