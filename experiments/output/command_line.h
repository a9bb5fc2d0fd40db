// Command lines as a person would type them into a shell.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lockstep {

// In single quotes where a POSIX shell would read it as more than one plain word.
std::string shell_quoted(std::string_view argument);

// Quoted arguments with spaces between.
std::string shell_line(const std::vector<std::string>& arguments);

// What this process was started with; the program by its file name alone. Empty where the system
// does not tell.
std::string own_command_line();

}  // namespace lockstep
