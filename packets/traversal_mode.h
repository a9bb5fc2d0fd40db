// How rays go through Embree: which of its calls, and which context flag. A mode decides how fast
// rays are traced, never what they hit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lockstep {

// rtcIntersect1/4/8/16, rtcIntersect1M over single rays, rtcIntersectNM over packets of 16; and
// rtcOccluded... alike. Embree 4 has no streams: the last two are not modes there.
enum class Packets : std::uint8_t { Single, Four, Eight, Sixteen, Stream1M, StreamNM };

struct TraversalMode {
  Packets packets = Packets::Single;
  bool coherent = false;  // Embree's context flag; single rays are traced alike with either

  bool operator==(const TraversalMode&) const = default;
};

inline constexpr bool has_streams = LOCKSTEP_EMBREE_MAJOR < 4;
inline constexpr int traversal_modes = has_streams ? 12 : 8;

constexpr int index(TraversalMode mode) { return 2 * int(mode.packets) + int(mode.coherent); }
constexpr TraversalMode traversal_mode(int index) { return {Packets(index / 2), index % 2 == 1}; }

// Lanes of a packet; 1 for single rays and their streams.
constexpr int lanes(Packets packets) {
  constexpr int of[] = {1, 4, 8, 16, 1, 16};
  return of[int(packets)];
}

// "single", "packet8", "packet8-coherent", "stream1m", "streamnm-coherent" and the like.
std::string to_string(TraversalMode mode);

// A mode by its name; nothing for "auto". Throws UsageError.
std::optional<TraversalMode> parse_traversal(std::string_view text);

enum class RayKind : std::uint8_t { Camera, Bounce, Shadow };
inline constexpr int ray_kinds = 3;

}  // namespace lockstep
