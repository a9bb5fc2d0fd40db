// The scenes that benchmarks render: built-in ones, and killeroo-quad from the `shared` folder beside
// the repository where there is one.
#pragma once

#include "core/scene.h"

#include <string>
#include <vector>

namespace lockstep {

std::vector<std::string> bench_scene_names();

// Built when first asked for, at a size that takes about a tenth of a second per sample; kept.
const Scene& bench_scene(const std::string& name);

}  // namespace lockstep
