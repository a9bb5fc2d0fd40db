#include "experiments/commands/command_table.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <sstream>

namespace lockstep {
namespace {

std::string joined_lines(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// The words that a validator is named after, with bars between; see one_of() in options.cpp.
std::vector<std::string> words_of(CLI::Option& option) {
  std::vector<std::string> words;
  try {
    std::istringstream names(option.get_validator(0)->get_name());
    for (std::string word; std::getline(names, word, '|');) words.push_back(word);
  } catch (const CLI::OptionNotFound&) {  // it has no validators
  }
  return words;
}

CompletionKind kind_of(const OptionEntry& entry) {
  const auto is = [&](std::string_view name) {
    return std::find(entry.names.begin(), entry.names.end(), name) != entry.names.end();
  };
  if (entry.value.empty()) return CompletionKind::None;
  if (!entry.words.empty()) return CompletionKind::Words;
  if (is("--sampler") || is("--samplers")) return CompletionKind::Samplers;
  if (entry.value == "SCENE") return CompletionKind::Scene;
  if (entry.value == "DIR") return CompletionKind::Folder;
  const bool is_file = entry.value == "FILE" || entry.value == "SPEC" || entry.is_positional();
  return is_file ? CompletionKind::File : CompletionKind::None;
}

OptionEntry option_entry(CLI::Option& option) {
  OptionEntry entry;
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  if (option.get_items_expected_max() > 0) {
    entry.value = entry.names.empty() ? option.get_name() : option.get_type_name();
  }
  entry.description = joined_lines(option.get_description());
  entry.group = option.get_group();
  entry.fallback = option.get_default_str();
  entry.is_required = option.get_required();
  entry.is_repeated = entry.names.empty() && option.get_items_expected_max() > 1;
  entry.words = words_of(option);
  entry.kind = kind_of(entry);
  return entry;
}

CommandEntry command_entry(CLI::App& command) {
  CommandEntry entry;
  entry.name = command.get_name();
  const std::string text = command.get_description();
  entry.summary = text.substr(0, text.find('\n'));
  const std::size_t blank = text.find("\n\n");
  entry.description = blank == text.npos ? text : text.substr(blank + 2);
  entry.footer = command.get_footer();
  for (CLI::Option* option : command.get_options()) entry.options.push_back(option_entry(*option));
  std::stable_partition(entry.options.begin(), entry.options.end(),
                        [](const OptionEntry& o) { return o.is_positional(); });
  return entry;
}

}  // namespace

CommandTable command_table(CLI::App& program) {
  CommandTable table{command_entry(program), {}};
  for (CLI::App* command : program.get_subcommands({})) {
    table.commands.push_back(command_entry(*command));
  }
  return table;
}

}  // namespace lockstep
