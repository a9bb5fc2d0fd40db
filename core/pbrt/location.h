// Where in a scene file something stands, and the warnings that point there.
#pragma once

#include "core/error.h"

#include <set>
#include <string>
#include <vector>

namespace lockstep::pbrt {

// `file` is the path as the user gave it, so that messages read like the command line.
struct Location {
  std::string file;
  int line = 0;
};

// `text` with control characters, as broken files have them, made visible.
inline std::string printable(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text;
}

[[noreturn]] inline void fail(const Location& where, const std::string& what) {
  throw error_at(where.file, where.line, printable(what));
}

// Collects each message once, with the place that first gave rise to it.
class Warnings {
 public:
  void add(const Location& where, const std::string& message) {
    if (!known_.insert(message).second) return;
    lines_.push_back(where.file + ":" + std::to_string(where.line) + ": " + printable(message));
  }

  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::set<std::string> known_;
  std::vector<std::string> lines_;
};

}  // namespace lockstep::pbrt
