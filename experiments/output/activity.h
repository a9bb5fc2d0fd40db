// What the program is doing, in words, for errors that come from where nobody knows: memory that is
// used up, a crash.
#pragma once

#include <string>

namespace lockstep {

// What is being done while it lives: "reading the scene killeroo.pbrt". One thread begins and ends
// activities; the innermost counts.
class Activity {
 public:
  explicit Activity(std::string what);
  ~Activity();
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

 private:
  std::string what_;
  const char* outer_;
};

// The innermost activity; the one that an exception has just ended, where there is none; else "".
// Async-signal-safe.
const char* current_activity();

// One line for std::bad_alloc: what was being done, what this process holds of what it may, and
// what to do.
std::string out_of_memory_text();

}  // namespace lockstep
