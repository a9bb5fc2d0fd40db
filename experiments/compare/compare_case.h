// A case of a comparison: one scene at one depth, read and described.
#pragma once

#include "core/scene.h"
#include "experiments/compare/compare.h"

#include <optional>
#include <string>
#include <vector>

namespace lockstep {

struct CasePlan {
  std::size_t scene = 0;  // in the settings
  int depth = 0;
  std::string label;  // see SceneComparison
  double cost = 0.0;  // of a sample per pixel, in units that are about the same for all scenes
};

// All cases, scene by scene. Reads all scenes: a mistake in any of them is found before files are
// touched and hours are spent on the others. Throws Error, UsageError.
std::vector<CasePlan> plan_cases(const CompareSettings& settings);

// The scene that was needed last: cases of one scene follow each other.
class KeptScene {
 public:
  explicit KeptScene(const CompareSettings& settings) : settings_(settings) {}

  // A scene of the settings.
  const Scene& get(std::size_t index);
  double seconds() const { return seconds_; }  // that the last one took to read

 private:
  const CompareSettings& settings_;
  std::optional<Scene> scene_;
  std::size_t index_ = 0;
  double seconds_ = 0.0;
};

// The case before anything is rendered.
SceneComparison describe(const CompareSettings& settings, const CasePlan& plan, const Scene& scene);

}  // namespace lockstep
