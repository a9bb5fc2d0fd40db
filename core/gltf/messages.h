// Errors and warnings about a glTF file: "file: element: what". JSON has no lines worth naming.
#pragma once

#include "core/error.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace lockstep::gltf {

// `text` on one line and of bounded length, whatever strings of the file it quotes.
inline std::string printable(std::string text) {
  constexpr size_t longest = 400;
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  while (text.ends_with(' ')) text.pop_back();
  if (text.size() > longest) text = text.substr(0, longest) + " ...";
  return text;
}

[[noreturn]] inline void fail(const std::string& file, const std::string& what) {
  throw Error(file + ": " + printable(what));
}

// Collects each message once, with the element that first gave rise to it.
class Warnings {
 public:
  explicit Warnings(std::string file) : file_(std::move(file)) {}

  void add(const std::string& element, const std::string& message) {
    if (!known_.insert(message).second) return;
    lines_.push_back(file_ + ": " +
                     printable(element.empty() ? message : element + ": " + message));
  }

  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::string file_;
  std::set<std::string> known_;
  std::vector<std::string> lines_;
};

}  // namespace lockstep::gltf
