// Crashes leave a message: what happened, where in the image, and the command that does it again.
#pragma once

namespace lockstep {

// From now on SIGSEGV, SIGBUS, SIGFPE, SIGILL and SIGABRT, and with it exceptions that nobody
// catches in any thread, print a short block on stderr. The process then ends by the same signal,
// so exit status and core dump are as ever. Call it from the main thread, whose own stack may
// overflow: the handlers have another. A signal that already has a handler, such as a sanitizer's,
// keeps it. On other threads that overflow, they do not run.
void catch_crashes();

}  // namespace lockstep
