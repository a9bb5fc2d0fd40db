// Camera and environment from the command line, in place of the scene's.
#include "experiments/scenes/scene_overrides.h"

#include "core/read_scene.h"
#include "core/scene.h"
#include "tests/t_files.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <utility>
#include <vector>

namespace lockstep::test_scene_overrides {
namespace {

class SceneOverridesTest : public TestWithFiles {};

// The message of the UsageError that `action` throws; empty if it throws none.
template <typename Action>
std::string usage_error_of(Action action) {
  try {
    action();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

void expect_near(glm::vec3 a, glm::vec3 b, float tolerance = 1e-5f) {
  EXPECT_LT(glm::distance(a, b), tolerance)
      << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

glm::vec3 axis(const CameraDescription& camera, int i) {
  return glm::vec3(camera.camera_to_world[i]);
}

// A camera at (1, 2, 5) that looks along -z and a little down; what is on the right of its image
// lies along `right` times x.
CameraDescription tilted_camera(float right) {
  const glm::vec3 z = glm::normalize(glm::vec3(0.0f, -0.3f, -1.0f)), x(right, 0.0f, 0.0f);
  const glm::vec3 y = glm::normalize(glm::vec3(0.0f, 1.0f, -0.3f));
  CameraDescription camera;
  camera.camera_to_world =
      glm::mat4(glm::vec4(x, 0), glm::vec4(y, 0), glm::vec4(z, 0), glm::vec4(1, 2, 5, 1));
  camera.fov_degrees = 50.0f;
  camera.shift = {0.1f, -0.2f};
  return camera;
}
constexpr float kRightHanded = 1.0f, kLeftHanded = -1.0f;

float handedness(const CameraDescription& camera) {
  return glm::determinant(glm::mat3(camera.camera_to_world));
}

// Where a point lies in the image, right and up of the middle, at distance 1.
glm::vec2 seen_at(const CameraDescription& camera, glm::vec3 p) {
  const glm::vec4 local = glm::inverse(camera.camera_to_world) * glm::vec4(p, 1.0f);
  return glm::vec2(local.x, local.y) / local.z;
}

CameraDescription changed(CameraDescription camera, const std::string& text) {
  apply_override(parse_camera(text), camera);
  return camera;
}

TEST_F(SceneOverridesTest, CameraPartsInAnyOrder) {
  const CameraOverride camera =
      parse_camera("fov=40:up=0,0,1:origin=1,-2.5,3e1:focus=7:target=0,0,0:lens=0");
  EXPECT_EQ(camera.origin, glm::vec3(1.0f, -2.5f, 30.0f));
  EXPECT_EQ(camera.target, glm::vec3(0.0f));
  EXPECT_EQ(camera.up, glm::vec3(0, 0, 1));
  EXPECT_EQ(camera.fov_degrees, 40.0f);
  EXPECT_EQ(camera.lens_radius, 0.0f);
  EXPECT_EQ(camera.focal_distance, 7.0f);
  EXPECT_EQ(to_string(camera), "origin=1,-2.5,30:target=0,0,0:up=0,0,1:fov=40:lens=0:focus=7");

  const CameraOverride two = parse_camera("origin=0,0,1;fov=20.5");
  EXPECT_EQ(to_string(two), "origin=0,0,1:fov=20.5");
  EXPECT_FALSE(two.target || two.up || two.lens_radius || two.focal_distance);
  EXPECT_EQ(to_string(parse_camera("fov=0.1")), "fov=0.1");
  EXPECT_EQ(to_string(CameraOverride{}), "");
}

TEST_F(SceneOverridesTest, WrongCamerasAreSaidInOneLine) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"origin=1,2", "origin takes three numbers"},
      {"origin=1,2,3,4", "origin takes three numbers"},
      {"origin=1,2,x", "origin takes three numbers"},
      {"origin=1,2,", "origin takes three numbers"},
      {"origin=", "origin takes three numbers"},
      {"target=inf,0,0", "target takes three numbers"},
      {"target=0,nan,0", "target takes three numbers"},
      {"target=0,1e99,0", "target takes three numbers"},
      {"target=0,-1e19,0", "target is beyond 1e+18"},
      {"up=0,0,0", "up has no direction"},
      {"fov=0", "fov takes degrees between 0 and 180"},
      {"fov=180", "between 0 and 180"},
      {"fov=40,40", "between 0 and 180"},
      {"lens=-1", "lens takes a radius of 0 or more"},
      {"focus=0", "focus takes a distance above 0"},
      {"zoom=2", "no 'zoom'; the parts of a camera are origin, target, up, fov"},
      {"fov=40:fov=41", "fov is given twice"},
      {"fov=40:", "'' is not a part with its value"},
      {":fov=40", "'' is not a part with its value"},
      {"fov=40:5", "'5' is not a part with its value"},
      {"=", "no ''"}};
  for (const auto& [text, part] : wrong) {
    const std::string message = usage_error_of([&] { parse_camera(text); });
    expect_one_line_with(message, part);
    expect_one_line_with(message, "--camera: '" + text + "': ");
  }
}

TEST_F(SceneOverridesTest, CamerasFromFiles) {
  const std::string file = write(
      "view.json", "{\"origin\": [1, 2.5, -3], \"up\": [0, 1, 0],\n \"fov\": 35, \"lens\": 0.5}");
  EXPECT_EQ(to_string(parse_camera(file)), "origin=1,2.5,-3:up=0,1,0:fov=35:lens=0.5");
  // Any name without '='.
  EXPECT_EQ(to_string(parse_camera(write("view", "{\"focus\": 3}"))), "focus=3");
  EXPECT_EQ(to_string(parse_camera(write("a=b.json", "{}"))), "");
}

TEST_F(SceneOverridesTest, WrongCameraFilesAreSaidInOneLine) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"{\n\"fov\": 35,\n\"up\": [0, 1 0]}", "bad.json:3: not JSON"},
      {"", "bad.json:1: not JSON"},
      {"[1, 2, 3]", "bad.json: is not an object"},
      {"{\"eye\": [0, 0, 0]}", "bad.json: there is no 'eye'"},
      {"{\"origin\": [0, 0]}", "origin takes three numbers"},
      {"{\"origin\": [0, 0, \"1\"]}", "origin takes three numbers"},
      {"{\"origin\": [0, 0, [1]]}", "origin takes three numbers"},
      {"{\"origin\": 5}", "origin takes three numbers"},
      {"{\"fov\": null}", "fov takes degrees"},
      {"{\"lens\": 1e60}", "lens takes a radius"},
      {"{\"lens\": 1e19}", "lens is beyond 1e+18"},
      {"{\"lens\": 1e999}", "bad.json: a number is too large"}};
  for (const auto& [text, part] : wrong) {
    const std::string file = write("bad.json", text);
    expect_one_line_with(error_of([&] { parse_camera(file); }), part);
  }
  expect_one_line_with(error_of([] { parse_camera("nosuch.json"); }), "nosuch.json: no such file");
  expect_one_line_with(error_of([] { parse_camera("0,0,1"); }), "0,0,1: no such file");
  expect_one_line_with(error_of([&] { parse_camera(directory_.string()); }), "no such file");
  const std::string large = write("large.json", std::string(2 << 20, ' '));
  expect_one_line_with(error_of([&] { parse_camera(large); }), "too large");
}

