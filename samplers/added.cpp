#include "samplers/added.h"

#include "core/error.h"
#include "samplers/perturbations.h"
#include "samplers/presets.h"
#include "samplers/sequences.h"

#include <fmt/format.h>

#include <algorithm>

namespace lockstep {
namespace {

constexpr std::size_t most = 256;  // that an Id tells apart

void check_name(std::string_view kind, std::string_view name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
  if (plain && !name.empty()) return;
  throw Error(fmt::format("the added {} '{}' needs a name of lower-case letters, digits, - and _",
                          kind, name));
}

[[noreturn]] void throw_taken(std::string_view kind, std::string_view name) {
  throw Error(
      fmt::format("there is a {} '{}' already; give the added one another name", kind, name));
}

template <class Info>
struct Registry {
  std::vector<Info> infos;
  std::size_t own;                        // infos that are the library's
  std::vector<PointsFunction> functions;  // of the others

  template <class List>
  explicit Registry(const List& list) : infos(list.begin(), list.end()), own(list.size()) {}

  PointsFunction function(std::size_t place) const {
    return place < own ? nullptr : functions.at(place - own);
  }

  void add(std::string_view kind, const Info& info, PointsFunction points) {
    check_name(kind, info.name);
    for (const Info& other : infos) {
      if (other.name == info.name) throw_taken(kind, info.name);
    }
    if (infos.size() == most) {
      throw Error(fmt::format("{}: there are {} {}s already, no more fit", info.name, most, kind));
    }
    infos.push_back(info);
    functions.push_back(points);
  }
};

Registry<SequenceInfo>& sequences() {
  static Registry<SequenceInfo> registry(Sequences::infos());
  return registry;
}

Registry<PerturbationInfo>& perturbations() {
  static Registry<PerturbationInfo> registry(Perturbations::infos());
  return registry;
}

}  // namespace

void check_sampler_name(std::string_view name) {
  check_name("sampler", name);
  for (const Preset& preset : presets()) {
    if (preset.spec.name == name) throw_taken("sampler", name);
  }
}

void add_sequence(const SequenceInfo& info, PointsFunction points) {
  check_sampler_name(info.name);
  sequences().add("sequence", info, points);
  add_preset(preset_of(info));
}

void add_perturbation(const PerturbationInfo& info, PointsFunction offsets) {
  perturbations().add("offset", info, offsets);
}

const std::vector<SequenceInfo>& sequence_infos() { return sequences().infos; }
const std::vector<PerturbationInfo>& perturbation_infos() { return perturbations().infos; }

PointsFunction added_points(SequenceId sequence) {
  return sequences().function(std::size_t(sequence));
}
PointsFunction added_offsets(PerturbationId perturbation) {
  return perturbations().function(std::size_t(perturbation));
}

}  // namespace lockstep
