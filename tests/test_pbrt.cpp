// The pbrt reader: every supported construct, whole scenes, and broken files.
#include "core/error.h"
#include "core/mesh.h"
#include "core/read_scene.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <variant>
#include <vector>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

class Pbrt : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / ("lockstep_pbrt_" + std::to_string(getpid()) + test->name());
    fs::create_directories(folder_ / "geometry");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  SceneDescription read(const std::string& text) const {
    write("scene.pbrt", text);
    return read_pbrt((folder_ / "scene.pbrt").string());
  }
  SceneDescription read_world(const std::string& text) const { return read("WorldBegin\n" + text); }

  // The message, with the folder's name taken off.
  std::string error_of(const std::string& text) const {
    try {
      read(text);
    } catch (const Error& error) {
      std::string message = error.what();
      const std::string prefix = folder_.string() + "/";
      for (size_t at; (at = message.find(prefix)) != std::string::npos;) {
        message.erase(at, prefix.size());
      }
      return message;
    }
    return "no error";
  }

  fs::path folder_;
};

const TriangleMesh& mesh_of(const SceneDescription& scene, size_t shape = 0) {
  return std::get<TriangleMesh>(scene.shapes.at(shape).geometry);
}

const Sphere& sphere_of(const SceneDescription& scene, size_t shape = 0) {
  return std::get<Sphere>(scene.shapes.at(shape).geometry);
}

template <class T>
const T& material_of(const SceneDescription& scene, size_t shape = 0) {
  return std::get<T>(scene.materials.at(scene.shapes.at(shape).material).model);
}

bool warns(const SceneDescription& scene, const std::string& text) {
  for (const std::string& warning : scene.warnings) {
    if (warning.find(text) != std::string::npos) return true;
  }
  return false;
}