TEST_F(SceneOverridesTest, WhatIsNotGivenStays) {
  for (const float right : {kRightHanded, kLeftHanded}) {
    const CameraDescription old = tilted_camera(right);
    const CameraDescription moved = changed(old, "origin=7,8,9");
    expect_near(axis(moved, 3), {7, 8, 9});
    for (int i = 0; i < 3; ++i) EXPECT_EQ(axis(moved, i), axis(old, i));
    EXPECT_EQ(moved.fov_degrees, 50.0f);

    const CameraDescription zoomed = changed(old, "fov=20");
    EXPECT_EQ(zoomed.fov_degrees, 20.0f);
    EXPECT_EQ(zoomed.camera_to_world, old.camera_to_world);
    EXPECT_EQ(zoomed.shift, old.shift);
  }
}

// A point to the right of the target in the scene's image stays to the right of it.
TEST_F(SceneOverridesTest, ImagesDoNotFlip) {
  for (const float right : {kRightHanded, kLeftHanded}) {
    const CameraDescription old = tilted_camera(right);
    const glm::vec3 target(1.5f, 0.4f, -2.0f), beside = target + 0.1f * axis(old, 0);
    const CameraDescription turned = changed(old, "origin=1.2,2.1,4.9:target=1.5,0.4,-2");
    EXPECT_EQ(std::signbit(handedness(turned)), std::signbit(handedness(old)));
    EXPECT_NEAR(glm::length(seen_at(turned, target)), 0.0f, 1e-6f);
    EXPECT_GT(seen_at(old, beside).x, seen_at(old, target).x + 0.01f);
    EXPECT_GT(seen_at(turned, beside).x, 0.01f);
    EXPECT_GT(seen_at(turned, target + glm::vec3(0, 0.1f, 0)).y, 0.01f);
    // From behind, left and right change places in the world and not in the camera.
    const CameraDescription behind = changed(old, "origin=1.5,0.4,-9:target=1.5,0.4,-2");
    EXPECT_LT(seen_at(behind, beside).x, -0.01f);
    EXPECT_EQ(std::signbit(handedness(behind)), std::signbit(handedness(old)));
  }
}

