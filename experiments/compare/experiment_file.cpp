#include "experiments/compare/experiment_file.h"

#include "core/error.h"
#include "core/location.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>

namespace lockstep {
namespace {

using Kind = ValueKind;

std::string_view name_of(Kind kind) {
  switch (kind) {
    case Kind::Text:
      return "text in quotes";
    case Kind::Number:
      return "a number";
    case Kind::TextOrNumber:
      return "a number or text in quotes";
    case Kind::Switch:
      return "true or false";
  }
  return "";
}

std::string_view name_of(toml::node_type type) {
  switch (type) {
    case toml::node_type::string:
      return "text";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

int line_of(const toml::node& node) { return int(node.source().begin.line); }

const ExperimentKey* key_named(std::string_view name) {
  for (const ExperimentKey& key : experiment_keys()) {
    if (key.name == name) return &key;
  }
  return nullptr;
}

std::string unknown_key(std::string_view name) {
  std::string text = fmt::format("there is no key '{}'; keys are:", name);
  for (const ExperimentKey& key : experiment_keys()) text += fmt::format(" {}", key.name);
  return text;
}

// The value as text, if it is of this kind.
std::optional<std::string> text_of(const toml::node& node, Kind kind) {
  const bool text = kind == Kind::Text || kind == Kind::TextOrNumber;
  const bool number = kind == Kind::Number || kind == Kind::TextOrNumber;
  if (const auto* value = node.as_string(); value && text) return value->get();
  if (const auto* value = node.as_integer(); value && number)
    return fmt::format("{}", value->get());
  if (const auto* value = node.as_floating_point(); value && number) {
    return fmt::format("{}", value->get());
  }
  if (const auto* value = node.as_boolean(); value && kind == Kind::Switch) {
    return value->get() ? "true" : "false";
  }
  return {};
}

std::string expected_text(const ExperimentKey& key, const toml::node& node) {
  return fmt::format("{}: {}{} is expected here, not {}", key.name, name_of(key.kind),
                     key.is_list ? ", or a list of such," : "", name_of(node.type()));
}

ExperimentEntry read_entry(const std::string& path, const ExperimentKey& key,
                           const toml::node& node) {
  ExperimentEntry entry{&key, {}, line_of(node)};
  const auto add = [&](const toml::node& value) {
    const std::optional<std::string> text = text_of(value, key.kind);
    if (!text) throw error_at(path, line_of(value), expected_text(key, value));
    entry.values.push_back(*text);
  };
  const toml::array* list = node.as_array();
  if (!list || !key.is_list) {
    add(node);
    return entry;
  }
  for (const toml::node& value : *list) add(value);
  if (entry.values.empty()) {
    throw error_at(path, entry.line, fmt::format("{}: the list is empty", key.name));
  }
  return entry;
}

toml::table parse_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw Error(path + ": no such file; an experiment is a TOML file");
  }
  try {
    return toml::parse_file(path);
  } catch (const toml::parse_error& failure) {
    throw error_at(path, int(failure.source().begin.line),
                   printable(std::string(failure.description())));
  }
}

std::optional<double> number_in(const std::string& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

// As it stands in a file.
std::string value_text(Kind kind, const std::string& text) {
  if (kind == Kind::Switch) return text;
  const std::optional<double> number = kind == Kind::Text ? std::nullopt : number_in(text);
  if (number) return fmt::format("{}", *number);
  std::ostringstream quoted;
  quoted << toml::value<std::string>(text);
  return quoted.str();
}

}  // namespace

const std::vector<ExperimentKey>& experiment_keys() {
  static const std::vector<ExperimentKey> keys = {
      {"scenes", Kind::Text, true},    {"scenes_dir", Kind::Text},
      {"samplers", Kind::Text, true},  {"depth", Kind::Number, true},
      {"spp", Kind::Number, true},     {"seeds", Kind::Number},
      {"resolution", Kind::Text},      {"time_budgets", Kind::Number, true},
      {"targets", Kind::Text, true},   {"reference", Kind::Text},
      {"reference_spp", Kind::Number}, {"reference_dir", Kind::Text},
      {"timing_spread", Kind::Number}, {"timing_repeats", Kind::Number},
      {"output", Kind::Text},          {"quiet", Kind::Switch},
      {"camera", Kind::Text},          {"environment", Kind::Text},
      {"environment_up", Kind::Text},  {"environment_scale", Kind::Number},
      {"compensate", Kind::Switch},    {"roulette_depth", Kind::Number},
      {"threads", Kind::Number},       {"width", Kind::TextOrNumber},
      {"lanes", Kind::Text},           {"traversal", Kind::Text},
      {"general", Kind::Switch},       {"isa", Kind::Text},
      {"clamp", Kind::Number},         {"intersection", Kind::Text},
  };
  return keys;
}

std::vector<ExperimentEntry> read_experiment(const std::string& path) {
  const toml::table table = parse_file(path);
  std::vector<ExperimentEntry> entries;
  for (const auto& [name, node] : table) {
    const ExperimentKey* key = key_named(name.str());
    if (!key) {
      throw error_at(path, int(name.source().begin.line), printable(unknown_key(name.str())));
    }
    entries.push_back(read_entry(path, *key, node));
  }
  std::sort(entries.begin(), entries.end(),
            [](const ExperimentEntry& a, const ExperimentEntry& b) { return a.line < b.line; });
  return entries;
}

std::string experiment_text(const std::vector<ExperimentEntry>& entries) {
  std::string text;
  for (const ExperimentEntry& entry : entries) {
    std::vector<std::string> values;
    for (const std::string& value : entry.values) {
      values.push_back(value_text(entry.key->kind, value));
    }
    const std::string joined = fmt::format("{}", fmt::join(values, ", "));
    text += entry.key->is_list ? fmt::format("{} = [{}]\n", entry.key->name, joined)
                               : fmt::format("{} = {}\n", entry.key->name, joined);
  }
  return text;
}

}  // namespace lockstep
