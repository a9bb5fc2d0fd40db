// The metrics that every comparison reports, as one table: `lockstep metrics`, errors.csv and the
// report follow from it. To add a metric, write its function and add a row in metrics.cpp.
#pragma once

#include "core/image.h"
#include "experiments/flip.h"
#include "experiments/yee.h"

#include <string_view>
#include <vector>

namespace lockstep {

struct Metric {
  std::string_view name;   // key in CSV and JSON
  std::string_view title;  // for people
  std::string_view unit;   // empty where it has none
  bool lower_is_better = true;
};

const std::vector<Metric>& metrics();

// How the images are looked at.
struct MetricSettings {
  float pixels_per_degree = kPixelsPerDegree;  // FLIP
  YeeSettings yee;
};

// What was measured, and the maps that came with it, of one channel each.
struct Evaluation {
  std::vector<double> values;  // in the order of metrics()
  Image flip_ldr, flip_hdr;    // error of each pixel, 0 to 1
  Image yee_failing;           // 1 where a pixel differs visibly
};

// All metrics of linear RGB images. Throws Error where the images differ in size, have no three
// channels or hold a value that is not finite; `reference_name` and `test_name` are for its
// message.
Evaluation evaluate(const Image& reference, const Image& test, const MetricSettings& settings = {},
                    std::string_view reference_name = "reference",
                    std::string_view test_name = "test");

// The values alone.
std::vector<double> evaluate_metrics(const Image& reference, const Image& test,
                                     std::string_view reference_name = "reference",
                                     std::string_view test_name = "test");

}  // namespace lockstep