glm::vec3 normal_of(const TriangleMesh& mesh, size_t triangle = 0) {
  const glm::uvec3 t = mesh.triangles.at(triangle);
  const glm::vec3 a = mesh.positions[t.x];
  return glm::normalize(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
}

void expect_near(glm::vec3 a, glm::vec3 b, float tolerance = 1e-5f) {
  EXPECT_LT(glm::distance(a, b), tolerance)
      << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] ";

// --- View

TEST_F(Pbrt, EmptyWorldHasTheDefaultsOfV4) {
  const SceneDescription scene = read("WorldBegin");
  EXPECT_EQ(scene.name, "scene");
  EXPECT_EQ(scene.film.width, 1280);
  EXPECT_EQ(scene.film.height, 720);
  EXPECT_EQ(scene.film.filter.kind, PixelFilter::Kind::Gaussian);
  EXPECT_FLOAT_EQ(scene.film.filter.radius.x, 1.5f);
  EXPECT_FLOAT_EQ(scene.film.filter.sigma, 0.5f);
  EXPECT_EQ(scene.defaults.spp, 16);
  EXPECT_EQ(scene.defaults.depth, 5);
  EXPECT_FLOAT_EQ(scene.camera.fov_degrees, 90.0f);
  EXPECT_FALSE(scene.environment);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Pbrt, FilmOrWorldEndTellV3) {
  for (const char* text : {"Film \"image\" WorldBegin", "WorldBegin WorldEnd"}) {
    const SceneDescription scene = read(text);
    EXPECT_EQ(scene.film.width, 640);
    EXPECT_EQ(scene.film.height, 480);
    EXPECT_EQ(scene.film.filter.kind, PixelFilter::Kind::Box);
    EXPECT_FLOAT_EQ(scene.film.filter.radius.x, 0.5f);
  }
  EXPECT_EQ(read("Film \"rgb\" WorldBegin WorldEnd").film.width, 1280);
}

TEST_F(Pbrt, FilmSamplerAndIntegrator) {
  const SceneDescription scene = read(
      "# a comment [ \" \n"
      "Film \"rgb\" \"integer xresolution\" 320 \"integer yresolution\" [200]\n"
      "  \"string filename\" \"a.exr\" \"bool savefp16\" [false]\n"
      "Sampler \"halton\" \"integer pixelsamples\" [32] Integrator \"path\" \"integer maxdepth\" "
      "3\n"
      "Accelerator \"bvh\" \"string splitmethod\" \"sah\" ColorSpace \"srgb\"\n"
      "Option \"bool disablepixeljitter\" true WorldBegin");
  EXPECT_EQ(scene.film.width, 320);
  EXPECT_EQ(scene.film.height, 200);
  EXPECT_EQ(scene.defaults.spp, 32);
  EXPECT_EQ(scene.defaults.depth, 3);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Pbrt, PixelFiltersOfBothVersions) {
  const auto filter = [&](const std::string& text) {
    return read(text + " WorldBegin").film.filter;
  };
  const PixelFilter triangle_filter = filter("PixelFilter \"triangle\"");
  EXPECT_EQ(triangle_filter.kind, PixelFilter::Kind::Triangle);
  EXPECT_FLOAT_EQ(triangle_filter.radius.y, 2.0f);
  EXPECT_FLOAT_EQ(filter("PixelFilter \"box\" \"float xradius\" 1").radius.x, 1.0f);
  const PixelFilter v3 =
      filter("PixelFilter \"gaussian\" \"float xwidth\" 3 \"float alpha\" 8 Film \"image\"");
  EXPECT_FLOAT_EQ(v3.radius.x, 3.0f);
  EXPECT_FLOAT_EQ(v3.radius.y, 2.0f);
  EXPECT_FLOAT_EQ(v3.sigma, 0.25f);
  EXPECT_FLOAT_EQ(filter("PixelFilter \"gaussian\" Film \"image\"").sigma, 0.5f);
  EXPECT_FLOAT_EQ(filter("PixelFilter \"gaussian\" \"float sigma\" 0.7").sigma, 0.7f);
  const SceneDescription other = read("PixelFilter \"sinc\" WorldBegin");
  EXPECT_EQ(other.film.filter.kind, PixelFilter::Kind::Gaussian);
  EXPECT_TRUE(warns(other, "scene.pbrt:1: PixelFilter \"sinc\" is not supported"));
}

TEST_F(Pbrt, CameraLooksWhereItIsTold) {
  const SceneDescription scene = read(
      "LookAt 1 2 3  1 2 10  0 1 0 Camera \"perspective\" \"float fov\" 39\n"
      "\"float lensradius\" 0.1 \"float focaldistance\" 3 WorldBegin");
  const glm::mat4& m = scene.camera.camera_to_world;
  expect_near(glm::vec3(m[3]), {1, 2, 3});
  expect_near(glm::vec3(m[2]), {0, 0, 1});
  expect_near(glm::vec3(m[1]), {0, 1, 0});
  expect_near(glm::vec3(m[0]), {1, 0, 0});
  EXPECT_FLOAT_EQ(scene.camera.fov_degrees, 39.0f);
  EXPECT_TRUE(warns(scene, "thin lens"));
}

TEST_F(Pbrt, CameraTransformsComposeAsInPbrt) {
  const SceneDescription scene =
      read("Scale -1 1 1 Translate 0 0 5 Camera \"perspective\" WorldBegin");
  // The world point (0, 0, -5) is the eye; +x of the world is to the left.
  expect_near(glm::vec3(scene.camera.camera_to_world[3]), {0, 0, -5});
  expect_near(glm::vec3(scene.camera.camera_to_world[0]), {-1, 0, 0});
}

TEST_F(Pbrt, OtherCamerasAndIntegratorsWarn) {
  const SceneDescription scene =
      read("Camera \"orthographic\" \"float frameaspectratio\" 1\nIntegrator \"bdpt\"\nWorldBegin");
  EXPECT_TRUE(warns(scene, "scene.pbrt:1: Camera \"orthographic\" is not supported"));
  EXPECT_TRUE(warns(scene, "frameaspectratio"));
  EXPECT_TRUE(warns(scene, ":2: Integrator \"bdpt\": the scene is rendered with the path tracer"));
}

// --- Transforms and scopes

TEST_F(Pbrt, TransformsNestAndComeBack) {
  const SceneDescription scene = read_world(
      "AttributeBegin Translate 1 2 3 Scale 2 2 2\n"
      "  TransformBegin Rotate 90 0 0 1 Translate 1 0 0 Shape \"sphere\" TransformEnd\n"
      "  Shape \"sphere\" \"float radius\" 2 AttributeEnd\n"
      "Transform [1 0 0 0  0 1 0 0  0 0 1 0  7 8 9 1] ConcatTransform [2 0 0 0 0 2 0 0 0 0 2 0 1 0 "
      "0 1]\n"
      "Shape \"sphere\" Identity Shape \"sphere\"");
  expect_near(sphere_of(scene, 0).center, {1, 4, 3});
  EXPECT_FLOAT_EQ(sphere_of(scene, 0).radius, 2.0f);
  expect_near(sphere_of(scene, 1).center, {1, 2, 3});
  EXPECT_FLOAT_EQ(sphere_of(scene, 1).radius, 4.0f);
  expect_near(sphere_of(scene, 2).center, {8, 8, 9});
  EXPECT_FLOAT_EQ(sphere_of(scene, 2).radius, 2.0f);
  expect_near(sphere_of(scene, 3).center, {0, 0, 0});
}

TEST_F(Pbrt, CoordinateSystems) {
  const SceneDescription scene = read(
      "LookAt 0 0 -4  0 0 0  0 1 0 Camera \"perspective\" WorldBegin\n"
      "CoordSysTransform \"camera\" Shape \"sphere\"\n"
      "Identity Translate 5 0 0 CoordinateSystem \"here\" Identity\n"
      "CoordSysTransform \"here\" Shape \"sphere\" CoordSysTransform \"world\" Shape \"sphere\"");
  expect_near(sphere_of(scene, 0).center, {0, 0, -4});
  expect_near(sphere_of(scene, 1).center, {5, 0, 0});
  expect_near(sphere_of(scene, 2).center, {0, 0, 0});
}

TEST_F(Pbrt, AttributesGiveDefaults) {
  const SceneDescription scene = read_world(
      "AttributeBegin Attribute \"shape\" \"float radius\" 3 Shape \"sphere\"\n"
      "Shape \"sphere\" \"float radius\" 4 AttributeEnd Shape \"sphere\"");
  EXPECT_FLOAT_EQ(sphere_of(scene, 0).radius, 3.0f);
  EXPECT_FLOAT_EQ(sphere_of(scene, 1).radius, 4.0f);
  EXPECT_FLOAT_EQ(sphere_of(scene, 2).radius, 1.0f);
}

TEST_F(Pbrt, IncludesLookBesideTheFileThenBesideTheMainFile) {
  write("geometry/outer.pbrt", "Include \"inner.pbrt\" Include \"beside_main.pbrt\"");
  write("geometry/inner.pbrt", "Translate 1 0 0 Shape \"sphere\"");
  write("beside_main.pbrt", "Shape \"sphere\" \"float radius\" 9");
  const SceneDescription scene =
      read_world("Import \"geometry/outer.pbrt\" Shape \"sphere\" \"float radius\" 2");
  ASSERT_EQ(scene.shapes.size(), 3u);
  EXPECT_FLOAT_EQ(sphere_of(scene, 1).radius, 9.0f);
  expect_near(sphere_of(scene, 2).center, {1, 0, 0});
}

// --- Shapes

TEST_F(Pbrt, TriangleMeshes) {
  const SceneDescription scene = read_world(
      "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 1 1 0 0 1 0] \"integer indices\" [0 1 2 2 3 "
      "0]\n"
      "\"float uv\" [0 0 1 0 1 1 0 1]\n" +
      triangle);
  EXPECT_EQ(mesh_of(scene).triangles.size(), 2u);
  EXPECT_EQ(mesh_of(scene).uvs.at(2), glm::vec2(1, 1));
  EXPECT_TRUE(mesh_of(scene).normals.empty());
  expect_near(normal_of(mesh_of(scene)), {0, 0, 1});
  EXPECT_EQ(mesh_of(scene, 1).triangles.size(), 1u);
}

TEST_F(Pbrt, OrientationFollowsPbrt) {
  const auto normal = [&](const std::string& before, const std::string& more = "") {
    return normal_of(mesh_of(read_world(before + " " + triangle + more))).z;
  };
  const std::string up = "\"normal N\" [0 0 1 0 0 1 0 0 1]",
                    down = "\"normal N\" [0 0 -1 0 0 -1 0 0 -1]";
  EXPECT_EQ(normal(""), 1.0f);
  EXPECT_EQ(normal("ReverseOrientation"), -1.0f);
  EXPECT_EQ(normal("ReverseOrientation ReverseOrientation"), 1.0f);
  EXPECT_EQ(normal("Scale -1 1 1"), 1.0f);
  EXPECT_EQ(normal("Scale 1 1 -1"), -1.0f);  // the side moves with the object
  EXPECT_EQ(normal("Scale -1 1 1 ReverseOrientation"), -1.0f);
  EXPECT_EQ(normal("", up), 1.0f);
  EXPECT_EQ(normal("", down), -1.0f);  // shading normals overrule the winding
  EXPECT_EQ(normal("ReverseOrientation", up), -1.0f);
  EXPECT_EQ(normal("ReverseOrientation", down), 1.0f);
  EXPECT_EQ(normal("Scale -1 1 1", down), -1.0f);
}

TEST_F(Pbrt, NormalsOfNoLengthAreReplaced) {
  const TriangleMesh mesh = mesh_of(read_world(triangle + "\"normal N\" [0 0 0 0 0 5 0 3 4]"));
  expect_near(mesh.normals.at(0), {0, 0, 1});
  expect_near(mesh.normals.at(1), {0, 0, 1});
  expect_near(mesh.normals.at(2), {0, 0.6f, 0.8f});
}

TEST_F(Pbrt, BilinearMeshes) {
  const SceneDescription scene = read_world(
      "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  2 0 0  0 1 0  2 1 0]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 1]");
  const TriangleMesh& flat = mesh_of(scene);
  ASSERT_EQ(flat.triangles.size(), 2u);
  EXPECT_TRUE(flat.normals.empty());
  expect_near(normal_of(flat, 0), {0, 0, 1});
  expect_near(normal_of(flat, 1), {0, 0, 1});
  const TriangleMesh& curved = mesh_of(scene, 1);
  EXPECT_EQ(curved.triangles.size(), 128u);
  ASSERT_EQ(curved.normals.size(), curved.positions.size());
  for (size_t i = 0; i < curved.positions.size(); ++i) {
    const glm::vec3 p = curved.positions[i];  // z = x y
    EXPECT_NEAR(p.z, p.x * p.y, 1e-6f);
    expect_near(curved.normals[i], glm::normalize(glm::vec3(-p.y, -p.x, 1.0f)));
  }
}

TEST_F(Pbrt, LoopSubdivisionSurfaces) {
  const std::string tetrahedron =
      "\"integer indices\" [0 1 2 0 3 1 0 2 3 1 3 2] \"point P\" [1 1 1 1 -1 -1 -1 1 -1 -1 -1 1] ";
  const SceneDescription scene =
      read_world("Shape \"loopsubdiv\" \"integer nlevels\" 1 " + tetrahedron +
                 "Shape \"loopsubdiv\" \"integer levels\" [2] " + tetrahedron +
                 "ReverseOrientation Shape \"loopsubdiv\" " + tetrahedron);
  EXPECT_EQ(mesh_of(scene, 0).triangles.size(), 16u);
  EXPECT_EQ(mesh_of(scene, 1).triangles.size(), 64u);
  EXPECT_EQ(mesh_of(scene, 2).triangles.size(), 256u);
  // pbrt's normals of these surfaces oppose the winding of the control mesh.
  const TriangleMesh& inward = mesh_of(scene, 0);
  EXPECT_LT(glm::dot(inward.normals[0], inward.positions[0]), 0.0f);
  EXPECT_LT(glm::dot(normal_of(inward), inward.positions[inward.triangles[0].x]), 0.0f);
  const TriangleMesh& outward = mesh_of(scene, 2);
  EXPECT_GT(glm::dot(outward.normals[0], outward.positions[0]), 0.0f);
}

TEST_F(Pbrt, PlyMeshes) {
  write("geometry/quad.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  write("geometry/part.pbrt", "Shape \"plymesh\" \"string filename\" \"quad.ply\"");
  const SceneDescription scene = read_world("Translate 0 0 2 Include \"geometry/part.pbrt\"");
  ASSERT_EQ(mesh_of(scene).triangles.size(), 2u);
  expect_near(mesh_of(scene).positions[2], {1, 1, 2});
}

TEST_F(Pbrt, SpheresAndEllipsoids) {
  const SceneDescription scene = read_world(
      "AttributeBegin Rotate 30 1 2 3 Scale -2 2 2 Shape \"sphere\" \"float radius\" [1.5] "
      "AttributeEnd\n"
      "AttributeBegin ReverseOrientation Shape \"sphere\" AttributeEnd\n"
      "Scale 1 1 3 Shape \"sphere\" ReverseOrientation Shape \"sphere\" \"float zmin\" 0");
  EXPECT_FLOAT_EQ(sphere_of(scene, 0).radius, 3.0f);
  EXPECT_FALSE(sphere_of(scene, 0).emits_inwards);
  EXPECT_TRUE(sphere_of(scene, 1).emits_inwards);
  for (size_t shape : {2u, 3u}) {
    const TriangleMesh& mesh = mesh_of(scene, shape);
    const float side = shape == 2 ? 1.0f : -1.0f;
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
      const glm::vec3 p = mesh.positions[i];
      EXPECT_NEAR(p.x * p.x + p.y * p.y + p.z * p.z / 9.0f, 1.0f, 1e-5f);
      expect_near(mesh.normals[i], side * glm::normalize(glm::vec3(p.x, p.y, p.z / 9.0f)));
    }
    EXPECT_GT(side * glm::dot(normal_of(mesh, 100), mesh.positions[mesh.triangles[100].x]), 0.0f);
  }
  EXPECT_TRUE(warns(scene, "partial spheres"));
}

