// The Mitsuba reader: every supported construct in the spellings of both generations, whole scenes
// against their pbrt versions, and broken files.
#include "core/error.h"
#include "core/mitsuba/reader.h"
#include "core/read_scene.h"
#include "core/serialized_mesh.h"

#include <zlib.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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

class Mitsuba : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / ("lockstep_mitsuba_" + std::to_string(getpid()) + test->name());
    fs::create_directories(folder_ / "sub");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }
  // What <scene> holds, of Mitsuba 3 and of 0.5.
  SceneDescription read(const std::string& text, const std::string& version = "3.0.0") const {
    return read_mitsuba(
        write("scene.xml", "<scene version=\"" + version + "\">\n" + text + "\n</scene>\n"));
  }
  SceneDescription read_old(const std::string& text) const { return read(text, "0.5.0"); }

  // The message, with the folder's name taken off.
  template <class Read>
  std::string message_of(const Read& read_file) const {
    std::string message = "no error";
    try {
      read_file();
    } catch (const Error& error) {
      message = error.what();
    }
    const std::string prefix = folder_.string() + "/";
    for (size_t at; (at = message.find(prefix)) != std::string::npos;) {
      message.erase(at, prefix.size());
    }
    return message;
  }
  std::string error_of(const std::string& text) const {
    return message_of([&] { read(text); });
  }

  fs::path folder_;
};

bool warns(const SceneDescription& scene, const std::string& text) {
  return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                     [&](const std::string& w) { return w.find(text) != w.npos; });
}

const TriangleMesh& mesh_of(const SceneDescription& scene, size_t shape = 0) {
  return std::get<TriangleMesh>(scene.shapes.at(shape).geometry);
}

const Sphere& sphere_of(const SceneDescription& scene, size_t shape = 0) {
  return std::get<Sphere>(scene.shapes.at(shape).geometry);
}

const Material& material_of(const SceneDescription& scene, size_t shape = 0) {
  return scene.materials.at(size_t(scene.shapes.at(shape).material));
}

