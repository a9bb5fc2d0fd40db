#include "experiments/output/command_line.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

namespace lockstep {

std::string shell_quoted(std::string_view argument) {
  const bool plain = std::all_of(argument.begin(), argument.end(), [](unsigned char c) {
    return std::isalnum(c) ||
           std::string_view("-_./,:=+@%").find(char(c)) != std::string_view::npos;
  });
  if (plain && !argument.empty()) return std::string(argument);
  std::string quoted = "'";
  for (char c : argument) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string shell_line(const std::vector<std::string>& arguments) {
  std::string line;
  for (const std::string& argument : arguments) {
    if (!line.empty()) line += ' ';
    line += shell_quoted(argument);
  }
  return line;
}

std::string own_command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  if (arguments.empty()) return "";
  arguments.front() = std::filesystem::path(arguments.front()).filename().string();
  return shell_line(arguments);
}

}  // namespace lockstep
