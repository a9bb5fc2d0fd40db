#include "packets/traversal_mode.h"

#include "core/error.h"

#include <fmt/format.h>

namespace lockstep {
namespace {

constexpr std::string_view names[] = {"single",   "packet4",  "packet8",
                                      "packet16", "stream1m", "streamnm"};
constexpr std::string_view coherent_suffix = "-coherent";

}  // namespace

std::string to_string(TraversalMode mode) {
  return fmt::format("{}{}", names[int(mode.packets)], mode.coherent ? coherent_suffix : "");
}

std::optional<TraversalMode> parse_traversal(std::string_view text) {
  if (text == "auto") return std::nullopt;
  TraversalMode mode;
  std::string_view rest = text;
  if (rest.ends_with(coherent_suffix)) {
    mode.coherent = true;
    rest.remove_suffix(coherent_suffix.size());
  }
  for (int i = 0; i < int(std::size(names)); ++i) {
    if (rest != names[i]) continue;
    mode.packets = Packets(i);
    if (mode == TraversalMode{Packets::Single, true}) break;
    if (index(mode) < traversal_modes) return mode;
    throw UsageError(fmt::format(
        "--traversal {}: Embree 4 has no streams of rays, and this program is built with it; "
        "choose auto, single, packet4, packet8 or packet16",
        text));
  }
  throw UsageError(fmt::format(
      "--traversal: '{}' is not auto, single, or one of packet4, packet8, packet16, stream1m and "
      "streamnm, each with or without -coherent",
      text));
}

}  // namespace lockstep
