#include "experiments/compare/compare_case.h"

#include "core/cpu_clock.h"
#include "core/read_scene.h"
#include "experiments/output/activity.h"
#include "experiments/output/output_file.h"
#include "experiments/output/render_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

// The scene's name, or its file's without folder and extension; with the folder where scenes would
// be called alike, and with the depth where there are several. Numbered where that is taken.
std::string unique_label(const CompareSettings& settings, const std::string& scene, int depth,
                         std::set<std::string>& taken) {
  const fs::path path(scene);
  const auto alike = std::count_if(
      settings.scenes.begin(), settings.scenes.end(),
      [&](const std::string& other) { return fs::path(other).stem() == path.stem(); });
  const std::string folder = path.parent_path().filename().string();
  std::string stem = file_name_safe((alike > 1 && !folder.empty() ? folder + '-' : std::string()) +
                                    path.stem().string());
  if (settings.depths.size() > 1) stem += fmt::format("-depth{}", depth);
  std::string label = stem;
  for (int n = 2; !taken.insert(label).second; ++n) label = fmt::format("{}-{}", stem, n);
  return label;
}

SceneDescription read_for(const CompareSettings& settings, const std::string& scene) {
  const Activity reading("reading the scene " + scene);
  SceneDescription description = read_scene(scene, settings.overrides);
  if (settings.resolution) {
    description.film.width = settings.resolution->x;
    description.film.height = settings.resolution->y;
  }
  return description;
}

std::vector<int> depths_of(const CompareSettings& settings, const SceneDescription& scene) {
  return settings.depths.empty() ? std::vector<int>{scene.defaults.depth} : settings.depths;
}

}  // namespace

const Scene& KeptScene::get(std::size_t index) {
  if (scene_ && index_ == index) return *scene_;
  scene_.reset();
  const double start = wall_seconds();
  scene_.emplace(read_for(settings_, settings_.scenes[index]), embree_isa(settings_.render.isa));
  index_ = index;
  seconds_ = wall_seconds() - start;
  return *scene_;
}

std::vector<CasePlan> plan_cases(const CompareSettings& settings) {
  for (const std::string& scene : settings.scenes) scene_format(scene);
  std::vector<CasePlan> plans;
  std::set<std::string> labels;
  for (std::size_t s = 0; s < settings.scenes.size(); ++s) {
    const SceneDescription scene = read_for(settings, settings.scenes[s]);
    for (int depth : depths_of(settings, scene)) {
      plans.push_back({s, depth, unique_label(settings, settings.scenes[s], depth, labels),
                       double(scene.film.width) * scene.film.height * (1.0 + depth)});
    }
  }
  return plans;
}

SceneComparison describe(const CompareSettings& settings, const CasePlan& plan,
                         const Scene& scene) {
  const SceneDescription& description = scene.description();
  SceneComparison result;
  result.scene = settings.scenes[plan.scene];
  result.label = plan.label;
  result.width = description.film.width;
  result.height = description.film.height;
  result.depth = plan.depth;
  result.triangles = scene.triangle_count();
  result.features = feature_names(scene.features());
  result.left_out = feature_names(all_features & ~scene.features());
  result.warnings = description.warnings;
  if (settings.render.clamp) {
    result.warnings.push_back(
        fmt::format("{}: all renders are {}", result.scene, clamp_text(*settings.render.clamp)));
  }
  return result;
}

}  // namespace lockstep
