#include "samplers/sampler_spec.h"

#include "core/error.h"
#include "samplers/added.h"
#include "samplers/presets.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace lockstep {
namespace {

// The words an option may take, in the order of their enum.
template <class E>
std::vector<std::string_view> words();
template <>
std::vector<std::string_view> words<Share>() {
  return {"pixel", "tile", "image"};
}
template <>
std::vector<std::string_view> words<Mix>() {
  return {"add", "xor"};
}
template <>
std::vector<std::string_view> words<WeightFilter>() {
  return {"none", "gaussian", "median"};
}
template <>
std::vector<std::string_view> words<Combine>() {
  return {"add", "weight"};
}
template <>
std::vector<std::string_view> words<SequenceId>() {
  std::vector<std::string_view> names;
  for (const SequenceInfo& info : sequence_infos()) names.push_back(info.name);
  return names;
}
template <>
std::vector<std::string_view> words<PerturbationId>() {
  std::vector<std::string_view> names;
  for (const PerturbationInfo& info : perturbation_infos()) names.push_back(info.name);
  return names;
}

template <class E>
E parse_choice(std::string_view key, std::string_view value) {
  const auto choices = words<E>();
  const auto found = std::find(choices.begin(), choices.end(), value);
  if (found != choices.end()) return E(found - choices.begin());
  throw UsageError(fmt::format("sampler option {}={} is unknown; choose from {}", key, value,
                               fmt::join(choices, ", ")));
}

float parse_number(std::string_view key, std::string_view value) {
  float x = 0.0f;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), x);
  if (error != std::errc() || end != value.data() + value.size() || !(x >= 0.0f)) {
    throw UsageError(fmt::format("sampler option {}={} needs a number of at least 0", key, value));
  }
  return x;
}

int parse_count(std::string_view key, std::string_view value) {
  const float x = parse_number(key, value);
  if (x != std::floor(x) || x > 65536.0f) {
    throw UsageError(
        fmt::format("sampler option {}={} needs a whole number of at most 65536", key, value));
  }
  return int(x);
}

// What an option needs to have an effect.
enum class Needs { Nothing, Sharing, Pilot, Map };

// One option: its key, what it takes, what it does, how to set it and its text.
struct Option {
  std::string_view key;
  std::string values;
  std::string_view meaning;
  Needs needs;
  void (*set)(SamplerSpec&, std::string_view key, std::string_view value);
  std::string (*get)(const SamplerSpec&);
};

template <class E>
std::string word(E value) {
  return std::string(words<E>()[size_t(value)]);
}
template <class E>
std::string alternatives() {
  return fmt::format("{}", fmt::join(words<E>(), "|"));
}
std::string number(float value) { return fmt::format("{}", value); }

void set_weight(SamplerSpec& s, std::string_view key, std::string_view value) {
  using enum WeightSource;
  s.weight_source = value == "map"     ? Map
                    : value == "auto"  ? Auto
                    : value == "cells" ? Cells
                                       : Constant;
  if (s.weight_source == Constant) s.weight = parse_number(key, value);
}
std::string get_weight(const SamplerSpec& s) {
  switch (s.weight_source) {
    case WeightSource::Map:
      return "map";
    case WeightSource::Auto:
      return "auto";
    case WeightSource::Cells:
      return "cells";
    case WeightSource::Constant:
      break;
  }
  return number(s.weight);
}
void set_interleave(SamplerSpec& s, std::string_view key, std::string_view value) {
  s.interleave = parse_count(key, value);
  if (s.interleave != 1 && s.interleave != 2 && s.interleave != 4) {
    throw UsageError(fmt::format("sampler option {}={} must be 1, 2 or 4", key, value));
  }
}

