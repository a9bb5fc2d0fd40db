// The Mitsuba reader: lights, and whole scenes against their pbrt versions.
#include "core/read_scene.h"
#include "tests/t_mitsuba.h"

#include <glm/trigonometric.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <variant>

namespace lockstep::test_mitsuba_scenes {
namespace {

namespace fs = std::filesystem;

// --- Lights

TEST_F(Mitsuba, AreaLights) {
  const std::string light = "<shape type=\"sphere\"><emitter type=\"area\">";
  const SceneDescription scene =
      read_old(light + "<spectrum name=\"radiance\" value=\"5000\"/></emitter></shape>" + light +
               "<spectrum name=\"radiance\" value=\"400:2, 700:2\"/></emitter></shape>" + light +
               "<blackbody name=\"radiance\" temperature=\"5000K\"/></emitter></shape>" + light +
               "<rgb name=\"radiance\" value=\"0\"/></emitter></shape>");
  EXPECT_EQ(scene.shapes[0].emission.value().radiance.value, glm::vec3(5000.0f));
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 0).reflectance.value, glm::vec3(0.0f));
  const glm::vec3 flat = scene.shapes[1].emission.value().radiance.value;
  EXPECT_NEAR(0.2126f * flat.x + 0.7152f * flat.y + 0.0722f * flat.z, 2.0f, 0.02f);
  const glm::vec3 warm = scene.shapes[2].emission.value().radiance.value;
  EXPECT_GT(warm.x, warm.y);
  EXPECT_GT(warm.y, warm.z);
  // Planck's law at 555 nm and 5000 K, W/(m^2 sr nm).
  EXPECT_NEAR(0.2126f * warm.x + 0.7152f * warm.y + 0.0722f * warm.z, 12700.0f, 700.0f);
  EXPECT_FALSE(scene.shapes[3].emission);
  expect_one_line_with(
      error_of(light + "<rgb name=\"radiance\" value=\"1 -1 0\"/></emitter></shape>"),
      "negative radiance");
}

TEST_F(Mitsuba, DeltaLights) {
  const SceneDescription scene = read(
      "<emitter type=\"point\"><point name=\"position\" x=\"1\" y=\"2\" z=\"3\"/>"
      "<rgb name=\"intensity\" value=\"4\"/></emitter>"
      "<emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"0,5,0\" "
      "target=\"0,0,0\" up=\"0,0,1\"/></transform><float name=\"cutoff_angle\" value=\"40\"/>"
      "</emitter><emitter type=\"directional\"><vector name=\"direction\" value=\"0,-2,0\"/>"
      "<rgb name=\"irradiance\" value=\"3\"/></emitter><emitter type=\"constant\">"
      "<rgb name=\"radiance\" value=\"0.5\"/></emitter><emitter type=\"constant\"/>");
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(std::get<PointLight>(scene.lights[0]).position, glm::vec3(1, 2, 3));
  EXPECT_EQ(std::get<PointLight>(scene.lights[0]).intensity, glm::vec3(4.0f));
  const auto& spot = std::get<SpotLight>(scene.lights[1]);
  expect_near(spot.position, {0, 5, 0});
  expect_near(spot.direction, {0, -1, 0});
  EXPECT_NEAR(spot.cos_outer, std::cos(glm::radians(40.0f)), 1e-6f);
  EXPECT_NEAR(spot.cos_inner, std::cos(glm::radians(30.0f)), 1e-6f);
  EXPECT_EQ(spot.falloff, SpotLight::Falloff::LinearAngle);
  expect_near(std::get<DistantLight>(scene.lights[2]).direction, {0, -1, 0});
  EXPECT_EQ(scene.environment.value().radiance, glm::vec3(0.5f));
  EXPECT_TRUE(warns(scene, "of several environments the first is used"));
}

