// Whole scenes in pbrt files, where they lie beside the project.
#include "tests/t_pbrt.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <variant>

namespace lockstep::test_pbrt_scenes {
namespace {

namespace fs = std::filesystem;

class SharedScene : public Pbrt {
 protected:
  SceneDescription read_shared(const std::string& name) const {
    return read_pbrt((scenes_ / name).string());
  }
  void SetUp() override {
    if (!fs::exists(scenes_)) GTEST_SKIP() << "the shared scenes are absent: " << scenes_;
    Pbrt::SetUp();
  }
  const fs::path scenes_ = fs::path(LOCKSTEP_SHARED_DIR) / "scenes";
};

TEST_F(SharedScene, KillerooSimple) {
  const SceneDescription scene = read_shared("killeroo-simple/killeroo-simple.pbrt");
  EXPECT_EQ(scene.name, "killeroo-simple");
  ASSERT_EQ(scene.shapes.size(), 5u);
  EXPECT_EQ(scene.materials.size(), 4u);
  EXPECT_EQ(scene.film.width, 700);
  EXPECT_EQ(scene.film.filter.kind, PixelFilter::Kind::Box);
  EXPECT_EQ(scene.defaults.spp, 8);
  expect_near(sphere_of(scene, 0).center, {150, 120, 20}, 1e-3f);
  EXPECT_EQ(scene.shapes[0].emission.value().radiance, glm::vec3(2000));
  EXPECT_EQ(mesh_of(scene, 3).triangles.size(), 33264u);
  EXPECT_EQ(mesh_of(scene, 4).triangles.size(), 33264u);
  EXPECT_FALSE(model_of<CoatedMaterial>(scene, 3).layered);
  expect_near(glm::vec3(scene.camera.camera_to_world[3]), {396.7348f, 54.7862f, 30.0f}, 1e-3f);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(SharedScene, KillerooQuadHoldsTheSameSurfaces) {
  const SceneDescription quad = read_shared("killeroo-quad/killeroo-quad.pbrt");
  ASSERT_EQ(quad.shapes.size(), 5u);
  EXPECT_EQ(quad.film.width, 684);
  EXPECT_EQ(quad.film.height, 513);
  EXPECT_EQ(quad.materials.size(), 4u);
  ASSERT_TRUE(quad.shapes[0].emission);
  EXPECT_EQ(mesh_of(quad, 0).triangles.size(), 2u);
  EXPECT_LT(normal_of(mesh_of(quad, 0)).z, 0.0f) << "the light faces down";
  EXPECT_TRUE(quad.warnings.empty());

  // Its PLY files are the subdivided meshes of the other scene, baked in world space.
  const SceneDescription simple = read_shared("killeroo-simple/killeroo-simple.pbrt");
  for (const size_t shape : {3u, 4u}) {
    const TriangleMesh &ours = mesh_of(simple, shape), &baked = mesh_of(quad, shape);
    ASSERT_EQ(ours.positions.size(), baked.positions.size());
    ASSERT_EQ(ours.triangles.size(), baked.triangles.size());
    // Both keep the vertices of the control mesh first.
    for (size_t i = 0; i < 4000; ++i) {
      EXPECT_LT(glm::distance(ours.positions[i], baked.positions[i]), 0.1f) << "of 220";
    }
  }
}

TEST_F(SharedScene, CornellBox) {
  const SceneDescription scene = read_shared("cornell-box/scene-v4.pbrt");
  ASSERT_EQ(scene.shapes.size(), 8u);
  EXPECT_EQ(scene.materials.size(), 8u);
  size_t triangles = 0;
  for (size_t i = 0; i < 8; ++i) triangles += mesh_of(scene, i).triangles.size();
  EXPECT_EQ(triangles, 36u);
  EXPECT_EQ(scene.shapes[7].emission.value().radiance, glm::vec3(17, 12, 4));
  EXPECT_LT(normal_of(mesh_of(scene, 7)).y, -0.99f) << "the light faces down";
  EXPECT_EQ(scene.film.filter.kind, PixelFilter::Kind::Triangle);
  EXPECT_FLOAT_EQ(scene.film.filter.radius.x, 1.0f);
  EXPECT_EQ(scene.defaults.depth, 65);
  expect_near(glm::vec3(scene.camera.camera_to_world[3]), {0, 1, 6.8f});
  expect_near(glm::vec3(scene.camera.camera_to_world[2]), {0, 0, -1});
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(SharedScene, VeachMis) {
  const SceneDescription scene = read_shared("veach-mis/scene-v4.pbrt");
  ASSERT_EQ(scene.shapes.size(), 9u);
  EXPECT_EQ(scene.materials.size(), 6u);
  int lights = 0;
  for (const Shape& shape : scene.shapes) {
    if (!shape.emission) continue;
    ++lights;
    EXPECT_FALSE(std::get<Sphere>(shape.geometry).emits_inwards);
  }
  EXPECT_EQ(lights, 3);
  EXPECT_FLOAT_EQ(model_of<ConductorMaterial>(scene, 0).alpha.x, 0.01f);
  EXPECT_EQ(scene.defaults.depth, 3);
  EXPECT_TRUE(scene.warnings.empty());
}

struct Count {
  const char* scene;
  size_t shapes, triangles, others, lights, materials, textures, warnings;
};

// As counted in the files; a measured reflectance and other integrators warn on purpose.
TEST_F(SharedScene, EveryFileIsReadWhole) {
  const Count counts[] = {
      {"bunny/bunny.pbrt", 3, 69453, 1, 2, 3, 0, 1},
      {"classroom/scene-v4.pbrt", 79, 103832, 0, 1, 44, 3, 0},
      {"cornell-box/scene-v4.pbrt", 8, 36, 0, 1, 8, 0, 0},
      {"killeroo-quad/killeroo-quad.pbrt", 5, 66534, 0, 1, 4, 0, 0},
      {"killeroo-simple/killeroo-simple.pbrt", 5, 66532, 1, 1, 4, 0, 0},
      {"killeroo-simple/killeroo-simple-v2.pbrt", 5, 66532, 1, 1, 4, 0, 1},
      {"staircase2/scene-v4.pbrt", 32, 30927, 5, 13, 21, 3, 0},
      {"veach-ajar/scene-v3.pbrt", 22, 382690, 0, 1, 13, 3, 0},
      {"veach-ajar/scene-v4.pbrt", 22, 382690, 0, 1, 13, 3, 0},
      {"veach-bidir/scene-v4.pbrt", 14, 11544, 0, 2, 4, 0, 1},
      {"veach-mis/scene-v4.pbrt", 9, 52, 3, 3, 6, 0, 0},
      {"water-caustic/scene-v4.pbrt", 10, 103487, 0, 1, 9, 0, 1},
  };
  for (const Count& expected : counts) {
    const SceneDescription scene = read_shared(expected.scene);
    size_t triangles = 0, others = 0, lights = scene.lights.size();
    for (const Shape& shape : scene.shapes) {
      const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
      triangles += mesh != nullptr ? mesh->triangles.size() : 0;
      others += mesh == nullptr ? 1 : 0;
      lights += shape.emission ? 1 : 0;
    }
    EXPECT_EQ(scene.shapes.size(), expected.shapes) << expected.scene;
    EXPECT_EQ(triangles, expected.triangles) << expected.scene;
    EXPECT_EQ(others, expected.others) << expected.scene;
    EXPECT_EQ(lights, expected.lights) << expected.scene;
    EXPECT_EQ(scene.materials.size(), expected.materials) << expected.scene;
    EXPECT_EQ(scene.textures.size(), expected.textures) << expected.scene;
    EXPECT_EQ(scene.warnings.size(), expected.warnings) << expected.scene;
    for (const Texture& texture : scene.textures) {
      EXPECT_TRUE(fs::exists(std::get<ImageTexture>(texture).file)) << expected.scene;
    }
  }
}

TEST_F(SharedScene, ClassroomHasASunAndASky) {
  const SceneDescription scene = read_shared("classroom/scene-v4.pbrt");
  const auto& sun = std::get<DistantLight>(scene.lights.at(0));
  expect_near(sun.direction, glm::normalize(glm::vec3(0.865804f, -0.416766f, 0.276929f)));
  EXPECT_EQ(sun.irradiance, glm::vec3(10.0f));
  const Environment& sky = scene.environment.value();
  EXPECT_EQ(sky.mapping, Environment::Mapping::EqualAreaOctahedral);
  EXPECT_TRUE(fs::exists(sky.file));
  // The map's z axis, its zenith, is up.
  expect_near(sky.to_world[2], {0, 1, 0});
}

TEST_F(SharedScene, StaircaseHasGlassThatAbsorbsAndLampsThatShineDown) {
  const SceneDescription scene = read_shared("staircase2/scene-v4.pbrt");
  int disks = 0, panes = 0;
  for (const Shape& shape : scene.shapes) {
    const Material& material = scene.materials.at(shape.material);
    if (const auto* glass = std::get_if<DielectricMaterial>(&material.model)) {
      ++panes;
      expect_near(glass->absorption, {0.5f, 0.2f, 0.4f});
    }
    if (const auto* disk = std::get_if<Disk>(&shape.geometry)) {
      ++disks;
      EXPECT_GT(std::abs(disk->normal.z), 0.99f);
      EXPECT_TRUE(shape.emission);
    }
  }
  EXPECT_EQ(panes, 1);
  EXPECT_EQ(disks, 5);
}

TEST_F(SharedScene, VeachAjarIsTheSameInBothVersions) {
  const SceneDescription v3 = read_shared("veach-ajar/scene-v3.pbrt");
  const SceneDescription v4 = read_shared("veach-ajar/scene-v4.pbrt");
  for (size_t i = 0; i < v3.shapes.size(); ++i) {
    EXPECT_EQ(mesh_of(v3, i).positions.size(), mesh_of(v4, i).positions.size());
    EXPECT_EQ(v3.shapes[i].material, v4.shapes[i].material);
  }
  for (size_t i = 0; i < v3.materials.size(); ++i) {
    EXPECT_EQ(v3.materials[i].model.index(), v4.materials[i].model.index()) << i;
  }
  for (size_t i = 0; i < v3.textures.size(); ++i) {
    const auto& a = std::get<ImageTexture>(v3.textures[i]);
    const auto& b = std::get<ImageTexture>(v4.textures[i]);
    EXPECT_EQ(a.file, b.file);
    EXPECT_EQ(a.filter, TextureFilter::Trilinear);
    EXPECT_EQ(b.filter, TextureFilter::Trilinear);
  }
}

// Cut short or with bytes changed, a scene is read or refused, and nothing else.
TEST_F(SharedScene, DamagedCopiesAreReadOrRefused) {
  std::mt19937 random(1);
  write("killeroo1_world.ply", "ply\n");
  write("geometry/killeroo.pbrt", triangle);
  for (const char* name :
       {"killeroo-simple/killeroo-simple.pbrt", "killeroo-quad/killeroo-quad.pbrt",
        "cornell-box/scene-v4.pbrt", "veach-mis/scene-v4.pbrt", "staircase2/scene-v4.pbrt",
        "classroom/scene-v4.pbrt"}) {
    std::ifstream file(scenes_ / name, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (int trial = 0; trial < 300; ++trial) {
      std::string damaged = text;
      if (trial % 2 == 0) damaged.resize(random() % text.size());
      for (int flips = trial % 4; flips > 0 && !damaged.empty(); --flips) {
        damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
      }
      const std::string message = error_of(damaged);
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

}  // namespace
}  // namespace lockstep::test_pbrt_scenes
