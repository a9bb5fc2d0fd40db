// Files made to exhaust a reader: circles, deep nesting, counts that nothing backs, small files
// that stand for large ones, devices. Each gives one line, soon.
#include "core/mitsuba/reader.h"
#include "core/ply.h"
#include "core/read_scene.h"
#include "core/serialized_mesh.h"
#include "tests/fuzz/playground.h"
#include "tests/t_gltf.h"

#include <functional>
#include <string>
#include <vector>

namespace lockstep::test_hostile_files {
namespace {

std::string repeated(int times, const std::string& text) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

std::string numbered(int times, const std::function<std::string(const std::string&)>& text) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text(std::to_string(i));
  return all;
}

const std::string world = "WorldBegin\n";

class HostileFiles : public TestWithFiles {
 protected:
  void expect(const std::string& name, const std::string& bytes, const std::string& part) const {
    write(name, bytes);
    expect_one_line_with(message_of([&] { read_scene(path(name)); }), part);
  }
  void expect_pbrt(const std::string& text, const std::string& part) const {
    expect("scene.pbrt", text, part);
  }
  void expect_mitsuba(const std::string& text, const std::string& part) const {
    expect("scene.xml", "<scene version=\"3.0.0\">" + text + "</scene>", part);
  }
};

TEST_F(HostileFiles, PbrtIncludesThatNeverEnd) {
  expect_pbrt("Include \"scene.pbrt\"\n", "scene.pbrt:1: files include one another more than 32");
  for (int i = 0; i < 30; ++i) {
    write("twice" + std::to_string(i) + ".pbrt",
          repeated(2, "Include \"twice" + std::to_string(i + 1) + ".pbrt\"\n"));
  }
  write("twice30.pbrt", "# nothing\n");
  expect_pbrt("Include \"twice0.pbrt\"\n", "more than 10000 files are included");
  expect_pbrt("Include \"/dev/zero\"\n", "scene.pbrt:1: \"/dev/zero\" cannot be opened");
}

TEST_F(HostileFiles, PbrtNesting) {
  constexpr int deep = 10'000;
  expect_pbrt(world + repeated(deep, "AttributeBegin\n"),
              "scene.pbrt:1002: AttributeBegin is neste");
  expect_pbrt(world + repeated(deep, "TransformBegin\n"),
              "scene.pbrt:1002: TransformBegin is neste");
  expect_pbrt(world + repeated(deep, "ObjectBegin \"a\"\n"), "scene.pbrt:3: ObjectBegin inside");
  expect_pbrt(world + "Shape \"sphere\" \"float radius\" " + repeated(deep, "["),
              "scene.pbrt:2: expected a value or ]");
  const auto next = [](const std::string& i) { return std::to_string(std::stoi(i) + 1); };
  expect_pbrt(world + "Texture \"0\" \"spectrum\" \"constant\"\n" +
                  numbered(deep,
                           [&](const std::string& i) {
                             return "Texture \"" + next(i) +
                                    "\" \"spectrum\" \"scale\" \"texture tex1\" \"" + i +
                                    "\" \"texture tex2\" \"" + i + "\"\n";
                           }) +
                  "Material \"diffuse\" \"texture reflectance\" \"10000\" Shape \"sphere\"",
              "is referred to through more than 64 others");
  expect_pbrt(world + "MakeNamedMaterial \"0\" \"string type\" \"diffuse\"\n" +
                  numbered(deep,
                           [&](const std::string& i) {
                             return "MakeNamedMaterial \"" + next(i) +
                                    "\" \"string type\" \"mix\" \"string materials\" [\"" + i +
                                    "\" \"" + i + "\"]\n";
                           }) +
                  "NamedMaterial \"10000\" Shape \"sphere\"",
              "is referred to through more than 64 others");
}

TEST_F(HostileFiles, PbrtSmallFilesThatStandForLargeOnes) {
  const std::string triangle = "\"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]\n";
  expect_pbrt(world + "Shape \"loopsubdiv\" \"integer levels\" 1000000 " + triangle,
              "scene.pbrt:2: Shape \"loopsubdiv\" cannot have 1000000 levels");
  expect_pbrt("Film \"rgb\" \"integer xresolution\" 2000000000 " + world,
              "resolution between 1 and 65536");
  expect_pbrt(world + "Attribute \"shape\" \"float a\" [" + repeated(1000, "1 ") + "]",
              "scene.pbrt:2: Attribute \"shape\" holds more than 256 values");
  expect_pbrt(world + "Shape \"sphere\" " +
                  numbered(20'000, [](const std::string& i) { return "\"float a" + i + "\" 1\n"; }),
              "scene.pbrt:1002: Shape \"sphere\" has more than 1000 parameters");
}

TEST_F(HostileFiles, MitsubaNestingAndCircles) {
  constexpr int deep = 10'000;
  expect_mitsuba(repeated(deep, "<bsdf type=\"twosided\">") + repeated(deep, "</bsdf>"),
                 "scene.xml:1: tags are nested more than 64 deep");
  expect_mitsuba("<include filename=\"scene.xml\"/>", "scene.xml includes itself");
  const std::string shape = "<shape type=\"sphere\"><ref id=\"a\"/></shape>";
  expect_mitsuba(
      "<bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf>"
      "<bsdf type=\"twosided\" id=\"b\"><ref id=\"a\"/></bsdf>" +
          shape,
      "refers to itself");
  expect_mitsuba(
      "<spectrum type=\"d65\" id=\"s\"><ref name=\"color\" id=\"s\"/></spectrum>"
      "<bsdf type=\"diffuse\" id=\"a\"><ref name=\"reflectance\" id=\"s\"/></bsdf>" +
          shape,
      "refers to itself");
  expect_mitsuba(
      "<texture type=\"scale\" id=\"s\"><ref id=\"s\"/></texture>"
      "<bsdf type=\"diffuse\" id=\"a\"><ref name=\"reflectance\" id=\"s\"/></bsdf>" +
          shape,
      "refers to itself");
}

TEST_F(HostileFiles, MitsubaEntitiesAreNotExpanded) {
  const std::string scene =
      "<scene version=\"3.0.0\">\n<shape type=\"sphere\"><float name=\"radius\" value=\"&b;\"/>"
      "</shape></scene>";
  expect("scene.xml", "<!DOCTYPE s [<!ENTITY a \"1\"><!ENTITY b \"&a;&a;&a;\">]>" + scene,
         "scene.xml:2: <float name=\"radius\">: expected a number, found \"&b\"");
  expect("scene.xml", "<!DOCTYPE s [<!ENTITY b SYSTEM \"file:///etc/hostname\">]>" + scene,
         "scene.xml:2: <float name=\"radius\">: expected a number, found \"&b\"");
}

TEST_F(HostileFiles, MitsubaParametersThatGrow) {
  const auto named = [](const std::string& name, const std::string& value) {
    return "<default name=\"" + name + "\" value=\"" + value + "\"/>";
  };
  const std::string a = named("a", repeated(1000, "x")), b = named("b", repeated(1000, "$a"));
  expect_mitsuba(a + b + named("c", "$b$b"), "scene.xml:1: a value is too long");
  expect_mitsuba(a + b + repeated(1000, named("c", "$b")), "too long in all");
}

TEST_F(HostileFiles, GltfNestingAndCounts) {
  const std::string start = "{\"asset\":{\"version\":\"2.0\"},";
  expect("scene.gltf", start + "\"extras\":" + repeated(10'000, "[") + repeated(10'000, "]") + "}",
         "the JSON is nested more than 100 deep");
  const std::string nodes = numbered(10'000, [](const std::string& i) {
    return "{\"children\":[" + std::to_string(std::stoi(i) + 1) + "]},";
  });
  expect("scene.gltf", start + "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[" + nodes + "{}]}",
         "node 1001 is more than 1000 levels below its root");
  const std::string view =
      "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":["
      "{\"byteLength\":36,\"uri\":\"data:,";
  const auto with_count = [&](const std::string& count, const std::string& uri) {
    return start + one_mesh("\"attributes\":{\"POSITION\":0}") +
           ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":" +
           count + "}]," + view + uri + "\"}]}";
  };
  expect("scene.gltf", with_count("4000000000", repeated(36, "a")), "accessor 0");
  expect("scene.gltf", with_count("3", "aaa"), "buffer 0 has 3 bytes, but its byteLength is 36");

  write("a.bin", "abc");
  const std::string buffers = repeated(20, "{\"byteLength\":3,\"uri\":\"a.bin\"},");
  expect("scene.gltf", start + "\"buffers\":[" + buffers + "{\"byteLength\":0}]}",
         "more than 16 buffers are the file");
}

std::string ply(const std::string& format, const std::string& vertices, const std::string& faces) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

TEST_F(HostileFiles, PlyCountsThatNothingBacks) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    expect("mesh.ply", ply(format, "3000000000", "1") + "0 0 0 1 0 0", "too short for 3000000000");
    expect("mesh.ply", ply(format, "0", "4000000000"), "too short for 4000000000");
  }
  const std::string corners = "0 0 0 1 0 0 0 1 0\n";
  expect("mesh.ply", ply("ascii", "3", "1") + "0 0 0 1 0 nan 0 1 0 3 0 1 2", "not finite");
  expect("mesh.ply", ply("ascii", "3", "1") + "0 0 0 1 0 1e19 0 1 0 3 0 1 2", "beyond 1e18");
  expect("mesh.ply", ply("ascii", "3", "1") + corners + "3 0 1 3", "mesh.ply:11: face 0 refers to");
  expect("mesh.ply", ply("ascii", "3", "1") + corners + "3 0 1 -1", "mesh.ply:11: face 0 refers");
  expect("mesh.ply", "ply\nelement vertex 1\nproperty flo\rat x\n", "unknown type \"flo?at\"");
  expect_one_line_with(error_of([] { read_ply("/dev/zero"); }), "cannot be opened");
}

