// Keyed indices: what brings together things of equal keys.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lockstep::coincidence {

// Something to sort: the key in the upper 32 bits, an index in the lower ones.
using Entry = std::uint64_t;

constexpr Entry make_entry(std::uint32_t key, std::size_t index) {
  return Entry{key} << 32 | static_cast<std::uint32_t>(index);
}
constexpr std::uint32_t key_of(Entry e) { return static_cast<std::uint32_t>(e >> 32); }
constexpr std::uint32_t index_of(Entry e) { return static_cast<std::uint32_t>(e); }

// Sorts by key and then index; expects entries of equal keys in the order of their indices.
// `scratch` is memory to reuse.
void sort_entries(std::span<Entry> entries, std::vector<Entry>& scratch);

// Entries in buckets by the upper bits of their keys, which should be hashes: buckets are then much
// of one size.
class Buckets {
 public:
  // Empties the shares, each a part of the whole in its order; buckets keep the order.
  explicit Buckets(std::vector<std::vector<Entry>>& shares);

  std::size_t size() const { return begins_.size() - 1; }
  int key_bits() const { return bits_; }  // that the entries of a bucket have in common
  std::span<Entry> operator[](std::size_t bucket) const {
    return {entries_.get() + begins_[bucket], entries_.get() + begins_[bucket + 1]};
  }

 private:
  int bits_ = 0;
  std::unique_ptr<Entry[]> entries_;
  std::vector<std::size_t> begins_;  // of each bucket, and the end
};

// Sorts the entries of a bucket by key and leaves out those whose key no other one has, or nearly
// all of them. Of the keys, which should be hashes, the first `common_bits` are all alike. The
// result is in `sorted`, memory to reuse.
void sort_shared_keys(std::span<const Entry> bucket, int common_bits, std::vector<Entry>& sorted);

}  // namespace lockstep::coincidence