template <class T>
const T& model_of(const SceneDescription& scene, size_t shape = 0) {
  return std::get<T>(material_of(scene, shape).model);
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

// Where a point falls on the film, in pixels from its top left corner.
glm::vec2 pixel_of(const SceneDescription& scene, glm::vec3 p) {
  const CameraDescription& c = scene.camera;
  const glm::vec3 local(glm::inverse(c.camera_to_world) * glm::vec4(p, 1.0f));
  const float shorter = float(std::min(scene.film.width, scene.film.height));
  glm::vec2 at;  // in units of the shorter side, right and up, from the camera's axis
  if (c.projection == CameraDescription::Projection::Perspective) {
    at = glm::vec2(local) / local.z / (2.0f * std::tan(0.5f * glm::radians(c.fov_degrees)));
  } else {
    at = glm::vec2(local) / c.extent;
  }
  at -= c.shift;
  return {0.5f * float(scene.film.width) + at.x * shorter,
          0.5f * float(scene.film.height) - at.y * shorter};
}

std::string with_bsdf(const std::string& bsdf) {
  return "<shape type=\"rectangle\">" + bsdf + "</shape>";
}

const std::string default_film =
    "<film type=\"hdrfilm\"><integer name=\"width\" value=\"200\"/>"
    "<integer name=\"height\" value=\"100\"/></film>";

// --- Documents

TEST_F(Mitsuba, EmptySceneHasDefaults) {
  const SceneDescription scene = read("");
  EXPECT_EQ(scene.name, "scene");
  EXPECT_EQ(scene.defaults.depth, 64);
  EXPECT_TRUE(scene.environment) << "the default light";
  EXPECT_TRUE(warns(scene, "no camera"));

  const SceneDescription seen = read("<sensor type=\"perspective\"/>");
  EXPECT_EQ(seen.film.width, 768);
  EXPECT_EQ(seen.film.height, 576);
  EXPECT_EQ(seen.film.filter.kind, PixelFilter::Kind::Gaussian);
  EXPECT_FLOAT_EQ(seen.film.filter.radius.x, 2.0f);
  EXPECT_EQ(seen.defaults.spp, 4);
  EXPECT_FALSE(warns(seen, "no camera"));
}

TEST_F(Mitsuba, ParametersAreSubstitutedAnywhere) {
  const SceneDescription scene = read(
      "<default name=\"w\" value=\"20\"/><default name=\"w\" value=\"30\"/>"
      "<default name=\"wide\" value=\"$w0\"/><default name=\"kind\" value=\"box\"/>"
      "<sensor type=\"perspective\"><film type=\"hdrfilm\">"
      "<integer name=\"width\" value=\"$w\"/><integer name=\"height\" value=\"$wide\"/>"
      "<rfilter type=\"$kind\"/></film></sensor>");
  EXPECT_EQ(scene.film.width, 20) << "the first value counts";
  EXPECT_EQ(scene.film.height, 200);
  EXPECT_EQ(scene.film.filter.kind, PixelFilter::Kind::Box);
  EXPECT_NE(error_of("\n<shape type=\"$x\"/>").find("scene.xml:3: the parameter $x has no value"),
            std::string::npos);
}

TEST_F(Mitsuba, FilesAreIncluded) {
  write("sub/part.xml",
        "<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"m\">"
        "<rgb name=\"reflectance\" value=\"$r\"/></bsdf>\n"
        "<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/><ref id=\"m\"/></shape>"
        "</scene>");
  write("sub/single.xml", "<shape type=\"sphere\"><ref id=\"m\"/></shape>");
  write("sub/a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const SceneDescription scene = read(
      "<default name=\"r\" value=\"0.25\"/><include filename=\"sub/part.xml\"/>"
      "<include filename=\"sub/single.xml\"/>");
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(scene.shapes[0].material, scene.shapes[1].material);
  EXPECT_EQ(model_of<DiffuseMaterial>(scene).reflectance.value, glm::vec3(0.25f));

  write("sub/a.obj", "v 0 0\n");
  EXPECT_NE(error_of("<default name=\"r\" value=\"0.25\"/><include filename=\"sub/part.xml\"/>")
                .find("sub/part.xml:2: sub/a.obj:1: "),
            std::string::npos);
}

TEST_F(Mitsuba, IncludesThatNeverEndAreRefused) {
  write("loop.xml", "<scene version=\"3.0.0\">\n<include filename=\"loop.xml\"/></scene>");
  EXPECT_NE(error_of("<include filename=\"loop.xml\"/>").find("loop.xml:2: the file"),
            std::string::npos);
  // Ten files that each include the next one ten times.
  const char* names[] = {"a.xml", "b.xml", "c.xml", "d.xml", "e.xml", "f.xml", "g.xml"};
  for (size_t i = 0; i + 1 < std::size(names); ++i) {
    std::string text = "<scene version=\"3.0.0\">";
    for (int k = 0; k < 10; ++k)
      text.append("<include filename=\"").append(names[i + 1]).append("\"/>");
    write(names[i], text + "</scene>");
  }
  write("g.xml", "<scene version=\"3.0.0\"/>");
  EXPECT_NE(error_of("<include filename=\"a.xml\"/>").find("too many files"), std::string::npos);
}

TEST_F(Mitsuba, BrokenXmlIsRefused) {
  const auto error_in = [&](const std::string& text) {
    return message_of([&] { read_mitsuba(write("x.xml", text)); });
  };
  EXPECT_EQ(error_in("<scene version=\"3.0.0\">\n<shape>\n</scene>").find("x.xml:3: is not proper"),
            0u);
  EXPECT_EQ(error_in("<bsdf type=\"diffuse\"/>").find("x.xml:1: expected <scene>"), 0u);
  EXPECT_EQ(error_in("").find("x.xml:1: "), 0u);
  EXPECT_THROW(read_mitsuba((folder_ / "absent.xml").string()), Error);
  EXPECT_THROW(read_mitsuba(folder_.string()), Error);

  // Entities are not expanded.
  std::string bomb = "<!DOCTYPE scene [<!ENTITY a \"xxxxxxxxxx\">";
  for (char c = 'b'; c < 'n'; ++c) {
    bomb += std::string("<!ENTITY ") + c + " \"";
    for (int i = 0; i < 10; ++i) bomb += std::string("&") + char(c - 1) + ";";
    bomb += "\">";
  }
  bomb += "]><scene version=\"3.0.0\"><shape type=\"&m;\"/></scene>";
  EXPECT_TRUE(warns(read_mitsuba(write("x.xml", bomb)), "type=\"&m;\""));

  // Nor do doubled parameters fill the memory.
  std::string doubled = "<default name=\"p0\" value=\"0123456789abcdef\"/>";
  for (int i = 0; i < 60; ++i) {
    const std::string p = "$p" + std::to_string(i);
    doubled += "<default name=\"p" + std::to_string(i + 1) + "\" value=\"" + p + p + "\"/>";
  }
  EXPECT_NE(error_of(doubled).find("a value is too long"), std::string::npos);
}

TEST_F(Mitsuba, DeepNestingIsRefused) {
  for (const int levels : {100, 10000, 300000}) {
    std::string text;
    for (int i = 0; i < levels; ++i) text += "<bsdf type=\"twosided\">";
    for (int i = 0; i < levels; ++i) text += "</bsdf>";
    EXPECT_NE(error_of(text).find("nested more than"), std::string::npos);
  }
  // The same by references, round in a circle or not.
  std::string chain = "<bsdf type=\"twosided\" id=\"m0\"><ref id=\"m4999\"/></bsdf>";
  for (int i = 1; i < 5000; ++i) {
    chain += "<bsdf type=\"blendbsdf\" id=\"m" + std::to_string(i) + "\">";
    for (int k = 0; k < 2; ++k) chain += "<ref id=\"m" + std::to_string(i - 1) + "\"/>";
    chain += "</bsdf>";
  }
  EXPECT_NE(error_of(chain + with_bsdf("<ref id=\"m4999\"/>")).find("nested too deeply"),
            std::string::npos);
  EXPECT_NE(
      error_of("<texture type=\"scale\" id=\"t\"><ref id=\"t\"/></texture>" +
               with_bsdf("<bsdf type=\"diffuse\"><ref name=\"reflectance\" id=\"t\"/></bsdf>"))
          .find("nested too deeply"),
      std::string::npos);
  EXPECT_NE(error_of("<shape type=\"sphere\"><ref id=\"nobody\"/></shape>")
                .find("scene.xml:2: there is no object with the id \"nobody\""),
            std::string::npos);
}

// --- Transforms

TEST_F(Mitsuba, LaterTransformsActOnEarlierOnes) {
  const auto moved = [&](const std::string& operations) {
    const SceneDescription scene =
        read("<shape type=\"sphere\"><transform name=\"to_world\">" + operations +
             "</transform><point name=\"center\" x=\"1\" y=\"2\" z=\"3\"/></shape>");
    return sphere_of(scene).center;
  };
  expect_near(moved("<translate x=\"1\"/><scale value=\"2\"/>"), {4, 4, 6});
  expect_near(moved("<scale value=\"2\"/><translate value=\"1, 0 0\"/>"), {3, 4, 6});
  expect_near(moved("<rotate z=\"1\" angle=\"90\"/>"), {-2, 1, 3});
  expect_near(moved("<rotate value=\"0,2,0\" angle=\"90\"/>"), {3, 2, -1});
  expect_near(moved("<matrix value=\"0 -1 0 5  1 0 0 6  0 0 1 7  0 0 0 1\"/>"), {3, 7, 10});
  expect_near(moved("<matrix value=\"0 -1 0  1 0 0  0 0 1\"/>"), {-2, 1, 3});
  // From (0, 0, 10) to the origin: x, left of the view, is the world's -x; z goes down.
  expect_near(moved("<lookat origin=\"0,0,10\" target=\"0,0,0\" up=\"0,1,0\"/>"), {-1, 2, 7});
  expect_near(moved("<lookAt origin=\"0,0,10\" target=\"0,0,0\" up=\"0,1,0\"/>"), {-1, 2, 7});
}

TEST_F(Mitsuba, BrokenTransformsSayWhereAndWhat) {
  const auto error_in = [&](const std::string& operation) {
    return error_of("<shape type=\"cube\"><transform name=\"to_world\">\n" + operation +
                    "</transform></shape>");
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
  };
  EXPECT_TRUE(has(error_in("<matrix value=\"1 2 3\"/>"), "scene.xml:3: <matrix> needs 9 or 16"));
  EXPECT_TRUE(has(error_in("<scale value=\"0\"/>"), "cannot be inverted"));
  EXPECT_TRUE(has(error_in("<scale value=\"nan\"/>"), "beyond the range"));
  EXPECT_TRUE(has(error_in("<scale value=\"1e300\"/>"), "beyond the range"));
  EXPECT_TRUE(has(error_in("<scale x=\"two\"/>"), "expected a number, found \"two\""));
  EXPECT_TRUE(has(error_in("<rotate angle=\"3\"/>"), "needs an axis"));
  EXPECT_TRUE(has(error_in("<rotate x=\"1\"/>"), "needs a number as its angle"));
  EXPECT_TRUE(has(error_in("<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1\"/>"), "projective"));
  EXPECT_TRUE(has(error_in("<lookat origin=\"0,0,0\" target=\"0,0,0\"/>"), "two distinct points"));
  EXPECT_TRUE(has(error_in("<warp x=\"1\"/>"), "is no transform"));
}

// --- Shapes

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

const std::string roof = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 -1\nv 1 0 -1\n";

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
  EXPECT_NE(error_of("<shape type=\"ply\"><string name=\"filename\" value=\"b.ply\"/></shape>")
                .find("scene.xml:2: b.ply: "),
            std::string::npos);
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
  EXPECT_NE(message_of([&] {
              read_serialized_mesh(write("m.serialized", serialized_file(4, false, 1)), 0);
            }).find("m.serialized: triangle 0 refers to vertex 3, but there are 3"),
            std::string::npos);
  const std::string bytes = serialized_file(4, false);
  std::mt19937 random(2);
  for (int trial = 0; trial < 500; ++trial) {
    std::string damaged = bytes;
    for (int flips = 1 + trial % 4; flips > 0; --flips) {
      damaged[random() % damaged.size()] = char(random() % 256);
    }
    const std::string path = write("m.serialized", damaged);
    EXPECT_NE(message_of([&] { read_serialized_mesh(path, trial % 2); }), "");
  }
}

