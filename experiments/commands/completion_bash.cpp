#include "experiments/commands/completion.h"

#include "samplers/sampler_spec.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace lockstep {
namespace {

// Bash breaks words at ':' and '=', which samplers hold: the word is taken from the line, and what
// bash takes for granted is cut off the replies in the end.
constexpr const char* helpers =
    R"(# Completes command lines of lockstep in bash: printed by `lockstep completion bash`.

# Those of the words that begin as the last item of a list does.
_lockstep_items() {
  local item=${cur##*,}
  mapfile -t COMPREPLY < <(compgen -P "${cur%"$item"}" -W "$1" -- "$item")
}

_lockstep_words() { mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur"); }

_lockstep_files() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen "$@" -- "$cur")
}

)";

constexpr const char* beginning = R"(_lockstep() {
  local line=${COMP_LINE:0:COMP_POINT} cur option
  local -a typed
  cur=${line##*[[:space:]]}
  read -ra typed <<<"${line%"$cur"}"
  COMPREPLY=()
  if [[ $cur == --*=* ]]; then
    option=${cur%%=*} cur=${cur#*=}
  else
    option=${typed[-1]}
  fi
  _lockstep_value "${typed[1]-}" "$option"
  local breaks=
  [[ $COMP_WORDBREAKS == *:* ]] && breaks+=:
  [[ $COMP_WORDBREAKS == *=* ]] && breaks+='='
  if [[ $breaks && $cur == *[$breaks]* ]]; then
    local head=${cur%"${cur##*[$breaks]}"}
    COMPREPLY=("${COMPREPLY[@]#"$head"}")
  fi
}
complete -F _lockstep lockstep
)";

// After a sampler's name: its options, and their words.
std::string sampler_function() {
  std::string keys, cases;
  for (const SamplerOption& option : sampler_options()) {
    keys += fmt::format(" {}=", option.key);
    if (option.values.find('|') == std::string::npos) continue;
    std::string values = option.values;
    std::replace(values.begin(), values.end(), '|', ' ');
    cases += fmt::format("    {}=*) words=\"{}\" ;;\n", option.key, values);
  }
  return fmt::format(R"(_lockstep_samplers() {{
  local item=${{cur##*[,:]}} words=
  local before=${{cur%"$item"}}
  case $item in
{}    *=*) ;;
    *)
      [[ $before == *: ]] || words="{}"
      [[ $before == *:* ]] && words+="{}"
      compopt -o nospace 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -P "$before" -W "$words" -- "$item")
      return
      ;;
  esac
  mapfile -t COMPREPLY < <(compgen -P "$before${{item%%=*}}=" -W "$words" -- "${{item#*=}}")
}}

)",
                     cases, sampler_words(), keys);
}

std::string value_of(const OptionEntry& option) {
  switch (option.kind) {
    case CompletionKind::Words:
      return fmt::format("_lockstep_items \"{}\"", fmt::join(option.words, " "));
    case CompletionKind::Samplers:
      return "_lockstep_samplers";
    case CompletionKind::Scene:
      return fmt::format("_lockstep_files -f -W \"{}\"", scene_words());
    case CompletionKind::File:
      return "_lockstep_files -f";
    case CompletionKind::Folder:
      return "_lockstep_files -d";
    case CompletionKind::None:
      break;
  }
  return ":";
}

std::string case_of(const CommandEntry& command) {
  std::string values, names, positional = ":";
  for (const OptionEntry& option : command.options) {
    for (const std::string& name : option.names) names += name + ' ';
    if (option.is_positional()) {
      positional = value_of(option);
    } else if (!option.value.empty()) {
      values += fmt::format("        {}) {} && return 0 ;;\n", fmt::join(option.names, " | "),
                            value_of(option));
    }
  }
  return fmt::format(
      "    {})\n      case $2 in\n{}      esac\n      if [[ $cur == -* ]]; then\n"
      "        _lockstep_words \"{}\"\n      else\n        {}\n      fi\n      ;;\n",
      command.name, values, names, positional);
}

}  // namespace

std::string bash_completion(const CommandTable& table) {
  std::string cases, first;
  for (const CommandEntry& command : table.commands) {
    cases += case_of(command);
    first += command.name + ' ';
  }
  for (const OptionEntry& option : table.itself.options) {
    first += fmt::format("{} ", fmt::join(option.names, " "));
  }
  return helpers + sampler_function() +
         "# What the value of option $2 of command $1 may be, or what else may come.\n"
         "_lockstep_value() {\n  case $1 in\n" +
         cases + fmt::format("    '') _lockstep_words \"{}\" ;;\n  esac\n}}\n\n", first) +
         beginning;
}

}  // namespace lockstep
