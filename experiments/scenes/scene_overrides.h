// What the command line changes about a scene: its camera, its environment, its metals.
#pragma once

#include "core/image.h"
#include "core/scene_description.h"
#include "experiments/scenes/camera_override.h"

#include <optional>
#include <string>

namespace lockstep {

struct EnvironmentOverride {
  enum class Kind { Keep, Remove, Replace };
  Kind kind = Kind::Keep;
  Environment environment;     // in place of the scene's
  std::optional<float> scale;  // of the radiance of whichever there is
  std::string up;              // where the image's top lies; empty: y
};

// "none", "R,G,B" (a constant radiance), or the name of an image, a latitude-longitude map as
// core/light_description.h has it, turned so that its top lies along `up`, any of x, y, z, -x, -y,
// -z (empty: y). Empty: the scene's own. Throws UsageError for values below 0, for "none" with a
// scale and for an `up` without an image, Error for a file that does not exist.
EnvironmentOverride parse_environment(const std::string& text, std::optional<float> scale,
                                      const std::string& up = "");

// In the form that parse_environment reads, without scale and up. Empty where nothing is replaced.
std::string to_string(const EnvironmentOverride& change);

// Throws UsageError where there is no environment to scale.
void apply_override(const EnvironmentOverride& change, std::optional<Environment>& environment);

struct SceneOverrides {
  CameraOverride camera;
  EnvironmentOverride environment;
  bool compensate = false;          // SceneDescription::compensate_microfacets
  bool robust_intersection = true;  // SceneDescription::robust_intersection
};

// For image headers and statistics: "camera", "environment", "environment_up", "environment_scale",
// "compensate" and "intersection" as typed, each only where it changes something.
Metadata override_metadata(const SceneOverrides& overrides);

// core/read_scene.h's read_scene with the changes made. Throws what it and apply_override() throw.
SceneDescription read_scene(const std::string& name, const SceneOverrides& overrides);

}  // namespace lockstep
