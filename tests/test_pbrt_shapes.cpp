// Shapes and objects of pbrt files.
#include "tests/t_pbrt.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace lockstep::test_pbrt_shapes {
namespace {

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

std::string ply_with(const std::string& vertices, const std::string& faces) {
  const auto lines = [](const std::string& text) { return std::ranges::count(text, '\n'); };
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(lines(vertices)) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(lines(faces)) + "\nproperty list uchar int vertex_indices\nend_header\n" +
         vertices + faces;
}

std::string ply_shape(const std::string& file) {
  return "Shape \"plymesh\" \"string filename\" \"" + file + "\"\n";
}

const std::string three_vertices = "0 0 0\n1 0 0\n0 1 0\n";

TEST_F(Pbrt, PlyMeshesStayInTheOrderOfTheirShapes) {
  std::string text;
  for (int i = 0; i < 60; ++i) {
    const std::string file = std::to_string(i) + ".ply";
    write(file, ply_with("0 0 0\n1 0 0\n0 1 " + std::to_string(i) + "\n", "3 0 1 2\n"));
    text += ply_shape(file);
    if (i % 10 == 5) text += "Shape \"sphere\"\n";
  }
  const SceneDescription scene = read_world(text);
  ASSERT_EQ(scene.shapes.size(), 66u);
  for (size_t i = 0, file = 0; i < scene.shapes.size(); ++i) {
    if (i % 11 == 6) {
      sphere_of(scene, i);
    } else {
      EXPECT_EQ(mesh_of(scene, i).positions.at(2).z, static_cast<float>(file++));
    }
  }
}

// The first by its place in the scene, however soon a file or the scene itself proves bad.
TEST_F(Pbrt, TheFirstOfSeveralErrorsIsTold) {
  std::string points;
  for (int i = 0; i < 50000; ++i) points += "1 2 3\n";
  write("good.ply", ply_with(three_vertices, "3 0 1 2\n"));
  write("empty.ply", ply_with(three_vertices, ""));
  write("far.ply", ply_with("0 0 0\n1e15 0 0\n0 1 0\n", "3 0 1 2\n"));
  write("late.ply", ply_with(points, "3 0 1 50000\n"));
  write("headless.ply", "ply\nformat ascii 1.0\nend_header\n");
  write("bad.ply", ply_with(three_vertices, "3 0 1 3\n"));
  const std::string good = ply_shape("good.ply"), late = ply_shape("late.ply");
  const std::string bad = ply_shape("bad.ply"), lamp = "AreaLightSource \"diffuse\" ";
  const std::string far = "Scale 1e25 1 1 " + ply_shape("far.ply") + "Identity\n";
  const std::string of_late = "scene.pbrt:4: late.ply:50010: face 0 refers to a vertex";
  const std::pair<std::string, std::string> cases[] = {
      {good + good + late + good + bad + bad, of_late},
      {good + good + late + "Teapot", of_late},
      {good + good + late + ply_shape("absent.ply"), of_late},
      {good + good + late + "AttributeBegin\n", of_late},
      {good + good + late + "NamedMaterial \"x\" " + good, of_late},
      {"\nObjectBegin \"x\"\n" + late + "ObjectEnd " + good + bad, of_late},
      {good + "Teapot\n" + bad, "scene.pbrt:3: unknown directive \"Teapot\""},
      {good + far + late, "scene.pbrt:3: Shape \"plymesh\" has points that leave the range"},
      {good + ply_shape("empty.ply") + lamp + bad + late, "scene.pbrt:4: bad.ply:13: face 0"},
      {good + ply_shape("headless.ply") + bad, "scene.pbrt:3: headless.ply:4: the file has no el"},
  };
  for (const auto& [text, message] : cases) {
    expect_one_line_with(message_of([&] { read_world(text); }), message);
  }
}

TEST_F(Pbrt, PlyMeshesWithoutFacesAreLeftOut) {
  write("good.ply", ply_with(three_vertices, "3 0 1 2\n"));
  write("empty.ply", ply_with(three_vertices, "") + "# " + std::string(10000, 'x'));
  std::string long_header = ply_with(three_vertices, "");
  long_header.insert(4, "comment " + std::string(10000, 'x') + "\n");
  write("long.ply", long_header);
  const SceneDescription scene = read_world(
      "Shape \"torus\"\nAreaLightSource \"diffuse\" \"string filename\" \"unused.png\"\n" +
      ply_shape("long.ply") + ply_shape("empty.ply") +
      "Shape \"klein\" AreaLightSource \"diffuse\" \"float power\" 1\n" + ply_shape("good.ply"));
  ASSERT_EQ(scene.warnings.size(), 3u);
  EXPECT_TRUE(
      scene.warnings[1].ends_with("scene.pbrt:4: Shape \"plymesh\" has no triangles; "
                                  "it is left out"));
  EXPECT_TRUE(scene.textures.empty());
  ASSERT_EQ(scene.shapes.size(), 1u);
  // One side of an area of 1/2 emits 1 in all.
  EXPECT_FLOAT_EQ(scene.shapes[0].emission->radiance.value.x, 2.0f / std::numbers::pi_v<float>);
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

TEST_F(Pbrt, RoundDisksStayDisks) {
  const SceneDescription scene = read_world(R"(
    AttributeBegin Translate 1 2 3 Rotate 90 1 0 0 Scale 2 2 5 Shape "disk" "float radius" 3
      "float height" 1 AttributeEnd
    AttributeBegin Scale 1 1 -1 Shape "disk" ReverseOrientation Shape "disk" AttributeEnd
    Scale -1 1 1 Shape "disk")");
  const auto disk = [&](size_t i) { return std::get<Disk>(scene.shapes.at(i).geometry); };
  expect_near(disk(0).center, {1, -3, 3});
  expect_near(disk(0).normal, {0, -1, 0});
  EXPECT_FLOAT_EQ(disk(0).radius, 6.0f);
  expect_near(disk(1).normal, {0, 0, -1});
  expect_near(disk(2).normal, {0, 0, 1});
  expect_near(disk(3).normal, {0, 0, 1});
}

TEST_F(Pbrt, OtherDisksAndCylindersAreMeshes) {
  const SceneDescription scene = read_world(R"(
    Shape "disk" "float innerradius" .5 "float phimax" 90 "float height" 2
    AttributeBegin Scale 2 1 1 Shape "disk" AttributeEnd
    Texture "t" "spectrum" "imagemap" "string filename" "t.png"
    AttributeBegin Material "diffuse" "texture reflectance" "t" Shape "disk" AttributeEnd
    ReverseOrientation Shape "cylinder" "float radius" 2 "float zmin" 0 "float zmax" 3
      "float phimax" 180)");
  const auto area = [](const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::vec3 a = mesh.positions[t.x];
      sum += 0.5 * glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
    }
    return sum;
  };
  const double pi = std::numbers::pi;
  EXPECT_NEAR(area(mesh_of(scene, 0)), pi * 0.75 / 4.0, 1e-2);
  EXPECT_NEAR(area(mesh_of(scene, 1)), pi * 2.0, 1e-2);
  EXPECT_NEAR(area(mesh_of(scene, 2)), pi, 1e-2);
  EXPECT_NEAR(area(mesh_of(scene, 3)), pi * 2.0 * 3.0, 1e-2);
  for (size_t shape : {0u, 1u, 2u}) {
    const TriangleMesh& mesh = mesh_of(scene, shape);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) expect_near(normal_of(mesh, i), {0, 0, 1});
    // v is 1 in the middle, 0 at the rim.
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
      const bool rim = mesh.uvs[i].y == 0.0f;
      EXPECT_EQ(rim, glm::length(glm::vec2(mesh.positions[i])) > 0.6f) << i;
    }
  }
  const TriangleMesh& half = mesh_of(scene, 3);
  for (size_t i = 0; i < half.positions.size(); ++i) {
    const glm::vec3 p = half.positions[i];
    EXPECT_NEAR(glm::length(glm::vec2(p)), 2.0f, 1e-5f);
    EXPECT_GT(p.y, -1e-5f);
    EXPECT_FLOAT_EQ(half.uvs[i].y, p.z / 3.0f);
    EXPECT_NEAR(half.uvs[i].x, std::atan2(std::max(p.y, 0.0f), p.x) / std::numbers::pi_v<float>,
                1e-5f);
    expect_near(half.normals[i], -glm::vec3(p.x, p.y, 0.0f) / 2.0f);
  }
  EXPECT_LT(glm::dot(normal_of(half), half.normals[0]) - 1.0f, 1e-3f);
  EXPECT_GT(glm::dot(normal_of(half), half.normals[0]), 0.9f);
}