// --- Materials

TEST_F(Mitsuba, ModelsAndTheirParametersInBothSpellings) {
  for (const bool old : {false, true}) {
    const auto name = [&](const char* a, const char* b) { return std::string(old ? a : b); };
    const std::string text = with_bsdf(
        "<bsdf type=\"roughdielectric\"><string name=\"" + name("intIOR", "int_ior") +
        "\" value=\"Diamond\"/><float name=\"" + name("extIOR", "ext_ior") +
        "\" value=\"1\"/><float name=\"alpha\" value=\"0.3\"/><string name=\"distribution\" "
        "value=\"ggx\"/><rgb name=\"" +
        name("specularTransmittance", "specular_transmittance") + "\" value=\"#ff8000\"/></bsdf>");
    const SceneDescription scene = old ? read_old(text) : read(text);
    const auto& glass = model_of<DielectricMaterial>(scene);
    EXPECT_FLOAT_EQ(glass.eta, 2.419f);
    EXPECT_EQ(glass.alpha, glm::vec2(0.3f));
    EXPECT_FALSE(glass.thin);
    expect_near(glass.transmittance.value, {1.0f, 0.2158605f, 0.0f});
    EXPECT_TRUE(material_of(scene).two_sided) << "transparent";
    EXPECT_FALSE(warns(scene, "microfacets"));
  }
}

