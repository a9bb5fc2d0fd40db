// OBJ and MTL files: every form of a corner, groups by material, scenes, and what broken files
// give.
#include "core/obj.h"

#include "core/default_view.h"
#include "tests/t_description.h"
#include "tests/t_files.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <variant>

namespace lockstep::test_obj {
namespace {

class Obj : public TestWithFiles {
 protected:
  TriangleMesh read(const std::string& text) const { return read_obj(write("mesh.obj", text)); }
};

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(Obj, PolygonsBecomeFansOfSharedVertices) {
  const TriangleMesh mesh = read(square + "v 0 0 1\nf 1 2 3 4\nf 1 2 5\n");
  ASSERT_EQ(mesh.positions.size(), 5u);
  ASSERT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.triangles[0], glm::uvec3(0, 1, 2));
  EXPECT_EQ(mesh.triangles[1], glm::uvec3(0, 2, 3));
  EXPECT_EQ(mesh.triangles[2], glm::uvec3(0, 1, 4));
  EXPECT_EQ(mesh.positions[4], glm::vec3(0, 0, 1));
  EXPECT_TRUE(mesh.normals.empty()) << "smoothing is not made up";
  EXPECT_TRUE(mesh.uvs.empty());
}

TEST_F(Obj, CornersInAllForms) {
  const std::string data = square + "vt 0.25 0.125\nvt 1 1 0\nvt 0.5\nvn 0 0 2\nvn 0 3 4\n";
  for (const std::string face : {"f 1/1/1 2/2/1 3/3/2", "f -4/-3/-2 -3/-2/-2 -2/-1/-1"}) {
    const TriangleMesh mesh = read(data + face);
    ASSERT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0));
    EXPECT_EQ(mesh.uvs[0], glm::vec2(0.25f, 0.875f)) << "v goes down";
    EXPECT_EQ(mesh.uvs[2], glm::vec2(0.5f, 1.0f));
    EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1)) << "of unit length";
    EXPECT_NEAR(glm::distance(mesh.normals[2], glm::vec3(0, 0.6f, 0.8f)), 0.0f, 1e-6f);
  }
  EXPECT_TRUE(read(data + "f 1//1 2//1 3//2").uvs.empty());
  EXPECT_TRUE(read(data + "f 1/1 2/2 3/3").normals.empty());
  EXPECT_EQ(read(data + "f 1/1/ 2/2/ 3/3/").uvs.size(), 3u);
}

TEST_F(Obj, VerticesAreJoinedOnlyWhereAllIndicesAgree) {
  const std::string data = square + "vt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\n";
  EXPECT_EQ(read(data + "f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/1/1\n").positions.size(), 4u);
  EXPECT_EQ(read(data + "f 1/1/1 2/1/1 3/1/1\nf 1/2/1 3/1/1 4/1/1\n").positions.size(), 5u);
  EXPECT_EQ(read(data + "f 1/1/1 2/1/1 3/1/1\nf 1/1/2 3/1/2 4/1/1\n").positions.size(), 6u);
}

TEST_F(Obj, CornersWithoutNormalsGetTheirFaces) {
  const TriangleMesh mesh = read(square + "vn 1 0 0\nvn 0 0 0\nf 1//1 2//1 3//1\nf 1 3 4//2\n");
  ASSERT_EQ(mesh.normals.size(), 6u);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(mesh.normals[i], glm::vec3(1, 0, 0));
  for (size_t i = 3; i < 6; ++i) EXPECT_EQ(mesh.normals[i], glm::vec3(0, 0, 1));
}

TEST_F(Obj, FacesMayComeBeforeTheirVertices) {
  EXPECT_EQ(read("f 1 2 3\n" + square).triangles.size(), 1u);
}

