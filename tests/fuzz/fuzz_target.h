// Code that reads what comes from outside, as libFuzzer calls it: bytes in, and nothing but the
// project's own errors may come out.
#pragma once

#include <cstddef>
#include <cstdint>

// Returns 0; prints what is wrong and aborts where own_errors.h says so. Each <name>_target.cpp
// defines it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
