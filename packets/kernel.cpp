// Compiled once per instruction set and width: LOCKSTEP_WIDTH lanes, exported as LOCKSTEP_KERNEL.
#include "packets/path.h"

namespace lockstep {

extern const Kernel LOCKSTEP_KERNEL;
const Kernel LOCKSTEP_KERNEL{Isa::LOCKSTEP_ISA_NAME, LOCKSTEP_WIDTH, sizeof(Wave),
                             trace_tile<LOCKSTEP_WIDTH>, fill_pair<LOCKSTEP_WIDTH>};

}  // namespace lockstep
