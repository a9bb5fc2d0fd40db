// lockstep compare: samplers against each other at equal time.
#include "core/error.h"
#include "experiments/commands.h"
#include "experiments/compare_run.h"
#include "experiments/options.h"

#include <memory>

namespace lockstep {
namespace {

struct CompareOptions {
  RendererOptions renderer;
  std::vector<std::string> scenes;
  std::string samplers, spp = "4,16,64,256", reference, directory;
  int seeds = 8;
  int reference_spp = 0;
  bool quiet = false;
};

void run_compare(const CompareOptions& options) {
  CompareSettings settings;
  settings.scenes = options.scenes;
  for (const std::string& sampler : split_sampler_list(options.samplers)) {
    settings.samplers.push_back(parse_sampler(sampler));
  }
  settings.rungs = parse_sample_counts(options.spp);
  settings.seeds = options.seeds;
  settings.reference_file = options.reference;
  settings.reference_spp = options.reference_spp;
  settings.depth = options.renderer.depth;
  if (!options.renderer.resolution.empty()) {
    settings.resolution = parse_resolution(options.renderer.resolution);
  }
  settings.overrides = scene_overrides(options.renderer);
  settings.render = render_settings(options.renderer);
  settings.directory = options.directory;
  run_comparison(settings, options.quiet);
}

void add_options(CLI::App& command, CompareOptions& options) {
  command
      .add_option("SCENE", options.scenes, "Built-in scenes (see 'lockstep scenes') or scene files")
      ->type_name("")
      ->required();
  command
      .add_option("--samplers", options.samplers,
                  "Samplers with their options, separated by commas; the others\n"
                  "are measured against the first")
      ->type_name("A,B,...")
      ->required();
  command.add_option("-o,--output", options.directory, "Folder for all results; made if missing")
      ->type_name("DIR")
      ->required();
  command.add_option("--spp", options.spp, "Samples per pixel of the renders, pilot included")
      ->type_name("N,N,...")
      ->capture_default_str();
  command.add_option("--seeds", options.seeds, "Renders of each kind, with seeds 0, 1, ...")
      ->type_name("N")
      ->check(number_between(1, 10000))
      ->capture_default_str();
  CLI::Option* reference =
      command.add_option("--reference", options.reference,
                         "Image to measure against, for one scene (default: render one)");
  reference->type_name("FILE");
  command
      .add_option("--reference-spp", options.reference_spp,
                  "Samples per pixel of the rendered reference, which is kept in DIR\n"
                  "for the next run (default: 1024 or 16 times the largest of\n"
                  "--spp, whichever is more)")
      ->type_name("N")
      ->check(number_between(2, 1 << 24))
      ->excludes(reference);
  command.add_flag("--quiet", options.quiet, "No progress; results, warnings and errors only");
  add_renderer_options(command, options.renderer);
}

}  // namespace

void add_compare_command(CLI::App& program, RunCommand& run) {
  CLI::App* command = program.add_subcommand("compare", "Compare samplers at equal time");
  command->description(
      "Compare samplers at equal time\n\n"
      "Render every scene with every sampler, sample count and seed, measure all images against a\n"
      "reference, and compare errors at equal CPU time; pilot images, filters and weights are\n"
      "paid for. Takes minutes: the reference and (sum of --spp) x seeds x samplers x scenes.");
  command->footer(
      "DIR receives errors.csv (a row for each render, as it is measured), spectra.csv (the errors'\n"
      "power by frequency), summary.json, report.html and the first seed's images. Errors are\n"
      "interpolated between sample counts, never beyond them. Verdicts against random need it among\n"
      "the samplers, and at least 4 seeds.\n"
      "\n"
      "Examples:\n"
      "  lockstep compare cornell --samplers random,cpt,rcs,owen -o out/cornell\n"
      "      about 5 minutes on two cores\n"
      "  lockstep compare scene.pbrt --samplers random,rcs:c=4,t=0.02,rcs:c=8 --spp 8,32 --seeds "
      "4\n"
      "      --reference reference.exr --depth 1 -o out/poster");
  auto options = std::make_shared<CompareOptions>();
  add_options(*command, *options);
  command->callback([options, &run] { run = [options] { run_compare(*options); }; });
}

}  // namespace lockstep
