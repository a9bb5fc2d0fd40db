#include "experiments/distributed/session.h"

#include <fmt/format.h>

#include <cstdio>

namespace lockstep {

void end_ranks(Desk& desk) {
  if (desk.ranks() == 1) return;
  const std::string silent = desk.dismiss();
  if (silent.empty()) {
    end_ranks();
    return;
  }
  fmt::print(stderr,
             "lockstep: all results are written, but {} did not answer to the end and had to be "
             "stopped by force; look after that machine\n",
             silent);
  std::fflush(nullptr);
  abort_ranks(1);
}

}  // namespace lockstep
