#include "experiments/compare/journal.h"

#include "core/error.h"
#include "experiments/metrics/metrics.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace lockstep {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// JSON has no number for what is not finite.
double number(const Json& json) { return json.is_null() ? std::nan("") : json.get<double>(); }

Json run_json(const MeasuredRun& measured) {
  const Measurement& run = measured.run;
  Json errors = Json::object(), rings = Json::array(), bad = Json::array();
  for (const BadSample& b : run.bad_samples) bad.push_back({b.x, b.y, b.sample});
  for (std::size_t m = 0; m < metrics().size(); ++m) {
    errors[std::string(metrics()[m].name)] = run.errors[m];
  }
  for (const SpectrumRing& ring : measured.spectrum.rings) {
    rings.push_back({ring.frequency, ring.power});
  }
  return {{"seed", run.seed},
          {"spp", run.spp},
          {"cpu_seconds", run.cpu_seconds},
          {"wall_seconds", run.wall_seconds},
          {"pilot_spp", run.pilot_spp},
          {"mean_weight", run.mean_weight},
          {"lanes", to_string(run.lanes)},
          {"lanes_active", run.lanes_active},
          {"clamped", run.clamped},
          {"nonfinite", run.nonfinite},
          {"nonfinite_samples", bad},
          {"width", run.packet_width},
          {"threads", run.threads},
          {"weights", run.has_weights},
          {"cpu", run.cpu},
          {"errors", errors},
          {"spectrum", {{"white", measured.spectrum.white}, {"rings", rings}}}};
}

MeasuredRun parse_run(const Json& json) {
  MeasuredRun measured;
  Measurement& run = measured.run;
  run.seed = json.at("seed");
  run.spp = json.at("spp");
  run.cpu_seconds = number(json.at("cpu_seconds"));
  run.wall_seconds = number(json.at("wall_seconds"));
  run.pilot_spp = json.at("pilot_spp");
  run.mean_weight = number(json.at("mean_weight"));
  run.lanes = parse_lane_layout(json.at("lanes").get<std::string>());
  run.lanes_active = number(json.at("lanes_active"));
  run.clamped = json.at("clamped");
  run.nonfinite = json.at("nonfinite");
  for (const Json& bad : json.at("nonfinite_samples")) {
    run.bad_samples.push_back({bad.at(0), bad.at(1), bad.at(2)});
  }
  run.packet_width = json.at("width");
  run.threads = json.at("threads");
  run.has_weights = json.at("weights");
  run.cpu = json.at("cpu");
  for (const Metric& metric : metrics()) {
    run.errors.push_back(number(json.at("errors").at(std::string(metric.name))));
  }
  const Json& spectrum = json.at("spectrum");
  measured.spectrum.white = number(spectrum.at("white"));
  for (const Json& ring : spectrum.at("rings")) {
    measured.spectrum.rings.push_back({number(ring.at(0)), number(ring.at(1))});
  }
  return measured;
}

Json repeat_json(const TimingRepeat& repeat) {
  return {{"seed", repeat.seed},
          {"spp", repeat.spp},
          {"cpu_seconds", repeat.cpu_seconds},
          {"wall_seconds", repeat.wall_seconds},
          {"cpu", repeat.cpu}};
}

TimingRepeat parse_repeat(const Json& json) {
  return {0,
          json.at("seed"),
          json.at("spp"),
          number(json.at("cpu_seconds")),
          number(json.at("wall_seconds")),
          json.at("cpu")};
}

Json entry_json(const JournalEntry& entry) {
  Json json = {{"scene", entry.scene},
               {"depth", entry.depth},
               {"sampler", entry.sampler},
               {"conditions", entry.conditions}};
  if (const auto* measured = std::get_if<MeasuredRun>(&entry.what)) {
    json["run"] = run_json(*measured);
  } else {
    json["repeat"] = repeat_json(std::get<TimingRepeat>(entry.what));
  }
  return json;
}

JournalEntry parse_entry(const Json& json, int line) {
  JournalEntry entry;
  entry.line = line;
  entry.scene = json.at("scene");
  entry.depth = json.at("depth");
  entry.sampler = json.at("sampler");
  entry.conditions = json.at("conditions");
  if (json.contains("run")) {
    entry.what = parse_run(json["run"]);
  } else {
    entry.what = parse_repeat(json.at("repeat"));
  }
  return entry;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Up to the last line break: what follows was cut short.
std::string whole_lines(std::string text) {
  text.resize(text.rfind('\n') + 1);  // 0 where there is none
  return text;
}

std::vector<Json> parse_lines(const std::string& text) {
  std::vector<Json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    // Moved, not copied: a copy takes stack for every level of nesting.
    Json json = Json::parse(line, nullptr, false);
    lines.push_back(json.is_discarded() ? Json() : std::move(json));
  }
  return lines;
}

std::string journal_path(const std::string& directory, bool resume) {
  const std::string path = (fs::path(directory) / kJournalFile).string();
  // A comparison that is running has its journal taken away by nobody.
  if (!resume && !is_being_appended(path)) set_aside(path);
  return path;
}

std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace

Journal::Journal(const std::string& directory, bool resume)
    : path_(journal_path(directory, resume)), file_(path_) {
  const std::string text = whole_lines(text_of(path_));
  file_.truncate(text.size());
  const std::vector<Json> lines = parse_lines(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const int line = int(i) + 1;
    try {
      if (lines[i].contains("note")) continue;
      earlier_.push_back(parse_entry(lines[i], line));
    } catch (const std::exception&) {
      throw error_at(path_, line,
                     "not a line that this version writes; remove it to render this again, or "
                     "leave out --resume to begin anew");
    }
  }
}

void Journal::add(const JournalEntry& entry) { file_.append(journal_line(entry)); }

void Journal::take_over(const std::vector<JournalEntry>& entries) {
  earlier_.insert(earlier_.end(), entries.begin(), entries.end());
}

void Journal::add_note(const Json& note) { file_.append(line_of({{"note", note}})); }

std::string journal_line(const JournalEntry& entry) { return line_of(entry_json(entry)); }

JournalEntry parse_journal_line(const std::string& text) {
  try {
    return parse_entry(Json::parse(text), 0);
  } catch (const std::exception& error) {
    throw Error(fmt::format("not a line of a journal: {}", error.what()));
  }
}

std::vector<Json> read_journal_lines(const std::string& path) {
  return parse_lines(whole_lines(text_of(path)));
}

}  // namespace lockstep
