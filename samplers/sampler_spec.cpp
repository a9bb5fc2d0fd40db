#include "samplers/sampler_spec.h"

#include "core/error.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace lockstep {
namespace {

struct Preset {
  std::string_view summary, paper;
  SamplerSpec spec;
};

SamplerSpec preset(std::string name, bool shared, Sequence sequence, Perturbation perturbation,
                   WeightSource source) {
  SamplerSpec s;
  s.name = std::move(name);
  s.shared = shared;
  s.sequence = sequence;
  s.perturbation = perturbation;
  s.weight_source = source;
  return s;
}

const std::array<Preset, 4>& presets() {
  using enum Perturbation;
  static const std::array<Preset, 4> list{{
      {"independent random numbers in every pixel", "plain Monte Carlo",
       preset("random", false, Sequence::Random, None, WeightSource::Constant)},
      {"an Owen-scrambled Sobol sequence of its own in every pixel, padded in pairs",
       "Burley 2020, Practical Hash-based Owen Scrambling",
       preset("owen", false, Sequence::Owen, None, WeightSource::Constant)},
      {"one sequence for all pixels", "Sadeghi, Chen and Jensen 2009, Coherent Path Tracing",
       preset("cpt", true, Sequence::Owen, None, WeightSource::Constant)},
      {"one sequence, left by each pixel as far as its weight from a pilot image says",
       "Staal and Hachisuka, Randomized Coherent Sampling",
       preset("rcs", true, Sequence::Owen, Constant, WeightSource::Map)},
  }};
  return list;
}

// The words an option may take, in the order of their enum.
template <class E>
struct Choices;
template <>
struct Choices<Sequence> {
  static constexpr std::array<std::string_view, 2> words{"random", "owen"};
};
template <>
struct Choices<Perturbation> {
  static constexpr std::array<std::string_view, 3> words{"none", "fresh", "constant"};
};
template <>
struct Choices<WeightFilter> {
  static constexpr std::array<std::string_view, 3> words{"none", "gaussian", "median"};
};
template <>
struct Choices<Combine> {
  static constexpr std::array<std::string_view, 2> words{"add", "weight"};
};

template <class E>
std::string joined() {
  return fmt::format("{}", fmt::join(Choices<E>::words, ", "));
}

template <class E>
E parse_choice(std::string_view key, std::string_view value) {
  for (std::size_t i = 0; i < Choices<E>::words.size(); ++i) {
    if (Choices<E>::words[i] == value) return E(i);
  }
  throw UsageError(
      fmt::format("sampler option {}={} is unknown; choose from {}", key, value, joined<E>()));
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

// One option: its key, what it applies to, its text and how to set it.
struct Option {
  std::string_view key, values, meaning;
  bool map_only;  // says how the map of weights is made or used
  void (*set)(SamplerSpec&, std::string_view key, std::string_view value);
  std::string (*get)(const SamplerSpec&);
};

template <class E>
std::string word(E value) {
  return std::string(Choices<E>::words[size_t(value)]);
}
std::string number(float value) { return fmt::format("{}", value); }

const std::array<Option, 8>& options() {
  using S = SamplerSpec;
  using T = std::string_view;
  static const std::array<Option, 8> list{{
      {"sequence", "random|owen", "the sequence u_k", false,
       [](S& s, T k, T v) { s.sequence = parse_choice<Sequence>(k, v); },
       [](const S& s) { return word(s.sequence); }},
      {"offset", "none|fresh|constant",
       "the perturbation u_{i,k}: none, new for each k, or one per pixel", false,
       [](S& s, T k, T v) { s.perturbation = parse_choice<Perturbation>(k, v); },
       [](const S& s) { return word(s.perturbation); }},
      {"weight", "map|0..1", "w: a map from a pilot, or one number for all pixels", false,
       [](S& s, T k, T v) {
         s.weight_source = v == "map" ? WeightSource::Map : WeightSource::Constant;
         if (v != "map") s.weight = parse_number(k, v);
       },
       [](const S& s) { return s.weight_source == WeightSource::Map ? "map" : number(s.weight); }},
      {"c", "number", "the map: w = min(1, c d) for relative difference d", true,
       [](S& s, T k, T v) { s.c = parse_number(k, v); }, [](const S& s) { return number(s.c); }},
      {"t", "number", "the map: w = 0 where d < t", true,
       [](S& s, T k, T v) { s.t = parse_number(k, v); }, [](const S& s) { return number(s.t); }},
      {"filter", "none|gaussian|median", "of the pilot, before differences are taken", true,
       [](S& s, T k, T v) { s.filter = parse_choice<WeightFilter>(k, v); },
       [](const S& s) { return word(s.filter); }},
      {"pilot", "samples", "of the spp, taken by the pilot; 0: a quarter, at least 1", true,
       [](S& s, T k, T v) { s.pilot = parse_count(k, v); },
       [](const S& s) { return fmt::format("{}", s.pilot); }},
      {"combine", "add|weight", "pilot and coherent image: by samples, or by w (biased)", true,
       [](S& s, T k, T v) { s.combine = parse_choice<Combine>(k, v); },
       [](const S& s) { return word(s.combine); }},
  }};
  return list;
}

const Preset& find_preset(std::string_view name) {
  std::string known;
  for (const Preset& p : presets()) {
    if (p.spec.name == name) return p;
    known += (known.empty() ? "" : ", ") + p.spec.name;
  }
  throw UsageError(fmt::format("unknown sampler '{}'; choose from {}", name, known));
}

const Option& apply_option(SamplerSpec& spec, std::string_view item) {
  const std::size_t equals = item.find('=');
  if (equals == std::string_view::npos) {
    throw UsageError(fmt::format("sampler option '{}' needs the form key=value", item));
  }
  const std::string_view key = item.substr(0, equals), value = item.substr(equals + 1);
  for (const Option& option : options()) {
    if (option.key != key) continue;
    if (!spec.shared) {
      throw UsageError(
          fmt::format("sampler {} has no option {}: its pixels share no sequence", spec.name, key));
    }
    option.set(spec, key, value);
    return option;
  }
  std::string known;
  for (const Option& option : options()) known += fmt::format(" {}", option.key);
  throw UsageError(fmt::format("unknown sampler option '{}'; choose from{}", key, known));
}

}  // namespace

SamplerSpec parse_sampler(std::string_view text) {
  const std::size_t colon = text.find(':');
  SamplerSpec spec = find_preset(text.substr(0, colon)).spec;
  if (colon == std::string_view::npos) return spec;
  std::string_view rest = text.substr(colon + 1), map_option;
  while (true) {
    const std::size_t comma = rest.find(',');
    if (apply_option(spec, rest.substr(0, comma)).map_only) map_option = rest.substr(0, comma);
    if (comma == std::string_view::npos) break;
    rest = rest.substr(comma + 1);
  }
  if (spec.weight_source != WeightSource::Map && !map_option.empty()) {
    throw UsageError(
        fmt::format("{}: {} has no effect without a map; set weight=map", text, map_option));
  }
  if (spec.weight_source == WeightSource::Map && spec.perturbation == Perturbation::None) {
    throw UsageError(
        fmt::format("{}: a weight map needs an offset to weigh; set offset=fresh", text));
  }
  if (spec.perturbation == Perturbation::None &&
      spec.weight != find_preset(spec.name).spec.weight) {
    throw UsageError(fmt::format("{}: a weight needs an offset to weigh; set offset=fresh", text));
  }
  if (spec.weight_source == WeightSource::Constant && spec.weight > 1.0f) {
    throw UsageError(fmt::format("{}: weight lies in [0, 1]; 1 is already independent", text));
  }
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

std::string sampler_help() {
  std::string text;
  for (const Preset& p : presets()) {
    text += fmt::format("  {:<8} {}\n           ({})\n", p.spec.name, p.summary, p.paper);
    if (!p.spec.shared) continue;
    std::string defaults;
    const bool map = p.spec.weight_source == WeightSource::Map;
    for (const Option& o : options()) {
      if (map || !o.map_only) defaults += fmt::format(" {}={}", o.key, o.get(p.spec));
    }
    text += fmt::format("           defaults:{}\n", defaults);
  }
  text += "\nOptions of samplers that share a sequence, as in rcs:c=4,offset=constant\n";
  for (const Option& o : options()) {
    text += fmt::format("  {:<8} {:<20} {}\n", o.key, o.values, o.meaning);
  }
  text +=
      "\nAs published: cpt:sequence=random and rcs:sequence=random,offset=fresh. The defaults keep "
      "a\n"
      "low-discrepancy sequence's stratification and have less error at equal time.\n";
  return text;
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
