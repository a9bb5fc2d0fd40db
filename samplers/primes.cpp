#include "samplers/primes.h"

#include <vector>

namespace lockstep {

const std::uint32_t* halton_primes() {
  static const std::vector<std::uint32_t> primes = [] {
    std::vector<std::uint32_t> found;
    for (std::uint32_t n = 2; found.size() < std::size_t(halton_dimensions); ++n) {
      bool prime = true;
      for (std::size_t i = 0; prime && i < found.size() && found[i] * found[i] <= n; ++i) {
        prime = n % found[i] != 0;
      }
      if (prime) found.push_back(n);
    }
    return found;
  }();
  return primes.data();
}

}  // namespace lockstep
