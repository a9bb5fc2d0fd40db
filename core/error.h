// Errors a user can act on: one line that says what, where and what to do.
#pragma once

#include <stdexcept>
#include <string>

namespace lockstep {

// The run failed: bad input file, unreadable image, out of disk. Exit status 1.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The command line asks for something that does not exist. Exit status 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// An error at a line of an input file: "file:line: what".
inline Error error_at(const std::string& file, int line, const std::string& what) {
  return Error(file + ":" + std::to_string(line) + ": " + what);
}

}  // namespace lockstep
