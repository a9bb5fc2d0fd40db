// Comparisons made up by hand, and small ones to run.
#pragma once

#include "experiments/compare/compare.h"
#include "experiments/metrics/metrics.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace lockstep {

namespace fs = std::filesystem;

// A run whose errors are `error`, squares of it, or 1 less it, as the metric wants; Yee's are
// `yee` pixels.
inline Measurement made_run(int sampler, std::uint32_t seed, int spp, double cpu, double error,
                            double yee = 1234.0) {
  Measurement run;
  run.sampler = sampler;
  run.seed = seed;
  run.spp = spp;
  run.cpu_seconds = cpu;
  run.wall_seconds = cpu;
  for (const Metric& metric : metrics()) {
    const bool squared = metric.name.find("mse") != std::string_view::npos &&
                         metric.name.find("rmse") == std::string_view::npos;
    const bool of_yee = metric.name.starts_with("yee");
    const double value = squared ? error * error : of_yee ? yee : error;
    run.errors.push_back(metric.lower_is_better ? value : 1.0 - error);
  }
  return run;
}

// Two samplers whose error is 1 / sqrt(spp); the second takes half the time.
inline Comparison made_comparison() {
  Comparison comparison;
  comparison.settings.samplers = {parse_sampler("random"), parse_sampler("owen")};
  comparison.settings.rungs = {4, 16, 64};
  comparison.settings.seeds = 4;
  SceneComparison scene;
  scene.scene = scene.label = "made </script> up";
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    for (int spp : {4, 16, 64}) {
      for (int s = 0; s < 2; ++s) {
        scene.runs.push_back(made_run(s, seed, spp, spp / (s + 1.0), 1.0 / std::sqrt(double(spp))));
      }
    }
  }
  for (int s = 0; s < 2; ++s) {
    scene.spectra.push_back({s, 16, 4, {{{0.125, 4.0}, {0.375, 1.0}}, 2.0}});
  }
  comparison.scenes.push_back(scene);
  return comparison;
}

// A sampler of a made-up comparison: seconds for a sample per pixel, and the error of `seed` as a
// factor on random's 1 / sqrt(spp).
struct MadeSampler {
  std::string name;
  double cost;
  std::function<double(int spp, std::uint32_t seed)> factor;
};

inline Comparison made_comparison(const std::vector<MadeSampler>& samplers, int seeds) {
  Comparison comparison;
  comparison.settings.rungs = {4, 16, 64};
  comparison.settings.seeds = seeds;
  SceneComparison scene;
  scene.scene = scene.label = "made";
  scene.depth = 3;
  for (std::size_t s = 0; s < samplers.size(); ++s) {
    comparison.settings.samplers.push_back(parse_sampler(samplers[s].name));
    for (std::uint32_t seed = 0; seed < std::uint32_t(seeds); ++seed) {
      for (int spp : comparison.settings.rungs) {
        scene.runs.push_back(made_run(int(s), seed, spp, samplers[s].cost * spp,
                                      samplers[s].factor(spp, seed) / std::sqrt(double(spp))));
      }
    }
  }
  comparison.scenes.push_back(scene);
  return comparison;
}

inline double always_one(int, std::uint32_t) { return 1.0; }
inline double above(int, std::uint32_t seed) { return 1.2 + 0.01 * seed; }
inline double below(int, std::uint32_t seed) { return 0.6 + 0.01 * seed; }
inline double about_one(int, std::uint32_t seed) { return seed % 2 ? 1.1 : 1.0 / 1.1; }

inline std::vector<std::string> lines_of(const fs::path& path) {
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

struct TemporaryFolder {
  fs::path path = fs::temp_directory_path() / ("lockstep-compare-" + std::to_string(::getpid()));
  TemporaryFolder() { fs::create_directories(path); }
  ~TemporaryFolder() { fs::remove_all(path); }
};

inline CompareSettings small_settings(const fs::path& folder) {
  CompareSettings settings;
  settings.scenes = {"cornell"};
  settings.samplers = {parse_sampler("random"), parse_sampler("cpt"), parse_sampler("rcs")};
  settings.rungs = {2, 8};
  settings.seeds = 2;
  settings.reference_spp = 32;
  settings.resolution = glm::ivec2(32, 32);
  settings.directory = folder.string();
  return settings;
}

}  // namespace lockstep
