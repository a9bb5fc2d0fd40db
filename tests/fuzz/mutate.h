// Damaged copies of files, the same in every run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lockstep::fuzz {

// SplitMix64 (Steele, Lea and Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next();
  // 0 to below `end`; 0 where that is 0.
  std::size_t below(std::size_t end);

 private:
  std::uint64_t state_;
};

// `corpus[index]` after one to four of these: bytes flipped, a span deleted, doubled, moved or
// repeated many times, the end cut off, a span of another file put in, a number in the text or four
// bytes replaced by extreme ones. At most 256 KiB.
std::string mutated(const std::vector<std::string>& corpus, std::size_t index, Random& random);

}  // namespace lockstep::fuzz