// A Sphere has no orientation: what turns a textured one makes it a mesh, with pbrt's (u, v).
TEST_F(Pbrt, TurnedTexturedSpheresAreMeshes) {
  const SceneDescription scene = read_world(R"(
    Texture "t" "spectrum" "imagemap" "string filename" "t.png"
    Material "diffuse" "texture reflectance" "t" Scale 2 2 2 Shape "sphere"
    Rotate 90 0 1 0 Shape "sphere")");
  EXPECT_FLOAT_EQ(sphere_of(scene, 0).radius, 2.0f);
  const TriangleMesh& mesh = mesh_of(scene, 1);
  EXPECT_EQ(mesh.triangles.size(), 2u * 128u * 63u);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 p = 0.5f * mesh.positions[i];
    EXPECT_NEAR(glm::length(p), 1.0f, 1e-5f);
    // The turn maps z to x.
    EXPECT_NEAR(mesh.uvs[i].y,
                1.0f - std::acos(std::clamp(p.x, -1.0f, 1.0f)) / std::numbers::pi_v<float>, 1e-3f);
  }
}

TEST_F(Pbrt, TextureCoordinatesByAnyName) {
  for (const char* name : {"point2 uv", "float st", "float texcoords"}) {
    const TriangleMesh mesh = mesh_of(read_world(triangle + "\"" + name + "\" [0 0 1 0 .25 .75]"));
    ASSERT_EQ(mesh.uvs.size(), 3u) << name;
    EXPECT_EQ(mesh.uvs[2], glm::vec2(0.25f, 0.75f));
  }
  const SceneDescription patch =
      read_world("Shape \"bilinearmesh\" \"point3 P\" [0 0 0  2 0 0  0 1 0  2 1 0]");
  for (size_t i = 0; i < 4; ++i) {
    const glm::vec3 p = mesh_of(patch).positions.at(i);
    EXPECT_EQ(mesh_of(patch).uvs.at(i), glm::vec2(p.x / 2.0f, p.y));
  }
}

