#include "experiments/compare.h"

#include "core/error.h"
#include "experiments/errors_csv.h"
#include "experiments/metrics.h"
#include "experiments/output_file.h"
#include "experiments/preview.h"
#include "experiments/reference.h"
#include "experiments/render_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>

namespace lockstep {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// One scene's part of the experiment, while it runs.
struct Phase {
  const CompareSettings& settings;
  SceneComparison& result;
  Scene scene;
  RenderSettings render_settings;
  ErrorsCsv& csv;
  std::function<bool(double work, std::string_view label)> progress;  // work in samples per pixel
};

void check_settings(const CompareSettings& settings) {
  if (settings.scenes.empty()) throw UsageError("compare: name at least one scene");
  if (settings.samplers.empty()) throw UsageError("compare: name at least one sampler");
  if (!settings.reference_file.empty() && settings.scenes.size() > 1) {
    throw UsageError(
        "--reference: one image is the reference of one scene; compare one scene at a time");
  }
  std::set<std::string> names;
  for (const SamplerSpec& sampler : settings.samplers) {
    if (!names.insert(to_string(sampler)).second) {
      throw UsageError(
          fmt::format("--samplers: {} is named twice; name each once", to_string(sampler)));
    }
  }
}

// The scene's name, or its file's without folder and extension; numbered where that is taken.
std::string unique_label(const std::string& scene, std::set<std::string>& taken) {
  const std::string stem = file_name_safe(fs::path(scene).stem().string());
  std::string label = stem;
  for (int n = 2; !taken.insert(label).second; ++n) label = fmt::format("{}-{}", stem, n);
  return label;
}

SceneDescription read_for(const CompareSettings& settings, const std::string& scene) {
  SceneDescription description = read_scene(scene, settings.overrides);
  if (settings.resolution) {
    description.film.width = settings.resolution->x;
    description.film.height = settings.resolution->y;
  }
  return description;
}

SceneComparison describe(const Scene& scene, const CompareSettings& settings,
                         const std::string& name, const std::string& label) {
  const SceneDescription& description = scene.description();
  SceneComparison result;
  result.scene = name;
  result.label = label;
  result.width = description.film.width;
  result.height = description.film.height;
  result.depth = settings.depth.value_or(description.defaults.depth);
  result.triangles = scene.triangle_count();
  result.features = feature_names(scene.features());
  result.left_out = feature_names(all_features & ~scene.features());
  result.warnings = description.warnings;
  return result;
}

// A mistake in any scene is found before files are touched and hours are spent on the others.
void check_scenes(const CompareSettings& settings) {
  for (const std::string& scene : settings.scenes) read_scene(scene, settings.overrides);
}

std::string in_directory(const CompareSettings& settings, const std::string& file) {
  return (fs::path(settings.directory) / file).string();
}

void keep_images(Phase& phase, int sampler_index, const RenderResult& render) {
  const SamplerSpec& sampler = phase.settings.samplers[std::size_t(sampler_index)];
  const std::string stem = fmt::format("{}-{}-{}spp", phase.result.label,
                                       file_name_safe(to_string(sampler)), render.stats.spp);
  RunImages images{sampler_index, render.stats.spp, stem + ".exr", stem + ".png", ""};
  Metadata metadata = render_metadata(phase.result.scene, sampler, phase.render_settings, render);
  metadata.merge(override_metadata(phase.settings.overrides));
  write_image(in_directory(phase.settings, images.exr), render.image, metadata);
  write_image(in_directory(phase.settings, images.png),
              exposed(render.image, phase.result.exposure));
  if (render.weights) {
    images.weights_png = stem + "-weights.png";
    write_image(in_directory(phase.settings, stem + "-weights.exr"), *render.weights, metadata);
    write_image(in_directory(phase.settings, images.weights_png), weights_as_grey(*render.weights));
  }
  phase.result.images.push_back(images);
}

void add_spectrum(SceneComparison& scene, int sampler, int spp, const Image& image) {
  const auto place =
      std::find_if(scene.spectra.begin(), scene.spectra.end(), [&](const RunSpectrum& spectrum) {
        return spectrum.sampler == sampler && spectrum.spp == spp;
      });
  RunSpectrum& spectrum = place != scene.spectra.end()
                              ? *place
                              : scene.spectra.emplace_back(RunSpectrum{sampler, spp, 0, {}});
  average_in(spectrum.mean, error_spectrum(scene.reference.image, image), ++spectrum.renders);
}

// Renders once with the settings, measures, and appends the row.
void measure(Phase& phase, int sampler_index, double work_before) {
  const SamplerSpec& sampler = phase.settings.samplers[std::size_t(sampler_index)];
  const RenderSettings& settings = phase.render_settings;
  const std::string label =
      fmt::format("{}: {} at {} spp, seed {} of {}", phase.result.label, to_string(sampler),
                  settings.spp, settings.seed + 1, phase.settings.seeds);
  const auto show = [&](double fraction) {
    return phase.progress(work_before + fraction * settings.spp, label);
  };
  const RenderResult render = lockstep::render(phase.scene, sampler, settings, show);
  const RenderStats& stats = render.stats;
  Measurement run;
  run.sampler = sampler_index;
  run.seed = settings.seed;
  run.spp = stats.spp;
  run.cpu_seconds = stats.cpu_seconds;
  run.wall_seconds = stats.wall_seconds;
  run.pilot_spp = stats.pilot_spp;
  run.mean_weight = stats.mean_weight;
  run.lanes = stats.lanes;
  run.lanes_active = stats.lanes_active;
  run.nonfinite = stats.nonfinite;
  run.errors = evaluate_metrics(phase.result.reference.image, render.image);
  phase.result.packet_width = stats.width;
  phase.result.threads = stats.threads;
  phase.csv.append(phase.result.scene, to_string(sampler), run);
  phase.result.runs.push_back(run);
  add_spectrum(phase.result, sampler_index, stats.spp, render.image);
  if (settings.seed == 0) keep_images(phase, sampler_index, render);
}

double work_per_seed(const CompareSettings& settings) {
  double work = 0.0;
  for (int spp : settings.rungs) work += spp * double(settings.samplers.size());
  return work;
}

// First renders touch memory and code for the first time: they are made and thrown away.
void warm_up(Phase& phase) {
  RenderSettings settings = phase.render_settings;
  settings.spp = std::min(4, phase.settings.rungs.front());
  for (const SamplerSpec& sampler : phase.settings.samplers) {
    render(phase.scene, sampler, settings,
           [&](double) { return phase.progress(0.0, phase.result.label + ": warming up"); });
  }
}

// Samplers are innermost and change their order, so that a disturbance of the machine falls on
// all alike. Returns false where the time ran out.
bool measure_all(Phase& phase, double work, Clock::time_point deadline) {
  const int samplers = int(phase.settings.samplers.size());
  const int rungs = int(phase.settings.rungs.size());
  Clock::duration longest_seed{};
  for (int seed = 0; seed < phase.settings.seeds; ++seed) {
    const Clock::time_point start = Clock::now();
    if (phase.settings.max_seconds > 0.0 && start + longest_seed > deadline && seed > 0)
      return false;
    phase.render_settings.seed = std::uint32_t(seed);
    for (int rung = 0; rung < rungs; ++rung) {
      phase.render_settings.spp = phase.settings.rungs[std::size_t(rung)];
      for (int i = 0; i < samplers; ++i) {
        measure(phase, (i + seed + rung) % samplers, work);
        work += phase.render_settings.spp;
      }
    }
    longest_seed = std::max(longest_seed, Clock::now() - start);
  }
  return true;
}

// The reference, then all runs. Returns false where the time ran out.
bool run_phase(Phase& phase, double reference_work, Clock::time_point deadline) {
  const auto show = [&](double fraction) {
    return phase.progress(fraction * reference_work, phase.result.label + ": reference");
  };
  phase.result.reference =
      make_reference(phase.settings, phase.result, phase.scene, phase.render_settings, show);
  phase.result.exposure = preview_exposure(phase.result.reference.image);
  phase.result.reference_png = fmt::format("{}-reference.png", phase.result.label);
  write_image(in_directory(phase.settings, phase.result.reference_png),
              exposed(phase.result.reference.image, phase.result.exposure));
  warm_up(phase);
  return measure_all(phase, reference_work, deadline);
}

}  // namespace