TEST_F(Mitsuba, DielectricDefaults) {
  EXPECT_FLOAT_EQ(model_of<DielectricMaterial>(read(with_bsdf("<bsdf type=\"dielectric\"/>"))).eta,
                  1.5046f / 1.000277f);
  EXPECT_TRUE(
      model_of<DielectricMaterial>(read(with_bsdf("<bsdf type=\"thindielectric\"/>"))).thin);
  EXPECT_NE(error_of(with_bsdf("<bsdf type=\"dielectric\"><string name=\"int_ior\" "
                               "value=\"butter\"/></bsdf>"))
                .find("the index of refraction of \"butter\" is not known"),
            std::string::npos);
  EXPECT_NE(error_of(with_bsdf("<bsdf type=\"dielectric\"><float name=\"int_ior\" "
                               "value=\"0\"/></bsdf>"))
                .find("above 0"),
            std::string::npos);
}

TEST_F(Mitsuba, DiffuseModels) {
  const SceneDescription scene = read(
      with_bsdf("<bsdf type=\"diffuse\"><srgb name=\"reflectance\" value=\"0.5, 0.5 1\"/></bsdf>") +
      with_bsdf("<bsdf type=\"roughdiffuse\"><float name=\"alpha\" value=\"0.3\"/></bsdf>") +
      with_bsdf("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"2\"/></bsdf>") +
      with_bsdf("<bsdf type=\"difftrans\"/>") + with_bsdf(""));
  expect_near(model_of<DiffuseMaterial>(scene, 0).reflectance.value, {0.2140411f, 0.2140411f, 1});
  EXPECT_NEAR(model_of<DiffuseMaterial>(scene, 1).sigma.value, 12.1542f, 1e-3f);
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 2).reflectance.value, glm::vec3(1.0f));
  EXPECT_TRUE(warns(scene, "\"reflectance\" is clamped"));
  EXPECT_EQ(model_of<DiffuseTransmissionMaterial>(scene, 3).transmittance.value, glm::vec3(0.5f));
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 4).reflectance.value, glm::vec3(0.5f));
  EXPECT_FALSE(material_of(scene, 0).two_sided) << "black from behind";
  EXPECT_FALSE(material_of(scene, 4).two_sided);
}

TEST_F(Mitsuba, SpectraInFiles) {
  write("eta.spd", "# nm index\n300 1.5\n\n900 1.5 # the same\n");
  const SceneDescription scene =
      read_old(with_bsdf("<bsdf type=\"conductor\"><spectrum name=\"eta\" filename=\"eta.spd\"/>"
                         "<float name=\"extEta\" value=\"1\"/></bsdf>"));
  expect_near(model_of<ConductorMaterial>(scene).eta.value, glm::vec3(1.5f));
  const std::string missing =
      with_bsdf("<bsdf type=\"conductor\"><spectrum name=\"eta\" filename=\"gone.spd\"/></bsdf>");
  EXPECT_NE(error_of(missing).find("scene.xml:2: gone.spd: cannot be opened"), std::string::npos);
}

TEST_F(Mitsuba, ConductorsByVersion) {
  const std::string plain = with_bsdf("<bsdf type=\"conductor\"/>");
  expect_near(model_of<ConductorMaterial>(read(plain)).eta.value, {0, 0, 0});
  expect_near(model_of<ConductorMaterial>(read(plain)).k.value, {1, 1, 1});
  const SceneDescription old = read_old(plain);
  expect_near(model_of<ConductorMaterial>(old).eta.value,
              glm::vec3(0.200438f, 0.924033f, 1.102212f) / 1.000277f);
  EXPECT_EQ(model_of<ConductorMaterial>(old).alpha, glm::vec2(0.0f));

  const SceneDescription rough = read(with_bsdf(
      "<bsdf type=\"roughconductor\"><string name=\"material\" value=\"Cr\"/>"
      "<float name=\"alpha_u\" value=\"0.2\"/><float name=\"alpha_v\" value=\"0.4\"/></bsdf>"));
  EXPECT_EQ(model_of<ConductorMaterial>(rough).alpha, glm::vec2(0.2f, 0.4f));
  EXPECT_GT(model_of<ConductorMaterial>(rough).eta.value.x, 3.0f);
  EXPECT_TRUE(warns(rough, "microfacets are GGX's instead of beckmann's"));
  const SceneDescription unknown = read(with_bsdf(
      "<bsdf type=\"conductor\"><string name=\"material\" value=\"Unobtainium\"/></bsdf>"));
  EXPECT_TRUE(warns(unknown, "the metal \"Unobtainium\" is not known"));
}

// Reflectance of light that arrives diffusely at a smooth plastic of a quarter albedo, at normal
// incidence: Mitsuba's formula, with and without "nonlinear", against that of the layered coat.
TEST_F(Mitsuba, PlasticIsAsBrightAsMitsubas) {
  const auto diffuse = [&](const char* nonlinear) {
    return model_of<CoatedMaterial>(
               read(with_bsdf("<bsdf type=\"plastic\"><rgb name=\"diffuse_reflectance\" "
                              "value=\"0.25\"/><float name=\"int_ior\" value=\"1.5\"/><float "
                              "name=\"ext_ior\" value=\"1\"/><boolean name=\"nonlinear\" value=\"" +
                              std::string(nonlinear) + "\"/></bsdf>")))
        .diffuse.value.x;
  };
  EXPECT_FLOAT_EQ(diffuse("true"), 0.25f);
  const float r = 0.5963f;  // the inner diffuse reflectance at 1.5 (Egan and Hilgeman 1973)
  EXPECT_NEAR(diffuse("false") / (1.0f - diffuse("false") * r), 0.25f / (1.0f - r), 2e-3f);
  const SceneDescription rough = read(with_bsdf("<bsdf type=\"roughplastic\"/>"));
  EXPECT_FLOAT_EQ(model_of<CoatedMaterial>(rough).alpha, 0.1f);
  EXPECT_FLOAT_EQ(model_of<CoatedMaterial>(rough).eta, 1.49f / 1.000277f);
}

