// A number that tells apart what was added to it.
#pragma once

#include <bit>
#include <cstdint>

namespace lockstep {

// FNV-1a, a word at a time.
class Fingerprint {
 public:
  void add(std::uint32_t word) {
    hash_ = (hash_ ^ word) * 0x100000001b3u;
    hash_ ^= hash_ >> 29;
  }
  void add(std::int32_t word) { add(std::uint32_t(word)); }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  template <class Values>
  void add_all(const Values& values) {
    add(std::uint32_t(values.size()));
    for (const auto value : values) add(value);
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace lockstep
