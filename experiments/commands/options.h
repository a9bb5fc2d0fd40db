// Command-line options that several subcommands share.
#pragma once

#include "experiments/scenes/scene_overrides.h"
#include "packets/render.h"

#include <CLI/CLI.hpp>
#include <glm/vec2.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lockstep {

// How to render, as typed; empty or "auto" where nothing was said.
struct RendererOptions {
  std::optional<int> depth;
  int roulette_depth = 5;
  std::optional<float> clamp;
  std::string resolution;
  int threads = 0;
  std::string width = "auto";
  std::string lanes = "auto";
  std::string traversal = "auto";
  bool general = false;
  std::string isa = "auto";
  std::string camera, environment, environment_up;
  std::optional<float> environment_scale;
  bool compensate = false;
  std::string intersection = "robust";
};

// Accepts numbers from `low` to `high`; help shows the option's own words alone.
CLI::Validator number_between(double low, double high);

// The same for whole numbers.
CLI::Validator whole_number_between(std::int64_t low, std::int64_t high);

// Accepts the words that the option's description gives. The validator is named after them, with
// bars between, for shells to complete.
CLI::Validator one_of(const std::vector<std::string>& choices);

// Makes all options of all subcommands that take a value refuse an empty one.
void refuse_empty_values(CLI::App& program);

void add_renderer_options(CLI::App& command, RendererOptions& options);

// How long a silent rank is waited for, in seconds.
void add_rank_options(CLI::App& command, double& timeout);

// Threads, width, lanes, instruction set and roulette depth. Throws UsageError, Error.
RenderSettings render_settings(const RendererOptions& options);

// What is to be changed about the scene. Throws UsageError, Error.
SceneOverrides scene_overrides(const RendererOptions& options);

// Reads the scene, prints what of it was not understood unless quiet, and makes the changes that
// the options ask for. Throws UsageError, Error.
SceneDescription read_described(const std::string& scene, const RendererOptions& options,
                                const SceneOverrides& overrides, bool quiet = false);

// "0,0.5,1": numbers from 0 to 1, ascending after sorting; duplicates go. Throws UsageError.
std::vector<float> parse_weights(std::string_view text);

// "WxH" in pixels. Throws UsageError.
glm::ivec2 parse_resolution(std::string_view text);

// "1,4,16": positive and ascending after sorting; duplicates go. Throws UsageError.
std::vector<int> parse_sample_counts(std::string_view text);
std::vector<int> parse_depths(std::string_view text);

// "0.5,1,2": positive and ascending after sorting; duplicates go. Throws UsageError.
std::vector<double> parse_time_budgets(std::string_view text);

// "flip_ldr=0.03,rmse=0.1": names before positive numbers. Throws UsageError.
std::vector<std::pair<std::string, double>> parse_targets(std::string_view text);

std::vector<std::string> split_at_commas(std::string_view text);

}  // namespace lockstep
