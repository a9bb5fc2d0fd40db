#include "experiments/compare/summary.h"
#include "experiments/metrics/metrics.h"
#include "experiments/output/render_metadata.h"

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

// Three digits; large counts of pixels whole, not as powers of ten.
std::string value_text(double value) {
  return value >= 1000.0 && value < 1e7 ? fmt::format("{:.0f}", value)
                                        : fmt::format("{:.3g}", value);
}

bool medians_disagree(const Json& ratio) {
  return !ratio.is_null() && ratio.value("medians_disagree", false);
}

// "x0.87", with a star where the interval excludes 1, and a mark where the medians disagree.
std::string ratio_text(const Json& ratio) {
  if (ratio.is_null()) return "-";
  const double value = ratio["value"].get<double>();
  std::string text =
      value >= 0.1 && value < 100.0 ? fmt::format("x{:.2f}", value) : fmt::format("x{:.1g}", value);
  if (!ratio.contains("interval_95")) return text;
  const Json& interval = ratio["interval_95"];
  if (interval[0].get<double>() > 1.0 || interval[1].get<double>() < 1.0) text += '*';
  return medians_disagree(ratio) ? text + '!' : text;
}

std::string header_line(const Json& summary, std::size_t width, bool with_ratio) {
  std::string line = fmt::format("  {:{}}", "sampler", width);
  for (const Json& column : summary["table"]) {
    line += fmt::format(" {:<{}}", column["heading"].get<std::string>(), with_ratio ? 15 : 13);
  }
  return line;
}

// True where no sampler was measured at the time.
bool is_outside(const Json& budget) {
  for (const Json& row : budget["samplers"]) {
    if (!row[std::string(metrics()[0].name)].is_null()) return false;
  }
  return true;
}

std::string equal_time_table(const Json& summary, const Json& scene, const Json& budget) {
  const std::size_t width = name_width(scene);
  if (is_outside(budget)) {
    return fmt::format(
        "\n  at {:.3g} s of CPU time no sampler was measured, and nothing is extrapolated: give "
        "more "
        "or\n  wider --spp\n",
        budget["cpu_seconds"].get<double>());
  }
  std::string text = fmt::format(
      "\n  at {:.3g} s of CPU time: medians, and mean ratios to {} over seeds; * 95 % interval "
      "excludes 1\n",
      budget["cpu_seconds"].get<double>(), scene["samplers"][0]["sampler"].get<std::string>());
  text += header_line(summary, width, true) + '\n';
  bool is_complete = true, do_agree = true;
  for (const Json& row : budget["samplers"]) {
    text += fmt::format("  {:{}}", row["sampler"].get<std::string>(), width);
    const bool is_base = &row == &budget["samplers"].front();
    for (const Json& column : summary["table"]) {
      const Json& cell = row[column["name"].get<std::string>()];
      if (cell.is_null()) {
        text += fmt::format(" {:<15}", "-");
        is_complete = false;
        continue;
      }
      text += fmt::format(" {:<8} {:<6}", value_text(cell["median"].get<double>()),
                          is_base ? "" : ratio_text(cell["ratio"]));
      do_agree = do_agree && !medians_disagree(cell["ratio"]);
    }
    text += '\n';
  }
  if (!is_complete) {
    text +=
        "  - not measured at this time, and nothing is extrapolated: give more or wider --spp\n";
  }
  if (!do_agree) {
    text +=
        "  ! the medians' ratio lies far off: few pixels or seeds decide (see relmse_trimmed)\n";
  }
  return text;
}

std::string rung_table(const Json& summary, const Json& scene) {
  const std::size_t width = name_width(scene);
  std::string text =
      "\n  No CPU time is covered by every sampler: nothing to compare at equal time.\n"
      "  Give more or wider --spp. Medians at each sample count:\n";
  text += header_line(summary, width, false) + fmt::format(" {:>7} {:>8}", "spp", "CPU s") + '\n';
  for (const Json& sampler : scene["samplers"]) {
    for (const Json& rung : sampler["rungs"]) {
      text += fmt::format("  {:{}}", sampler["sampler"].get<std::string>(), width);
      for (const Json& column : summary["table"]) {
        const Json& value = rung[column["name"].get<std::string>()]["median"];
        text += fmt::format(" {:<13}", value_text(value.get<double>()));
      }
      text += fmt::format(" {:>7} {:>8.3g}\n", rung["spp"].get<int>(),
                          rung["cpu_seconds"]["median"].get<double>());
    }
  }
  return text;
}

// Broken at spaces into lines of at most kLineWidth, those after the first indented.
std::string wrapped(const std::string& text) {
  constexpr std::size_t kLineWidth = 96;
  std::string result, line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!line.empty() && line.size() + 1 + word.size() > kLineWidth) {
      result += line + '\n';
      line = "   ";
    }
    line += line.empty() ? word : ' ' + word;
    at = end + 1;
  }
  return result + line + '\n';
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
  const Json clamp = summary.value("clamp", Json());
  if (clamp.is_number())
    text += fmt::format("\nAll renders are {}.\n", clamp_text(clamp.get<float>()));
  for (const Json& scene : summary["scenes"]) {
    text += scene_header(scene);
    const std::string unlike = scene.value("unlike_machines", "");
    if (!unlike.empty()) text += "  " + wrapped(unlike);
    const Json& budgets = scene["equal_time"]["budgets"];
    for (const Json& budget : budgets) text += equal_time_table(summary, scene, budget);
    if (budgets.empty()) text += rung_table(summary, scene);
    for (const Json& sampler : scene["samplers"]) {
      if (!sampler["biased"].get<bool>()) continue;
      text += fmt::format("  {} is biased: its mix of pilot and main image depends on the pilot.\n",
                          sampler["sampler"].get<std::string>());
    }
  }
  if (!summary["verdicts"].empty()) text += '\n';
  for (const Json& verdict : summary["verdicts"]) {
    text += wrapped(verdict["sentence"].get<std::string>());
  }
  return text;
}

}  // namespace lockstep
