// Room for the signal handlers of a thread whose own stack has overflown.
#pragma once

namespace lockstep {

// From now on until it ends, the calling thread has a stack apart for handlers that ask for one
// (SA_ONSTACK). One that it has already, such as a sanitizer's, stays; where there is no memory for
// one it gets none. The first call of a thread allocates, the others do nothing.
void give_signal_stack() noexcept;

}  // namespace lockstep
