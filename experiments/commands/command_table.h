// The commands and options of the program as a table: what --help shows, for the manual page and
// for shells that complete command lines.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace lockstep {

// How a value can be completed: not at all, from a list of words or of samplers, built-in scenes
// and files, files, folders.
enum class CompletionKind { None, Words, Samplers, Scene, File, Folder };

struct OptionEntry {
  std::vector<std::string> names;  // as typed, such as -o and --output; none for a positional
  std::string value;               // what its value is called; empty for flags
  std::string description;         // one line
  std::string group;               // the heading it stands under
  std::string fallback;            // the value where none is given; may be empty
  bool is_required = false;
  bool is_repeated = false;
  CompletionKind kind = CompletionKind::None;
  std::vector<std::string> words;  // for CompletionKind::Words

  bool is_positional() const { return names.empty(); }
};

struct CommandEntry {
  std::string name;
  std::string summary;      // one line
  std::string description;  // paragraphs with blank lines between; as is the footer
  std::string footer;
  std::vector<OptionEntry> options;  // positionals first
};

// All subcommands, in the order of --help; `itself` is the program and its own options.
struct CommandTable {
  CommandEntry itself;
  std::vector<CommandEntry> commands;
};

CommandTable command_table(CLI::App& program);

}  // namespace lockstep
