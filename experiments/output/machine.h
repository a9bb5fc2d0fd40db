// What a figure was measured on, and when.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lockstep {

std::string_view version();
std::string embree_version();  // that the program is built with, and what it lacks
std::string cpu_name();
int cpu_count();                    // logical processors this process may use
std::string system_name();          // kernel and architecture
std::string date_and_time();        // local, ISO 8601 with the offset from UTC
std::uint64_t peak_memory_bytes();  // of this process so far, resident

// Names and versions of what results may depend on beside this program: compiler and libraries.
std::vector<std::pair<std::string, std::string>> component_versions();

}  // namespace lockstep
