// The Mitsuba reader: shapes and the files of meshes.
#include "core/serialized_mesh.h"
#include "tests/t_mitsuba.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace lockstep::test_mitsuba_shapes {
namespace {

TEST_F(Mitsuba, BuiltInShapesFaceOutwards) {
  const SceneDescription scene = read(
      "<shape type=\"rectangle\"/><shape type=\"cube\"/><shape type=\"disk\"/>"
      "<shape type=\"sphere\"/><shape type=\"cylinder\"><point name=\"p1\" value=\"0,0,4\"/>"
      "<float name=\"radius\" value=\"0.5\"/></shape>");
  ASSERT_EQ(scene.shapes.size(), 5u);
  expect_near(normal_of(mesh_of(scene, 0)), {0, 0, 1});
  EXPECT_EQ(mesh_of(scene, 0).positions[0], glm::vec3(-1, -1, 0));
  EXPECT_EQ(mesh_of(scene, 0).uvs[0], glm::vec2(0, 0));

  const TriangleMesh& cube = mesh_of(scene, 1);
  ASSERT_EQ(cube.triangles.size(), 12u);
  for (size_t i = 0; i < 12; ++i) {
    EXPECT_GT(glm::dot(normal_of(cube, i), cube.positions[cube.triangles[i].x]), 0.9f);
  }
  // The side at -y, as Mitsuba has it: u along z, v along x.
  EXPECT_EQ(cube.positions[0], glm::vec3(1, -1, -1));
  EXPECT_EQ(cube.uvs[0], glm::vec2(0, 1));
  EXPECT_EQ(cube.positions[2], glm::vec3(-1, -1, 1));
  EXPECT_EQ(cube.uvs[2], glm::vec2(1, 0));

  const auto& disk = std::get<Disk>(scene.shapes[2].geometry);
  EXPECT_EQ(disk.normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(disk.radius, 1.0f);
  EXPECT_EQ(sphere_of(scene, 3).radius, 1.0f);

  const TriangleMesh& tube = mesh_of(scene, 4);
  for (size_t i = 0; i < tube.triangles.size(); ++i) {
    const glm::vec3 p = tube.positions[tube.triangles[i].x];
    EXPECT_NEAR(std::hypot(p.x, p.y), 0.5f, 1e-5f);
    EXPECT_GT(glm::dot(normal_of(tube, i), glm::vec3(p.x, p.y, 0.0f)), 0.49f);
  }
}

TEST_F(Mitsuba, FlippingAndMirroringOfSides) {
  const std::string flip = "<boolean name=\"flip_normals\" value=\"true\"/>";
  const std::string mirror =
      "<transform name=\"toWorld\"><scale x=\"-1\" y=\"2\" z=\"1\"/></transform>";
  const SceneDescription scene = read(
      "<shape type=\"rectangle\">" + flip + "</shape><shape type=\"rectangle\">" + mirror +
      "</shape><shape type=\"rectangle\">" + mirror + flip + "</shape><shape type=\"sphere\">" +
      flip + "</shape><shape type=\"disk\"><boolean name=\"flipNormals\" value=\"true\"/></shape>" +
      "<shape type=\"disk\">" + mirror + "</shape>");
  expect_near(normal_of(mesh_of(scene, 0)), {0, 0, -1});
  expect_near(normal_of(mesh_of(scene, 1)), {0, 0, 1});
  expect_near(normal_of(mesh_of(scene, 2)), {0, 0, -1});
  EXPECT_TRUE(sphere_of(scene, 3).emits_inwards);
  expect_near(std::get<Disk>(scene.shapes[4].geometry).normal, {0, 0, -1});
  expect_near(normal_of(mesh_of(scene, 5)), {0, 0, 1});
}

TEST_F(Mitsuba, SpheresAndDisksBecomeMeshesWhereTheyMust) {
  const std::string texture =
      "<bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\"/></bsdf>";
  const SceneDescription scene = read(
      "<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/><transform name=\"to_world\">"
      "<scale x=\"1\" y=\"2\" z=\"3\"/></transform></shape><shape type=\"sphere\">" +
      texture + "</shape><shape type=\"disk\">" + texture + "</shape>");
  glm::vec3 largest(0.0f);
  for (const glm::vec3 p : mesh_of(scene, 0).positions) largest = glm::max(largest, p);
  expect_near(largest, {2, 4, 6}, 1e-3f);
  const TriangleMesh& sphere = mesh_of(scene, 1);
  for (size_t i = 0; i < sphere.triangles.size(); ++i) {
    EXPECT_GT(glm::dot(normal_of(sphere, i), sphere.positions[sphere.triangles[i].x]), 0.9f);
  }
  // A quarter around from +x, on the equator, is +y.
  const auto at = std::find(sphere.uvs.begin(), sphere.uvs.end(), glm::vec2(0.25f, 0.5f));
  ASSERT_NE(at, sphere.uvs.end());
  expect_near(sphere.positions[size_t(at - sphere.uvs.begin())], {0, 1, 0});
  for (size_t i = 0; i < mesh_of(scene, 2).triangles.size(); ++i) {
    expect_near(normal_of(mesh_of(scene, 2), i), {0, 0, 1});
  }
}

TEST_F(Mitsuba, MeshFilesAndTheirNormals) {
  // Two squares at right angles that share an edge.
  write("a.obj", roof + "vt 0 0.25\nf 1/1 2/1 3/1 4/1\nf 6/1 2/1 1/1 5/1\n");
  const auto mesh = [&](const std::string& parameters) {
    return mesh_of(read("<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/>" +
                        parameters + "</shape>"));
  };
  const TriangleMesh smooth = mesh("");
  ASSERT_EQ(smooth.normals.size(), 6u) << "made up, as Mitsuba does";
  EXPECT_LT(smooth.normals[0].y, -0.1f);
  EXPECT_EQ(smooth.uvs[0].y, 0.75f);
  EXPECT_EQ(mesh("<boolean name=\"flip_tex_coords\" value=\"false\"/>").uvs[0].y, 0.25f);
  EXPECT_TRUE(mesh("<boolean name=\"face_normals\" value=\"true\"/>").normals.empty());
  EXPECT_LT(normal_of(mesh("<boolean name=\"flip_normals\" value=\"true\"/>")).z, -0.9f);
  for (const glm::vec3 n : mesh("<float name=\"maxSmoothAngle\" value=\"30\"/>").normals) {
    EXPECT_NEAR(std::max(std::abs(n.y), std::abs(n.z)), 1.0f, 1e-6f) << "a sharp edge";
  }
  const TriangleMesh wide = mesh("<float name=\"maxSmoothAngle\" value=\"120\"/>");
  EXPECT_LT(std::abs(wide.normals[0].z), 0.95f);

  // The winding follows the shading normals.
  write("a.obj", roof + "vn 0 0 -1\nf 1//1 2//1 3//1\n");
  EXPECT_LT(normal_of(mesh("")).z, -0.9f);
  write("a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(mesh_of(read("<shape type=\"ply\"><string name=\"filename\" value=\"a.ply\"/></shape>"))
                .normals.size(),
            3u);
  expect_one_line_with(
      error_of("<shape type=\"ply\"><string name=\"filename\" value=\"b.ply\"/></shape>"),
      "scene.xml:2: b.ply: ");
}

