#include "experiments/commands/manual.h"

#include "core/read_scene.h"
#include "experiments/output/machine.h"
#include "samplers/sampler_spec.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>
#include <string_view>

namespace lockstep {
namespace {

// Text as it stands: troff reads backslashes, and points and quotes that begin a line; a bare
// hyphen may become a typographic one that cannot be searched for or copied.
std::string escaped(std::string_view text) {
  std::string result;
  if (text.starts_with('.') || text.starts_with('\'')) result = "\\&";
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      result += c;
    }
  }
  return result;
}

// Paragraphs, as help has them: indented lines are examples and stay as they are.
std::string paragraphs(const std::string& text) {
  std::string result;
  bool in_example = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool is_example = line.starts_with(' ');
    if (is_example != in_example) result += is_example ? ".EX\n" : ".EE\n";
    in_example = is_example;
    result += line.empty() ? ".PP\n" : escaped(line) + '\n';
  }
  if (in_example) result += ".EE\n";
  return result;
}

std::string synopsis(const CommandEntry& command) {
  std::string text = fmt::format(".B lockstep {}\n", escaped(command.name));
  for (const OptionEntry& option : command.options) {
    if (!option.is_positional()) continue;
    const std::string value = escaped(option.value) + (option.is_repeated ? " ..." : "");
    text +=
        option.is_required ? fmt::format(".I {}\n", value) : fmt::format("[\\fI{}\\fR]\n", value);
  }
  return text + "[\\fIoptions\\fR]\n";
}

std::string option_text(const OptionEntry& option) {
  std::string text = ".TP\n";
  if (option.is_positional()) {
    text += fmt::format("\\fI{}\\fR", escaped(option.value));
  } else {
    text += fmt::format("\\fB{}\\fR", escaped(fmt::format("{}", fmt::join(option.names, ", "))));
    if (!option.value.empty()) text += fmt::format(" \\fI{}\\fR", escaped(option.value));
  }
  text += '\n' + escaped(option.description);
  if (option.is_required) text += " (required)";
  if (!option.fallback.empty()) text += fmt::format(" (default: {})", escaped(option.fallback));
  return text + '\n';
}

std::string option_list(const CommandEntry& command) {
  std::string text, group;
  for (const OptionEntry& option : command.options) {
    if (option.group != group && option.group != "Options" && !option.is_positional()) {
      text += fmt::format(".PP\n{}:\n", escaped(option.group));
    }
    group = option.group;
    text += option_text(option);
  }
  return text;
}

std::string command_section(const CommandEntry& command) {
  return fmt::format(".SS \"lockstep {}\"\n", escaped(command.name)) + synopsis(command) + ".PP\n" +
         paragraphs(command.description) + option_list(command) +
         (command.footer.empty() ? "" : ".PP\n" + paragraphs(command.footer));
}

std::string scene_section() {
  std::string text =
      ".SH SCENES\nWhere a command takes a scene, it takes one of these names or a file of pbrt (2 "
      "to 4), Mitsuba\n(0.4 to 3), glTF 2.0, OBJ or PLY.\n";
  for (const BuiltinScene& scene : builtin_scenes()) {
    text += fmt::format(".TP\n.B {}\n{}\n", escaped(scene.name), escaped(scene.summary));
  }
  return text;
}

constexpr const char* environment_section =
    ".SH ENVIRONMENT\n"
    ".TP\n.B LOCKSTEP_ISA\nInstruction set of the kernels where \\-\\-isa does not name one.\n"
    ".TP\n.B LOCKSTEP_SCENES\nFolder of scenes for compare where \\-\\-scenes\\-dir does not name "
    "one.\n";

}  // namespace

std::string manual_page(const CommandTable& table) {
  std::string text = fmt::format(
      ".TH LOCKSTEP 1 \"\" \"lockstep {}\" \"User Commands\"\n"
      ".SH NAME\nlockstep \\- packet\\-tracing research renderer for coherent sampling\n"
      ".SH SYNOPSIS\n.B lockstep\n.I command\n[\\fIoptions\\fR]\n.PP\n.B lockstep\n"
      ".I command\n.B \\-\\-help\n.SH DESCRIPTION\n",
      escaped(version()));
  text += paragraphs(table.itself.description) + option_list(table.itself);
  text += ".PP\n" + paragraphs(table.itself.footer) + ".SH COMMANDS\n";
  for (const CommandEntry& command : table.commands) text += command_section(command);
  text += scene_section() + ".SH SAMPLERS\n.EX\n";
  std::istringstream lines(sampler_help());
  for (std::string line; std::getline(lines, line);) text += escaped(line) + '\n';
  return text + ".EE\n" + environment_section;
}

}  // namespace lockstep
