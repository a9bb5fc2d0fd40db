// Compiled per instruction set, width and set of features: LOCKSTEP_WIDTH lanes for scenes with
// LOCKSTEP_FEATURES at most, exported as LOCKSTEP_KERNEL.
#include "packets/feature_sets.h"
#include "packets/path.h"

namespace lockstep {

extern const Kernel LOCKSTEP_KERNEL;
const Kernel LOCKSTEP_KERNEL{Isa::LOCKSTEP_ISA_NAME,
                             LOCKSTEP_WIDTH,
                             LOCKSTEP_FEATURES,
                             sizeof(Wave),
                             trace_tile<LOCKSTEP_WIDTH, LOCKSTEP_FEATURES>,
                             replay,
                             fill_pair<LOCKSTEP_WIDTH>};

}  // namespace lockstep