TEST_F(Obj, LineEndsContinuationsAndWhatIsSkipped) {
  const TriangleMesh mesh = read(
      "\xEF\xBB\xBF# made by hand\r\n\r\no thing\r\ng a b\r\ns 1\r\nv 0 0 0 1.0\r\n"
      "  v +1 0 0 0.5 0.5 0.5\r\n\tv 0 \\\r\n 1e0 0\r\nl 1 2\r\np 1\r\n"
      "f 1 2 \\\n 3 # one\n");
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh.positions[2], glm::vec3(0, 1, 0));
}

TEST_F(Obj, PartsByMaterial) {
  const ObjFile file = read_obj_parts(write(
      "mesh.obj",
      "mtllib some library.mtl\n" + square +
          "f 1 2 3\nusemtl red glass\nf 1 3 4\nusemtl blue\nf 1 2 4\nusemtl red glass\nf 2 3 4\n"
          "usemtl unused\ncurv 0 1 1 2\n"));
  ASSERT_EQ(file.parts.size(), 3u);
  EXPECT_EQ(file.parts[0].material, "");
  EXPECT_EQ(file.parts[1].material, "red glass");
  EXPECT_EQ(file.parts[1].mesh.triangles.size(), 2u);
  EXPECT_EQ(file.parts[1].mesh.positions.size(), 4u);
  EXPECT_EQ(file.parts[2].material, "blue");
  EXPECT_EQ(file.libraries, std::vector<std::string>{"some library.mtl"});
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_NE(file.warnings[0].find("mesh.obj:14: curved surfaces"), std::string::npos);
}

TEST_F(Obj, BrokenFilesSayWhereAndWhat) {
  struct Case {
    std::string text, message;
  };
  const Case cases[] = {
      {"v 0 0\n", "mesh.obj:1: the line has too few numbers"},
      {"v 0 0 zero\n", "mesh.obj:1: expected a number, found \"zero\""},
      {"\n\nv 0 0 nan\n", "mesh.obj:3: a number is not finite"},
      {"v 0 0 1e99\n", "mesh.obj:1: a number is not finite"},
      {square + "f 1 2 5\n", "mesh.obj:5: a face has the index 5, but there are 4 vertices"},
      {square + "f 1 2 3\nf 1/1 2/1 3/1\n", ":6: a face has the index 1, but there are 0 texture"},
      {square + "f 1//7 2//1 3//1\n", ":5: a face has the index 7, but there are 0 normals"},
      {square + "f -1 -2 -5\n", "mesh.obj:5: an index reaches back beyond the first vertex"},
      {square + "f 0 1 2\n", "mesh.obj:5: expected the index of a vertex, found \"0\""},
      {square + "f 1 2 x\n", "mesh.obj:5: expected the index of a vertex, found \"x\""},
      {square + "f 1 2 99999999999\n", "mesh.obj:5: expected the index of a vertex"},
      {square + "f /1 2 3\n", "mesh.obj:5: a corner of a face has no vertex"},
      {square + "f 1/1/1/1 2 3\n", "mesh.obj:5: a corner of a face has more than three indices"},
      {square + "f 1 2\n", "mesh.obj:5: a face has fewer than three vertices"},
      {"v 1 \\\n 2\n", "mesh.obj:1: the line has too few numbers"},
  };
  for (const Case& c : cases) expect_one_line_with(message_of([&] { read(c.text); }), c.message);
  EXPECT_THROW(read_obj(path("absent.obj")), Error);
  EXPECT_THROW(read_obj(directory_.string()), Error);
  EXPECT_TRUE(read("").triangles.empty());
}

// --- Scenes

// Where `camera` sees a point, in units of half the image's shorter side from its middle.
glm::vec2 seen_at(const CameraDescription& camera, glm::vec3 p) {
  const glm::vec3 local(glm::inverse(camera.camera_to_world) * glm::vec4(p, 1.0f));
  EXPECT_GT(local.z, 0.0f) << "in front of the camera";
  return glm::vec2(local) / local.z / std::tan(0.5f * glm::radians(camera.fov_degrees));
}

