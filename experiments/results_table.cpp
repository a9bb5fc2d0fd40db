#include "experiments/summary.h"

#include <fmt/format.h>

#include <algorithm>

namespace lockstep {
namespace {

using Json = nlohmann::ordered_json;

std::size_t name_width(const Json& scene) {
  std::size_t width = std::string("sampler").size();
  for (const Json& sampler : scene["samplers"]) {
    width = std::max(width, sampler["sampler"].get<std::string>().size());
  }
  return width;
}

std::string ratio_text(const Json& ratio) {
  if (ratio.is_null()) return "";
  std::string text = fmt::format("x{:.3g}", ratio["value"].get<double>());
  if (ratio.contains("interval_95")) {
    text += fmt::format(" [{:.3g}, {:.3g}]", ratio["interval_95"][0].get<double>(),
                        ratio["interval_95"][1].get<double>());
  }
  return text;
}

std::string header_line(const Json& summary, std::size_t width, bool with_ratio) {
  std::string line = fmt::format("  {:{}}", "sampler", width);
  for (const Json& metric : summary["metrics"]) {
    line += fmt::format("  {:<{}}", metric["name"].get<std::string>(), with_ratio ? 29 : 14);
  }
  return line;
}

std::string equal_time_table(const Json& summary, const Json& scene, const Json& budget) {
  const std::size_t width = name_width(scene);
  std::string text = fmt::format(
      "\n  at {:.3g} s of CPU time (median; ratio to {}, with 95 % interval over seeds)\n",
      budget["cpu_seconds"].get<double>(), scene["samplers"][0]["sampler"].get<std::string>());
  text += header_line(summary, width, true) + '\n';
  for (const Json& row : budget["samplers"]) {
    text += fmt::format("  {:{}}", row["sampler"].get<std::string>(), width);
    for (const Json& metric : summary["metrics"]) {
      const Json& cell = row[metric["name"].get<std::string>()];
      text +=
          fmt::format("  {:<10.4g}{:<19}", cell["median"].get<double>(), ratio_text(cell["ratio"]));
    }
    text += '\n';
  }
  return text;
}

std::string rung_table(const Json& summary, const Json& scene) {
  const std::size_t width = name_width(scene);
  std::string text =
      "\n  No CPU time is covered by every sampler: nothing to compare at equal time.\n"
      "  Give more or wider --spp. Medians at each sample count:\n";
  text += header_line(summary, width, false) + fmt::format("  {:>7}  {}", "spp", "CPU s") + '\n';
  for (const Json& sampler : scene["samplers"]) {
    for (const Json& rung : sampler["rungs"]) {
      text += fmt::format("  {:{}}", sampler["sampler"].get<std::string>(), width);
      for (const Json& metric : summary["metrics"]) {
        text += fmt::format("  {:<14.4g}",
                            rung[metric["name"].get<std::string>()]["median"].get<double>());
      }
      text += fmt::format("  {:>7}  {:.3g}\n", rung["spp"].get<int>(),
                          rung["cpu_seconds"]["median"].get<double>());
    }
  }
  return text;
}

std::string scene_header(const Json& scene) {
  std::string text = fmt::format(
      "\n{}: {}x{}, depth {}, {} threads, {} lanes; reference {}",
      scene["scene"].get<std::string>(), scene["resolution"][0].get<int>(),
      scene["resolution"][1].get<int>(), scene["depth"].get<int>(), scene["threads"].get<int>(),
      scene["width"].get<int>(), scene["reference"]["origin"].get<std::string>());
  if (!scene["reference"]["relmse_estimate"].is_null()) {
    text += fmt::format(", its own relMSE about {:.1e}",
                        scene["reference"]["relmse_estimate"].get<double>());
  }
  return text + '\n';
}

}  // namespace

std::string results_table(const Json& summary) {
  std::string text;
  if (!summary["complete"].get<bool>()) {
    text += "\nStopped before all seeds were rendered: what follows was measured until then.\n";
  }
  for (const Json& scene : summary["scenes"]) {
    text += scene_header(scene);
    const Json& budgets = scene["equal_time"]["budgets"];
    for (const Json& budget : budgets) text += equal_time_table(summary, scene, budget);
    if (budgets.empty()) text += rung_table(summary, scene);
    for (const Json& sampler : scene["samplers"]) {
      if (!sampler["biased"].get<bool>()) continue;
      text += fmt::format("  {} is biased: its mix of pilot and main image depends on the pilot.\n",
                          sampler["sampler"].get<std::string>());
    }
  }
  return text;
}

}  // namespace lockstep
