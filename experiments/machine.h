// What a figure was measured on, and when.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace lockstep {

std::string_view version();
std::string cpu_name();
int cpu_count();                    // logical processors this process may use
std::string date_and_time();        // local, ISO 8601 with the offset from UTC
std::uint64_t peak_memory_bytes();  // of this process so far, resident

}  // namespace lockstep
