// How a packet's lanes map to pixels and samples.
#pragma once

#include <string>
#include <string_view>

namespace lockstep {

// x * y pixels, `samples` of each.
struct LaneLayout {
  int x = 4;
  int y = 4;
  int samples = 1;

  bool operator==(const LaneLayout&) const = default;
};

// "XxYxS", powers of two whose product is at most 256. Throws UsageError.
LaneLayout parse_lane_layout(std::string_view text);

// "4x4x1" and the like.
std::string to_string(const LaneLayout& lanes);

}  // namespace lockstep
