#include "experiments/commands/completion.h"

#include "core/read_scene.h"
#include "samplers/sampler_spec.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace lockstep {
namespace {

// In the single quotes of zsh and fish. `special` characters get a backslash.
std::string quoted(std::string_view text, std::string_view special) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
    } else {
      if (special.find(c) != special.npos) result += '\\';
      result += c;
    }
  }
  return result + '\'';
}

// What follows an option in a specification of zsh's _arguments.
std::string zsh_action(const OptionEntry& option) {
  switch (option.kind) {
    case CompletionKind::Words:
      return fmt::format("({})", fmt::join(option.words, " "));
    case CompletionKind::Samplers:
      return "_lockstep_samplers";
    case CompletionKind::Scene:
      return "_lockstep_scenes";
    case CompletionKind::File:
      return "_files";
    case CompletionKind::Folder:
      return "_files -/";
    case CompletionKind::None:
      break;
  }
  return " ";
}

std::string zsh_arguments(const CommandEntry& command) {
  std::string text;
  for (const OptionEntry& option : command.options) {
    const std::string value =
        option.value.empty()
            ? ""
            : fmt::format(":{}:{}", quoted(option.value, ":\\"), quoted(zsh_action(option), ""));
    text += " \\\n        ";
    if (option.is_positional()) {
      text += (option.is_repeated ? "'*'" : "") + value;
      continue;
    }
    const std::string description = quoted(fmt::format("[{}]", option.description), "\\:");
    text +=
        fmt::format("'({0})'{1}{2}{3}", fmt::join(option.names, " "),
                    option.names.size() > 1 ? fmt::format("{{{}}}", fmt::join(option.names, ","))
                                            : option.names[0],
                    description, value);
  }
  return text;
}

std::string fish_value(const OptionEntry& option) {
  switch (option.kind) {
    case CompletionKind::Words:
      return fmt::format(" -x -a '{}'", fmt::join(option.words, " "));
    case CompletionKind::Samplers:
      return fmt::format(" -x -a '{}'", sampler_words());
    case CompletionKind::Scene:
    case CompletionKind::File:
      return " -r -F";
    case CompletionKind::Folder:
      return " -x -a '(__fish_complete_directories)'";
    case CompletionKind::None:
      break;
  }
  return option.value.empty() ? " -f" : " -x";
}

std::string fish_option(const OptionEntry& option, const std::string& condition) {
  std::string text = "complete -c lockstep -n " + condition;
  for (const std::string& name : option.names) {
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  return text + fish_value(option) + " -d " + quoted(option.description, "\\") + '\n';
}

}  // namespace

std::string scene_words() {
  std::vector<std::string_view> names;
  for (const BuiltinScene& scene : builtin_scenes()) names.push_back(scene.name);
  return fmt::format("{}", fmt::join(names, " "));
}

std::string sampler_words() { return fmt::format("{}", fmt::join(sampler_names(), " ")); }

std::string zsh_completion(const CommandTable& table) {
  std::string commands, cases;
  for (const CommandEntry& command : table.commands) {
    commands += fmt::format("    {}\n", quoted(command.name + ':' + command.summary, "\\"));
    cases += fmt::format("    {})\n      _arguments{}\n      ;;\n", command.name,
                         zsh_arguments(command));
  }
  return fmt::format(R"(#compdef lockstep
# Completes command lines of lockstep in zsh: printed by `lockstep completion zsh`.

_lockstep_samplers() {{
  compset -P '*,'
  compadd -- {}
}}

_lockstep_scenes() {{
  compadd -- {}
  _files
}}

_lockstep() {{
  local -a commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    _arguments{}
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{}  esac
}}

if [[ $funcstack[1] == _lockstep ]]; then
  _lockstep "$@"
else
  compdef _lockstep lockstep
fi
)",
                     sampler_words(), scene_words(), commands, zsh_arguments(table.itself), cases);
}

std::string fish_completion(const CommandTable& table) {
  std::string text =
      "# Completes command lines of lockstep in fish: printed by `lockstep completion fish`.\n";
  for (const OptionEntry& option : table.itself.options) {
    text += fish_option(option, "__fish_use_subcommand");
  }
  for (const CommandEntry& command : table.commands) {
    text += fmt::format("complete -c lockstep -n __fish_use_subcommand -f -a {} -d {}\n",
                        command.name, quoted(command.summary, "\\"));
    const std::string seen = fmt::format("'__fish_seen_subcommand_from {}'", command.name);
    bool takes_files = false;
    for (const OptionEntry& option : command.options) {
      if (!option.is_positional()) {
        text += fish_option(option, seen);
        continue;
      }
      takes_files = option.kind != CompletionKind::Words;
      const std::string words = option.kind == CompletionKind::Scene
                                    ? scene_words()
                                    : fmt::format("{}", fmt::join(option.words, " "));
      if (words.empty()) continue;
      text += fmt::format("complete -c lockstep -n {} -a '{}'\n", seen, words);
    }
    if (!takes_files) text += fmt::format("complete -c lockstep -n {} -f\n", seen);
  }
  return text;
}

std::string completion_script(const CommandTable& table, std::string_view shell) {
  if (shell == "zsh") return zsh_completion(table);
  return shell == "fish" ? fish_completion(table) : bash_completion(table);
}

}  // namespace lockstep