std::string obj_shape(const std::string& file, const std::string& parameters = "") {
  return "<shape type=\"obj\"><string name=\"filename\" value=\"" + file + "\"/>" + parameters +
         "</shape>\n";
}

// All but those that the file has no camera and no light.
std::vector<std::string> warnings_of_shapes(const SceneDescription& scene) {
  std::vector<std::string> warnings = scene.warnings;
  std::erase_if(warnings, [](const std::string& w) { return w.starts_with("scene: "); });
  return warnings;
}

TEST_F(Mitsuba, MeshFilesStayInTheOrderOfTheirShapes) {
  std::string text;
  std::string group = "<shape type=\"shapegroup\" id=\"g\">\n";
  for (int i = 0; i < 60; ++i) {
    const std::string file = std::to_string(i) + ".obj";
    write(file, "v 0 0 0\nv 1 0 0\nv 0 1 " + std::to_string(i) + "\nf 1 2 3\n");
    (i % 10 == 3 ? group : text) += obj_shape(file);
    if (i % 10 == 5) text += "<shape type=\"sphere\"/>\n";
    if (i % 10 == 8) text += "<shape type=\"merge\">" + obj_shape(file) + "</shape>\n";
  }
  const std::string instance = "<shape type=\"instance\"><ref id=\"g\"/></shape>\n";
  const SceneDescription scene = read(group + "</shape>\n" + text + instance + instance);
  EXPECT_EQ(warnings_of_shapes(scene), std::vector<std::string>{});
  std::vector<float> expected, found, of_group;
  for (int i = 0; i < 60; ++i) {
    if (i % 10 != 3) expected.push_back(float(i));
    if (i % 10 == 5) expected.push_back(-1.0f);
    if (i % 10 == 8) expected.push_back(float(i));
  }
  const auto last_z = [](const Shape& shape) {
    const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
    return mesh != nullptr ? mesh->positions.at(2).z : -1.0f;
  };
  for (const Shape& shape : scene.shapes) found.push_back(last_z(shape));
  EXPECT_EQ(found, expected);
  ASSERT_EQ(scene.objects.size(), 1u);
  for (const Shape& shape : scene.objects[0].shapes) of_group.push_back(last_z(shape));
  EXPECT_EQ(of_group, (std::vector<float>{3, 13, 23, 33, 43, 53}));
}

