// Lights of pbrt files.
#include "tests/t_pbrt.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>
#include <string>

namespace lockstep::test_pbrt_lights {
namespace {

TEST_F(Pbrt, AreaLights) {
  const SceneDescription scene = read_world(
      "Shape \"sphere\" AttributeBegin\n"
      "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"float scale\" 2 \"bool twosided\" true\n" +
      triangle + "AttributeEnd\n" + triangle +
      "AreaLightSource \"area\" \"color L\" [2000 2000 2000] \"integer nsamples\" [8] Shape "
      "\"sphere\"\n"
      "AreaLightSource \"diffuse\" \"rgb L\" [0 0 0] Shape \"sphere\"");
  EXPECT_FALSE(scene.shapes[0].emission);
  ASSERT_TRUE(scene.shapes[1].emission);
  EXPECT_EQ(scene.shapes[1].emission->radiance, glm::vec3(2, 4, 6));
  EXPECT_TRUE(scene.shapes[1].emission->two_sided);
  EXPECT_FALSE(scene.shapes[2].emission);
  ASSERT_TRUE(scene.shapes[3].emission);
  EXPECT_EQ(scene.shapes[3].emission->radiance, glm::vec3(2000));
  EXPECT_FALSE(scene.shapes[3].emission->two_sided);
  EXPECT_FALSE(scene.shapes[4].emission);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Pbrt, InfiniteLightsAddUp) {
  const SceneDescription scene = read_world(
      "LightSource \"infinite\" \"rgb L\" [1 2 3] \"float scale\" .5\n"
      "LightSource \"infinite\" \"color L\" [1 1 1] \"color scale\" [1 0 2]\n"
      "LightSource \"infinite\" \"float illuminance\" 3.14159265");
  ASSERT_TRUE(scene.environment);
  expect_near(scene.environment->radiance, {2.5f, 2.0f, 4.5f});
}

TEST_F(Pbrt, BlackBodiesHaveTheirHue) {
  const auto sky = [&](const std::string& l) {
    return read_world("LightSource \"infinite\" \"blackbody L\" " + l).environment->radiance;
  };
  const glm::vec3 weights(0.2126f, 0.7152f, 0.0722f);
  EXPECT_NEAR(glm::dot(sky("2700"), weights), 1.0f, 1e-3f);
  EXPECT_GT(sky("2700").x, 1.5f * sky("2700").z);
  EXPECT_GT(sky("12000").z, sky("12000").x);
  expect_near(sky("6500"), glm::vec3(1.0f), 0.1f);
}

TEST_F(Pbrt, AreaLightsWithPowerOrAnImage) {
  const SceneDescription scene = read_world(R"(
    AreaLightSource "diffuse" "rgb L" [1 2 1] "float power" 100 "bool twosided" true
    Shape "sphere" "float radius" 2 Shape "disk" Shape "bilinearmesh" "point3 P" [0 0 0 3 0 0 0 2 0 3 2 0]
    AreaLightSource "diffuse" "string filename" "glow.exr" "float scale" 3
    Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0] Shape "disk")");
  const double pi = std::numbers::pi;
  const double areas[] = {16.0 * pi, pi, 6.0};
  for (size_t i = 0; i < 3; ++i) {
    // Two sides, pi steradians of cosine each.
    const double radiance = 100.0 / (2.0 * pi * areas[i]);
    expect_near(scene.shapes.at(i).emission.value().radiance.value,
                glm::vec3(radiance, 2.0 * radiance, radiance), 1e-4f);
  }
  for (size_t i : {3u, 4u}) {
    const ColorInput& radiance = scene.shapes.at(i).emission.value().radiance;
    EXPECT_EQ(radiance, ColorInput(glm::vec3(3.0f), 0));
    EXPECT_FALSE(mesh_of(scene, i).uvs.empty());
  }
  ASSERT_EQ(scene.textures.size(), 1u);
  const auto& image = std::get<ImageTexture>(scene.textures[0]);
  EXPECT_EQ(image.file, path("glow.exr"));
  EXPECT_EQ(image.uv.v_row, glm::vec2(0, -1));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Pbrt, PointLights) {
  const SceneDescription scene = read_world(R"(
    Translate 1 2 3 Scale 2 2 2
    LightSource "point" "rgb I" [1 2 3] "float scale" 2 "point3 from" [1 0 0]
    LightSource "point" "rgb I" [1 0 0] "float power" 12.566371
    LightSource "goniometric" "rgb I" [4 4 4] "string filename" "a.exr")");
  ASSERT_EQ(scene.lights.size(), 3u);
  const auto& plain = std::get<PointLight>(scene.lights[0]);
  expect_near(plain.position, {3, 2, 3});
  EXPECT_EQ(plain.intensity, glm::vec3(2, 4, 6));
  expect_near(std::get<PointLight>(scene.lights[1]).intensity, {1, 0, 0});
  expect_near(std::get<PointLight>(scene.lights[2]).intensity, glm::vec3(4.0f));
  EXPECT_TRUE(warns(scene, ":6: LightSource \"goniometric\" is not supported; it shines evenly"));
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST_F(Pbrt, DistantLights) {
  const SceneDescription scene = read_world(R"(
    Scale 5 5 5 LightSource "distant" "rgb L" [1 2 3] "point from" [0 1 0] "point to" [0 0 0]
    Identity Rotate 90 1 0 0 LightSource "distant" "float illuminance" 7)");
  const auto& sun = std::get<DistantLight>(scene.lights.at(0));
  expect_near(sun.direction, {0, -1, 0});
  EXPECT_EQ(sun.irradiance, glm::vec3(1, 2, 3));
  const auto& other = std::get<DistantLight>(scene.lights.at(1));
  expect_near(other.direction, {0, -1, 0});  // z turned about x
  EXPECT_EQ(other.irradiance, glm::vec3(7.0f));
}

TEST_F(Pbrt, SpotLightsOfBothVersions) {
  const std::string world = R"(WorldBegin Translate 0 0 1
    LightSource "spot" "point from" [1 0 0] "point to" [1 0 -4] "float coneangle" 60
      "float conedeltaangle" 15)";
  const SceneDescription v4 = read(world);
  const auto& spot = std::get<SpotLight>(v4.lights.at(0));
  expect_near(spot.position, {1, 0, 1});
  expect_near(spot.direction, {0, 0, -1});
  EXPECT_FLOAT_EQ(spot.cos_outer, 0.5f);
  EXPECT_FLOAT_EQ(spot.cos_inner, std::sqrt(0.5f));
  EXPECT_EQ(spot.falloff, SpotLight::Falloff::Smoothstep);
  const SceneDescription v3 = read("Film \"image\"" + world);
  EXPECT_EQ(std::get<SpotLight>(v3.lights.at(0)).falloff, SpotLight::Falloff::Quartic);
  const SceneDescription power = read(world + " \"float power\" 10");
  const float cone = 2.0f * std::numbers::pi_v<float> *
                     ((1.0f - spot.cos_inner) + 0.5f * (spot.cos_inner - spot.cos_outer));
  EXPECT_NEAR(std::get<SpotLight>(power.lights.at(0)).intensity.x, 10.0f / cone, 1e-4f);
}

TEST_F(Pbrt, EnvironmentMapsOfV4) {
  const SceneDescription scene = read_world(R"(
    Rotate 90 1 0 0 Scale -3 3 3
    LightSource "infinite" "string filename" "sky.exr" "float scale" .5)");
  const Environment& sky = scene.environment.value();
  EXPECT_EQ(sky.mapping, Environment::Mapping::EqualAreaOctahedral);
  EXPECT_EQ(sky.file, path("sky.exr"));
  EXPECT_EQ(sky.where, path("scene.pbrt") + ":4");
  EXPECT_EQ(sky.radiance, glm::vec3(0.5f));
  expect_near(sky.to_world[0], {-1, 0, 0});
  expect_near(sky.to_world[1], {0, 0, 1});
  expect_near(sky.to_world[2], {0, -1, 0});
  EXPECT_TRUE(scene.warnings.empty());
}

// pbrt-v3 looks up (atan2(y, x) / 2 pi, acos(z) / pi); the scene's maps have (x right of the middle
// column, which is -z; y up).
TEST_F(Pbrt, EnvironmentMapsOfV3) {
  const SceneDescription scene = read(R"(Film "image" WorldBegin Rotate 30 1 2 3
    LightSource "infinite" "string mapname" "sky.exr" "rgb L" [1 2 3] "integer nsamples" 4)");
  const Environment& sky = scene.environment.value();
  EXPECT_EQ(sky.mapping, Environment::Mapping::LatLong);
  EXPECT_EQ(sky.radiance, glm::vec3(1, 2, 3));
  const SceneDescription turned =
      read_world("Rotate 30 1 2 3 CoordinateSystem \"here\" " + triangle);
  const TriangleMesh& frame = mesh_of(turned);  // its points are the origin, x and y
  const glm::vec3 x = frame.positions[1], y = frame.positions[2], z = glm::cross(x, y);
  for (const glm::vec2 uv : {glm::vec2(0.1f, 0.2f), glm::vec2(0.4f, 0.7f), glm::vec2(0.9f, 0.5f)}) {
    const float phi = 2.0f * std::numbers::pi_v<float> * uv.x;
    const float theta = std::numbers::pi_v<float> * uv.y;
    const glm::vec3 pbrt =
        std::sin(theta) * (std::cos(phi) * x + std::sin(phi) * y) + std::cos(theta) * z;
    const float turn = phi - std::numbers::pi_v<float>;  // from the middle column to the right
    const glm::vec3 ours(std::sin(theta) * std::sin(turn), std::cos(theta),
                         -std::sin(theta) * std::cos(turn));
    expect_near(sky.to_world * ours, pbrt);
  }
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Pbrt, OneEnvironmentMapStaysAlone) {
  const SceneDescription scene = read_world(R"(
    LightSource "infinite" "rgb L" [9 9 9]
    LightSource "infinite" "string filename" "first.exr"
    LightSource "infinite" "string filename" "second.exr" "float illuminance" 3)");
  EXPECT_EQ(scene.environment.value().file, path("first.exr"));
  EXPECT_EQ(scene.environment.value().radiance, glm::vec3(1.0f));
  EXPECT_TRUE(warns(scene, ":4: beside an environment map"));
  EXPECT_TRUE(warns(scene, ":5: the illuminance of an environment map"));
  EXPECT_EQ(scene.warnings.size(), 2u);
  EXPECT_TRUE(
      warns(read_world("Scale 1 2 1 LightSource \"infinite\" \"string filename\" \"a.exr\""),
            "may only turn, mirror and scale evenly"));
}

TEST_F(Pbrt, IlluminantsByName) {
  const SceneDescription scene =
      read_world("LightSource \"infinite\" \"spectrum L\" \"stdillum-A\" \"float scale\" 2");
  const glm::vec3 l = scene.environment.value().radiance;
  EXPECT_NEAR(glm::dot(l, glm::vec3(0.2126f, 0.7152f, 0.0722f)), 2.0f, 1e-2f);
  EXPECT_GT(l.x, 3.0f * l.z);
}

}  // namespace
}  // namespace lockstep::test_pbrt_lights
