#include "experiments/distributed/agreement.h"

#include "core/error.h"
#include "experiments/output/machine.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <thread>

namespace lockstep {
namespace {

// All that this process may use, which a launcher may have chosen for each rank; where it has not,
// the ranks of a machine share.
int own_threads(const Ranks& ranks) {
  const int all = int(std::max(1u, std::thread::hardware_concurrency()));
  const int own = cpu_count();
  return own < all ? own : std::max(1, all / ranks.on_node);
}

}  // namespace

void agree(const Ranks& ranks, RenderSettings& settings) {
  if (ranks.count == 1) return;
  if (settings.threads == 0) settings.threads = own_threads(ranks);
  const nlohmann::json own = {
      {"isa", name(settings.isa)}, {"threads", settings.threads}, {"version", version()}};
  const auto first = nlohmann::json::parse(text_of_rank_0(own.dump()));
  if (first.at("version") != own.at("version")) {
    throw Error(fmt::format("version {}, but rank 0 runs {}; start the same program everywhere",
                            version(), first.at("version").get<std::string>()));
  }
  const auto isa = first.at("isa").get<std::string>();
  const std::vector<Isa> available = available_isas();
  if (std::none_of(available.begin(), available.end(), [&](Isa i) { return name(i) == isa; })) {
    throw Error(fmt::format("{} has no {}, which rank 0 renders with; give --isa {}", cpu_name(),
                            isa, name(available.back())));
  }
  settings.isa = choose_isa(isa);
  settings.threads = first.at("threads");
}

}  // namespace lockstep
