// lockstep completion, lockstep manual: what an installation gives to shells and to man.
#include "experiments/commands/command_table.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/completion.h"
#include "experiments/commands/manual.h"
#include "experiments/commands/options.h"

#include <fmt/format.h>

#include <memory>

namespace lockstep {
namespace {

void add_completion_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("completion", "Print what completes command lines");
  command->description(
      "Print what completes command lines\n\n"
      "Print a script that lets a shell complete commands, options and their values, samplers,\n"
      "built-in scenes and files. Installations have it where shells look for it.");
  command->footer(
      "Examples:\n"
      "  source <(lockstep completion bash)\n"
      "  lockstep completion fish > ~/.config/fish/completions/lockstep.fish");
  auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->type_name("")
      ->required()
      ->check(one_of({"bash", "zsh", "fish"}));
  command->callback([shell, &program, &run] {
    run = [shell, &program] {
      fmt::print("{}", completion_script(command_table(program), *shell));
    };
  });
}

void add_manual_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("manual", "Print the manual page");
  command->description(
      "Print the manual page\n\n"
      "Print the manual page, all of --help with the samplers and scenes, in the language of\n"
      "man(7). Installations have it as lockstep(1).");
  command->footer(
      "Example:\n"
      "  lockstep manual | man -l -");
  command->callback([&program, &run] {
    run = [&program] { fmt::print("{}", manual_page(command_table(program))); };
  });
}

}  // namespace

void add_shell_commands(CLI::App& program, RunCommand& run) {
  add_completion_command(program, run);
  add_manual_command(program, run);
}

}  // namespace lockstep
