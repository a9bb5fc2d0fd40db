// Experiments written down: a TOML file whose keys are compare's options, with underscores for
// their hyphens. docs/compare.md lists them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lockstep {

// What may stand behind a key.
enum class ValueKind { Text, Number, TextOrNumber, Switch };

struct ExperimentKey {
  std::string_view name;
  ValueKind kind = ValueKind::Text;
  bool is_list = false;  // one value may stand without brackets
};

const std::vector<ExperimentKey>& experiment_keys();

// A key of a file with its values as they would be typed on the command line; a switch has "true"
// or "false".
struct ExperimentEntry {
  const ExperimentKey* key = nullptr;
  std::vector<std::string> values;
  int line = 0;
};

// Throws Error ("file:line: what is wrong") where the file cannot be read, is no TOML, or has a key
// or a type of value that there is not.
std::vector<ExperimentEntry> read_experiment(const std::string& path);

// The same as a file. Lines of entries do not matter.
std::string experiment_text(const std::vector<ExperimentEntry>& entries);

}  // namespace lockstep
