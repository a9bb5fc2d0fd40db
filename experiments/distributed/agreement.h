// What all ranks of a run have to have in common.
#pragma once

#include "experiments/distributed/ranks.h"
#include "packets/render.h"

namespace lockstep {

// Instruction set and threads are rank 0's in all ranks: bits depend on the one, times on the
// other. Where no number of threads is given, ranks of one machine share its processors. Throws
// Error where this CPU cannot, or where rank 0 runs another version.
void agree(const Ranks& ranks, RenderSettings& settings);

}  // namespace lockstep