const std::vector<Option>& options() {
  using S = SamplerSpec;
  using T = std::string_view;
  static const std::vector<Option> list{
      {"sequence", alternatives<SequenceId>(), "the sequence u_k", Needs::Nothing,
       [](S& s, T k, T v) { s.sequence = parse_choice<SequenceId>(k, v); },
       [](const S& s) { return word(s.sequence); }},
      {"share", alternatives<Share>(),
       "whose sequence it is: each pixel's, each tile's, everyone's", Needs::Nothing,
       [](S& s, T k, T v) { s.share = parse_choice<Share>(k, v); },
       [](const S& s) { return word(s.share); }},
      {"pairs", "number", "pairs of dimensions that are shared, from the first; 0: all",
       Needs::Sharing, [](S& s, T k, T v) { s.pairs = parse_count(k, v); },
       [](const S& s) { return fmt::format("{}", s.pairs); }},
      {"interleave", "1|2|4", "n: n x n sequences, pixels n apart share", Needs::Sharing,
       set_interleave, [](const S& s) { return fmt::format("{}", s.interleave); }},
      {"offset", alternatives<PerturbationId>(), "u_{i,k}, by which a pixel leaves the sequence",
       Needs::Sharing, [](S& s, T k, T v) { s.perturbation = parse_choice<PerturbationId>(k, v); },
       [](const S& s) { return word(s.perturbation); }},
      {"mix", alternatives<Mix>(), "how: u_k + w u_{i,k}, or only digits below w, by XOR",
       Needs::Sharing, [](S& s, T k, T v) { s.mix = parse_choice<Mix>(k, v); },
       [](const S& s) { return word(s.mix); }},
      {"weight", "map|auto|cells|0..1",
       "w: a map from a pilot by c and t, or by its noise; the cells' side; a number",
       Needs::Sharing, set_weight, get_weight},
      {"c", "number", "the map: w = min(1, c d) for relative difference d", Needs::Map,
       [](S& s, T k, T v) { s.c = parse_number(k, v); }, [](const S& s) { return number(s.c); }},
      {"t", "number", "the map: w = 0 where d < t", Needs::Map,
       [](S& s, T k, T v) { s.t = parse_number(k, v); }, [](const S& s) { return number(s.t); }},
      {"filter", alternatives<WeightFilter>(), "of the pilot, before differences are taken",
       Needs::Map, [](S& s, T k, T v) { s.filter = parse_choice<WeightFilter>(k, v); },
       [](const S& s) { return word(s.filter); }},
      {"pilot", "samples", "of the spp, taken by the pilot; 0: a quarter, at least 1", Needs::Pilot,
       [](S& s, T k, T v) { s.pilot = parse_count(k, v); },
       [](const S& s) { return fmt::format("{}", s.pilot); }},
      {"combine", alternatives<Combine>(), "pilot and coherent image: by samples, or by w (biased)",
       Needs::Pilot, [](S& s, T k, T v) { s.combine = parse_choice<Combine>(k, v); },
       [](const S& s) { return word(s.combine); }},
  };
  return list;
}

const Option& apply_option(SamplerSpec& spec, std::string_view item) {
  const std::size_t equals = item.find('=');
  if (equals == std::string_view::npos) {
    throw UsageError(fmt::format("sampler option '{}' needs the form key=value", item));
  }
  const std::string_view key = item.substr(0, equals), value = item.substr(equals + 1);
  std::string known;
  for (const Option& option : options()) {
    if (option.key == key) {
      option.set(spec, key, value);
      return option;
    }
    known += fmt::format(" {}", option.key);
  }
  throw UsageError(fmt::format("unknown sampler option '{}'; choose from{}", key, known));
}

// The options whose needs are not met by the others.
void check_needs(const SamplerSpec& spec, std::string_view text, const Option& option,
                 std::string_view item) {
  const bool map = spec.weight_source == WeightSource::Map;
  const char* remedy = option.needs >= Needs::Sharing && !spec.shared()
                           ? "without a shared sequence; set share=image"
                       : option.needs == Needs::Map && !map ? "without a map; set weight=map"
                       : option.needs == Needs::Pilot && !spec.has_pilot()
                           ? "without a pilot; set weight=map or weight=auto"
                           : nullptr;
  if (remedy) throw UsageError(fmt::format("{}: {} has no effect {}", text, item, remedy));
}

void check_weight(const SamplerSpec& spec, std::string_view text) {
  const bool moves = spec.perturbation != PerturbationId{};
  const SamplerSpec& base = find_preset(spec.name).spec;
  if (!moves && spec.has_pilot()) {
    throw UsageError(
        fmt::format("{}: a weight map needs an offset to weigh; set offset=constant", text));
  }
  if (!moves && (spec.weight != base.weight || spec.weight_source == WeightSource::Cells)) {
    throw UsageError(
        fmt::format("{}: a weight needs an offset to weigh; set offset=constant", text));
  }
  if (spec.weight_source == WeightSource::Constant && spec.weight > 1.0f) {
    throw UsageError(fmt::format("{}: weight lies in [0, 1]; 1 is already independent", text));
  }
}

}  // namespace

