// Crashes leave a message: what happened, where in the image, and the command that does it again.
#pragma once

namespace lockstep {

// From now on SIGSEGV, SIGBUS, SIGFPE, SIGILL and SIGABRT, and with it exceptions that nobody
// catches in any thread, print a short block on stderr. The process then ends by the same signal,
// so exit status and core dump are as ever. A signal that already has a handler, such as a
// sanitizer's, keeps it. Where a stack overflows the handlers need another: the calling thread gets
// one, threads that render have theirs (packets/signal_stack.h), and on others they do not run
// then.
void catch_crashes();

}  // namespace lockstep
