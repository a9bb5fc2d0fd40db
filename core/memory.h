// How much memory there is, so that what cannot fit is refused before any of it is taken.
#pragma once

#include <cstdint>
#include <string>

namespace lockstep {

// Bytes that this process may still take: what the system has left, swap included, within the
// limits of ulimit -v and of the process's control group.
std::uint64_t available_memory();

// Bytes of address space that this process has taken, and those that ulimit -v leaves it; more than
// any machine has where there is no such limit.
std::uint64_t used_address_space();
std::uint64_t left_address_space();

// Throws Error where `bytes` are more than that: "WHAT needs 40.0 GiB of memory, and 7.5 GiB are
// left; ADVICE".
void require_memory(double bytes, const std::string& what, const std::string& advice);

}  // namespace lockstep