// --- Materials

TEST_F(Pbrt, MaterialsOfV4) {
  const SceneDescription scene = read_world(
      "Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3] Shape \"sphere\"\n"
      "Material \"coateddiffuse\" \"rgb reflectance\" [.4 .5 .6] \"float roughness\" .25 Shape "
      "\"sphere\"\n"
      "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"\n"
      "  \"float uroughness\" .04 \"float vroughness\" .09 Shape \"sphere\"\n"
      "Material \"conductor\" \"rgb eta\" [1 2 3] \"rgb k\" [4 5 6] \"float roughness\" .3\n"
      "  \"bool remaproughness\" false Shape \"sphere\"\n"
      "Material \"conductor\" \"rgb reflectance\" [.25 .5 1] \"float roughness\" 0 Shape "
      "\"sphere\"");
  EXPECT_EQ(material_of<DiffuseMaterial>(scene, 0).reflectance, glm::vec3(.1f, .2f, .3f));
  const auto& coated = material_of<CoatedMaterial>(scene, 1);
  EXPECT_TRUE(coated.layered);
  EXPECT_EQ(coated.diffuse, glm::vec3(.4f, .5f, .6f));
  EXPECT_EQ(coated.specular, glm::vec3(1.0f));
  EXPECT_FLOAT_EQ(coated.alpha, 0.5f);
  EXPECT_FLOAT_EQ(coated.eta, 1.5f);
  const auto& gold = material_of<ConductorMaterial>(scene, 2);
  EXPECT_LT(gold.eta.value.x, gold.eta.value.z);
  EXPECT_FLOAT_EQ(gold.alpha.x, 0.2f);
  EXPECT_FLOAT_EQ(gold.alpha.y, 0.3f);
  const auto& given = material_of<ConductorMaterial>(scene, 3);
  EXPECT_EQ(given.eta, glm::vec3(1, 2, 3));
  EXPECT_EQ(given.k, glm::vec3(4, 5, 6));
  EXPECT_FLOAT_EQ(given.alpha.x, 0.3f);
  const auto& mirror = material_of<ConductorMaterial>(scene, 4);
  const glm::vec3 f = mirror.k.value * mirror.k.value / (4.0f + mirror.k.value * mirror.k.value);  // Fresnel for eta 1
  expect_near(f, {.25f, .5f, 1.0f}, 1e-3f);
  EXPECT_FLOAT_EQ(mirror.alpha.x, 1e-3f);
  EXPECT_TRUE(warns(scene, "perfectly smooth"));
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST_F(Pbrt, MaterialsOfV3) {
  const SceneDescription scene = read_world(
      "Material \"matte\" \"color Kd\" [.1 .2 .3] Shape \"sphere\"\n"
      "Material \"plastic\" \"color Kd\" [.4 .2 .2] \"color Ks\" [.5 .5 .5] \"float roughness\" "
      "[.025]\n"
      "  Shape \"sphere\"\n"
      "Material \"plastic\" \"float roughness\" .2 \"bool remaproughness\" \"false\" Shape "
      "\"sphere\"\n"
      "Material \"metal\" \"spectrum eta\" \"spds/Ag.eta.spd\" \"rgb k\" [1 2 3] Shape \"sphere\"");
  EXPECT_EQ(material_of<DiffuseMaterial>(scene, 0).reflectance, glm::vec3(.1f, .2f, .3f));
  const auto& plastic = material_of<CoatedMaterial>(scene, 1);
  EXPECT_FALSE(plastic.layered);
  EXPECT_EQ(plastic.diffuse, glm::vec3(.4f, .2f, .2f));
  EXPECT_EQ(plastic.specular, glm::vec3(.5f));
  EXPECT_NEAR(plastic.alpha, 0.21556f, 1e-4f);
  const auto& defaults = material_of<CoatedMaterial>(scene, 2);
  EXPECT_EQ(defaults.diffuse, glm::vec3(.25f));
  EXPECT_EQ(defaults.specular, glm::vec3(.25f));
  EXPECT_FLOAT_EQ(defaults.alpha, 0.2f);
  const auto& silver = material_of<ConductorMaterial>(scene, 3);
  EXPECT_NEAR(silver.eta.value.x, 0.155f, 1e-3f);
  EXPECT_EQ(silver.k, glm::vec3(1, 2, 3));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Pbrt, ShapesOfOneMaterialShareIt) {
  const SceneDescription scene = read_world(
      "Shape \"sphere\" MakeNamedMaterial \"unused\" \"string type\" \"diffuse\"\n"
      "MakeNamedMaterial \"red\" \"string type\" [\"diffuse\"] \"rgb reflectance\" [1 0 0]\n"
      "NamedMaterial \"red\" Shape \"sphere\" Shape \"sphere\" AttributeBegin Material \"matte\"\n"
      "Shape \"sphere\" AttributeEnd Shape \"sphere\"");
  ASSERT_EQ(scene.materials.size(), 3u);
  const std::vector<int> expected = {0, 1, 1, 2, 1};
  for (size_t i = 0; i < 5; ++i) EXPECT_EQ(scene.shapes.at(i).material, expected[i]);
  EXPECT_EQ(material_of<DiffuseMaterial>(scene, 1).reflectance, glm::vec3(1, 0, 0));
}

TEST_F(Pbrt, InterfacesAreLeftOut) {
  for (const char* name : {"none", "interface", ""}) {
    const SceneDescription scene =
        read_world("Material \"" + std::string(name) + "\"\n" + triangle + "\n" + triangle);
    EXPECT_TRUE(scene.shapes.empty());
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_TRUE(warns(scene, "scene.pbrt:3: shapes with an interface material"));
  }
}

TEST_F(Pbrt, SpectraBecomeColours) {
  const auto reflectance = [&](const std::string& spectrum) {
    return material_of<DiffuseMaterial>(
               read_world("Material \"diffuse\" \"spectrum reflectance\" " + spectrum + triangle))
        .reflectance.value;
  };
  expect_near(reflectance("[300 .5 800 .5]"), glm::vec3(0.5f), 1e-4f);
  const glm::vec3 red = reflectance("[400 0 590 0 600 .9 800 .9]");
  EXPECT_GT(red.x, 0.5f);
  EXPECT_LT(red.y, 0.3f);
  EXPECT_LT(red.z, 0.1f);
}

// --- Lights

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

// --- What is not supported

TEST_F(Pbrt, UnsupportedThingsWarnOncePerKind) {
  const SceneDescription scene = read_world(
      "Material \"hair\" \"float eta\" 1.55\nMaterial \"hair\"\nShape \"cone\"\nShape \"cone\"\n"
      "LightSource \"distant\" \"point3 from\" [0 0 0]\nLightSource \"distant\"\n"
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.png\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\" \"float alpha\" 0.5\n"
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" MediumInterface \"fog\" \"\"\n"
      "ObjectBegin \"o\" Shape \"sphere\" ObjectEnd ObjectInstance \"o\"\n"
      "LightSource \"infinite\" \"string filename\" \"sky.exr\"\n"
      "ActiveTransform EndTime Translate 9 9 9 ActiveTransform All Shape \"sphere\"\n");
  EXPECT_TRUE(warns(scene, ":2: Material \"hair\" is not supported; a diffuse grey is used"));
  EXPECT_TRUE(warns(scene, ":4: Shape \"cone\" is not supported"));
  EXPECT_TRUE(warns(scene, ":6: LightSource \"distant\" is not supported"));
  EXPECT_TRUE(warns(scene, ":8: textures are not supported yet"));
  EXPECT_TRUE(warns(scene, ":10: Shape \"sphere\": the parameter \"float alpha\""));
  EXPECT_TRUE(warns(scene, ":11: participating media"));
  EXPECT_TRUE(warns(scene, ":12: object instances"));
  EXPECT_TRUE(warns(scene, ":13: environment maps"));
  EXPECT_TRUE(warns(scene, ":14: motion"));
  EXPECT_EQ(scene.warnings.size(), 9u);
  ASSERT_EQ(scene.shapes.size(), 2u);
  expect_near(sphere_of(scene, 1).center, {0, 0, 0});
  EXPECT_EQ(material_of<DiffuseMaterial>(scene, 0).reflectance, glm::vec3(0.5f));
}

// --- Broken files

TEST_F(Pbrt, BrokenFilesSayWhereAndWhat) {
  write("self.pbrt", "Include \"self.pbrt\"");
  write("bad.ply", "ply\nformat ascii 1.0\nelement vertex 0\n");
  struct Case {
    std::string text, message;
  };
  const std::string world = "WorldBegin\n";
  const Case cases[] = {
      {"", "scene.pbrt: the file has no WorldBegin"},
      {"Camera \"perspective\"\n\"float fov\"\nWorldBegin",
       "scene.pbrt:2: expected a value list after \"float fov\""},
      {"Camera \"perspective\" \"float fov\" [", ":1: expected a value or ] for \"float fov\""},
      {"Camera \"perspective\" \"float fov\" []", ":1: \"float fov\" has no value"},
      {"Camera \"perspective\" \"float fov\" [1 2]", ":1: \"float fov\" must have one value"},
      {"Camera \"perspective\" \"float fov\" 200 ", "fov between 0 and 180"},
      {"Camera \"perspective\" \"flaot fov\" 39", ":1: unknown parameter type in \"flaot fov\""},
      {"Camera \"perspective\" \"fov\" 39", ":1: expected a parameter such as"},
      {"Camera \"perspective\" \"float fov\" \"wide\"", "\"float fov\" cannot have the value"},
      {"Camera \"perspective\" \"float fov\" 3x", ":1: expected a number, found \"3x\""},
      {"Camera \"perspective\" \"float fov\" 1e99", ":1: the number \"1e99\" is out of range"},
      {"Camera \"perspective\" \"float fov\" 1 \"float fov\" 2", "is given twice"},
      {"Camera perspective", ":1: expected the camera's type in quotes after Camera"},
      {"\nCamera \"perspective", "scene.pbrt:2: the string that starts here has no closing quote"},
      {"Film \"rgb\" \"integer xresolution\" 0\nWorldBegin",
       "scene.pbrt:1: Film needs a resolution"},
      {"Film \"rgb\" \"integer xresolution\" 1.5 WorldBegin", "whole numbers"},
      {"Sampler \"zsobol\" \"integer pixelsamples\" 0", "Sampler needs pixelsamples above 0"},
      {"LookAt 0 0 0 0 0 1 0 0 1", ":1: LookAt needs two distinct points"},
      {"Scale 1 0 1", ":1: Scale gives a transform that cannot be inverted"},
      {"Rotate 30 0 0 0", ":1: Rotate needs an axis"},
      {"Translate 1 2\nWorldBegin", ":2: expected a number for Translate, found \"WorldBegin\""},
      {"Transform [1 2 3]", ":1: expected 16 numbers of a matrix, found \"]\""},
      {"Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]", ":1: the matrix is projective"},
      {"Teapot", ":1: unknown directive \"Teapot\""},
      {"[ 1 2 ]", ":1: expected a directive, found \"[\""},
      {"Shape \"sphere\"", ":1: Shape must come after WorldBegin"},
      {world + "Film \"rgb\"", ":2: Film must come before WorldBegin"},
      {world + "AttributeBegin\n", "scene.pbrt:2: AttributeBegin is never closed"},
      {world + "AttributeEnd", ":2: AttributeEnd without AttributeBegin"},
      {world + "TransformBegin\nAttributeEnd",
       ":3: AttributeEnd does not close the TransformBegin of line 2"},
      {world + "CoordSysTransform \"x\"", ":2: the coordinate system \"x\" has not been defined"},
      {world + "NamedMaterial \"x\"", ":2: NamedMaterial \"x\" has not been defined"},
      {world + "MakeNamedMaterial \"x\"", ":2: MakeNamedMaterial \"x\" needs \"string type\""},
      {world + "Include \"absent.pbrt\"", "scene.pbrt:2: \"absent.pbrt\" cannot be opened"},
      {world + "Include \"self.pbrt\"", "self.pbrt:1: files include one another more than 32 deep"},
      {world + "Shape \"plymesh\"", ":2: Shape \"plymesh\" needs \"string filename\""},
      {world + "Shape \"plymesh\" \"string filename\" \"absent.ply\"",
       "scene.pbrt:2: absent.ply: cannot be opened"},
      {world + "Shape \"plymesh\" \"string filename\" \"bad.ply\"",
       "scene.pbrt:2: bad.ply:4: the PLY"},
      {world + "Shape \"trianglemesh\"", ":2: Shape \"trianglemesh\" needs \"point3 P\""},
      {world + "Shape \"trianglemesh\"\n\"point3 P\" [0 0 0 1]",
       ":3: \"point3 P\" has 4 values; expected a multiple of 3"},
      {world + triangle + "\n\"integer indices\" [0 1 3]",
       ":3: Shape \"trianglemesh\" has the index 3, but only 3 points"},
      {world + triangle + "\"integer indices\" [0 1 -1]", "has the index -1"},
      {world + triangle + "\n\"integer indices\" [0 1]",
       ":3: Shape \"trianglemesh\" has 2 indices; expected a multiple of 3"},
      {world + triangle + "\"normal N\" [0 0 1]", "has 3 points but 1 values of \"N\""},
      {world + "Scale 1e25 1 1 Shape \"trianglemesh\" \"point3 P\" [1e20 0 0 1 0 0 0 1 0]",
       "leave the range of float"},
      {world + "Shape \"loopsubdiv\" \"point3 P\" [0 0 0 1 0 0 0 1 0]",
       "needs \"integer indices\""},
      {world + "Shape \"loopsubdiv\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]\n"
               "\"integer levels\" 30",
       ":2: Shape \"loopsubdiv\" cannot have 30 levels"},
      {world + "Shape \"loopsubdiv\" \"point3 P\" [0 0 0 1 0 0 0 1 0 0 0 1]\n"
               "\"integer indices\" [0 1 2 0 1 3]",
       "wind in opposite ways"},
      {world + "Shape \"sphere\" \"float radius\" -1",
       ":2: Shape \"sphere\" needs a radius above 0"},
      {world + "AreaLightSource \"diffuse\" \"rgb L\" [1 -1 1]", "negative radiance"},
      {world + "Attribute \"teapot\"", ":2: Attribute \"teapot\" is not one of"},
  };
  for (const Case& c : cases) {
    const std::string message = error_of(c.text);
    EXPECT_NE(message.find(c.message), std::string::npos) << message << "\nexpected " << c.message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_THROW(read_pbrt((folder_ / "absent.pbrt").string()), Error);
  EXPECT_THROW(read_pbrt(folder_.string()), Error);
}

// --- Whole scenes

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
  EXPECT_FALSE(material_of<CoatedMaterial>(scene, 3).layered);
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
  EXPECT_FLOAT_EQ(material_of<ConductorMaterial>(scene, 0).alpha.x, 0.01f);
  EXPECT_EQ(scene.defaults.depth, 3);
  EXPECT_TRUE(scene.warnings.empty());
}

// Cut short or with bytes changed, a scene is read or refused, and nothing else.
TEST_F(SharedScene, DamagedCopiesAreReadOrRefused) {
  std::mt19937 random(1);
  write("killeroo1_world.ply", "ply\n");
  write("geometry/killeroo.pbrt", triangle);
  for (const char* name :
       {"killeroo-simple/killeroo-simple.pbrt", "killeroo-quad/killeroo-quad.pbrt",
        "cornell-box/scene-v4.pbrt", "veach-mis/scene-v4.pbrt"}) {
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
}  // namespace lockstep
