#include "experiments/scenes/camera_override.h"

#include "core/error.h"
#include "core/location.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKeys = "origin, target, up, fov, lens and focus";
constexpr std::uintmax_t kLargestFile = 1 << 20;  // bytes
constexpr float kFarthest = 1e18f;                // its square is finite

using Point = std::optional<glm::vec3> CameraOverride::*;
using Number = std::optional<float> CameraOverride::*;

struct PointKey {
  std::string_view key;
  Point member;
};
struct NumberKey {
  std::string_view key;
  Number member;
  const char* expected;
  bool (*accepts)(float);
};

constexpr std::array kPoints{PointKey{"origin", &CameraOverride::origin},
                             PointKey{"target", &CameraOverride::target},
                             PointKey{"up", &CameraOverride::up}};
constexpr std::array kNumbers{
    NumberKey{"fov", &CameraOverride::fov_degrees, "degrees between 0 and 180",
              [](float v) { return v > 0.0f && v < 180.0f; }},
    NumberKey{"lens", &CameraOverride::lens_radius, "a radius of 0 or more",
              [](float v) { return v >= 0.0f; }},
    NumberKey{"focus", &CameraOverride::focal_distance, "a distance above 0",
              [](float v) { return v > 0.0f; }}};

// Sets what `key` names; values are finite. Returns what is wrong, empty if nothing is.
std::string set(CameraOverride& camera, std::string_view key, const std::vector<float>& values) {
  for (const float v : values) {
    if (std::abs(v) > kFarthest) return fmt::format("{} is beyond {:g}", key, kFarthest);
  }
  for (const PointKey& known : kPoints) {
    if (known.key != key) continue;
    auto& member = camera.*known.member;
    if (member) return fmt::format("{} is given twice", key);
    if (values.size() != 3) return fmt::format("{} takes three numbers, such as 0,1.5,4", key);
    member = glm::vec3(values[0], values[1], values[2]);
    if (key == "up" && *member == glm::vec3(0.0f)) return "up has no direction";
    return "";
  }
  for (const NumberKey& known : kNumbers) {
    if (known.key != key) continue;
    auto& member = camera.*known.member;
    if (member) return fmt::format("{} is given twice", key);
    if (values.size() != 1 || !known.accepts(values[0])) {
      return fmt::format("{} takes {}", key, known.expected);
    }
    member = values[0];
    return "";
  }
  return fmt::format("there is no '{}'; the parts of a camera are {}", key, kKeys);
}

// Numbers between commas; empty where one of them is none.
std::vector<float> numbers(std::string_view text) {
  std::vector<float> values;
  for (;;) {
    const std::string_view item = text.substr(0, text.find(','));
    float value = 0.0f;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), value);
    if (error != std::errc() || end != item.data() + item.size() || !std::isfinite(value)) {
      return {};
    }
    values.push_back(value);
    if (item.size() == text.size()) return values;
    text.remove_prefix(item.size() + 1);
  }
}

CameraOverride parse_parts(std::string_view text) {
  CameraOverride camera;
  for (std::string_view rest = text;;) {
    const std::string_view part = rest.substr(0, rest.find_first_of(":;"));
    const std::size_t equals = part.find('=');
    const std::string wrong =
        equals == std::string_view::npos
            ? fmt::format("'{}' is not a part with its value, such as fov=40", part)
            : set(camera, part.substr(0, equals), numbers(part.substr(equals + 1)));
    if (!wrong.empty()) throw UsageError(fmt::format("--camera: '{}': {}", text, wrong));
    if (part.size() == rest.size()) return camera;
    rest.remove_prefix(part.size() + 1);
  }
}

nlohmann::json read_json(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    throw Error(fmt::format(
        "--camera: {}: no such file; name a JSON file, or parts such as origin=0,1.5,4:fov=40",
        path));
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(fmt::format("--camera: {}: cannot open the file for reading", path));
  if (fs::file_size(path, ignored) > kLargestFile) {
    throw Error(fmt::format("--camera: {}: too large for a camera", path));
  }
  const std::string text(std::istreambuf_iterator<char>(file), {});
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const auto end = text.begin() + std::ptrdiff_t(std::min(error.byte, text.size()));
    throw error_at(path, 1 + int(std::count(text.begin(), end, '\n')),
                   "not JSON; write an object such as {\"origin\": [0, 1.5, 4], \"fov\": 40}");
  } catch (const nlohmann::json::out_of_range&) {
    throw Error(fmt::format("--camera: {}: a number is too large", path));
  }
}

std::vector<float> numbers(const nlohmann::json& value) {
  std::vector<float> values;
  const auto add = [&](const nlohmann::json& v) {
    if (v.is_number() && std::isfinite(v.get<float>())) values.push_back(v.get<float>());
  };
  if (!value.is_array()) add(value);
  if (value.is_array()) {
    for (const nlohmann::json& v : value) add(v);
    if (values.size() != value.size()) values.clear();
  }
  return values;
}

CameraOverride parse_file(const std::string& path) {
  const nlohmann::json json = read_json(path);
  if (!json.is_object()) {
    throw Error(fmt::format("--camera: {}: is not an object with {}", path, kKeys));
  }
  CameraOverride camera;
  for (const auto& [key, value] : json.items()) {
    const std::string wrong = set(camera, key, numbers(value));
    if (!wrong.empty()) throw Error(fmt::format("--camera: {}: {}", path, printable(wrong)));
  }
  return camera;
}

