// The end of a run on several ranks.
#pragma once

#include "experiments/distributed/desk.h"

namespace lockstep {

// For rank 0, when all results are written: lets the others go and ends MPI. Where one does not
// answer, says so and ends all by force, with status 1.
void end_ranks(Desk& desk);

}  // namespace lockstep
