// What every fuzz target asks of the code that it feeds: nothing but the project's own errors.
#pragma once

#include "core/error.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace lockstep::fuzz {

// Input was accepted, but what came of it cannot be used.
struct Unusable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline void require(bool fine, const std::string& what) {
  if (!fine) throw Unusable(what);
}

// What is typed as an option: the program puts messages that repeat it on one line.
inline std::string typed(const std::uint8_t* data, std::size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

[[noreturn]] inline void report(const char* target, const std::string& what) {
  std::fprintf(stderr, "%s: %s\n", target, what.c_str());
  std::abort();
}

// Errors and warnings are one line that says something.
inline void check_message(const char* target, const std::string& message) {
  if (message.empty()) report(target, "an error says nothing");
  if (message.find_first_of("\n\r") != message.npos) report(target, "not one line: " + message);
}

// Prints what is wrong and aborts where `action` throws anything else than Error or UsageError, or
// where their text is not one line.
template <class Action>
void expect_own_errors(const char* target, Action action) {
  try {
    action();
  } catch (const Error& error) {
    check_message(target, error.what());
  } catch (const UsageError& error) {
    check_message(target, error.what());
  } catch (const Unusable& broken) {
    report(target, std::string("what cannot be used is accepted: ") + broken.what());
  } catch (const std::exception& other) {
    report(target, std::string("not an Error: ") + other.what());
  }
}

}  // namespace lockstep::fuzz