TEST_F(SceneOverridesTest, TurnedCamerasHaveRightAnglesAndKeepTheirScale) {
  CameraDescription old = tilted_camera(kLeftHanded);
  for (int i = 0; i < 3; ++i) old.camera_to_world[i] *= float(i + 2);
  const CameraDescription turned = changed(old, "target=-4,3,2:up=0.2,1,0.4");
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(glm::length(axis(turned, i)), float(i + 2), 1e-5f);
    EXPECT_NEAR(glm::dot(axis(turned, i), axis(turned, (i + 1) % 3)), 0.0f, 1e-5f);
  }
  expect_near(glm::normalize(axis(turned, 2)), glm::normalize(glm::vec3(-5, 1, -3)));
  // `up` appears upwards.
  EXPECT_NEAR(glm::dot(axis(turned, 0), glm::vec3(0.2f, 1.0f, 0.4f)), 0.0f, 1e-5f);
  EXPECT_GT(glm::dot(axis(turned, 1), glm::vec3(0.2f, 1.0f, 0.4f)), 0.0f);
}

TEST_F(SceneOverridesTest, CamerasStandUprightAsTheScenesDo) {
  // Tilted, not rolled: the horizon stays level wherever it looks.
  const CameraDescription side = changed(tilted_camera(kRightHanded), "target=5,1,4");
  EXPECT_NEAR(axis(side, 0).y, 0.0f, 1e-6f);
  EXPECT_GT(axis(side, 1).y, 0.5f);
  // Along that axis itself it falls back on its own.
  const CameraDescription down = changed(tilted_camera(kRightHanded), "target=1,-9,5");
  expect_near(axis(down, 2), {0, -1, 0});
  EXPECT_NEAR(std::abs(handedness(down)), 1.0f, 1e-5f);
  // Where z is up.
  CameraDescription z_up;
  z_up.camera_to_world =
      glm::mat4({1, 0, 0, 0}, {0, 0.6f, 0.8f, 0}, {0, 0.8f, -0.6f, 0}, {0, 0, 0, 1});
  const CameraDescription turned = changed(z_up, "target=3,1,-1");
  EXPECT_NEAR(axis(turned, 0).z, 0.0f, 1e-6f);
  EXPECT_GT(axis(turned, 1).z, 0.5f);
  // Rolled: its own upward axis counts.
  CameraDescription rolled;
  const float h = std::sqrt(0.5f);
  rolled.camera_to_world = glm::mat4({h, h, 0, 0}, {-h, h, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1});
  const CameraDescription same = changed(rolled, "target=0,0,2");
  for (int i = 0; i < 3; ++i) expect_near(axis(same, i), axis(rolled, i));
}

TEST_F(SceneOverridesTest, ImpossibleViewsAreSaid) {
  const CameraDescription camera = tilted_camera(kRightHanded);
  expect_one_line_with(usage_error_of([&] { changed(camera, "target=1,2,5"); }),
                       "the target 1,2,5 is where the camera is");
  expect_one_line_with(usage_error_of([&] { changed(camera, "target=1,5,5:up=0,-2,0"); }),
                       "up is along the direction of view");
}

