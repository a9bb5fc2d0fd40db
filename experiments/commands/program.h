// The command line as a function: what the program `lockstep` runs, and what a program with
// samplers or metrics of its own calls once it has added them (docs/library.md).
#pragma once

namespace lockstep {

// Runs the subcommand that the arguments name and prints its messages; gives the exit status: 0
// done, 1 failed while running, 2 wrong usage. Throws nothing. Once per process: it handles
// signals.
int run_program(int argc, const char* const* argv);

}  // namespace lockstep
