// The directives of pbrt-v2, v3 and v4: one small function each, found by name in one table.
#pragma once

#include "core/pbrt/state.h"

#include <string>

namespace lockstep::pbrt {

// Carries out every directive of a file. `from` is the directive that includes it.
void read_file(State& state, const std::string& path, const Location& from);

}  // namespace lockstep::pbrt
