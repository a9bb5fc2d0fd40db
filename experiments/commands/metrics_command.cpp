// lockstep metrics: how far one image is from another.
#include "experiments/commands/commands.h"
#include "experiments/commands/options.h"
#include "experiments/metrics/block_error.h"
#include "experiments/metrics/error_spectrum.h"
#include "experiments/metrics/metrics.h"
#include "experiments/output/activity.h"
#include "experiments/output/display_image.h"
#include "experiments/output/output_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <utility>

namespace lockstep {
namespace {

struct MetricsOptions {
  std::string reference, test, maps;
  bool json = false;
  MetricSettings settings;
};

std::string table_help() {
  std::string text = "Metrics (lower is better unless said otherwise):\n";
  for (const Metric& metric : metrics()) {
    text += fmt::format("  {:19} {}{}{}\n", metric.name, metric.title,
                        metric.unit.empty() ? "" : fmt::format(", in units of {}", metric.unit),
                        metric.lower_is_better ? "" : " (higher is better)");
  }
  return text +
         "relMSE is the mean over pixels and channels of d^2 / (reference^2 + 0.01), SMAPE that "
         "of\n"
         "|d| / (|reference| + |test| + 0.01). Values are linear RGB; 8-bit files are taken out "
         "of\n"
         "the sRGB curve first. FLIP and SSIM see values above 1 as 1; HDR-FLIP takes the worst "
         "of\n"
         "several exposures chosen from the reference. Yee's metric is perceptualdiff's.\n"
         "\n"
         "luminance_ratio is the mean luminance of TEST over that of REFERENCE, "
         "block_relative_rmse "
         "the\n"
         "RMSE of the luminance of blocks of 16x16 pixels relative to the reference's: what is not "
         "noise.\n"
         "--json adds the power spectrum of the error over frequency, and that of white noise as "
         "strong.\n"
         "\n"
         "--maps writes flip_ldr.png and flip_hdr.png (black 0 to cream 1), flip_hdr_exposure.png "
         "(where\n"
         "HDR-FLIP is largest: purple at the first exposure, yellow at the last), yee.png (red: "
         "visibly\n"
         "different) and error.exr (test - reference).\n"
         "\nExample:\n  lockstep metrics reference.exr test.exr --json --maps out/maps";
}

Image error_of(const Image& reference, const Image& test) {
  Image error = test;
  for (std::size_t i = 0; i < error.pixels.size(); ++i) error.pixels[i] -= reference.pixels[i];
  return error;
}

// A one-channel map of zeros and ones as black and red: perceptualdiff's colours.
Image black_and_red(const Image& map) {
  Image image(map.width, map.height, 3);
  for (std::size_t i = 0; i < map.pixels.size(); ++i) image.pixels[3 * i] = map.pixels[i];
  return image;
}

void write_maps(const std::string& directory, const Evaluation& evaluation, const Image& error) {
  const auto path = [&](const char* file) {
    return (std::filesystem::path(directory) / file).string();
  };
  write_image(path("flip_ldr.png"), magma(evaluation.flip_ldr));
  write_image(path("flip_hdr.png"), magma(evaluation.flip_hdr.map));
  write_image(path("flip_hdr_exposure.png"), viridis(evaluation.flip_hdr.exposure));
  write_image(path("yee.png"), black_and_red(evaluation.yee_failing));
  write_image(path("error.exr"), error);
}

nlohmann::ordered_json spectrum_json(const ErrorSpectrum& spectrum) {
  nlohmann::ordered_json json = {{"frequency", nlohmann::ordered_json::array()},
                                 {"power", nlohmann::ordered_json::array()},
                                 {"white", spectrum.white}};
  for (const SpectrumRing& ring : spectrum.rings) {
    json["frequency"].push_back(ring.frequency);
    json["power"].push_back(ring.power);
  }
  return json;
}

void run_metrics(const MetricsOptions& options) {
  const Activity measuring(fmt::format("measuring {} against {}", options.test, options.reference));
  const Image reference = read_image(options.reference);
  const Image test = read_image(options.test);
  if (!options.maps.empty()) make_output_directory(options.maps);
  const Evaluation evaluation =
      evaluate(reference, test, options.settings, options.reference, options.test);
  if (!options.maps.empty()) write_maps(options.maps, evaluation, error_of(reference, test));
  std::vector<std::pair<std::string, double>> values;
  for (std::size_t i = 0; i < evaluation.values.size(); ++i) {
    values.emplace_back(metrics()[i].name, evaluation.values[i]);
  }
  values.emplace_back("block_relative_rmse", block_relative_rmse(reference, test));
  values.emplace_back("luminance_ratio", luminance_ratio(reference, test));
  if (options.json) {
    nlohmann::ordered_json json;
    for (const auto& [name, value] : values) json[name] = value;
    json["spectrum"] = spectrum_json(error_spectrum(reference, test));
    fmt::print("{}\n", json.dump(2));
    return;
  }
  for (const auto& [name, value] : values) fmt::print("{:19} {:.9g}\n", name, value);
}

void add_viewing_options(CLI::App& command, MetricSettings& settings) {
  const auto add = [&](const char* flag, float& value, const char* type, const char* description,
                       double low, double high) {
    command.add_option(flag, value, description)
        ->type_name(type)
        ->group("Viewing")
        ->check(number_between(low, high))
        ->capture_default_str();
  };
  YeeSettings& yee = settings.yee;
  add("--ppd", settings.pixels_per_degree, "N",
      "Pixels per degree, for FLIP; the default is 3840 pixels\n"
      "over 0.7 m seen from 0.7 m",
      5, 1000);
  add("--yee-fov", yee.field_of_view, "DEGREES", "Yee: field of view of the image's width", 0.1,
      89.9);
  add("--yee-gamma", yee.gamma, "G", "Yee: gamma of the display", 0.1, 10);
  add("--yee-luminance", yee.luminance, "L", "Yee: luminance of white in cd/m^2", 0.01, 1e6);
  add("--yee-colour-factor", yee.colour_factor, "C", "Yee: weight of the colour test", 0, 1);
  command.add_flag("--yee-luminance-only", yee.luminance_only, "Yee: no colour test")
      ->group("Viewing");
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
  command->add_option("--maps", options->maps, "Folder for maps of the errors; made if missing")
      ->type_name("DIR");
  add_viewing_options(*command, options->settings);
  command->callback([options, &run] { run = [options] { run_metrics(*options); }; });
}

}  // namespace lockstep