// The direction in which Mitsuba looks up the map's point (u, v), v downwards, is
// (sin 2 pi u sin pi v, cos pi v, -cos 2 pi u sin pi v); an Environment's middle column is -z.
TEST_F(Mitsuba, EnvironmentMapsAreTurnedTheSameWay) {
  const SceneDescription scene = read(
      "<emitter type=\"envmap\"><string name=\"filename\" value=\"e.exr\"/><float name=\"scale\" "
      "value=\"3\"/><transform name=\"to_world\"><rotate y=\"1\" angle=\"90\"/></transform>"
      "</emitter>");
  const Environment& e = scene.environment.value();
  EXPECT_EQ(e.mapping, Environment::Mapping::LatLong);
  EXPECT_EQ(e.radiance, glm::vec3(3.0f));
  EXPECT_EQ(e.file, path("e.exr"));
  for (const float u : {0.0f, 0.1f, 0.3f, 0.75f}) {
    const float phi = 2.0f * 3.14159265f * u;
    const glm::vec3 mitsuba(std::sin(phi), 0.0f, -std::cos(phi));
    const glm::vec3 ours(std::sin(phi - 3.14159265f), 0.0f, -std::cos(phi - 3.14159265f));
    // A quarter turn around y: x goes to -z.
    expect_near(e.to_world * ours, {mitsuba.z, 0.0f, -mitsuba.x});
  }
}

TEST_F(Mitsuba, SkiesAreConstantWithAWarning) {
  const SceneDescription scene = read_old(
      "<emitter type=\"sunsky\"><float name=\"turbidity\" value=\"3\"/><float name=\"scale\" "
      "value=\"2\"/></emitter>");
  EXPECT_EQ(scene.environment.value().radiance, glm::vec3(2.0f));
  EXPECT_TRUE(warns(scene, "skies and suns are not supported"));
}

// --- Whole scenes

class SharedMitsuba : public Mitsuba {
 protected:
  void SetUp() override {
    scenes_ = fs::path(LOCKSTEP_SHARED_DIR) / "scenes";
    if (!fs::exists(scenes_ / "sponza")) GTEST_SKIP() << "no " << scenes_;
    Mitsuba::SetUp();
  }
  SceneDescription read_shared(const std::string& name) const {
    return read_mitsuba((scenes_ / name).string());
  }
  SceneDescription read_shared_pbrt(const std::string& name) const {
    return read_pbrt((scenes_ / name).string());
  }

  fs::path scenes_;
};

size_t triangles_of(const SceneDescription& scene) {
  size_t sum = 0;
  for (const Shape& shape : scene.shapes) {
    const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
    sum += mesh != nullptr ? mesh->triangles.size() : 0;
  }
  return sum;
}

void expect_same_scene(const SceneDescription& a, const SceneDescription& b) {
  ASSERT_EQ(a.shapes.size(), b.shapes.size());
  EXPECT_EQ(a.materials.size(), b.materials.size());
  EXPECT_EQ(triangles_of(a), triangles_of(b));
  EXPECT_EQ(a.film.width, b.film.width);
  EXPECT_EQ(a.film.height, b.film.height);
  EXPECT_EQ(a.film.filter.kind, b.film.filter.kind);
  for (size_t i = 0; i < a.shapes.size(); ++i) {
    const Material &m = material_of(a, i), &n = material_of(b, i);
    EXPECT_EQ(m.model.index(), n.model.index()) << i;
    if (const auto* metal = std::get_if<ConductorMaterial>(&m.model)) {
      EXPECT_EQ(metal->alpha, std::get<ConductorMaterial>(n.model).alpha);
      expect_near(metal->eta.value, std::get<ConductorMaterial>(n.model).eta.value, 1e-4f);
    }
    if (const auto* diffuse = std::get_if<DiffuseMaterial>(&m.model)) {
      expect_near(diffuse->reflectance.value, std::get<DiffuseMaterial>(n.model).reflectance.value);
    }
    ASSERT_EQ(a.shapes[i].emission.has_value(), b.shapes[i].emission.has_value()) << i;
    if (!a.shapes[i].emission) continue;
    const glm::vec3 l = a.shapes[i].emission->radiance.value;
    expect_near(l, b.shapes[i].emission->radiance.value, 1e-3f * glm::length(l));
    if (const auto* mesh = std::get_if<TriangleMesh>(&a.shapes[i].geometry)) {
      EXPECT_GT(glm::dot(normal_of(*mesh), normal_of(mesh_of(b, i))), 0.999f);
    }
  }
  // The same points fall on the same pixels.
  for (const Shape& shape : a.shapes) {
    const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
    if (mesh == nullptr) continue;
    const glm::vec3 p = mesh->positions[mesh->triangles[0].x];
    EXPECT_LT(glm::distance(pixel_of(a, p), pixel_of(b, p)), 0.1f);
  }
}

