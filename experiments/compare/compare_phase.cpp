#include "experiments/compare/compare_phase.h"

#include "core/error.h"
#include "experiments/compare/equal_time.h"
#include "experiments/compare/reference.h"
#include "experiments/metrics/metrics.h"
#include "experiments/output/activity.h"
#include "experiments/output/machine.h"
#include "experiments/output/preview.h"
#include "experiments/output/render_command.h"
#include "experiments/output/render_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>

namespace lockstep {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string in_directory(const CompareSettings& settings, const std::string& file) {
  return (fs::path(settings.directory) / file).string();
}

const SamplerSpec& sampler_of(const Phase& phase, int sampler) {
  return phase.settings.samplers[std::size_t(sampler)];
}

// Everything but scene, depth, sampler, seed and sample count that a render's error or time depends
// on, except for the CPU. Renders are compared with each other only where it is the same.
std::string conditions_of(const Phase& phase) {
  const RenderSettings& settings = phase.render_settings;
  const int threads = settings.threads > 0 ? settings.threads
                                           : int(std::max(1u, std::thread::hardware_concurrency()));
  return fmt::format(
      "scene {:016x} at {}x{}, roulette from {}, {}, width {}, lanes {}, traversal {}, {} kernels, "
      "{} threads, {}reference {:016x}, version {}",
      phase.scene->fingerprint(), phase.result.width, phase.result.height, settings.roulette_depth,
      name(settings.isa), settings.width > 0 ? std::to_string(settings.width) : "auto",
      settings.lanes ? to_string(*settings.lanes) : "auto",
      settings.traversal ? to_string(*settings.traversal) : "auto",
      settings.specialized ? "special" : "general", threads,
      settings.clamp ? fmt::format("clamped at {}, ", *settings.clamp) : "",
      content_fingerprint(phase.result.reference.image), version());
}

RunImages image_names(const Phase& phase, int sampler, int spp, bool has_weights) {
  const std::string stem = fmt::format("{}-{}-{}spp", phase.result.label,
                                       file_name_safe(to_string(sampler_of(phase, sampler))), spp);
  return {sampler, spp, stem + ".exr", stem + ".png", has_weights ? stem + "-weights.png" : ""};
}

void keep_images(Phase& phase, int sampler, const RenderResult& render) {
  const RunImages images =
      image_names(phase, sampler, render.stats.spp, render.weights.has_value());
  Metadata metadata = render_metadata(phase.result.scene, sampler_of(phase, sampler),
                                      phase.render_settings, render);
  metadata.merge(override_metadata(phase.settings.overrides));
  write_image(in_directory(phase.settings, images.exr), render.image, metadata);
  write_image(in_directory(phase.settings, images.png),
              exposed(render.image, phase.result.exposure));
  if (render.weights) {
    const std::string exr = fs::path(images.weights_png).replace_extension(".exr").string();
    write_image(in_directory(phase.settings, exr), *render.weights, metadata);
    write_image(in_directory(phase.settings, images.weights_png), weights_as_grey(*render.weights));
  }
  phase.result.images.push_back(images);
}

void add_spectrum(SceneComparison& scene, int sampler, int spp, const ErrorSpectrum& next) {
  const auto place =
      std::find_if(scene.spectra.begin(), scene.spectra.end(), [&](const RunSpectrum& spectrum) {
        return spectrum.sampler == sampler && spectrum.spp == spp;
      });
  RunSpectrum& spectrum = place != scene.spectra.end()
                              ? *place
                              : scene.spectra.emplace_back(RunSpectrum{sampler, spp, 0, {}});
  average_in(spectrum.mean, next, ++spectrum.renders);
}

// Makes a run part of the result.
void take_in(Phase& phase, const MeasuredRun& measured) {
  const Measurement& run = measured.run;
  phase.done.insert({run.sampler, run.seed, run.spp});
  phase.result.packet_width = run.packet_width;
  phase.result.threads = run.threads;
  phase.result.runs.push_back(run);
  add_spectrum(phase.result, run.sampler, run.spp, measured.spectrum);
}

JournalEntry entry_of(const Phase& phase, int sampler,
                      std::variant<MeasuredRun, TimingRepeat> what) {
  return {phase.result.scene, phase.result.depth, to_string(sampler_of(phase, sampler)),
          phase.conditions,   std::move(what),    0};
}

void check_conditions(const Phase& phase, const JournalEntry& entry) {
  if (entry.conditions == phase.conditions) return;
  throw error_at(
      phase.journal_path, entry.line,
      fmt::format("{} at depth {} was measured under other conditions ({}) than those of "
                  "now ({}); use the same again, or leave out --resume to begin anew",
                  entry.scene, entry.depth, entry.conditions, phase.conditions));
}

bool is_wanted(const CompareSettings& settings, const Measurement& run) {
  const std::vector<int>& rungs = settings.rungs;
  return run.seed < std::uint32_t(settings.seeds) &&
         std::find(rungs.begin(), rungs.end(), run.spp) != rungs.end();
}

void restore_run(Phase& phase, const MeasuredRun& measured) {
  const Measurement& run = measured.run;
  if (phase.done.contains({run.sampler, run.seed, run.spp})) return;
  take_in(phase, measured);
  if (run.seed != 0) return;
  const RunImages images = image_names(phase, run.sampler, run.spp, run.has_weights);
  std::error_code error;
  if (fs::exists(in_directory(phase.settings, images.png), error)) {
    phase.result.images.push_back(images);
  }
}

// The order in which one process measures: seeds, sample counts, samplers in turn.
std::tuple<std::uint32_t, int, int> order_of(const CompareSettings& settings,
                                             const Measurement& run) {
  const int samplers = int(settings.samplers.size());
  const auto rung = std::find(settings.rungs.begin(), settings.rungs.end(), run.spp);
  const int turn = int(run.seed) + int(rung - settings.rungs.begin());
  return {run.seed, run.spp, ((run.sampler - turn) % samplers + samplers) % samplers};
}

// For each seed the CPU whose renders count.
std::map<std::uint32_t, std::string> chosen_cpus(const CompareSettings& settings,
                                                 const std::vector<MeasuredRun>& runs) {
  std::map<std::uint32_t, std::map<std::string, std::set<std::pair<int, int>>>> found;
  for (const MeasuredRun& measured : runs) {
    const Measurement& run = measured.run;
    found[run.seed][run.cpu].insert({run.sampler, run.spp});
  }
  std::map<std::uint32_t, std::string> chosen;
  for (const auto& [seed, cpus] : found) {
    chosen[seed] = cpu_name();
    for (const auto& [cpu, renders] : cpus) {
      if (renders.size() == settings.samplers.size() * settings.rungs.size()) chosen[seed] = cpu;
    }
  }
  return chosen;
}

// Gives messages about the next render the command that makes it again.
void name_render(Phase& phase, const SamplerSpec& sampler) {
  RenderSettings& settings = phase.render_settings;
  settings.scene_name = phase.result.scene;
  settings.command =
      render_command(phase.result.scene, sampler, settings, phase.result.width, phase.result.height,
                     override_metadata(phase.settings.overrides));
}

// Renders in full, whatever `progress` says: a stop waits for the end of the render. Returns
// whether one was asked for.
bool render_whole(Phase& phase, int sampler, const std::string& what, double work_before,
                  RenderResult& result) {
  const RenderSettings& settings = phase.render_settings;
  bool stop = false;
  const Activity rendering("rendering " + phase.result.scene);
  const std::string label = fmt::format("{}: {} at {} spp, {}", phase.result.label,
                                        to_string(sampler_of(phase, sampler)), settings.spp, what);
  const auto show = [&](double fraction) {
    stop |= !phase.progress(work_before + fraction * settings.spp, label);
    return true;
  };
  name_render(phase, sampler_of(phase, sampler));
  result = render(*phase.scene, sampler_of(phase, sampler), settings, show);
  return stop;
}

Measurement measurement_of(const Phase& phase, int sampler, const RenderResult& render) {
  const RenderStats& stats = render.stats;
  Measurement run;
  run.sampler = sampler;
  run.seed = phase.render_settings.seed;
  run.spp = stats.spp;
  run.cpu_seconds = stats.cpu_seconds;
  run.wall_seconds = stats.wall_seconds;
  run.pilot_spp = stats.pilot_spp;
  run.mean_weight = stats.mean_weight;
  run.lanes = stats.lanes;
  run.lanes_active = stats.lanes_active;
  run.clamped = stats.clamped;
  run.nonfinite = stats.nonfinite;
  run.bad_samples = stats.bad_samples;
  run.errors = evaluate(*phase.reference, render.image).values;
  run.packet_width = stats.width;
  run.threads = stats.threads;
  run.has_weights = render.weights.has_value();
  run.cpu = cpu_name();
  return run;
}

// Renders once with the settings and measures. Images come first, the journal's line last: what has
// a line has all its files.
void measure(Phase& phase, int sampler, double work_before) {
  const std::string what =
      fmt::format("seed {} of {}", phase.render_settings.seed + 1, phase.settings.seeds);
  RenderResult render;
  const bool stop = render_whole(phase, sampler, what, work_before, render);
  const Activity measuring("measuring the errors of a render of " + phase.result.scene);
  const MeasuredRun measured{measurement_of(phase, sampler, render),
                             error_spectrum(phase.result.reference.image, render.image)};
  if (measured.run.seed == 0) keep_images(phase, sampler, render);
  phase.record(entry_of(phase, sampler, measured));
  take_in(phase, measured);
  if (stop) throw Cancelled();
}

}  // namespace