// --- Objects

TEST_F(Pbrt, ObjectsAreKeptOnceAndPlacedOften) {
  const SceneDescription scene = read_world(R"(
    Translate 1 0 0
    ObjectBegin "tree" Translate 0 1 0 Material "diffuse" Shape "sphere" Material "none" Shape "sphere"
    ObjectEnd
    ObjectBegin "unused" Material "mirror" Shape "sphere" ObjectEnd
    ObjectBegin "empty" ObjectEnd
    Scale 2 2 2 ObjectInstance "tree" Identity ObjectInstance "tree" ObjectInstance "empty"
    ObjectInstance "later" ObjectBegin "later" Shape "sphere" ObjectEnd)");
  EXPECT_TRUE(scene.shapes.empty());
  ASSERT_EQ(scene.objects.size(), 2u);
  ASSERT_EQ(scene.objects[0].shapes.size(), 1u);
  expect_near(std::get<Sphere>(scene.objects[0].shapes[0].geometry).center, {1, 1, 0});
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.instances[0].object, 0);
  expect_near(glm::vec3(scene.instances[0].to_world * glm::vec4(1, 1, 0, 1)), {3, 2, 0});
  EXPECT_EQ(scene.instances[1].to_world, glm::mat4(1.0f));
  EXPECT_EQ(scene.instances[2].object, 1);
  EXPECT_EQ(scene.materials.size(), 2u);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Pbrt, ObjectsDoNotEmit) {
  const SceneDescription scene = read_world(
      "ObjectBegin \"lamp\" AreaLightSource \"diffuse\"\nShape \"sphere\" ObjectEnd\n"
      "ObjectInstance \"lamp\" Shape \"sphere\"");
  EXPECT_FALSE(scene.objects.at(0).shapes.at(0).emission);
  EXPECT_FALSE(scene.shapes.at(0).emission);
  EXPECT_TRUE(warns(scene, "scene.pbrt:3: shapes of objects do not emit"));
}

}  // namespace
}  // namespace lockstep::test_pbrt_shapes
