// lockstep scenes, lockstep samplers: what there is to choose from.
#include "core/read_scene.h"
#include "experiments/commands/commands.h"
#include "samplers/sampler_spec.h"

#include <fmt/format.h>

#include <algorithm>

namespace lockstep {
namespace {

void print_scenes() {
  std::size_t width = 0;
  for (const BuiltinScene& scene : builtin_scenes()) width = std::max(width, scene.name.size());
  for (const BuiltinScene& scene : builtin_scenes()) {
    fmt::print("{:{}}  {}\n", scene.name, width, scene.summary);
  }
}

}  // namespace

void add_scenes_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("scenes", "List the built-in scenes");
  command->description(
      "List the built-in scenes\n\n"
      "List the built-in scenes. Their names are valid wherever a command takes a SCENE, beside\n"
      "paths to files of pbrt (2 to 4), Mitsuba (0.4 to 3), glTF 2.0, OBJ or PLY.");
  command->callback([&run] { run = print_scenes; });
}

void add_samplers_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("samplers", "List the samplers and their options");
  command->description(
      "List the samplers and their options\n\n"
      "List the samplers with their options, defaults and papers.");
  command->callback([&run] { run = [] { fmt::print("{}\n", sampler_help()); }; });
}

}  // namespace lockstep