TEST_F(Obj, SceneHasADefaultViewThatFramesIt) {
  const SceneDescription scene = read_obj_scene(write(
      "far.obj", "v 100 200 300\nv 110 200 300\nv 110 205 300\nv 100 200 320\nf 1 2 3\nf 1 2 4"));
  EXPECT_EQ(scene.name, "far");
  ASSERT_EQ(scene.shapes.size(), 1u);
  float widest = 0.0f;
  for (const glm::vec3 p : mesh_of(scene).positions) {
    const glm::vec2 at = seen_at(scene.camera, p);
    EXPECT_LE(std::max(std::abs(at.x), std::abs(at.y)), 1.0f);
    widest = std::max(widest, std::max(std::abs(at.x), std::abs(at.y)));
  }
  EXPECT_GT(widest, 0.4f) << "fills the image";
  EXPECT_GT(scene.camera.camera_to_world[3].y, 205.0f) << "from above";
  ASSERT_TRUE(scene.environment);
  EXPECT_EQ(scene.environment->radiance, glm::vec3(1.0f));
  EXPECT_TRUE(warns(scene, "no camera"));
  EXPECT_TRUE(warns(scene, "no light"));
}

TEST(DefaultView, CountsInstancesAndKeepsLights) {
  SceneDescription scene;
  scene.objects.push_back({{Shape{Sphere{glm::vec3(0.0f), 1.0f}, 0, {}}}});
  scene.instances.push_back({0, glm::mat4(1.0f)});
  scene.instances.back().to_world[3] = glm::vec4(50, 0, 0, 1);
  scene.lights.emplace_back(PointLight{});
  add_default_view(scene);
  EXPECT_NEAR(glm::length(seen_at(scene.camera, glm::vec3(50, 0, 0))), 0.0f, 1e-4f);
  EXPECT_FALSE(scene.environment);
  EXPECT_EQ(scene.warnings.size(), 1u);

  SceneDescription empty;
  add_default_view(empty);
  EXPECT_TRUE(std::isfinite(empty.camera.camera_to_world[3].x));
}

TEST_F(Obj, MaterialsOfMtlFiles) {
  write("a.mtl",
        "# comment\nKd 1 1 1\nnewmtl matte\nKd 0.1 0.2 0.3\nillum 1\n"
        "newmtl shiny\nKd 0.5 0.5 0.5\nKs 0.25 0.25 0.25\nNs 198\nNi 1.4\n"
        "newmtl glass\nillum 7\nNi 1.33\n"
        "newmtl lamp\nKd 0 0 0\nKe 10 20 30\nd 0.5\n"
        "newmtl metal\nKd 0.9 0.8 0.7\nPr 0.5\nPm 1\n"
        "newmtl mirror\nillum 3\nKd 0 0 0\nKs 0.9 0.9 0.9\nNs 1000\n");
  const SceneDescription scene = read_obj_scene(
      write("mesh.obj", "mtllib a.mtl\nmtllib gone.mtl\n" + square +
                            "usemtl matte\nf 1 2 3\nusemtl shiny\nf 1 2 3\nusemtl glass\nf 1 2 3\n"
                            "usemtl lamp\nf 1 2 3\nusemtl metal\nf 1 2 3\nusemtl mirror\nf 1 2 3\n"
                            "usemtl unheard of\nf 1 2 3\n"));
  ASSERT_EQ(scene.shapes.size(), 7u);
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 0).reflectance.value, glm::vec3(0.1f, 0.2f, 0.3f));
  const auto& shiny = model_of<CoatedMaterial>(scene, 1);
  EXPECT_FLOAT_EQ(shiny.alpha, 0.1f);
  EXPECT_FLOAT_EQ(shiny.eta, 1.4f);
  EXPECT_EQ(shiny.specular.value, glm::vec3(0.25f));
  EXPECT_FALSE(shiny.layered);
  EXPECT_FLOAT_EQ(model_of<DielectricMaterial>(scene, 2).eta, 1.33f);
  EXPECT_EQ(scene.shapes[3].emission.value().radiance.value, glm::vec3(10, 20, 30));
  EXPECT_EQ(material_of(scene, 3).opacity, FloatInput(0.5f));
  EXPECT_FLOAT_EQ(model_of<PrincipledMaterial>(scene, 4).alpha.value, 0.25f);
  EXPECT_EQ(model_of<ConductorMaterial>(scene, 5).alpha, glm::vec2(0.0f));
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 6).reflectance.value, glm::vec3(0.5f));
  EXPECT_TRUE(warns(scene, "\"gone.mtl\" is missing"));
  EXPECT_FALSE(scene.environment) << "the lamp is a light";
}