TEST_F(Mitsuba, Principled) {
  const SceneDescription scene = read(with_bsdf(
      "<bsdf type=\"principled\"><rgb name=\"base_color\" value=\"0.1 0.2 0.3\"/>"
      "<float name=\"metallic\" value=\"0.7\"/><float name=\"roughness\" value=\"0.4\"/>"
      "<float name=\"clearcoat\" value=\"1\"/><float name=\"clearcoat_gloss\" value=\"1\"/>"
      "<float name=\"sheen\" value=\"0.5\"/></bsdf>"));
  const auto& m = model_of<PrincipledMaterial>(scene);
  EXPECT_EQ(m.base_color.value, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_FLOAT_EQ(m.metallic.value, 0.7f);
  EXPECT_FLOAT_EQ(m.alpha.value, 0.16f);
  EXPECT_FLOAT_EQ(m.eta, 1.5f);
  EXPECT_FLOAT_EQ(m.coat.value, 0.25f);
  EXPECT_NEAR(m.coat_alpha.value, 0.001f, 1e-7f);
  EXPECT_TRUE(warns(scene, "\"sheen\" is not supported"));
}

TEST_F(Mitsuba, ModelsAroundOthers) {
  const SceneDescription scene =
      read(with_bsdf("<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf>") +
           with_bsdf("<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.25\"/>"
                     "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf></bsdf>") +
           with_bsdf("<bsdf type=\"bumpmap\"><texture type=\"scale\"><float name=\"scale\" "
                     "value=\"0.5\"/><texture type=\"bitmap\"><string name=\"filename\" "
                     "value=\"b.png\"/></texture></texture><float name=\"scale\" value=\"3\"/>"
                     "<bsdf type=\"plastic\"/></bsdf>") +
           with_bsdf("<bsdf type=\"normalmap\"><texture type=\"bitmap\" name=\"normalmap\"><string "
                     "name=\"filename\" value=\"n.png\"/><boolean name=\"raw\" value=\"true\"/>"
                     "</texture><bsdf type=\"diffuse\"/></bsdf>") +
           with_bsdf("<bsdf type=\"coating\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
                     "value=\"0.3\"/></bsdf></bsdf>") +
           with_bsdf("<bsdf type=\"null\"/>"));
  ASSERT_EQ(scene.shapes.size(), 5u);
  EXPECT_TRUE(warns(scene, "(\"null\") are left out"));
  EXPECT_TRUE(material_of(scene, 0).two_sided);
  EXPECT_TRUE(material_of(scene, 1).two_sided);
  EXPECT_EQ(material_of(scene, 1).opacity, FloatInput(0.25f));
  ASSERT_TRUE(material_of(scene, 2).bump);
  EXPECT_FLOAT_EQ(material_of(scene, 2).bump->value, 1.5f);
  const int normals = material_of(scene, 3).normal_map;
  EXPECT_EQ(std::get<ImageTexture>(scene.textures.at(size_t(normals))).encoding,
            TextureEncoding::Linear);
  EXPECT_EQ(model_of<CoatedMaterial>(scene, 4).diffuse.value, glm::vec3(0.3f));
  EXPECT_EQ(model_of<CoatedMaterial>(scene, 4).alpha, 0.0f);
}

// The share of the light that each leaf of a mix gets.
void shares_of(const SceneDescription& scene, int index, float share,
               std::vector<std::pair<int, float>>& shares) {
  const auto* mix = std::get_if<MixMaterial>(&scene.materials.at(size_t(index)).model);
  if (mix == nullptr) {
    shares.emplace_back(index, share);
    return;
  }
  shares_of(scene, mix->first, share * (1.0f - mix->amount.value), shares);
  shares_of(scene, mix->second, share * mix->amount.value, shares);
}

TEST_F(Mitsuba, Mixtures) {
  const std::string a = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.125\"/></bsdf>";
  const std::string b = "<bsdf type=\"conductor\"/>", c = "<bsdf type=\"dielectric\"/>";
  const SceneDescription scene = read(
      with_bsdf("<bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"0.5, 0.1, 0.2\"/>" +
                a + b + c + "</bsdf>") +
      with_bsdf("<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.3\"/>" + a + b +
                "</bsdf>") +
      with_bsdf("<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.3\"/>" + a +
                "<bsdf type=\"null\"/></bsdf>"));
  std::vector<std::pair<int, float>> shares;
  shares_of(scene, scene.shapes[0].material, 1.0f, shares);
  ASSERT_EQ(shares.size(), 4u);
  const float expected[] = {0.5f, 0.1f, 0.2f, 0.2f};
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(shares[i].second, expected[i], 1e-6f);
  const auto& rest = scene.materials[size_t(shares[3].first)].model;
  EXPECT_EQ(std::get<DiffuseMaterial>(rest).reflectance.value, glm::vec3(0.0f)) << "absorbed";
  const auto& blend = model_of<MixMaterial>(scene, 1);
  EXPECT_EQ(blend.amount, FloatInput(0.3f));
  EXPECT_NO_THROW(std::get<ConductorMaterial>(scene.materials[size_t(blend.second)].model));
  EXPECT_FLOAT_EQ(material_of(scene, 2).opacity.value, 0.7f) << "a hole";
  EXPECT_NE(error_of(with_bsdf("<bsdf type=\"mixturebsdf\"><string name=\"weights\" "
                               "value=\"1\"/>" +
                               a + b + "</bsdf>"))
                .find("a weight of 0 or more for each of its 2 models"),
            std::string::npos);
}

TEST_F(Mitsuba, PhongKeepsItsAlbedo) {
  const SceneDescription scene = read_old(with_bsdf(
      "<bsdf type=\"phong\"><float name=\"exponent\" value=\"198\"/><rgb "
      "name=\"diffuseReflectance\" value=\"0.4, 0.2, 0.1\"/><spectrum name=\"specularReflectance\" "
      "value=\"0.1\"/></bsdf>"));
  const auto& mix = model_of<MixMaterial>(scene);
  const float share = mix.amount.value;
  const auto& diffuse = std::get<DiffuseMaterial>(scene.materials[size_t(mix.first)].model);
  const auto& metal = std::get<ConductorMaterial>(scene.materials[size_t(mix.second)].model);
  expect_near((1.0f - share) * diffuse.reflectance.value, {0.4f, 0.2f, 0.1f});
  expect_near(share * metal.specular.value, {0.1f, 0.1f, 0.1f});
  EXPECT_FLOAT_EQ(metal.alpha.x, 0.1f);
  EXPECT_LE(diffuse.reflectance.value.x, 1.0f);
  EXPECT_TRUE(warns(scene, "phong is rendered with GGX"));
}

TEST_F(Mitsuba, UnknownThingsAreWarnedOfOnce) {
  const SceneDescription scene =
      read("\n" + with_bsdf("<bsdf type=\"hair\"/>") + with_bsdf("<bsdf type=\"hair\"/>") +
           "<shape type=\"sdfgrid\"/><emitter type=\"projector\"/><volume/>" +
           "<shape type=\"cube\"><float name=\"wobble\" value=\"1\"/></shape>");
  EXPECT_TRUE(warns(scene, "scene.xml:3: <bsdf type=\"hair\"> is not supported; a diffuse grey"));
  EXPECT_TRUE(warns(scene, "<shape type=\"sdfgrid\"> is not supported; it is left out"));
  EXPECT_TRUE(warns(scene, "<emitter type=\"projector\"> is not supported"));
  EXPECT_TRUE(warns(scene, "<volume> of the scene is not understood"));
  EXPECT_TRUE(warns(scene, "\"wobble\" of <shape type=\"cube\"> is not understood"));
  EXPECT_EQ(scene.warnings.size(), 7u) << "with those of the default camera and light";
}

// --- Textures

TEST_F(Mitsuba, Bitmaps) {
  const auto texture = [&](const std::string& parameters, bool old) {
    const std::string text = with_bsdf(
        "<bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\"><string "
        "name=\"filename\" value=\"sub\\a.png\"/>" +
        parameters + "</texture></bsdf>");
    const SceneDescription scene = old ? read_old(text) : read(text);
    return std::get<ImageTexture>(
        scene.textures.at(size_t(model_of<DiffuseMaterial>(scene).reflectance.texture)));
  };
  const auto string = [](const char* name, const char* value) {
    return std::string("<string name=\"") + name + "\" value=\"" + value + "\"/>";
  };
  const ImageTexture plain = texture("", false);
  EXPECT_EQ(fs::path(plain.file), folder_ / "sub/a.png");
  EXPECT_EQ(plain.filter, TextureFilter::Bilinear);
  EXPECT_EQ(plain.encoding, TextureEncoding::ByFormat);
  EXPECT_EQ(plain.wrap_u, TextureWrap::Repeat);
  EXPECT_NE(plain.where.find("scene.xml:2"), std::string::npos);
  EXPECT_EQ(texture("", true).filter, TextureFilter::Trilinear) << "ewa";
  EXPECT_EQ(texture(string("filter_type", "nearest"), false).filter, TextureFilter::Nearest);
  EXPECT_EQ(texture(string("wrapMode", "mirror") + string("wrapModeV", "zero"), true).wrap_u,
            TextureWrap::Mirror);
  EXPECT_EQ(texture(string("wrapMode", "mirror") + string("wrapModeV", "zero"), true).wrap_v,
            TextureWrap::Black);
  EXPECT_EQ(texture("<float name=\"gamma\" value=\"1\"/>", true).encoding, TextureEncoding::Linear);
  EXPECT_EQ(texture("<float name=\"gamma\" value=\"-1\"/>", true).encoding, TextureEncoding::Srgb);
  EXPECT_EQ(texture("<float name=\"gamma\" value=\"1.8\"/>", true).gamma, 1.8f);

  const auto apply = [](const UvTransform& t, glm::vec2 uv) {
    return glm::vec2(glm::dot(t.u_row, uv), glm::dot(t.v_row, uv)) + t.offset;
  };
  const ImageTexture old = texture(
      "<float name=\"uscale\" value=\"2\"/><float name=\"vscale\" value=\"3\"/>"
      "<float name=\"uoffset\" value=\"0.5\"/>",
      true);
  EXPECT_EQ(apply(old.uv, {1, 1}), glm::vec2(2.5f, 3));
  const ImageTexture matrix = texture(
      "<transform name=\"to_uv\"><matrix value=\"2 0 0.5 0 3 0.25 0 0 1\"/></transform>", false);
  EXPECT_EQ(apply(matrix.uv, {1, 1}), glm::vec2(2.5f, 3.25f));
  const ImageTexture moved = texture(
      "<transform name=\"to_uv\"><scale x=\"2\" y=\"3\"/><translate x=\"0.5\"/></transform>",
      false);
  EXPECT_EQ(apply(moved.uv, {1, 1}), glm::vec2(2.5f, 3));
}

TEST_F(Mitsuba, CheckerboardsAndScales) {
  const SceneDescription scene = read(
      "<texture type=\"checkerboard\" id=\"t\"><rgb name=\"color0\" value=\"0.5\"/>"
      "<transform name=\"to_uv\"><scale x=\"8\" y=\"4\"/></transform></texture>" +
      with_bsdf("<bsdf type=\"diffuse\"><ref name=\"reflectance\" id=\"t\"/></bsdf>") +
      with_bsdf("<bsdf type=\"diffuse\"><texture type=\"scale\" name=\"reflectance\"><float "
                "name=\"scale\" value=\"0.5\"/><ref id=\"t\"/></texture></bsdf>") +
      with_bsdf("<bsdf type=\"roughconductor\"><texture type=\"bitmap\" name=\"alpha\"><string "
                "name=\"filename\" value=\"a.png\"/><string name=\"channel\" value=\"g\"/>"
                "</texture></bsdf>") +
      with_bsdf("<bsdf type=\"diffuse\"><texture type=\"marble\" name=\"reflectance\"/></bsdf>"));
  ASSERT_EQ(scene.textures.size(), 2u) << "one that is referred to twice is there once";
  const auto& board = std::get<CheckerboardTexture>(scene.textures[0]);
  EXPECT_EQ(board.even.value, glm::vec3(0.5f));
  EXPECT_EQ(board.odd.value, glm::vec3(0.2f));
  EXPECT_EQ(board.uv.u_row, glm::vec2(16, 0)) << "squares have side 1/2";
  EXPECT_EQ(board.uv.v_row, glm::vec2(0, 8));
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 1).reflectance, ColorInput(glm::vec3(0.5f), 0));
  const auto& rough = model_of<ConductorMaterial>(scene, 2);
  EXPECT_EQ(rough.alpha, glm::vec2(1.0f));
  EXPECT_EQ(rough.alpha_scale.texture, 1);
  EXPECT_EQ(rough.alpha_scale.channel, 1);
  EXPECT_TRUE(warns(scene, "<texture type=\"marble\"> is not supported"));
}

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
  EXPECT_NE(error_of(light + "<rgb name=\"radiance\" value=\"1 -1 0\"/></emitter></shape>")
                .find("negative radiance"),
            std::string::npos);
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
  EXPECT_EQ(fs::path(e.file), folder_ / "e.exr");
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