std::string command_of(const SceneComparison& scene, const CompareSettings& settings,
                       const Measurement& run) {
  RenderSettings render = settings.render;
  render.seed = run.seed, render.spp = run.spp, render.depth = scene.depth;
  return render_command(scene.scene, settings.samplers[std::size_t(run.sampler)], render,
                        scene.width, scene.height, override_metadata(settings.overrides));
}

int place_of(const CompareSettings& settings, const std::string& sampler) {
  for (std::size_t s = 0; s < settings.samplers.size(); ++s) {
    if (to_string(settings.samplers[s]) == sampler) return int(s);
  }
  return -1;
}

void restore(Phase& phase) {
  std::vector<MeasuredRun> runs;
  for (const JournalEntry& entry : phase.earlier) {
    if (entry.scene != phase.result.scene || entry.depth != phase.result.depth) continue;
    check_conditions(phase, entry);
    const int sampler = place_of(phase.settings, entry.sampler);
    if (sampler < 0) continue;
    if (const auto* measured = std::get_if<MeasuredRun>(&entry.what)) {
      MeasuredRun own = *measured;
      own.run.sampler = sampler;
      if (is_wanted(phase.settings, own.run)) runs.push_back(std::move(own));
    } else {
      TimingRepeat repeat = std::get<TimingRepeat>(entry.what);
      repeat.sampler = sampler;
      phase.result.repeats.push_back(repeat);
    }
  }
  std::stable_sort(runs.begin(), runs.end(), [&](const MeasuredRun& a, const MeasuredRun& b) {
    return order_of(phase.settings, a.run) < order_of(phase.settings, b.run);
  });
  const std::map<std::uint32_t, std::string> cpus = chosen_cpus(phase.settings, runs);
  for (const MeasuredRun& run : runs) {
    if (run.run.cpu == cpus.at(run.run.seed)) restore_run(phase, run);
  }
}

