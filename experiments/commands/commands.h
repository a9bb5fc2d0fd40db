// The subcommands. Each function adds its subcommand to the program and, when it is chosen, sets
// `run` to what it has to do.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace lockstep {

using RunCommand = std::function<void()>;

void add_render_command(CLI::App& program, RunCommand& run);
void add_compare_command(CLI::App& program, RunCommand& run);
void add_demo_command(CLI::App& program, RunCommand& run);
void add_profile_command(CLI::App& program, RunCommand& run);
void add_stress_command(CLI::App& program, RunCommand& run);
void add_metrics_command(CLI::App& program, RunCommand& run);
void add_runs_command(CLI::App& program, RunCommand& run);
void add_info_command(CLI::App& program, RunCommand& run);
void add_scenes_command(CLI::App& program, RunCommand& run);
void add_samplers_command(CLI::App& program, RunCommand& run);
void add_shell_commands(CLI::App& program, RunCommand& run);  // completion, manual

}  // namespace lockstep
