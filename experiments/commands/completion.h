// Scripts by which shells complete command lines of the program, from the same table as --help.
#pragma once

#include "experiments/commands/command_table.h"

#include <string_view>

namespace lockstep {

// `shell` is bash, zsh or fish.
std::string completion_script(const CommandTable& table, std::string_view shell);

std::string bash_completion(const CommandTable& table);
std::string zsh_completion(const CommandTable& table);
std::string fish_completion(const CommandTable& table);

// Names with spaces between.
std::string scene_words();
std::string sampler_words();

}  // namespace lockstep
