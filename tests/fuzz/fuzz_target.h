// One reader of scenes as libFuzzer calls it: bytes in, and nothing but the project's own errors
// may come out.
#pragma once

#include <cstddef>
#include <cstdint>

// Returns 0. Prints what is wrong and aborts where the reader throws anything else than Error or
// UsageError, where their text is not one line, and where a scene that is accepted cannot be used:
// see digest.h. Which reader it is, LOCKSTEP_FUZZ_FORMAT says when it is compiled.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
