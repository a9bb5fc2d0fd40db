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

// Searches the groups of equal keys among sorted `entries`.
void search_groups(std::span<const Entry> entries, OverlapSearch& search) {
  for (std::size_t first = 0; first < entries.size();) {
    const std::uint32_t key = key_of(entries[first]);
    std::size_t end = first + 1;
    while (end < entries.size() && key_of(entries[end]) == key) ++end;
    if (end - first > 1) search.search(entries.subspan(first, end - first), axis_of_key(key));
    first = end;
  }
}

// Empty where no triangle overlaps another one.
std::vector<std::uint8_t> overlap_flags(const UnitMesh& mesh) {
  const Buckets buckets = bucketed_planes(mesh);
  std::vector<std::uint8_t> flags(mesh.count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, buckets.size()), [&](const auto& range) {
    OverlapSearch search(mesh, flags);
    std::vector<Entry> sorted;
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      sort_shared_keys(buckets[i], buckets.key_bits(), sorted);
      search_groups(sorted, search);
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
