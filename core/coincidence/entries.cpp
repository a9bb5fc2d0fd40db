#include "core/coincidence/entries.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

namespace lockstep::coincidence {
namespace {

// Of a bucket, on average: so many fit the innermost caches.
constexpr std::size_t kBucketEntries = 2048;
// More buckets than this would be written to through too many pages at once.
constexpr int kMostBucketBits = 11;

// Of keys, by which entries are linked: chains are mostly of one entry or of one key.
constexpr int kMostLinkBits = 16;

// Stable, 11 bits of the key a pass.
void radix_sort(std::span<Entry> entries, std::vector<Entry>& scratch) {
  scratch.resize(entries.size());
  std::span<Entry> from = entries, to = scratch;
  for (int shift = 32; shift < 64; shift += 11) {
    std::array<std::size_t, 2048> next{};
    for (const Entry e : from) ++next[e >> shift & 2047];
    std::size_t sum = 0;
    for (std::size_t& n : next) sum += std::exchange(n, sum);
    for (const Entry e : from) to[next[e >> shift & 2047]++] = e;
    std::swap(from, to);
  }
  // The passes are odd in number: the last one left them in the scratch.
  std::copy(from.begin(), from.end(), to.begin());
}

}  // namespace

void sort_entries(std::span<Entry> entries, std::vector<Entry>& scratch) {
  constexpr std::size_t radix_pays = 4096;
  if (entries.size() < radix_pays) {
    std::sort(entries.begin(), entries.end());
  } else if (!std::is_sorted(entries.begin(), entries.end())) {
    radix_sort(entries, scratch);
  }
}

Buckets::Buckets(std::vector<std::vector<Entry>>& shares) {
  std::size_t total = 0;
  for (const std::vector<Entry>& share : shares) total += share.size();
  bits_ = std::min(static_cast<int>(std::bit_width(total / kBucketEntries)), kMostBucketBits);
  const std::size_t buckets = std::size_t{1} << bits_;
  const auto bucket_of = [shift = 64 - bits_](Entry e) { return shift < 64 ? e >> shift : 0; };

  // How many entries each share has for each bucket, then where it puts them.
  std::vector<std::vector<std::size_t>> places(shares.size());
  tbb::parallel_for(std::size_t{0}, shares.size(), [&](std::size_t i) {
    places[i].assign(buckets, 0);
    for (const Entry e : shares[i]) ++places[i][bucket_of(e)];
  });
  std::size_t sum = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    begins_.push_back(sum);
    for (std::vector<std::size_t>& place : places) sum += std::exchange(place[b], sum);
  }
  begins_.push_back(sum);

  entries_ = std::make_unique_for_overwrite<Entry[]>(total);
  tbb::parallel_for(std::size_t{0}, shares.size(), [&](std::size_t i) {
    for (const Entry e : shares[i]) entries_[places[i][bucket_of(e)]++] = e;
    shares[i] = {};
  });
}

void SharedKeys::link(std::span<const Entry> bucket, int common_bits) {
  const int width = static_cast<int>(std::bit_width(bucket.size())) + 1;
  shift_ = {common_bits, 64 - std::min(width, kMostLinkBits)};
  heads_.assign(std::size_t{1} << (64 - shift_.down), 0);
  next_.resize(bucket.size());
  for (std::size_t i = bucket.size(); i-- > 0;) {
    next_[i] = std::exchange(heads_[chain_of(bucket[i])], static_cast<std::uint32_t>(i + 1));
  }
  // Without branches, which could not be predicted.
  chains_.resize(bucket.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < bucket.size(); ++i) {
    chains_[count] = static_cast<std::uint32_t>(i + 1);
    count += (heads_[chain_of(bucket[i])] == i + 1) & (next_[i] != 0);
  }
  chains_.resize(count);
}

void SharedKeys::collect(std::span<const Entry> bucket, std::uint32_t head) {
  chain_.clear();
  const std::uint32_t key = key_of(bucket[head - 1]);
  bool one_key = true;
  for (std::uint32_t i = head; i != 0; i = next_[i - 1]) {
    chain_.push_back(bucket[i - 1]);
    one_key &= key_of(bucket[i - 1]) == key;
  }
  if (!one_key) std::sort(chain_.begin(), chain_.end());
}

}  // namespace lockstep::coincidence