TEST_F(SharedMitsuba, ScenesAreThoseOfPbrt) {
  const SceneDescription cornell = read_shared("cornell-box/scene_v3.xml");
  expect_same_scene(cornell, read_shared_pbrt("cornell-box/scene-v4.pbrt"));
  EXPECT_TRUE(cornell.warnings.empty());
  EXPECT_EQ(cornell.defaults.depth, 64);
  EXPECT_TRUE(material_of(cornell).two_sided);
  expect_same_scene(read_shared("veach-mis/scene-mitsuba3.xml"),
                    read_shared_pbrt("veach-mis/scene-v4.pbrt"));
  expect_same_scene(read_shared("veach-bidir/scene-mitsuba3.xml"),
                    read_shared_pbrt("veach-bidir/scene-v4.pbrt"));
}

TEST_F(SharedMitsuba, VeachMisOfBothGenerations) {
  const SceneDescription old = read_shared("veach-mis/scene-mitsuba0.5.xml");
  const SceneDescription modern = read_shared("veach-mis/scene-mitsuba3.xml");
  expect_same_scene(old, modern);
  EXPECT_FALSE(material_of(old).two_sided);
  EXPECT_TRUE(material_of(modern).two_sided);
  EXPECT_EQ(sphere_of(old, 5).center, sphere_of(modern, 5).center);
  EXPECT_EQ(old.defaults.spp, 512) << "not that of the hidden sampler";
}

TEST_F(SharedMitsuba, SerializedScenes) {
  const SceneDescription sponza = read_shared("sponza/sponza.xml");
  EXPECT_EQ(sponza.shapes.size(), 38u);
  EXPECT_EQ(triangles_of(sponza), 66445u);
  EXPECT_EQ(sponza.textures.size(), 10u);
  EXPECT_EQ(sponza.materials.size(), 20u);
  EXPECT_TRUE(sponza.warnings.empty());
  for (const Texture& texture : sponza.textures) {
    EXPECT_TRUE(fs::exists(std::get<ImageTexture>(texture).file));
  }

  const SceneDescription matpreview = read_shared("matpreview/matpreview.xml");
  EXPECT_EQ(matpreview.shapes.size(), 3u);
  EXPECT_EQ(triangles_of(matpreview), 61600u);
  EXPECT_TRUE(fs::exists(matpreview.environment.value().file));
  EXPECT_NEAR(matpreview.camera.fov_degrees, 28.8415f, 1e-3f);
  EXPECT_NO_THROW(model_of<CoatedMaterial>(matpreview, 2));
}

// Cut short or with bytes changed, a scene is read or refused, and nothing else.
TEST_F(SharedMitsuba, DamagedCopiesAreReadOrRefused) {
  std::mt19937 random(1);
  write("models/Mesh000.obj", roof + "f 1 2 3\n");
  for (const char* name : {"cornell-box/scene_v3.xml", "veach-mis/scene-mitsuba0.5.xml",
                           "veach-bidir/scene-mitsuba3.xml", "matpreview/matpreview.xml"}) {
    std::ifstream file(scenes_ / name, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (int trial = 0; trial < 200; ++trial) {
      std::string damaged = text;
      if (trial % 8 == 0) damaged.resize(random() % text.size());
      for (int flips = trial % 4; flips > 0 && !damaged.empty(); --flips) {
        // Mostly characters that leave the XML whole.
        damaged[random() % damaged.size()] =
            trial % 2 ? char(random() % 256) : "09azAZ$#.-"[random() % 10];
      }
      const std::string path = write("scene.xml", damaged);
      const std::string message = message_of([&] { read_mitsuba(path); });
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

}  // namespace
}  // namespace lockstep::test_mitsuba_scenes
