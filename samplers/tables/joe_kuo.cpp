#include "samplers/joe_kuo.h"
#include "samplers/tables/tables.h"

#include <boost/random/sobol.hpp>

#include <bit>
#include <vector>

namespace lockstep {
namespace {

using Table = boost::random::default_sobol_table;

std::uint32_t mirrored(std::uint32_t x) {
  std::uint32_t y = 0;
  for (int bit = 0; bit < 32; ++bit) y |= (x >> bit & 1u) << (31 - bit);
  return y;
}

// The direction numbers of one dimension as fractions (Bratley and Fox 1988, eq. 2 and 3). The
// polynomial's bits are its coefficients, the highest power first.
void make_dimension(std::uint32_t polynomial, std::size_t number, std::uint32_t* columns) {
  const int degree = std::bit_width(polynomial) - 1;
  std::uint32_t m[32];
  for (int j = 0; j < degree && j < 32; ++j) m[j] = Table::minit(number, std::size_t(j));
  for (int j = degree; j < 32; ++j) {
    m[j] = m[j - degree] ^ (m[j - degree] << degree);
    for (int k = 1; k < degree; ++k) {
      if (polynomial >> (degree - k) & 1u) m[j] ^= m[j - k] << k;
    }
  }
  for (int j = 0; j < 32; ++j) columns[j] = mirrored(m[j] << (31 - j));
}

}  // namespace

std::vector<std::uint32_t> make_joe_kuo_matrices() {
  std::vector<std::uint32_t> all(joe_kuo_dimensions * 32);
  for (int j = 0; j < 32; ++j) all[std::size_t(j)] = 1u << j;  // van der Corput
  for (std::size_t d = 1; d < joe_kuo_dimensions; ++d) {
    make_dimension(Table::polynomial(d - 1), d - 1, all.data() + d * 32);
  }
  return all;
}

}  // namespace lockstep
