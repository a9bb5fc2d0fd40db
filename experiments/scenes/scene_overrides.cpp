#include "experiments/scenes/scene_overrides.h"

#include "core/error.h"
#include "core/read_scene.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

namespace lockstep {
namespace {

namespace fs = std::filesystem;
using Kind = EnvironmentOverride::Kind;

// Three numbers between commas, whatever they are.
std::optional<glm::vec3> parse_color(const std::string& text) {
  glm::vec3 color(0.0f);
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int i = 0; i < 3; ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return {};
    const auto [next, error] = std::from_chars(at, end, color[i]);
    if (error != std::errc()) return {};
    at = next;
  }
  if (at != end) return {};
  return color;
}

// Turns y to the axis named, the other axes as little as that allows.
glm::mat3 turned_up(const std::string& up) {
  const bool down = up.starts_with('-');
  const float sign = down ? -1.0f : 1.0f;
  const std::string_view axis = std::string_view(up).substr(down ? 1 : 0);
  if (axis == "x") return {{0.0f, -sign, 0.0f}, {sign, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
  if (axis == "y") return {{1.0f, 0.0f, 0.0f}, {0.0f, sign, 0.0f}, {0.0f, 0.0f, sign}};
  if (axis == "z") return {{1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, sign}, {0.0f, -sign, 0.0f}};
  throw UsageError(
      fmt::format("--environment-up: unknown axis '{}'; choose from x, y, z, -x, -y, -z", up));
}

Environment parse_replacement(const std::string& text) {
  if (const auto color = parse_color(text)) {
    for (const float v : {color->x, color->y, color->z}) {
      if (v >= 0.0f && std::isfinite(v)) continue;
      throw UsageError(fmt::format("--environment: '{}': radiance is 0 or more", text));
    }
    return Environment(*color);
  }
  std::error_code ignored;
  if (!fs::is_regular_file(text, ignored)) {
    throw Error(fmt::format(
        "--environment: {}: no such file; name an image such as sky.exr, or give R,G,B or none",
        text));
  }
  Environment environment;
  environment.mapping = Environment::Mapping::LatLong;
  environment.file = text;
  environment.where = "--environment";
  return environment;
}

// What readers say of the default that the override has replaced.
void drop_warnings(SceneDescription& scene, std::string_view ending) {
  std::erase_if(scene.warnings, [&](const std::string& w) { return w.ends_with(ending); });
}

}  // namespace

EnvironmentOverride parse_environment(const std::string& text, std::optional<float> scale,
                                      const std::string& up) {
  EnvironmentOverride change;
  change.scale = scale;
  change.up = up;
  const auto refuse_up = [&] {
    if (!up.empty()) throw UsageError("--environment-up: add --environment with an image to turn");
  };
  if (text.empty()) {
    refuse_up();
    return change;
  }
  change.kind = text == "none" ? Kind::Remove : Kind::Replace;
  if (change.kind == Kind::Replace) change.environment = parse_replacement(text);
  if (change.kind == Kind::Remove && scale) {
    throw UsageError("--environment-scale: there is nothing to scale with --environment none");
  }
  if (change.environment.mapping == Environment::Mapping::Constant) {
    refuse_up();
  } else if (!up.empty()) {
    change.environment.to_world = turned_up(up);
  }
  return change;
}

std::string to_string(const EnvironmentOverride& change) {
  if (change.kind == Kind::Keep) return "";
  if (change.kind == Kind::Remove) return "none";
  const Environment& e = change.environment;
  if (e.mapping != Environment::Mapping::Constant) return e.file;
  return fmt::format("{},{},{}", e.radiance.x, e.radiance.y, e.radiance.z);
}

void apply_override(const EnvironmentOverride& change, std::optional<Environment>& environment) {
  if (change.kind == Kind::Remove) environment.reset();
  if (change.kind == Kind::Replace) environment = change.environment;
  if (!change.scale) return;
  if (!environment) {
    throw UsageError("--environment-scale: the scene has no environment; add --environment");
  }
  environment->radiance *= *change.scale;
}

Metadata override_metadata(const SceneOverrides& overrides) {
  Metadata metadata;
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) metadata[key] = value;
  };
  add("camera", to_string(overrides.camera));
  add("environment", to_string(overrides.environment));
  add("environment_up", overrides.environment.up);
  const std::optional<float> scale = overrides.environment.scale;
  add("environment_scale", scale ? fmt::format("{}", *scale) : "");
  add("compensate", overrides.compensate ? "yes" : "");
  add("intersection", overrides.robust_intersection ? "" : "fast");
  return metadata;
}

SceneDescription read_scene(const std::string& name, const SceneOverrides& overrides) {
  SceneDescription scene = read_scene(name);
  apply_override(overrides.camera, scene.camera);
  apply_override(overrides.environment, scene.environment);
  scene.compensate_microfacets = overrides.compensate;
  scene.robust_intersection = overrides.robust_intersection;
  if (overrides.camera.origin) drop_warnings(scene, "; one that frames all is used");
  if (overrides.environment.kind != Kind::Keep) {
    drop_warnings(scene, "; an environment of radiance 1 is used");
  }
  return scene;
}

}  // namespace lockstep