TEST_F(SceneOverridesTest, Lenses) {
  const CameraDescription camera = tilted_camera(kRightHanded);
  EXPECT_EQ(changed(camera, "lens=0.25").lens_radius, 0.25f);
  EXPECT_EQ(changed(camera, "lens=0.25").focal_distance, camera.focal_distance);
  EXPECT_EQ(changed(camera, "lens=0.25:focus=3").focal_distance, 3.0f);
  EXPECT_NEAR(changed(camera, "lens=0.25:target=1,2,1").focal_distance, 4.0f, 1e-5f);
  EXPECT_EQ(changed(camera, "lens=0.25:target=1,2,1:focus=3").focal_distance, 3.0f);
  EXPECT_EQ(changed(camera, "target=1,2,1").focal_distance, camera.focal_distance);
}

TEST_F(SceneOverridesTest, AFovMakesCamerasPerspective) {
  CameraDescription camera = tilted_camera(kRightHanded);
  camera.projection = CameraDescription::Projection::Orthographic;
  EXPECT_EQ(changed(camera, "target=0,0,0").projection,
            CameraDescription::Projection::Orthographic);
  EXPECT_EQ(changed(camera, "fov=30").projection, CameraDescription::Projection::Perspective);
}

TEST_F(SceneOverridesTest, ACamerasOwnOverrideMakesIt) {
  for (const float right : {kRightHanded, kLeftHanded}) {
    CameraDescription wanted = tilted_camera(right);
    wanted.lens_radius = 0.125f;
    wanted.focal_distance = 6.5f;
    const std::string text = to_string(override_of(wanted));
    CameraDescription other;
    other.camera_to_world[0] *= -right * handedness(tilted_camera(kLeftHanded));
    const CameraDescription made = changed(other, text);
    for (int i = 0; i < 4; ++i) expect_near(axis(made, i), axis(wanted, i), 2e-5f);
    EXPECT_EQ(made.fov_degrees, 50.0f);
    EXPECT_EQ(made.lens_radius, 0.125f);
    EXPECT_EQ(made.focal_distance, 6.5f);
  }
  CameraDescription tiny = tilted_camera(kRightHanded);
  tiny.camera_to_world[3] = glm::vec4(1e-7f, 2e-7f, -3e-7f, 1.0f);
  const CameraDescription made = changed(tiny, to_string(override_of(tiny)));
  EXPECT_LT(glm::distance(axis(made, 3), axis(tiny, 3)), 1e-12f);
  expect_near(axis(made, 2), axis(tiny, 2), 2e-5f);
}

TEST_F(SceneOverridesTest, Environments) {
  using Kind = EnvironmentOverride::Kind;
  EXPECT_EQ(parse_environment("", {}).kind, Kind::Keep);
  EXPECT_EQ(parse_environment("none", {}).kind, Kind::Remove);
  const EnvironmentOverride constant = parse_environment("0.5,1,0", 2.0f);
  EXPECT_EQ(constant.kind, Kind::Replace);
  EXPECT_EQ(to_string(constant), "0.5,1,0");
  const std::string file = write("sky.hdr", "");
  const EnvironmentOverride map = parse_environment(file, {});
  EXPECT_EQ(map.environment.mapping, Environment::Mapping::LatLong);
  EXPECT_EQ(map.environment.file, file);
  EXPECT_EQ(to_string(map), file);

  std::optional<Environment> scene = Environment(glm::vec3(3.0f));
  apply_override(parse_environment("", 0.5f), scene);
  EXPECT_EQ(scene.value().radiance, glm::vec3(1.5f));
  apply_override(map, scene);
  EXPECT_EQ(scene.value().radiance, glm::vec3(1.0f));
  EXPECT_EQ(scene.value().to_world, glm::mat3(1.0f));
  apply_override(constant, scene);
  EXPECT_EQ(scene.value().mapping, Environment::Mapping::Constant);
  EXPECT_EQ(scene.value().radiance, glm::vec3(1, 2, 0));
  apply_override(parse_environment("none", {}), scene);
  EXPECT_FALSE(scene);
  expect_one_line_with(usage_error_of([&] { apply_override(parse_environment("", 2.0f), scene); }),
                       "the scene has no environment");
}