// --- View

TEST_F(Mitsuba, FieldsOfView) {
  const auto fov = [&](const std::string& parameters) {
    return read("<sensor type=\"perspective\">" + parameters + default_film + "</sensor>")
        .camera.fov_degrees;
  };
  const auto axis = [](const char* name) {
    return "<float name=\"fov\" value=\"60\"/><string name=\"fovAxis\" value=\"" +
           std::string(name) + "\"/>";
  };
  // 200 x 100 pixels; ours is along the shorter axis.
  const float narrow = 2.0f * glm::degrees(std::atan(0.5f * std::tan(glm::radians(30.0f))));
  EXPECT_NEAR(fov("<float name=\"fov\" value=\"60\"/>"), narrow, 1e-4f) << "x by default";
  EXPECT_NEAR(fov(axis("x")), narrow, 1e-4f);
  EXPECT_NEAR(fov(axis("larger")), narrow, 1e-4f);
  EXPECT_NEAR(fov(axis("y")), 60.0f, 1e-4f);
  EXPECT_NEAR(fov(axis("smaller")), 60.0f, 1e-4f);
  const float diagonal = std::tan(glm::radians(30.0f)) / std::sqrt(5.0f);
  EXPECT_NEAR(fov(axis("diagonal")), 2.0f * glm::degrees(std::atan(diagonal)), 1e-4f);
  const float lens = std::hypot(36.0f, 24.0f) / 70.0f / std::sqrt(5.0f);
  EXPECT_NEAR(fov("<string name=\"focalLength\" value=\"35mm\"/>"),
              2.0f * glm::degrees(std::atan(lens)), 1e-4f);
  EXPECT_NE(error_of("<sensor type=\"perspective\"><float name=\"fov\" value=\"180\"/></sensor>")
                .find("a fov between 0 and 180"),
            std::string::npos);
}

