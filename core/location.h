// Where in a scene file something stands, and the errors and warnings that point there.
#pragma once

#include "core/error.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace lockstep {

// `file` is the path as the user gave it, so that messages read like the command line.
struct Location {
  std::string file;
  int line = 0;
};

// `text` with control characters, as broken files have them, shown as `stand_in`.
inline std::string printable(std::string text, char stand_in = '?') {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = stand_in;
  }
  return text;
}

// Throws the Error "file:line: what".
[[noreturn]] inline void fail(const Location& where, const std::string& what) {
  throw error_at(where.file, where.line, printable(what));
}

// Collects each message once, with the place that first gave rise to it.
class Warnings {
 public:
  void add(const Location& where, const std::string& message) {
    if (is_new(message)) {
      lines_.push_back(where.file + ":" + std::to_string(where.line) + ": " + printable(message));
    }
  }

  // The same for a place that is no line of a file; `line` names it.
  void add_line(const std::string& message, std::string line) {
    if (is_new(message)) lines_.push_back(std::move(line));
  }

  const std::vector<std::string>& lines() const { return lines_; }

 private:
  bool is_new(const std::string& message) { return known_.insert(message).second; }

  std::set<std::string> known_;
  std::vector<std::string> lines_;
};

}  // namespace lockstep