TEST_F(HostileFiles, ObjCoordinates) {
  expect("a.obj", "v 0 0 0\nv 0 -2e18 0\nf 1 1 2\n", "a.obj:2: a vertex is farther than 1e18");
  expect("a.obj", "v 0 0 inf\n", "a.obj:1: a number is not finite");
  expect("a.obj", "v 0 0 0\nf 1 1 2\n", "a.obj:2: a face has the index 2");
}

TEST_F(HostileFiles, ObjMaterialFilesAreReadOnce) {
  write("a.mtl",
        numbered(100, [](const std::string& i) { return "newmtl m" + i + "\nmap_Kd a.png\n"; }));
  write("a.obj", repeated(1000, "mtllib a.mtl\n") + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(read_scene(path("a.obj")).textures.size(), 100u);
}

TEST_F(HostileFiles, FacesWithoutAreaAreNoErrors) {
  write("a.obj", "v 0 0 0\nv 1 0 0\nf 1 1 1\nf 1 2 2\n");
  EXPECT_EQ(mesh_of(read_scene(path("a.obj"))).triangles.size(), 2u);
  write("a.ply", ply("ascii", "1", "1") + "0 0 0 3 0 0 0");
  EXPECT_EQ(mesh_of(read_scene(path("a.ply"))).triangles.size(), 1u);
}

// Cut off anywhere, a binary file gives an error.
TEST_F(HostileFiles, TruncatedBinaries) {
  GltfBuffer buffer;
  buffer.add("VEC3", corner_positions);
  const std::string little = ply("binary_little_endian", "3", "1") + raw(corner_positions);
  const std::pair<std::string, std::string> files[] = {
      {"a.glb", buffer.container(one_mesh("\"attributes\":{\"POSITION\":0}"))},
      {"a.ply", little + std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13)},
      {"a.serialized", fuzz::small_serialized_mesh()},
  };
  for (const auto& [name, bytes] : files) {
    const auto read = [&](std::size_t size) {
      write(name, bytes.substr(0, size));
      return message_of([&] {
        if (name == "a.serialized") {
          read_serialized_mesh(path(name), 0);
        } else {
          read_scene(path(name));
        }
      });
    };
    EXPECT_EQ(read(bytes.size()), "") << name;
    for (std::size_t part = 0; part < 16; ++part) {
      expect_one_line_with(read(bytes.size() * part / 16), name + ":");
    }
  }
}

TEST_F(HostileFiles, SerializedCountsThatNothingBacks) {
  std::string mesh = fuzz::small_serialized_mesh();
  const std::size_t vertices = mesh.find(std::string("\3\0\0\0\0\0\0\0", 8));
  ASSERT_NE(vertices, mesh.npos);
  for (std::size_t i = 0; i < 7; ++i) mesh[vertices + i] = '\xff';
  write("a.serialized", mesh);
  expect_one_line_with(message_of([&] { read_serialized_mesh(path("a.serialized"), 0); }),
                       "a.serialized: a mesh is too short for the");
}

}  // namespace
}  // namespace lockstep::test_hostile_files