TEST_F(SceneOverridesTest, FastIntersectionIsNamedAndAnotherScene) {
  SceneOverrides overrides;
  EXPECT_TRUE(override_metadata(overrides).empty());
  EXPECT_TRUE(read_scene("cornell", overrides).robust_intersection);
  overrides.robust_intersection = false;
  EXPECT_EQ(override_metadata(overrides).at("intersection"), "fast");
  const SceneDescription fast = read_scene("cornell", overrides);
  EXPECT_FALSE(fast.robust_intersection);
  EXPECT_NE(Scene(fast, "").fingerprint(), Scene(read_scene("cornell"), "").fingerprint());
}

TEST_F(SceneOverridesTest, TheEnvironmentsTopIsTurned) {
  const std::string file = write("sky.hdr", "");
  const std::pair<const char*, glm::vec3> axes[] = {{"x", {1, 0, 0}},   {"y", {0, 1, 0}},
                                                    {"z", {0, 0, 1}},   {"-x", {-1, 0, 0}},
                                                    {"-y", {0, -1, 0}}, {"-z", {0, 0, -1}}};
  for (const auto& [name, top] : axes) {
    const glm::mat3 m = parse_environment(file, {}, name).environment.to_world;
    EXPECT_EQ(m * glm::vec3(0, 1, 0), top) << name;
    EXPECT_EQ(glm::determinant(m), 1.0f) << name;
  }
  SceneOverrides overrides;
  overrides.environment = parse_environment(file, {}, "z");
  EXPECT_EQ(override_metadata(overrides),
            (Metadata{{"environment", file}, {"environment_up", "z"}}));
  for (const char* text : {"", "none", "1,2,3"}) {
    expect_one_line_with(usage_error_of([&] { parse_environment(text, {}, "z"); }), "an image");
  }
  expect_one_line_with(usage_error_of([&] { parse_environment(file, {}, "up"); }), "unknown axis");
}

TEST_F(SceneOverridesTest, WrongEnvironmentsAreSaidInOneLine) {
  for (const char* text : {"sky.exr", "1,2", "1,2,3,4", "1,2,x", "1", ",,"}) {
    expect_one_line_with(error_of([&] { parse_environment(text, {}); }),
                         std::string("--environment: ") + text + ": no such file");
  }
  expect_one_line_with(error_of([&] { parse_environment(directory_.string(), {}); }), "no such");
  for (const char* text : {"-1,0,0", "0,inf,0", "nan,0,0"}) {
    expect_one_line_with(usage_error_of([&] { parse_environment(text, {}); }),
                         "radiance is 0 or more");
  }
  expect_one_line_with(usage_error_of([] { parse_environment("none", 1.0f); }), "nothing to scale");
}

// Files of geometry alone get a camera and a light, and a warning for each.
TEST_F(SceneOverridesTest, ReplacedDefaultsAreNotWarnedOf) {
  const std::string file = write("scene.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  SceneOverrides overrides;
  EXPECT_EQ(read_scene(file, overrides).warnings.size(), 2u);
  overrides.environment = parse_environment("1,2,3", {});
  EXPECT_EQ(read_scene(file, overrides).warnings.size(), 1u);
  overrides.camera = parse_camera("fov=30");
  EXPECT_EQ(read_scene(file, overrides).warnings.size(), 1u);
  overrides.camera = parse_camera("origin=0,0,5:target=0,0,0");
  EXPECT_EQ(read_scene(file, overrides).warnings.size(), 0u);
}

TEST_F(SceneOverridesTest, ScenesAreReadWithThem) {
  SceneOverrides overrides;
  EXPECT_TRUE(override_metadata(overrides).empty());
  overrides.camera = parse_camera("origin=0,1,9:fov=12");
  overrides.environment = parse_environment("1,2,3", 0.5f);
  const SceneDescription scene = read_scene("cornell", overrides);
  expect_near(axis(scene.camera, 3), {0, 1, 9});
  EXPECT_EQ(scene.camera.fov_degrees, 12.0f);
  EXPECT_EQ(scene.environment.value().radiance, glm::vec3(0.5f, 1.0f, 1.5f));
  EXPECT_EQ(override_metadata(overrides), (Metadata{{"camera", "origin=0,1,9:fov=12"},
                                                    {"environment", "1,2,3"},
                                                    {"environment_scale", "0.5"}}));
}

}  // namespace
}  // namespace lockstep::test_scene_overrides