TEST_F(Obj, TexturesOfMtlFiles) {
  write("a.mtl",
        "newmtl a\nmap_Kd -s 2 3 -o 0.5 0.25 -clamp on textures\\my wood.png\nKd 0.5 0.5 0.5\n"
        "map_d alpha.png\nmap_Bump -bm 0.3 bump.png\nnorm normal.png\n");
  const SceneDescription scene =
      read_obj_scene(write("mesh.obj", "mtllib a.mtl\n" + square + "usemtl a\nf 1 2 3\n"));
  const Material& m = scene.materials.at(0);
  const ColorInput diffuse = std::get<DiffuseMaterial>(m.model).reflectance;
  EXPECT_EQ(diffuse.value, glm::vec3(1.0f)) << "a map replaces the colour";
  const ImageTexture& wood = image_of(scene, diffuse.texture);
  EXPECT_EQ(wood.file, path("textures/my wood.png"));
  EXPECT_EQ(wood.wrap_u, TextureWrap::Clamp);
  EXPECT_NE(wood.where.find("a.mtl:2"), std::string::npos);
  // (u, v) = (0.2, 0.4) with v upwards goes to (0.9, 1.45); here v goes down.
  const glm::vec2 uv(0.2f, 0.6f);
  EXPECT_NEAR(glm::dot(wood.uv.u_row, uv) + wood.uv.offset.x, 0.9f, 1e-6f);
  EXPECT_NEAR(glm::dot(wood.uv.v_row, uv) + wood.uv.offset.y, 1.0f - 1.45f, 1e-6f);
  EXPECT_GE(m.opacity.texture, 0);
  ASSERT_TRUE(m.bump);
  EXPECT_FLOAT_EQ(m.bump->value, 0.3f);
  EXPECT_EQ(image_of(scene, m.normal_map).encoding, TextureEncoding::Linear);
}

TEST_F(Obj, BrokenMtlFilesSayWhereAndWhat) {
  for (const char* line : {"Kd red", "Ns", "map_Kd", "Ni nan", "d x"}) {
    write("a.mtl", "newmtl a\n" + std::string(line) + "\n");
    const std::string obj = write("mesh.obj", "mtllib a.mtl\n" + square + "usemtl a\nf 1 2 3\n");
    const std::string message = message_of([&] { read_obj_scene(obj); });
    EXPECT_NE(message.find("a.mtl:2: "), std::string::npos) << line << ": " << message;
  }
  expect_one_line_with(message_of([&] { read_obj_scene(write("mesh.obj", square)); }),
                       "has no faces");
}

TEST_F(Obj, DamagedFilesAreReadOrRefused) {
  const std::string text = "mtllib a.mtl\n" + square +
                           "vt 0 0\nvn 0 0 1\nusemtl a\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -1 -2 -3\n";
  const std::string mtl = "newmtl a\nKd 1 0 0\nmap_Kd -o 1 1 a.png\nNs 10\nillum 2\n";
  std::mt19937 random(1);
  for (int trial = 0; trial < 600; ++trial) {
    std::string obj = text, library = mtl;
    for (std::string* damaged : {&obj, &library}) {
      for (int flips = trial % 4; flips > 0; --flips) {
        (*damaged)[random() % damaged->size()] = char(random() % 256);
      }
      if (trial % 3 == 0) damaged->resize(random() % damaged->size());
    }
    write("a.mtl", library);
    const std::string path = write("mesh.obj", obj);
    const std::string message = message_of([&] { read_obj_scene(path); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace lockstep::test_obj
