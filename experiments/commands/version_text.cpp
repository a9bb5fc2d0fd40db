#include "experiments/commands/version_text.h"

#include "experiments/output/machine.h"
#include "packets/isa.h"

#include <fmt/format.h>

namespace lockstep {
namespace {

template <class Predicate>
std::string isa_names(Predicate is_named) {
  std::string names;
  for (const Isa isa : all_isas) {
    if (is_named(isa)) names += fmt::format(" {}", name(isa));
  }
  return names.empty() ? " none" : names;
}

std::string compiler() {
  for (const auto& [component, number] : component_versions()) {
    if (component == "compiler") return number;
  }
  return "unknown";
}

}  // namespace

std::string version_text() {
  const std::string commit = *build_commit ? build_commit : "none: not built in a repository";
  const std::string type = *LOCKSTEP_BUILD_TYPE ? LOCKSTEP_BUILD_TYPE : "no build type";
  return fmt::format(
      "lockstep {}\n"
      "commit     {}\n"
      "compiler   {}, {}\n"
      "kernels   {}\n"
      "this CPU  {}, {}\n"
      "built with {}",
      version(), commit, compiler(), type, isa_names(is_compiled), isa_names(cpu_runs), cpu_name(),
      LOCKSTEP_LIBRARY_VERSIONS);
}

}  // namespace lockstep
