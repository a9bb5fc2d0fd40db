#include "experiments/output/render_command.h"

#include "experiments/output/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace lockstep {
namespace {

struct Words {
  std::vector<std::string> all;
  void add(const char* option, std::string value) {
    all.insert(all.end(), {option, std::move(value)});
  }
};

}  // namespace

std::string scene_command(const std::string& scene, const RenderSettings& settings, int depth,
                          int width, int height, const Metadata& overrides) {
  Words words{{"lockstep", "render", scene}};
  words.add("--depth", std::to_string(depth));
  words.add("--roulette-depth", std::to_string(settings.roulette_depth));
  words.add("--resolution", fmt::format("{}x{}", width, height));
  words.add("--isa", std::string(name(settings.isa)));
  if (settings.clamp) words.add("--clamp", fmt::format("{}", *settings.clamp));
  for (const auto& [key, value] : overrides) {
    std::string option = "--" + key;
    std::replace(option.begin(), option.end(), '_', '-');
    words.all.push_back(option);
    if (key != "compensate") words.all.push_back(value);
  }
  return shell_line(words.all);
}

std::string render_command(const std::string& scene, const SamplerSpec& sampler,
                           const RenderSettings& settings, int width, int height,
                           const Metadata& overrides) {
  Words words;
  words.add("-o", "again.exr");
  words.add("--sampler", to_string(sampler));
  words.add("--spp", std::to_string(settings.spp));
  words.add("--seed", std::to_string(settings.seed));
  if (settings.width > 0) words.add("--width", std::to_string(settings.width));
  if (settings.lanes) words.add("--lanes", to_string(*settings.lanes));
  if (settings.traversal) words.add("--traversal", to_string(*settings.traversal));
  if (settings.threads > 0) words.add("--threads", std::to_string(settings.threads));
  if (!settings.specialized) words.all.push_back("--general");
  return scene_command(scene, settings, settings.depth, width, height, overrides) + ' ' +
         shell_line(words.all);
}

std::string nonfinite_text(const BadSample& bad, std::uint32_t seed, const std::string& command) {
  return fmt::format(
      "lockstep: warning: not finite: pixel ({}, {}), sample {}, seed {}; again with: {}\n", bad.x,
      bad.y, bad.sample, seed, command);
}

}  // namespace lockstep
