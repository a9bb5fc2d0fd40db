// lockstep metrics: how far one image is from another.
#include "experiments/commands.h"
#include "experiments/metrics.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace lockstep {
namespace {

struct MetricsOptions {
  std::string reference, test;
  bool json = false;
};

std::string table_help() {
  std::string text = "Metrics (lower is better unless said otherwise):\n";
  for (const Metric& metric : metrics()) {
    text += fmt::format("  {:16} {}{}{}\n", metric.name, metric.title,
                        metric.unit.empty() ? "" : fmt::format(", in units of {}", metric.unit),
                        metric.lower_is_better ? "" : " (higher is better)");
  }
  return text +
         "relMSE is the mean over pixels and channels of d^2 / (reference^2 + 0.01). Values are\n"
         "linear RGB; 8-bit files are taken out of the sRGB curve first.\n"
         "\nExample:\n  lockstep metrics reference.exr test.exr --json";
}

void run_metrics(const MetricsOptions& options) {
  const Image reference = read_image(options.reference);
  const Image test = read_image(options.test);
  const std::vector<double> values =
      evaluate_metrics(reference, test, options.reference, options.test);
  nlohmann::ordered_json json;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Metric& metric = metrics()[i];
    json[std::string(metric.name)] = values[i];
    if (!options.json) fmt::print("{:16} {:.9g}\n", metric.name, values[i]);
  }
  if (options.json) fmt::print("{}\n", json.dump(2));
}

}  // namespace

void add_metrics_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("metrics", "Measure one image against a reference");
  command->description(
      "Measure one image against a reference\n\n"
      "Measure how far the image TEST is from the image REFERENCE. Takes seconds.");
  command->footer(table_help());
  auto options = std::make_shared<MetricsOptions>();
  command->add_option("REFERENCE", options->reference, "Image taken as the truth")
      ->type_name("")
      ->required();
  command->add_option("TEST", options->test, "Image of the same size to be judged")
      ->type_name("")
      ->required();
  command->add_flag("--json", options->json, "Print a JSON object instead of lines");
  command->callback([options, &run] { run = [options] { run_metrics(*options); }; });
}

}  // namespace lockstep
