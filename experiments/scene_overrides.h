// What the command line changes about a scene: its camera, its environment, its metals.
#pragma once

#include "core/image.h"
#include "core/scene_description.h"
#include "experiments/camera_override.h"

#include <optional>
#include <string>

namespace lockstep {

struct EnvironmentOverride {
  enum class Kind { Keep, Remove, Replace };
  Kind kind = Kind::Keep;
  Environment environment;     // in place of the scene's
  std::optional<float> scale;  // of the radiance of whichever there is
};

// "none", "R,G,B" (a constant radiance), or the name of an image, a latitude-longitude map with y
// up as core/light_description.h has it. Empty: the scene's own. Throws UsageError for values below
// 0 and for "none" with a scale, Error for a file that does not exist.
EnvironmentOverride parse_environment(const std::string& text, std::optional<float> scale);

// In the form that parse_environment reads, without the scale. Empty where nothing is replaced.
std::string to_string(const EnvironmentOverride& change);

// Throws UsageError where there is no environment to scale.
void apply_override(const EnvironmentOverride& change, std::optional<Environment>& environment);

struct SceneOverrides {
  CameraOverride camera;
  EnvironmentOverride environment;
  bool compensate = false;  // SceneDescription::compensate_microfacets
};

// For image headers and statistics: "camera", "environment", "environment_scale" and "compensate" as
// typed, each only where it changes something.
Metadata override_metadata(const SceneOverrides& overrides);

// core/read_scene.h's read_scene with the changes made. Throws what it and apply_override() throw.
SceneDescription read_scene(const std::string& name, const SceneOverrides& overrides);

}  // namespace lockstep
