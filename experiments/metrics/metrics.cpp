#include "experiments/metrics/metrics.h"

#include "core/error.h"
#include "experiments/metrics/squared_error.h"
#include "experiments/metrics/structural_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lockstep {
namespace {

// What is evaluated, and where the result goes.
struct Task {
  const PreparedReference& prepared;
  const Image& reference;
  const Image& test;
  Evaluation& result;
};

// Metrics that one function evaluates together; it appends their values.
struct Evaluator {
  std::vector<Metric> metrics;
  std::function<void(Task& task)> append;
};

template <double (*function)(const Image&, const Image&)>
void append_value(Task& task) {
  task.result.values.push_back(function(task.reference, task.test));
}

void append_yee(Task& task) {
  const YeeSettings& settings = task.prepared.settings.yee;
  YeeDifference difference =
      yee_difference(task.prepared.yee, yee_view(task.test, settings), settings);
  const double pixels = double(task.reference.width) * double(task.reference.height);
  task.result.values.push_back(double(difference.pixels));
  task.result.values.push_back(double(difference.pixels) / pixels);
  task.result.yee_failing = std::move(difference.failing);
}

void append_flip_ldr(Task& task) {
  task.result.flip_ldr = task.prepared.flip.ldr_map(task.test);
  task.result.values.push_back(mean_of_map(task.result.flip_ldr));
}

void append_flip_hdr(Task& task) {
  task.result.flip_hdr = task.prepared.flip.hdr_map(task.test);
  task.result.values.push_back(mean_of_map(task.result.flip_hdr.map));
}

std::vector<Evaluator>& evaluators() {
  static std::vector<Evaluator> table = {
      {{{"rmse", "RMSE", "radiance"}}, append_value<rmse>},
      {{{"relmse", "relMSE", ""}}, append_value<relmse>},
      {{{"relmse_trimmed", "relMSE, worst 0.1 % of pixels left out", ""}},
       append_value<relmse_trimmed>},
      {{{"yee_pixels", "Pixels that differ visibly (Yee)", ""},
        {"yee_share", "Share of pixels that differ visibly (Yee)", ""}},
       append_yee},
      {{{"flip_ldr", "FLIP", ""}}, append_flip_ldr},
      {{{"flip_hdr", "HDR-FLIP", ""}}, append_flip_hdr},
      {{{"mse", "MSE", "radiance²"}}, append_value<mse>},
      {{{"smape", "SMAPE", ""}}, append_value<smape>},
      {{{"ssim", "SSIM", "", false}}, append_value<ssim>},
      {{{"low_pass_rmse", "RMSE of the error blurred over 4 pixels", "radiance"}},
       append_value<low_pass_rmse>},
  };
  return table;
}

void check_finite(const Image& image, std::string_view name) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (std::isfinite(image.pixels[i])) continue;
    const std::size_t pixel = i / std::size_t(image.channels);
    throw Error(
        fmt::format("{}: pixel ({}, {}) is not finite; no metric is defined for such an image",
                    name, pixel % std::size_t(image.width), pixel / std::size_t(image.width)));
  }
}

void check_colour(const Image& image, std::string_view name) {
  if (image.pixels.empty()) throw Error(fmt::format("{}: the image has no pixels", name));
  if (image.channels != 3) {
    throw Error(
        fmt::format("{}: {} channels; metrics are defined for RGB images", name, image.channels));
  }
  check_finite(image, name);
}

void check_sizes(const Image& reference, const Image& test, std::string_view reference_name,
                 std::string_view test_name) {
  if (reference.width == test.width && reference.height == test.height &&
      reference.channels == test.channels) {
    return;
  }
  throw Error(
      fmt::format("{} is {}x{} with {} channels, {} is {}x{} with {}; compare images of one size",
                  reference_name, reference.width, reference.height, reference.channels, test_name,
                  test.width, test.height, test.channels));
}

std::vector<Metric>& metric_list() {
  static std::vector<Metric> table = [] {
    std::vector<Metric> all;
    for (const Evaluator& evaluator : evaluators()) {
      all.insert(all.end(), evaluator.metrics.begin(), evaluator.metrics.end());
    }
    return all;
  }();
  return table;
}

bool is_column_name(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace

const std::vector<Metric>& metrics() { return metric_list(); }

void add_metric(const Metric& metric, MetricFunction function) {
  if (!is_column_name(metric.name)) {
    throw Error(fmt::format(
        "the added metric '{}' needs a name of lower-case letters, digits and _", metric.name));
  }
  for (const Metric& other : metrics()) {
    if (other.name != metric.name) continue;
    throw Error(fmt::format("there is a metric '{}' already; give the added one another name",
                            metric.name));
  }
  metric_list().push_back(metric);
  evaluators().push_back({{metric}, [function = std::move(function)](Task& task) {
                            task.result.values.push_back(function(task.reference, task.test));
                          }});
}

PreparedReference prepare_reference(const Image& reference, const MetricSettings& settings,
                                    std::string_view name, std::size_t flip_bytes) {
  check_colour(reference, name);
  return {&reference, std::string(name), settings,
          FlipReference(reference, settings.pixels_per_degree, flip_bytes),
          yee_view(reference, settings.yee)};
}

Evaluation evaluate(const PreparedReference& prepared, const Image& test,
                    std::string_view test_name) {
  check_sizes(*prepared.image, test, prepared.name, test_name);
  check_colour(test, test_name);
  Evaluation result;
  Task task{prepared, *prepared.image, test, result};
  for (const Evaluator& evaluator : evaluators()) evaluator.append(task);
  return result;
}

Evaluation evaluate(const Image& reference, const Image& test, const MetricSettings& settings,
                    std::string_view reference_name, std::string_view test_name) {
  check_sizes(reference, test, reference_name, test_name);
  return evaluate(prepare_reference(reference, settings, reference_name, 0), test, test_name);
}

std::vector<double> evaluate_metrics(const Image& reference, const Image& test,
                                     std::string_view reference_name, std::string_view test_name) {
  return evaluate(reference, test, {}, reference_name, test_name).values;
}

}  // namespace lockstep
