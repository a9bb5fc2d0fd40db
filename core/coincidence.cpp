// Coincident triangles in three steps: keys of planes and places in them, buckets that bring
// triangles of equal keys together, and a search for overlaps in each group of equal keys.
#include "core/coincidence.h"

#include "core/coincidence/overlap_search.h"
#include "core/coincidence/plane_keys.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace lockstep {
namespace coincidence {
namespace {

// Threads take so many triangles at a time.
constexpr std::size_t kShare = 1 << 13;

Buckets bucketed_planes(const UnitMesh& mesh) {
  std::vector<std::vector<Entry>> shares((mesh.count + kShare - 1) / kShare);
  tbb::parallel_for(std::size_t{0}, shares.size(), [&](std::size_t i) {
    shares[i] = plane_entries(mesh, i * kShare, std::min((i + 1) * kShare, mesh.count));
  });
  return Buckets(shares);
}

// Empty where no triangle overlaps another one.
std::vector<std::uint8_t> overlap_flags(const UnitMesh& mesh) {
  const Buckets buckets = bucketed_planes(mesh);
  std::vector<std::uint8_t> flags(mesh.count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, buckets.size()), [&](const auto& range) {
    OverlapSearch search(mesh, flags);
    SharedKeys keys;
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      keys.for_each_group(buckets[i], buckets.key_bits(), [&](std::span<const Entry> group) {
        search.search(group, axis_of_key(key_of(group[0])));
      });
    }
  });
  if (std::find(flags.begin(), flags.end(), 1) == flags.end()) flags.clear();
  return flags;
}

}  // namespace
}  // namespace coincidence

std::vector<std::uint8_t> find_coincident_triangles(const float* positions,
                                                    const std::int32_t* triangles,
                                                    std::size_t count) {
  const coincidence::UnitMesh mesh = coincidence::unit_mesh(positions, triangles, count);
  if (mesh.scale == 0.0) return {};
  return coincidence::overlap_flags(mesh);
}

}  // namespace lockstep