TEST_F(Mitsuba, CameraLooksAlongZWithXToTheLeft) {
  const SceneDescription scene = read(
      "<sensor type=\"perspective\"><float name=\"fov\" value=\"90\"/><transform name=\"to_world\">"
      "<lookat origin=\"0,0,10\" target=\"0,0,0\" up=\"0,1,0\"/></transform>" +
      default_film + "</sensor>");
  const glm::vec2 middle = pixel_of(scene, {0, 0, 0});
  EXPECT_NEAR(middle.x, 100.0f, 1e-3f);
  EXPECT_NEAR(middle.y, 50.0f, 1e-3f);
  // In the world's right-handed frame, +x is on the right of who looks along -z.
  EXPECT_NEAR(pixel_of(scene, {10, 0, 0}).x, 200.0f, 1e-3f);
  EXPECT_NEAR(pixel_of(scene, {0, 5, 0}).y, 0.0f, 1e-3f);
}

TEST_F(Mitsuba, CropsSeeAPartOfTheSameImage) {
  const auto scene_with = [&](const std::string& type, const std::string& crop,
                              const std::string& camera) {
    return read("<sensor type=\"" + type + "\">" + camera +
                "<film type=\"hdrfilm\"><integer "
                "name=\"width\" value=\"200\"/><integer name=\"height\" value=\"100\"/>" +
                crop + "</film></sensor>");
  };
  const std::string crop =
      "<integer name=\"crop_offset_x\" value=\"30\"/><integer name=\"cropOffsetY\" value=\"10\"/>"
      "<integer name=\"crop_width\" value=\"20\"/><integer name=\"cropHeight\" value=\"60\"/>";
  const glm::vec3 p(-0.3f, 0.2f, 2.0f);
  for (const char* type : {"perspective", "orthographic"}) {
    const SceneDescription whole = scene_with(type, "", ""), part = scene_with(type, crop, "");
    EXPECT_EQ(part.film.width, 20);
    EXPECT_EQ(part.film.height, 60);
    EXPECT_NEAR(pixel_of(part, p).x, pixel_of(whole, p).x - 30.0f, 1e-3f);
    EXPECT_NEAR(pixel_of(part, p).y, pixel_of(whole, p).y - 10.0f, 1e-3f);
  }
  // The ray of a pixel is that of the pixel a tenth of the width, a fifth of the height further.
  const SceneDescription whole = scene_with("perspective", "", "");
  const SceneDescription moved =
      scene_with("perspective", "",
                 "<float name=\"principal_point_offset_x\" value=\"0.1\"/>"
                 "<float name=\"principalPointOffsetY\" value=\"0.2\"/>");
  EXPECT_NEAR(pixel_of(moved, p).x, pixel_of(whole, p).x - 20.0f, 1e-3f);
  EXPECT_NEAR(pixel_of(moved, p).y, pixel_of(whole, p).y - 20.0f, 1e-3f);
  EXPECT_NE(message_of([&] {
              scene_with("perspective", "<integer name=\"crop_width\" value=\"201\"/>", "");
            }).find("the crop window"),
            std::string::npos);
}

