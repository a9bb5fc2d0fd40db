#include "samplers/primes.h"
#include "samplers/tables/tables.h"

namespace lockstep {

std::vector<std::uint32_t> make_primes() {
  std::vector<std::uint32_t> primes;
  for (std::uint32_t n = 2; primes.size() < std::size_t(halton_dimensions); ++n) {
    bool prime = true;
    for (std::size_t i = 0; prime && i < primes.size() && primes[i] * primes[i] <= n; ++i) {
      prime = n % primes[i] != 0;
    }
    if (prime) primes.push_back(n);
  }
  return primes;
}

}  // namespace lockstep