bool all_done(const Phase& phase) {
  return phase.done.size() == phase.settings.samplers.size() * phase.settings.rungs.size() *
                                  std::size_t(phase.settings.seeds);
}

void warm_up(Phase& phase, double work) {
  phase.render_settings.spp = std::min(4, phase.settings.rungs.front());
  for (const SamplerSpec& sampler : phase.settings.samplers) {
    name_render(phase, sampler);
    render(*phase.scene, sampler, phase.render_settings,
           [&](double) { return phase.progress(work, phase.result.label + ": warming up"); });
  }
}

// Samplers are innermost and change their order, so that a disturbance of the machine falls on
// all alike.
void measure_seed(Phase& phase, int seed, double work) {
  const int samplers = int(phase.settings.samplers.size());
  const int rungs = int(phase.settings.rungs.size());
  phase.render_settings.seed = std::uint32_t(seed);
  for (int rung = 0; rung < rungs; ++rung) {
    const int spp = phase.settings.rungs[std::size_t(rung)];
    phase.render_settings.spp = spp;
    for (int i = 0; i < samplers; ++i) {
      const int sampler = (i + seed + rung) % samplers;
      if (!phase.done.contains({sampler, std::uint32_t(seed), spp})) measure(phase, sampler, work);
      work += spp;
    }
  }
}

