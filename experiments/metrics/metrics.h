// The metrics that every comparison reports, as one table: `lockstep metrics`, errors.csv and the
// report follow from it. To add a metric, write its function and add a row in metrics.cpp.
#pragma once

#include "core/image.h"
#include "experiments/metrics/flip.h"
#include "experiments/metrics/yee.h"

#include <cstddef>
#include <functional>
#include <string>
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

// Adds a metric of linear RGB images to the table; for programs that build on the library, before
// they measure anything. Throws Error where the name is taken, or is not of lower-case letters,
// digits and
// _. The metric's texts must live as long as the program.
using MetricFunction = std::function<double(const Image& reference, const Image& test)>;
void add_metric(const Metric& metric, MetricFunction function);

// How the images are looked at.
struct MetricSettings {
  float pixels_per_degree = kPixelsPerDegree;  // FLIP
  YeeSettings yee;
};

// A reference that many images are measured against: what metrics need of it is worked out once.
// The image must live as long.
struct PreparedReference {
  const Image* image;
  std::string name;  // for messages
  MetricSettings settings;
  FlipReference flip;
  YeeView yee;
};

// Throws Error where the image is not RGB or holds a value that is not finite. `flip_bytes` bounds
// what is kept for FLIP; the rest is worked out for each image.
PreparedReference prepare_reference(const Image& reference, const MetricSettings& settings = {},
                                    std::string_view name = "reference",
                                    std::size_t flip_bytes = std::size_t(1) << 30);

// What was measured, and the maps that came with it, of one channel each.
struct Evaluation {
  std::vector<double> values;  // in the order of metrics()
  Image flip_ldr;              // error of each pixel, 0 to 1
  HdrFlip flip_hdr;
  Image yee_failing;  // 1 where a pixel differs visibly
};

// All metrics of linear RGB images. Throws Error where the images differ in size, have no three
// channels or hold a value that is not finite; `reference_name` and `test_name` are for its
// message.
Evaluation evaluate(const PreparedReference& reference, const Image& test,
                    std::string_view test_name = "test");
Evaluation evaluate(const Image& reference, const Image& test, const MetricSettings& settings = {},
                    std::string_view reference_name = "reference",
                    std::string_view test_name = "test");

// The values alone.
std::vector<double> evaluate_metrics(const Image& reference, const Image& test,
                                     std::string_view reference_name = "reference",
                                     std::string_view test_name = "test");

}  // namespace lockstep
