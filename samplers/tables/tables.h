// The samplers' tables, which make_tables.cpp computes while the program is built: rendering pays
// nothing for them.
#pragma once

#include <cstdint>
#include <vector>

namespace lockstep {

std::vector<std::uint32_t> make_blue_noise_mask();   // samplers/blue_noise_mask.h
std::vector<std::uint32_t> make_joe_kuo_matrices();  // samplers/joe_kuo.h
std::vector<std::uint32_t> make_pmj02_table();       // samplers/pmj02_table.h
std::vector<std::uint32_t> make_primes();            // samplers/primes.h

}  // namespace lockstep