Comparison compare(const CompareSettings& settings, const CompareProgress& progress) {
  check_settings(settings);
  check_scenes(settings);
  make_output_directory(settings.directory);
  ErrorsCsv csv(settings.directory);
  const Clock::time_point deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(settings.max_seconds));
  Comparison comparison;
  comparison.settings = settings;
  std::set<std::string> labels;
  for (std::size_t s = 0; s < settings.scenes.size(); ++s) {
    const std::string& name = settings.scenes[s];
    Scene scene(read_for(settings, name), embree_isa(settings.render.isa));
    comparison.scenes.push_back(describe(scene, settings, name, unique_label(name, labels)));
    SceneComparison& result = comparison.scenes.back();

    RenderSettings render_settings = settings.render;
    render_settings.depth = result.depth;
    const double reference_work =
        has_reference(settings, result, scene) ? 0.0 : double(reference_spp(settings));
    const double total = reference_work + settings.seeds * work_per_seed(settings);
    const auto show = [&](double work, std::string_view label) {
      return !progress ||
             progress((double(s) + work / total) / double(settings.scenes.size()), label);
    };
    Phase phase{settings, result, std::move(scene), render_settings, csv, show};
    try {
      comparison.complete &= run_phase(phase, reference_work, deadline);
    } catch (const Cancelled&) {
      comparison.complete = false;
      if (result.runs.empty()) comparison.scenes.pop_back();
      break;
    }
  }
  return comparison;
}

}  // namespace lockstep
