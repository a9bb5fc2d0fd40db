// The equal-time experiment: every sampler renders every scene at every depth and sample count with
// several seeds, each render complete and timed, and each image is measured against one reference.
//
// Times are what RenderStats says: thread CPU seconds and wall seconds of the whole render, pilot,
// filter and weights included. Scene loading is not part of them.
//
// All that was measured is in a journal (journal.h): a comparison that was stopped, at any moment
// and by anything, continues from there.
#pragma once

#include "core/image.h"
#include "core/scene_description.h"
#include "experiments/metrics/error_spectrum.h"
#include "experiments/scenes/scene_overrides.h"
#include "packets/render.h"
#include "samplers/sampler_spec.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lockstep {

// An error to reach, and the time that takes.
struct ErrorTarget {
  std::string metric;  // a Metric's name, of one where lower is better
  double error = 0.0;
};

struct CompareSettings {
  std::vector<std::string> scenes;
  std::vector<SamplerSpec> samplers;          // the first is what the others are measured against
  std::vector<int> rungs = {4, 16, 64, 256};  // samples per pixel
  int seeds = 8;
  std::string reference_file;  // empty: render one
  int reference_spp = 0;       // 0: 1024 or 100 times the longest rung, whichever is more
  std::vector<int> depths;     // ascending; empty: the scene's
  std::optional<glm::ivec2> resolution;
  SceneOverrides overrides;  // of every scene
  RenderSettings render;     // threads, width, lanes, instruction set, roulette depth
  double max_seconds = 0.0;  // if positive: begin no further seed past this wall time
  std::string directory;
  std::string reference_folder;  // where rendered references are kept; empty: the directory
  std::vector<double> budgets;   // CPU seconds to report at; empty: chosen from what was measured
  std::vector<ErrorTarget> targets;  // empty: a FLIP that all samplers reach
  // Rungs whose median time is uncertain by more than this share are timed again, at most so often.
  double timing_spread = 0.03;
  std::optional<int> timing_repeats;  // empty: half the seeds
  bool resume = false;                // go on with what the directory holds
  std::string experiment;             // the settings as text (TOML), for the journal and the report
};

// One complete render and its errors, in the order of metrics().
struct Measurement {
  int sampler = 0;
  std::uint32_t seed = 0;
  int spp = 0;
  double cpu_seconds = 0.0;
  double wall_seconds = 0.0;
  int pilot_spp = 0;
  double mean_weight = 0.0;
  LaneLayout lanes;
  double lanes_active = 0.0;
  std::uint64_t clamped = 0;  // samples
  std::uint64_t nonfinite = 0;
  std::vector<BadSample> bad_samples;  // the first of those that were not finite
  std::vector<double> errors;
  int packet_width = 0;  // SIMD lanes
  int threads = 0;
  bool has_weights = false;  // the sampler made a map
  std::string cpu;           // the name of the one that rendered it
};

struct SceneComparison;

// The command that renders it again.
std::string command_of(const SceneComparison& scene, const CompareSettings& settings,
                       const Measurement& run);

// A render that was repeated for its time alone.
struct TimingRepeat {
  int sampler = 0;
  std::uint32_t seed = 0;
  int spp = 0;
  double cpu_seconds = 0.0;
  double wall_seconds = 0.0;
  std::string cpu;
};

// The spectrum of the error of a sampler's renders at one sample count: powers are averaged, so
// that errors of different seeds do not cancel as they would in a mean image.
struct RunSpectrum {
  int sampler = 0;
  int spp = 0;
  int renders = 0;
  ErrorSpectrum mean;
};

// The image that errors are measured against.
struct Reference {
  Image image;
  std::string file;
  std::string origin;  // one line for people: how it was made
  int spp = 0;         // 0 where unknown
  // Mean squared error over (reference^2 + 0.01), estimated from two independent halves.
  std::optional<double> relmse;
  // What the image itself is off by, by metric: half of what its halves differ by, a quarter for
  // squared errors. Metrics that do not shrink so are left out.
  std::map<std::string, double> errors;
};

// Files in the output directory, relative to it, of the first seed's render.
struct RunImages {
  int sampler = 0;
  int spp = 0;
  std::string exr, png, weights_png;
};

struct SceneComparison {
  std::string scene;  // as named on the command line
  std::string label;  // short, unique, fit for a file name
  int width = 0;
  int height = 0;
  int depth = 0;
  int packet_width = 0;  // SIMD lanes, and threads, as rendered
  int threads = 0;
  std::size_t triangles = 0;
  std::vector<std::string> features, left_out, warnings;
  Reference reference;
  std::string reference_png;
  float exposure = 1.0f;  // factor on radiance in every PNG of this scene
  std::vector<Measurement> runs;
  std::vector<TimingRepeat> repeats;
  std::vector<RunSpectrum> spectra;
  std::vector<RunImages> images;
};

struct Comparison {
  CompareSettings settings;
  bool complete = true;  // false where it was interrupted or ran out of its time
  std::vector<SceneComparison> scenes;
};

// Called with the share of the work done and what is being rendered; false asks the experiment to
// stop: it finishes the render that it measures. A reference stops at once and keeps what it has.
using CompareProgress = std::function<bool(double fraction, std::string_view label)>;

// Called when a scene is done at a depth and others follow, with all so far, which is not complete.
using SceneDone = std::function<void(const Comparison&)>;

class Desk;

// Runs the experiment, with the help of other ranks where there is a desk; the journal and
// errors.csv in the directory grow row by row, images appear as they are rendered. When stopped,
// returns what was measured so far. Throws Error, UsageError.
Comparison compare(const CompareSettings& settings, const CompareProgress& progress,
                   const SceneDone& scene_done = {}, Desk* desk = nullptr);

}  // namespace lockstep
