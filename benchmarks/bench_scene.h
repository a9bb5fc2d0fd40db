// The scenes that benchmarks render: built-in ones, and killeroo-quad from the `shared` folder
// beside the repository where there is one.
#pragma once

#include "core/scene.h"

#include <string>
#include <vector>

namespace lockstep {

// All of them.
std::vector<std::string> bench_scene_names();

// Those of `names` that are there.
std::vector<std::string> bench_scene_names(const std::vector<std::string>& names);

// Built when first asked for, and kept. `pixels` is the length of the image's longer side; at 342 a
// sample of every pixel takes about a tenth of a second.
const Scene& bench_scene(const std::string& name, int pixels = 342);

}  // namespace lockstep