// The axis of the world that the camera stands along, or its own upward one if it is rolled.
glm::dvec3 upright(const glm::dmat3& m) {
  const glm::dvec3 up = m[1] / glm::length(m[1]), right = m[0] / glm::length(m[0]);
  glm::dvec3 axis(0.0);
  int nearest = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(up[i]) > std::abs(up[nearest])) nearest = i;
  }
  axis[nearest] = std::copysign(1.0, up[nearest]);
  return std::abs(right[nearest]) < 1e-3 ? axis : up;
}

// Turns the camera; the lengths of its axes, and which side of the view its right is on, stay.
void turn(glm::dvec3 forward, const std::vector<glm::dvec3>& ups, glm::mat4& camera_to_world) {
  const glm::dmat3 old(camera_to_world);
  const double side = glm::determinant(old) < 0.0 ? -1.0 : 1.0;
  forward /= glm::length(forward);
  for (const glm::dvec3& up : ups) {
    const glm::dvec3 right = glm::cross(up / glm::length(up), forward);
    if (!(glm::length(right) > 1e-4)) continue;
    const glm::dvec3 x = side * right / glm::length(right), y = side * glm::cross(forward, x);
    const glm::dvec3 axes[] = {x, y, forward};
    for (int i = 0; i < 3; ++i) {
      camera_to_world[i] = glm::vec4(glm::vec3(axes[i] * glm::length(old[i])), 0.0f);
    }
    return;
  }
  throw UsageError("--camera: up is along the direction of view; give another");
}

std::string text_of(glm::vec3 v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

float rounded(float v) { return std::strtof(fmt::format("{:.6g}", v).c_str(), nullptr); }

// To six digits of `scale`: products of matrices leave dust.
glm::vec3 rounded(glm::vec3 v, float scale) {
  const int digits = std::clamp(5 - int(std::floor(std::log10(scale))), 0, 45);
  for (int i = 0; i < 3; ++i) {
    v[i] = std::strtof(fmt::format("{:.{}f}", v[i], digits).c_str(), nullptr) + 0.0f;
  }
  return v;
}

}  // namespace

CameraOverride parse_camera(const std::string& text) {
  const bool is_file = text.ends_with(".json") || text.find('=') == std::string::npos;
  return is_file ? parse_file(text) : parse_parts(text);
}

std::string to_string(const CameraOverride& camera) {
  std::string text;
  const auto add = [&](std::string_view key, const std::string& value) {
    text += fmt::format("{}{}={}", text.empty() ? "" : ":", key, value);
  };
  for (const auto& [key, member] : kPoints) {
    if (camera.*member) add(key, text_of(*(camera.*member)));
  }
  for (const NumberKey& known : kNumbers) {
    if (camera.*known.member) add(known.key, fmt::format("{}", *(camera.*known.member)));
  }
  return text;
}

CameraOverride override_of(const CameraDescription& camera) {
  const glm::mat4& m = camera.camera_to_world;
  const glm::vec3 origin(m[3]), forward = glm::normalize(glm::vec3(m[2]));
  CameraOverride o;
  // As far as the origin is from zero: rounded, both still give the direction.
  const float distance = glm::length(origin) > 0.0f ? glm::length(origin) : 1.0f;
  o.origin = rounded(origin, distance);
  o.target = rounded(origin + distance * forward, distance);
  o.up = rounded(glm::normalize(glm::vec3(m[1])), 1.0f);
  if (camera.projection == CameraDescription::Projection::Perspective) {
    o.fov_degrees = rounded(camera.fov_degrees);
  }
  if (camera.lens_radius > 0.0f) {
    o.lens_radius = rounded(camera.lens_radius);
    o.focal_distance = rounded(camera.focal_distance);
  }
  return o;
}

void apply_override(const CameraOverride& change, CameraDescription& camera) {
  glm::mat4& m = camera.camera_to_world;
  if (change.origin) m[3] = glm::vec4(*change.origin, 1.0f);
  const glm::dvec3 origin(m[3]), axis(m[2]);
  const glm::dvec3 forward = change.target ? glm::dvec3(*change.target) - origin : axis;
  if (!(glm::length(forward) > 0.0)) {
    throw UsageError(fmt::format("--camera: the target {} is where the camera is; move one of them",
                                 text_of(glm::vec3(origin))));
  }
  if (change.up) {
    turn(forward, {glm::dvec3(*change.up)}, m);
  } else if (change.target) {
    turn(forward, {upright(glm::dmat3(m)), glm::dvec3(m[1]), axis}, m);
  }
  if (change.fov_degrees) {
    camera.fov_degrees = *change.fov_degrees;
    camera.projection = CameraDescription::Projection::Perspective;
  }
  if (change.lens_radius) camera.lens_radius = *change.lens_radius;
  if (change.focal_distance) {
    camera.focal_distance = *change.focal_distance;
  } else if (change.target && change.lens_radius) {
    camera.focal_distance = float(glm::length(forward) / glm::length(axis));
  }
}

}  // namespace lockstep