SamplerSpec parse_sampler(std::string_view text) {
  const std::size_t colon = text.find(':');
  SamplerSpec spec = find_preset(text.substr(0, colon)).spec;
  if (colon == std::string_view::npos) return spec;
  std::string_view rest = text.substr(colon + 1);
  std::vector<std::pair<const Option*, std::string_view>> given;
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string_view item = rest.substr(0, comma);
    given.emplace_back(&apply_option(spec, item), item);
    if (comma == std::string_view::npos) break;
    rest = rest.substr(comma + 1);
  }
  for (const auto& [option, item] : given) check_needs(spec, text, *option, item);
  check_weight(spec, text);
  return spec;
}

std::string to_string(const SamplerSpec& spec) {
  const SamplerSpec& base = find_preset(spec.name).spec;
  std::string text = spec.name;
  char separator = ':';
  for (const Option& option : options()) {
    const std::string value = option.get(spec);
    if (value == option.get(base)) continue;
    text += fmt::format("{}{}={}", separator, option.key, value);
    separator = ',';
  }
  return text;
}

std::vector<std::string> sampler_names() {
  std::vector<std::string> names;
  for (const Preset& p : presets()) names.push_back(p.spec.name);
  return names;
}

std::vector<SamplerOption> sampler_options() {
  std::vector<SamplerOption> list;
  for (const Option& option : options()) list.push_back({std::string(option.key), option.values});
  return list;
}

std::string sampler_help() {
  std::string text;
  for (const Preset& p : presets()) {
    text += fmt::format("  {:<10} {}\n             ({})\n", p.spec.name, p.summary, p.paper);
    if (!p.spec.shared()) continue;
    std::string defaults;
    for (const Option& o : options()) {
      const bool used = o.needs == Needs::Map     ? p.spec.weight_source == WeightSource::Map
                        : o.needs == Needs::Pilot ? p.spec.has_pilot()
                                                  : true;
      if (used) defaults += fmt::format(" {}={}", o.key, o.get(p.spec));
    }
    text += fmt::format("             defaults:{}\n", defaults);
  }
  text += "\nOptions, as in rcs:c=4,offset=fresh; all but the first two need a shared sequence\n";
  for (const Option& o : options()) {
    text += fmt::format("  {:<10} {}\n             {}\n", o.key, o.meaning, o.values);
  }
  text += "\nOffsets\n";
  for (const PerturbationInfo& o : perturbation_infos()) {
    text += fmt::format("  {:<10} {}\n             ({})\n", o.name, o.summary, o.paper);
  }
  text +=
      "\nAs published: cpt:sequence=random and rcs:sequence=random,offset=fresh. The defaults keep "
      "a\n"
      "low-discrepancy sequence's stratification and have less error at equal time.\n";
  return text;
}

SequenceId sequence_named(std::string_view name) {
  return parse_choice<SequenceId>("sequence", name);
}
PerturbationId perturbation_named(std::string_view name) {
  return parse_choice<PerturbationId>("offset", name);
}
std::string_view name(SequenceId sequence) { return words<SequenceId>()[size_t(sequence)]; }
std::string_view name(PerturbationId perturbation) {
  return words<PerturbationId>()[size_t(perturbation)];
}

bool is_planned(const SamplerSpec& spec) {
  return sequence_infos()[size_t(spec.sequence)].planned ||
         spec.weight_source == WeightSource::Cells;
}

std::vector<std::string> split_sampler_list(std::string_view list) {
  std::vector<std::string> result;
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    const std::string_view item = list.substr(0, comma);
    // "c=4" belongs to the sampler before it; "rcs:c=4" begins one.
    const bool begins = item.find(':') < item.find('=') || item.find('=') == std::string_view::npos;
    if (begins || result.empty()) {
      result.emplace_back(item);
    } else {
      result.back().append(",").append(item);
    }
    if (comma == list.size() - 1) result.emplace_back();  // an empty item, for the parser to refuse
    list = comma == std::string_view::npos ? std::string_view{} : list.substr(comma + 1);
  }
  return result;
}

}  // namespace lockstep
