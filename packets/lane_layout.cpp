#include "packets/lane_layout.h"

#include "core/error.h"
#include "packets/kernel.h"

#include <fmt/format.h>

#include <charconv>

namespace lockstep {
namespace {

int parse_extent(std::string_view text, std::string_view part) {
  int value = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (error != std::errc() || end != part.data() + part.size() || value < 1 || value > 256 ||
      (value & (value - 1)) != 0) {
    throw UsageError(fmt::format(
        "lane layout '{}' needs the form XxYxS in powers of two, such as 4x4x1 or 1x1x16", text));
  }
  return value;
}

}  // namespace

LaneLayout parse_lane_layout(std::string_view text) {
  const std::size_t first = text.find('x');
  const std::size_t second = first == std::string_view::npos ? first : text.find('x', first + 1);
  if (second == std::string_view::npos) parse_extent(text, "");
  const LaneLayout lanes{parse_extent(text, text.substr(0, first)),
                         parse_extent(text, text.substr(first + 1, second - first - 1)),
                         parse_extent(text, text.substr(second + 1))};
  if (lanes.x > tile_size || lanes.y > tile_size || lanes.x * lanes.y * lanes.samples > 256) {
    throw UsageError(
        fmt::format("lane layout '{}' is too large: at most {}x{} pixels and 256 lanes", text,
                    tile_size, tile_size));
  }
  return lanes;
}

std::string to_string(const LaneLayout& lanes) {
  return fmt::format("{}x{}x{}", lanes.x, lanes.y, lanes.samples);
}

}  // namespace lockstep
