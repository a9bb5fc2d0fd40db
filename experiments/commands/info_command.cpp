// lockstep info: what a scene file holds, and what of it was not understood.
#include "experiments/commands/commands.h"
#include "experiments/output/activity.h"
#include "experiments/output/machine.h"
#include "experiments/scenes/scene_report.h"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace lockstep {
namespace {

struct InfoOptions {
  std::string scene;
  bool json = false;
};

void run_info(const InfoOptions& options) {
  const Activity reading("reading the scene " + options.scene);
  const SceneReport report = report_scene(options.scene);
  if (!options.json) {
    fmt::print("{}", report_text(report));
    return;
  }
  auto json = report_json(report);
  json["peak_memory_bytes"] = peak_memory_bytes();
  json["version"] = version();
  // Names in scene files need not be UTF-8.
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

void add_info_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("info", "Show what a scene consists of");
  command->description(
      "Show what a scene consists of\n\n"
      "Read SCENE with its images and show what its file says: geometry, materials, textures,\n"
      "lights, camera and film, and a warning for all that was not understood.");
  command->footer(
      "Examples:\n"
      "  lockstep info scene.pbrt\n"
      "  lockstep info scene.xml --json");
  auto options = std::make_shared<InfoOptions>();
  command
      ->add_option("SCENE", options->scene, "Built-in scene (see 'lockstep scenes') or scene file")
      ->type_name("")
      ->required();
  command->add_flag("--json", options->json, "As JSON, for scripts");
  command->callback([options, &run] { run = [options] { run_info(*options); }; });
}

}  // namespace lockstep