std::vector<UnsteadyRung> unsteady_rungs(const SceneComparison& scene,
                                         const CompareSettings& settings) {
  std::vector<UnsteadyRung> unsteady;
  for (std::size_t s = 0; s < settings.samplers.size(); ++s) {
    for (const auto& [spp, rung] : rungs_of(scene, int(s))) {
      if (median_uncertainty(rung.cpu_times).value_or(0.0) > settings.timing_spread) {
        unsteady.push_back({int(s), spp});
      }
    }
  }
  std::stable_sort(unsteady.begin(), unsteady.end(),
                   [](const UnsteadyRung& a, const UnsteadyRung& b) { return a.spp < b.spp; });
  return unsteady;
}

int repeats_so_far(const SceneComparison& scene) {
  std::map<std::pair<int, int>, int> counts;
  int most = 0;
  for (const TimingRepeat& repeat : scene.repeats) {
    most = std::max(most, ++counts[{repeat.sampler, repeat.spp}]);
  }
  return most;
}

int most_repeats(const CompareSettings& settings) {
  return settings.timing_repeats.value_or((settings.seeds + 1) / 2);
}

void repeat_round(Phase& phase, int round, const std::vector<UnsteadyRung>& unsteady, double work) {
  for (std::size_t i = 0; i < unsteady.size(); ++i) {
    const auto [sampler, spp] = unsteady[(i + std::size_t(round)) % unsteady.size()];
    phase.render_settings.seed = std::uint32_t(round % phase.settings.seeds);
    phase.render_settings.spp = spp;
    const std::string what =
        fmt::format("timed again, {} of at most {}", round + 1, most_repeats(phase.settings));
    RenderResult render;
    const bool stop = render_whole(phase, sampler, what, work - spp, render);
    const TimingRepeat repeat{sampler,
                              phase.render_settings.seed,
                              spp,
                              render.stats.cpu_seconds,
                              render.stats.wall_seconds,
                              cpu_name()};
    phase.record(entry_of(phase, sampler, repeat));
    phase.result.repeats.push_back(repeat);
    if (stop) throw Cancelled();
  }
}

void open_phase(Phase& phase, double reference_work) {
  const Activity preparing("the reference of " + phase.result.scene);
  const auto show = [&](double fraction) {
    return phase.progress(fraction * reference_work, phase.result.label + ": reference");
  };
  SceneComparison& result = phase.result;
  result.reference = make_reference(phase.settings, result, *phase.scene, phase.render_settings,
                                    show, phase.render_half);
  phase.reference = prepare_reference(result.reference.image);
  result.exposure = preview_exposure(result.reference.image);
  result.reference_png = fmt::format("{}-reference.png", result.label);
  phase.conditions = conditions_of(phase);
}

void show_reference(Phase& phase) {
  const SceneComparison& result = phase.result;
  write_image(in_directory(phase.settings, result.reference_png),
              exposed(result.reference.image, result.exposure));
}

namespace {

// Returns false where the time ran out.
bool measure_all(Phase& phase, double work, Clock::time_point deadline) {
  Clock::duration longest_seed{};
  for (int seed = 0; seed < phase.settings.seeds; ++seed) {
    const Clock::time_point start = Clock::now();
    if (phase.settings.max_seconds > 0.0 && start + longest_seed > deadline && seed > 0)
      return false;
    measure_seed(phase, seed, work);
    work += work_per_seed(phase.settings);
    longest_seed = std::max(longest_seed, Clock::now() - start);
  }
  return true;
}

// Renders again, for their times alone, the rungs whose times spread too far, in turn.
void repeat_unsteady(Phase& phase, double work) {
  for (int round = repeats_so_far(phase.result); round < most_repeats(phase.settings); ++round) {
    const std::vector<UnsteadyRung> unsteady = unsteady_rungs(phase.result, phase.settings);
    if (unsteady.empty()) return;
    repeat_round(phase, round, unsteady, work);
  }
}

}  // namespace

double work_per_seed(const CompareSettings& settings) {
  double work = 0.0;
  for (int spp : settings.rungs) work += spp * double(settings.samplers.size());
  return work;
}

bool run_phase(Phase& phase, double reference_work, Clock::time_point deadline) {
  open_phase(phase, reference_work);
  show_reference(phase);
  restore(phase);
  if (!all_done(phase)) warm_up(phase, reference_work);
  if (!measure_all(phase, reference_work, deadline)) return false;
  repeat_unsteady(phase, reference_work + phase.settings.seeds * work_per_seed(phase.settings));
  return true;
}

}  // namespace lockstep