// The first by its place in the scene, however soon a file or the scene itself proves bad.
TEST_F(Mitsuba, TheFirstOfSeveralErrorsIsTold) {
  std::string points;
  for (int i = 0; i < 50000; ++i) points += "v 1 2 3\n";
  write("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("late.obj", points + "f 1 2 50001\n");
  write("bad.obj", "f 1 2 3\n");
  const std::string good = obj_shape("good.obj"), late = obj_shape("late.obj");
  const std::string bad = obj_shape("bad.obj");
  const std::string nowhere = "<shape type=\"sphere\"><ref id=\"nowhere\"/></shape>\n";
  const std::string of_late = "scene.xml:4: late.obj:50001: ";
  const std::pair<std::string, std::string> cases[] = {
      {good + good + late + good + bad + bad, of_late},
      {good + good + late + nowhere, of_late},
      {good + good + late + obj_shape("absent.obj"), of_late},
      {good + nowhere + bad + late, "scene.xml:3: there is no object"},
      {good + good + obj_shape("bad.obj", "<ref id=\"nowhere\"/>") + late,
       "scene.xml:4: there is no object"},
      {good + obj_shape("good.obj", "<float name=\"flip_tex_coords\" value=\"1\"/>") + bad,
       "scene.xml:3: "},
  };
  for (const auto& [text, message] : cases) expect_one_line_with(error_of(text), message);
}

TEST_F(Mitsuba, MeshFilesOfShapesThatAreLeftOutMayBeBad) {
  write("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const SceneDescription scene =
      read(obj_shape("good.obj") + obj_shape("absent.obj", "<bsdf type=\"null\"/>") +
           "<shape type=\"shapegroup\">" + obj_shape("absent.obj") + "</shape>");
  EXPECT_EQ(scene.shapes.size(), 1u);
}

TEST_F(Mitsuba, WhatMeshFilesDoNotUnderstandIsTold) {
  write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string known =
      "<boolean name=\"faceNormals\" value=\"true\"/>"
      "<boolean name=\"flip_tex_coords\" value=\"true\"/>"
      "<float name=\"maxSmoothAngle\" value=\"30\"/><boolean name=\"collapse\" value=\"true\"/>";
  EXPECT_TRUE(warnings_of_shapes(read(obj_shape("a.obj", known))).empty());
  const std::string unknown = "<integer name=\"shape_index\" value=\"0\"/>";
  const auto warnings = warnings_of_shapes(read(obj_shape("a.obj", known + unknown)));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("\"shape_index\""), std::string::npos);
}

TEST_F(Mitsuba, ObjFilesBringTheirOwnMaterials) {
  write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl glass\nKd 0 0 1\n");
  write("a.obj", "mtllib a.mtl\n" + roof + "usemtl red\nf 1 2 3\nusemtl glass\nf 1 2 4\n");
  const std::string file = "<string name=\"filename\" value=\"a.obj\"/>";
  const SceneDescription own = read_old("<shape type=\"obj\">" + file + "</shape>");
  ASSERT_EQ(own.shapes.size(), 2u);
  EXPECT_EQ(model_of<DiffuseMaterial>(own, 1).reflectance.value, glm::vec3(0, 0, 1));
  const SceneDescription given = read_old("<shape type=\"obj\">" + file +
                                          "<bsdf type=\"dielectric\" name=\"glass\"/></shape>");
  EXPECT_EQ(model_of<DiffuseMaterial>(given, 0).reflectance.value, glm::vec3(1, 0, 0));
  EXPECT_NO_THROW(model_of<DielectricMaterial>(given, 1));
  const SceneDescription one =
      read_old("<shape type=\"obj\">" + file + "<bsdf type=\"conductor\"/></shape>");
  ASSERT_EQ(one.shapes.size(), 1u);
  EXPECT_EQ(mesh_of(one).triangles.size(), 2u);
}

TEST_F(Mitsuba, GroupsAreInstanced) {
  const std::string emitter = "<emitter type=\"area\"/>";
  const SceneDescription scene = read(
      "<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"/><shape type=\"sphere\">" +
      emitter + "</shape></shape>" +
      "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\">"
      "<translate x=\"5\"/></transform></shape><shape type=\"instance\"><ref id=\"g\"/></shape>"
      "<shape type=\"merge\"><shape type=\"disk\"/></shape>");
  EXPECT_EQ(scene.shapes.size(), 1u);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].shapes.size(), 2u);
  EXPECT_FALSE(scene.objects[0].shapes[1].emission);
  EXPECT_TRUE(warns(scene, "lights inside groups"));
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].to_world[3], glm::vec4(5, 0, 0, 1));
}

