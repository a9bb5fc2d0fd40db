// Errors and warnings about a glTF file: "file: element: what". JSON has no lines worth naming.
#pragma once

#include "core/location.h"

#include <string>
#include <utility>
#include <vector>

namespace lockstep::gltf {

// `text` on one line and of bounded length, whatever strings of the file it quotes.
inline std::string printable(std::string text) {
  constexpr size_t longest = 400;
  text = lockstep::printable(std::move(text), ' ');
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
    const std::string what = element.empty() ? message : element + ": " + message;
    once_.add_line(message, file_ + ": " + printable(what));
  }

  const std::vector<std::string>& lines() const { return once_.lines(); }

 private:
  std::string file_;
  lockstep::Warnings once_;
};

}  // namespace lockstep::gltf
