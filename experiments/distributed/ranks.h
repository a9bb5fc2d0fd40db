// The processes that mpirun or srun started together: ranks 0, 1, ... of one run, each on a machine
// of its own or several on one. Without such a launcher, or compiled without MPI, there is rank 0
// alone, and nothing here is started. The only place that knows MPI is ranks.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lockstep {

struct Ranks {
  int rank = 0;
  int count = 1;
  int on_node = 1;  // how many of them share this machine
};

// This process's rank by what the launcher left in the environment; empty where it started no
// others. Starts nothing.
std::optional<int> launched_rank();

// Starts MPI where the process was launched with others; all of them have to. Throws Error where
// that is so and cannot be.
Ranks start_ranks();

// What rank 0 says; all ranks have to call it.
std::string text_of_rank_0(std::string text);

// Ends MPI where it was started; waits for all ranks.
void end_ranks();

// Ends this process and all others; does nothing where MPI was not started.
void abort_ranks(int status);

struct Message {
  int from = 0;
  int kind = 0;
  std::vector<char> bytes;
};

// Any thread may send and receive. Neither waits: a message leaves as soon as the other side takes
// it, and ranks that have stopped delay nobody.
void send(int to, int kind, std::vector<char> bytes);

// The next message that has arrived in full; those of one rank come in their order.
std::optional<Message> receive();

// What this rank has sent and received so far.
struct Traffic {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
};
Traffic traffic();

}  // namespace lockstep