// A .serialized file of two meshes.
std::string serialized_file(int version, bool doubles, std::uint32_t bad_index = 0) {
  const auto put = [](std::string& s, auto value) {
    s.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  std::string file;
  std::vector<std::uint64_t> offsets;
  for (int m = 0; m < 2; ++m) {
    offsets.push_back(file.size());
    std::string raw;
    put(raw, std::uint32_t(0x0001 | 0x0002 | 0x0008 | (m == 1 ? 0x0010 : 0) |
                           (doubles ? 0x2000 : 0x1000)));
    if (version == 4) raw += std::string("name") + '\0';
    put(raw, std::uint64_t(3));
    put(raw, std::uint64_t(1));
    const auto put_float = [&](double v) { doubles ? put(raw, v) : put(raw, float(v)); };
    for (const double v : {0, 0, 0, 1, 0, 0, 0, m + 1, 0}) put_float(v);
    for (int i = 0; i < 3; ++i) {
      for (const double v : {0, 0, 2}) put_float(v);
    }
    for (const double v : {0.0, 0.0, 1.0, 0.25, 0.0, 1.0}) put_float(v);
    for (int i = 0; i < 9; ++i) put_float(0.5);
    for (const std::uint32_t i : {0u, 1u, 2u + bad_index}) put(raw, i);
    std::vector<Bytef> packed(compressBound(raw.size()));
    uLongf size = packed.size();
    compress(packed.data(), &size, reinterpret_cast<const Bytef*>(raw.data()), raw.size());
    put(file, std::uint16_t(0x041C));
    put(file, std::uint16_t(version));
    file.append(reinterpret_cast<const char*>(packed.data()), size);
  }
  for (const std::uint64_t offset : offsets) {
    version == 4 ? put(file, offset) : put(file, std::uint32_t(offset));
  }
  put(file, std::uint32_t(2));
  return file;
}

TEST_F(Mitsuba, SerializedMeshes) {
  for (const int version : {3, 4}) {
    for (const bool doubles : {false, true}) {
      const std::string bytes = serialized_file(version, doubles);
      const std::string path = write("m.serialized", bytes);
      const SerializedMesh first = read_serialized_mesh(path, 0);
      const SerializedMesh second = read_serialized_mesh(path, 1);
      EXPECT_FALSE(first.face_normals);
      EXPECT_TRUE(second.face_normals);
      ASSERT_EQ(second.mesh.positions.size(), 3u);
      EXPECT_EQ(second.mesh.positions[2], glm::vec3(0, 2, 0));
      EXPECT_EQ(second.mesh.normals[1], glm::vec3(0, 0, 1));
      EXPECT_EQ(second.mesh.uvs[1], glm::vec2(1, 0.25f));
      ASSERT_EQ(second.mesh.triangles.size(), 1u);
      EXPECT_EQ(second.mesh.triangles[0], glm::uvec3(0, 1, 2));
      EXPECT_THROW(read_serialized_mesh(path, 2), Error);
      EXPECT_THROW(read_serialized_mesh(path, -1), Error);
      for (size_t cut = 0; cut < bytes.size(); ++cut) {
        EXPECT_THROW(read_serialized_mesh(write("m.serialized", bytes.substr(0, cut)), 1), Error);
      }
    }
  }
  write("m.serialized", serialized_file(4, false));
  const SceneDescription scene = read(
      "<shape type=\"serialized\"><string name=\"filename\" value=\"m.serialized\"/>"
      "<integer name=\"shape_index\" value=\"1\"/></shape>"
      "<shape type=\"serialized\"><string name=\"filename\" value=\"m.serialized\"/></shape>");
  EXPECT_EQ(mesh_of(scene, 0).positions[2], glm::vec3(0, 2, 0));
  EXPECT_TRUE(mesh_of(scene, 0).normals.empty());
  EXPECT_FALSE(mesh_of(scene, 1).normals.empty());
}

TEST_F(Mitsuba, DamagedSerializedMeshesAreReadOrRefused) {
  expect_one_line_with(
      message_of(
          [&] { read_serialized_mesh(write("m.serialized", serialized_file(4, false, 1)), 0); }),
      "m.serialized: triangle 0 refers to vertex 3, but there are 3");
  const std::string bytes = serialized_file(4, false);
  std::mt19937 random(2);
  for (int trial = 0; trial < 500; ++trial) {
    std::string damaged = bytes;
    for (int flips = 1 + trial % 4; flips > 0; --flips) {
      damaged[random() % damaged.size()] = char(random() % 256);
    }
    const std::string path = write("m.serialized", damaged);
    const std::string message = message_of([&] { read_serialized_mesh(path, trial % 2); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace lockstep::test_mitsuba_shapes
