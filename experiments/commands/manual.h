// The manual page in the language of man(7), from the same table as --help.
#pragma once

#include "experiments/commands/command_table.h"

namespace lockstep {

std::string manual_page(const CommandTable& table);

}  // namespace lockstep
