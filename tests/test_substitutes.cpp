// What stands in for what kernels do not render yet.
#include "core/substitutes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lockstep {
namespace {

SceneDescription scene_of(Material material, Geometry geometry = Sphere{}) {
  SceneDescription scene;
  scene.name = "scene";
  scene.materials.push_back(std::move(material));
  scene.shapes.push_back({std::move(geometry), 0, {}});
  return scene;
}

template <class T>
const T& model_of(const SceneDescription& scene, std::size_t i = 0) {
  return std::get<T>(scene.materials.at(i).model);
}

bool warns(const SceneDescription& scene, const std::string& what) {
  return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                     [&](const std::string& w) { return w.find(what) != std::string::npos; });
}

TEST(Substitutes, LeaveWhatIsRenderedAsItIs) {
  SceneDescription scene = scene_of(CoatedMaterial{});
  scene.lights.emplace_back(PointLight{});
  substitute_unsupported(scene);
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(model_of<CoatedMaterial>(scene).alpha, 0.1f);
}

TEST(Substitutes, DisksKeepTheirAreaAndSide) {
  const glm::vec3 normal = glm::normalize(glm::vec3(1, -2, 0.5f)), centre(3, 4, 5);
  SceneDescription scene = scene_of(DiffuseMaterial{}, Disk{centre, normal, 2.0f});
  substitute_unsupported(scene);
  const auto& mesh = std::get<TriangleMesh>(scene.shapes[0].geometry);
  double area = 0.0;
  for (const glm::uvec3 t : mesh.triangles) {
    const glm::vec3 p = mesh.positions[t.x];
    const glm::vec3 n = glm::cross(mesh.positions[t.y] - p, mesh.positions[t.z] - p);
    area += 0.5 * double(glm::length(n));
    EXPECT_NEAR(glm::dot(glm::normalize(n), normal), 1.0f, 1e-4f);
  }
  EXPECT_NEAR(area, 4.0 * std::numbers::pi, 1e-4);
  for (const glm::vec3 p : mesh.positions) {
    EXPECT_NEAR(glm::dot(p - centre, normal), 0.0f, 1e-5f);
    EXPECT_LT(glm::distance(p, centre), 2.002f);
  }
}

TEST(Substitutes, InstancesBecomeShapesInTheirPlaces) {
  SceneDescription scene = scene_of(DiffuseMaterial{});
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  scene.objects.push_back({{{mesh, 0, {}}, {Sphere{{1, 0, 0}, 0.5f}, 0, {}}}});
  scene.instances.push_back({0, glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, 7))});
  scene.instances.push_back({0, glm::scale(glm::mat4(1.0f), glm::vec3(-2.0f, 1.0f, 1.0f))});
  substitute_unsupported(scene);
  ASSERT_EQ(scene.shapes.size(), 5u);
  EXPECT_EQ(std::get<TriangleMesh>(scene.shapes[1].geometry).positions[1], glm::vec3(1, 0, 7));
  const auto& ball = std::get<TriangleMesh>(scene.shapes[2].geometry);
  for (const glm::vec3 p : ball.positions) {
    EXPECT_NEAR(glm::distance(p, glm::vec3(1, 0, 7)), 0.5f, 1e-5f);
  }
  // Mirrored: the winding turns, so that the normal keeps to its side.
  const auto& mirrored = std::get<TriangleMesh>(scene.shapes[3].geometry);
  const glm::uvec3 t = mirrored.triangles[0];
  const glm::vec3 p = mirrored.positions[t.x];
  EXPECT_GT(glm::cross(mirrored.positions[t.y] - p, mirrored.positions[t.z] - p).z, 0.0f);
}

TEST(Substitutes, SmoothMetalsAndCoatsGetSomeRoughness) {
  ConductorMaterial metal;
  metal.alpha = glm::vec2(0.0f);
  SceneDescription scene = scene_of(metal);
  CoatedMaterial coated;
  coated.alpha = 0.0f;
  scene.materials.emplace_back(coated);
  substitute_unsupported(scene);
  EXPECT_EQ(model_of<ConductorMaterial>(scene).alpha, glm::vec2(1e-3f));
  EXPECT_EQ(model_of<CoatedMaterial>(scene, 1).alpha, 1e-3f);
}

TEST(Substitutes, ColouredMirrorsKeepTheirColour) {
  const glm::vec3 colour(0.8f, 0.4f, 0.2f);
  ConductorMaterial mirror;
  mirror.eta = glm::vec3(0.0f), mirror.k = glm::vec3(1.0f);  // reflects everything
  mirror.specular = colour;
  SceneDescription scene = scene_of(mirror);
  substitute_unsupported(scene);
  const auto& m = model_of<ConductorMaterial>(scene);
  const glm::vec3 eta = m.eta.value, k = m.k.value;
  for (int c = 0; c < 3; ++c) {
    const float above = (eta[c] - 1) * (eta[c] - 1) + k[c] * k[c];
    EXPECT_NEAR(above / (above + 4 * eta[c]), colour[c], 1e-5f) << c;
  }
}

TEST(Substitutes, MixesBecomeTheirFirstPart) {
  SceneDescription scene = scene_of(MixMaterial{1, 2, 0.5f});
  scene.materials.emplace_back(MixMaterial{2, 0, 0.5f});
  scene.materials.emplace_back(DiffuseMaterial{glm::vec3(0.1f, 0.2f, 0.3f)});
  substitute_unsupported(scene);
  EXPECT_EQ(model_of<DiffuseMaterial>(scene).reflectance, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_TRUE(warns(scene, "mixed materials"));
}

TEST(Substitutes, EachKindIsSaidOnce) {
  DiffuseMaterial textured;
  textured.reflectance = ColorInput(glm::vec3(0.8f), 0);
  SceneDescription scene = scene_of(textured);
  for (int i = 0; i < 4; ++i) scene.materials.emplace_back(textured);
  scene.materials.emplace_back(DielectricMaterial{});
  scene.environment = Environment(glm::vec3(2.0f));
  scene.environment->mapping = Environment::Mapping::LatLong;
  scene.camera.lens_radius = 0.1f;
  substitute_unsupported(scene);
  EXPECT_EQ(model_of<DiffuseMaterial>(scene).reflectance, glm::vec3(0.4f));
  EXPECT_EQ(scene.warnings.size(), 4u);
  EXPECT_TRUE(warns(scene, "textures are not rendered yet; half of what scales them is used (5x)"));
  EXPECT_TRUE(warns(scene, "dielectric"));
  EXPECT_TRUE(warns(scene, "environment maps"));
  EXPECT_TRUE(warns(scene, "lenses"));
}

}  // namespace
}  // namespace lockstep
