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

// The groups of equal keys in a bucket, found by chains of entries whose keys agree in some bits:
// fewer steps than sorting takes, as most chains hold one entry or one key. Holds memory to reuse.
class SharedKeys {
 public:
  // Calls f(group) for the entries of each key that several of `bucket` have, in their order. Of
  // the keys, which should be hashes, the first `common_bits` are all alike.
  template <class F>
  void for_each_group(std::span<const Entry> bucket, int common_bits, const F& f) {
    link(bucket, common_bits);
    for (const std::uint32_t head : chains_) {
      collect(bucket, head);
      for (std::size_t first = 0, end = 0; first < chain_.size(); first = end) {
        const std::uint32_t key = key_of(chain_[first]);
        while (end < chain_.size() && key_of(chain_[end]) == key) ++end;
        if (end - first > 1) f(std::span<const Entry>(&chain_[first], end - first));
      }
    }
  }

 private:
  struct Shift {
    int up, down;
  };

  std::size_t chain_of(Entry e) const { return e << shift_.up >> shift_.down; }
  void link(std::span<const Entry> bucket, int common_bits);
  void collect(std::span<const Entry> bucket, std::uint32_t head);

  Shift shift_{};
  std::vector<std::uint32_t> heads_, next_;  // 1 + an index into the bucket; 0: none
  std::vector<std::uint32_t> chains_;        // heads of those with several entries
  std::vector<Entry> chain_;                 // sorted by key
};

}  // namespace lockstep::coincidence