TEST_F(Mitsuba, OtherCamerasFiltersAndCounts) {
  const SceneDescription thin = read(
      "<integrator type=\"path\"><integer name=\"max_depth\" value=\"2\"/></integrator>"
      "<sensor type=\"thinlens\"><float name=\"aperture_radius\" value=\"0.1\"/>"
      "<float name=\"focus_distance\" value=\"7\"/><sampler type=\"independent\">"
      "<integer name=\"sampleCount\" value=\"32\"/></sampler><film type=\"hdrfilm\">"
      "<rfilter type=\"gaussian\"><float name=\"stddev\" value=\"0.25\"/></rfilter></film>"
      "</sensor><sensor type=\"perspective\"/>");
  EXPECT_FLOAT_EQ(thin.camera.lens_radius, 0.1f);
  EXPECT_FLOAT_EQ(thin.camera.focal_distance, 7.0f);
  EXPECT_EQ(thin.defaults.spp, 32);
  EXPECT_EQ(thin.defaults.depth, 1) << "direct light";
  EXPECT_FLOAT_EQ(thin.film.filter.radius.x, 1.0f);
  EXPECT_TRUE(warns(thin, "of several sensors the first is used"));

  const SceneDescription flat = read(
      "<integrator type=\"bdpt\"/><sensor type=\"orthographic\"><transform name=\"to_world\">"
      "<scale x=\"3\" y=\"3\"/></transform>" +
      default_film + "</sensor>");
  EXPECT_EQ(flat.camera.projection, CameraDescription::Projection::Orthographic);
  EXPECT_FLOAT_EQ(flat.camera.extent, 3.0f) << "six wide, three high";
  EXPECT_EQ(flat.defaults.depth, 64);
  EXPECT_TRUE(warns(flat, "<integrator type=\"bdpt\">"));

  const SceneDescription lanczos = read(
      "<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"lanczos\"/></film>"
      "</sensor>");
  EXPECT_TRUE(warns(lanczos, "<rfilter type=\"lanczos\"> is not supported"));
  EXPECT_NE(error_of("<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" "
                     "value=\"1000000\"/></film></sensor>")
                .find("<film> needs a width"),
            std::string::npos);
}

// --- Whole scenes

class SharedMitsuba : public Mitsuba {
 protected:
  void SetUp() override {
    scenes_ = fs::path(LOCKSTEP_SHARED_DIR) / "scenes";
    if (!fs::exists(scenes_ / "sponza")) GTEST_SKIP() << "no " << scenes_;
    Mitsuba::SetUp();
  }
  void TearDown() override {
    if (!IsSkipped()) Mitsuba::TearDown();
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
  fs::create_directories(folder_ / "models");
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
}  // namespace lockstep
