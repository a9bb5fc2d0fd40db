// Options with a grammar of their own: cameras (as text and as a file of JSON), environments, lane
// layouts and modes of traversal. What is accepted is finite and has a text that means the same.
#include "experiments/scenes/scene_overrides.h"
#include "packets/lane_layout.h"
#include "packets/traversal_mode.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/own_errors.h"
#include "tests/fuzz/playground.h"

#include <glm/mat4x4.hpp>

#include <cmath>
#include <string>

namespace lockstep::fuzz {
namespace {

void check_camera(const CameraOverride& change) {
  const std::string text = to_string(change);
  if (text.empty()) return;
  require(to_string(parse_camera(text)) == text, "camera " + text + " is another");
  CameraDescription camera;
  apply_override(change, camera);
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      require(std::isfinite(camera.camera_to_world[column][row]), text + ": not finite");
    }
  }
  require(std::isfinite(camera.focal_distance) && std::isfinite(camera.lens_radius),
          text + ": the lens is not finite");
}

void check_environment(const std::string& text) {
  const EnvironmentOverride change = parse_environment(text, {});
  const std::string again = to_string(change);
  require(to_string(parse_environment(again, {})) == again, "environment " + again);
}

void check_layout(const std::string& text) {
  const LaneLayout lanes = parse_lane_layout(text);
  require(lanes.x > 0 && lanes.y > 0 && lanes.samples > 0, "lanes without places");
  require(parse_lane_layout(to_string(lanes)) == lanes, "lanes " + text);
}

void check_traversal(const std::string& text) {
  const auto mode = parse_traversal(text);
  require(!mode || parse_traversal(to_string(*mode)) == mode, "traversal " + text);
}

}  // namespace
}  // namespace lockstep::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lockstep;
  using namespace lockstep::fuzz;
  static const Playground playground;
  const std::string text = typed(data, size);
  expect_own_errors("camera", [&] { check_camera(parse_camera(text)); });
  expect_own_errors("environment", [&] { check_environment(text); });
  expect_own_errors("lanes", [&] { check_layout(text); });
  expect_own_errors("traversal", [&] { check_traversal(text); });
  if (!text.starts_with('{')) return 0;
  const std::string path = playground.write("camera.json", data, size);
  expect_own_errors("camera's file", [&] { check_camera(parse_camera(path)); });
  return 0;
}
