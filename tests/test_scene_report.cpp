// What `lockstep info` says of small scenes in every format.
#include "experiments/scenes/scene_report.h"

#include "tests/t_files.h"
#include "tests/t_png.h"

#include <string>

namespace lockstep::test_scene_report {
namespace {

class SceneReportTest : public TestWithFiles {
 protected:
  std::string write_png(const std::string& name, std::uint32_t width, std::uint32_t height) const {
    return write(name, png_bytes({width, height, 3, 8,
                                  std::vector<std::uint16_t>(size_t(width * height * 3), 128)}));
  }
};

bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

// Geometry, an object with two instances, materials, textures, every kind of light.
constexpr const char* kPbrt = R"(
LookAt 0 2 8  0 2 0  0 1 0
Camera "perspective" "float fov" 30 "float lensradius" 0.25 "float focaldistance" 8
Film "rgb" "integer xresolution" 64 "integer yresolution" 32
PixelFilter "triangle" "float xradius" 1 "float yradius" 2
Sampler "halton" "integer pixelsamples" 12
Integrator "volpath" "integer maxdepth" 6
WorldBegin
LightSource "point" "rgb I" [1 1 1]
LightSource "distant"
LightSource "infinite" "rgb L" [0.5 1 2]
Texture "wood" "spectrum" "imagemap" "string filename" "wood.png"
Texture "again" "spectrum" "imagemap" "string filename" "wood.png" "string wrap" "clamp"
Texture "broken" "spectrum" "imagemap" "string filename" "broken.png"
Texture "tiles" "spectrum" "checkerboard"
MakeNamedMaterial "floor" "string type" "diffuse" "texture reflectance" "wood"
MakeNamedMaterial "wall" "string type" "coateddiffuse" "texture reflectance" "broken"
MakeNamedMaterial "shelf" "string type" "coateddiffuse" "texture reflectance" "again"
MakeNamedMaterial "glass" "string type" "dielectric" "string surprise" "yes"
NamedMaterial "floor"
Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0] "integer indices" [0 1 2 1 3 2]
NamedMaterial "wall"
Shape "sphere" "float radius" 2
NamedMaterial "glass"
Shape "disk" "float radius" 1 "float height" 3
AttributeBegin
  AreaLightSource "diffuse" "bool twosided" true
  Shape "trianglemesh" "point3 P" [0 4 0 1 4 0 0 4 1]
AttributeEnd
ObjectBegin "thing"
  NamedMaterial "shelf"
  Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0]
ObjectEnd
AttributeBegin
  Translate 10 0 0
  ObjectInstance "thing"
AttributeEnd
AttributeBegin
  Translate 0 0 -20
  ObjectInstance "thing"
AttributeEnd
)";

TEST_F(SceneReportTest, Pbrt) {
  write_png("wood.png", 6, 4);
  write("broken.png", "no image");
  const SceneReport r = report_scene(write("scene.pbrt", kPbrt));
  EXPECT_EQ(r.format, SceneFormat::Pbrt);
  EXPECT_EQ(r.own.meshes, 2u);
  EXPECT_EQ(r.own.spheres, 1u);
  EXPECT_EQ(r.own.disks, 1u);
  EXPECT_EQ(r.own.triangles, 3u);
  EXPECT_EQ(r.own.vertices, 7u);
  EXPECT_EQ(r.object_count, 1u);
  EXPECT_EQ(r.instance_count, 2u);
  EXPECT_EQ(r.objects.triangles, 1u);
  EXPECT_EQ(r.placed.triangles, 2u);
  EXPECT_EQ(r.bounds.lo, glm::vec3(-2, -2, -20));
  EXPECT_EQ(r.bounds.hi, glm::vec3(11, 4, 3));

  EXPECT_EQ(r.emitters.counts.shapes(), 1u);
  EXPECT_EQ(r.emitters.counts.triangles, 1u);
  EXPECT_EQ(r.emitters.two_sided, 1);
  EXPECT_EQ(r.lights.point, 1);
  EXPECT_EQ(r.lights.distant, 1);
  EXPECT_EQ(r.lights.spot, 0);
  ASSERT_TRUE(r.environment);
  EXPECT_EQ(r.environment->mean_radiance, r.environment->environment.radiance);
  EXPECT_EQ(r.camera.fov_degrees, 30.0f);
  EXPECT_EQ(r.film.width, 64);
  EXPECT_EQ(r.defaults.spp, 12);
  ASSERT_EQ(r.warnings.size(), 1u);
  expect_one_line_with(r.warnings[0], "surprise");
}

TEST_F(SceneReportTest, MaterialsAndTextures) {
  write_png("wood.png", 6, 4);
  write("broken.png", "no image");
  const SceneReport r = report_scene(write("scene.pbrt", kPbrt));
  int materials = 0;
  for (const MaterialCounts& m : r.materials) {
    materials += m.count;
    if (m.model == "coated diffuse") {
      EXPECT_EQ(m.count, 2);
      EXPECT_EQ(m.textured, 2);
    }
    if (m.model == "dielectric") {
      EXPECT_EQ(m.textured, 0);
    }
  }
  EXPECT_GE(materials, 4);
  ASSERT_GE(r.textures.size(), 1u);
  EXPECT_EQ(r.textures[0].kind, "image");
  EXPECT_EQ(r.textures[0].count, 3);
  // Textures of one file share its image; a broken one does not stop the others.
  ASSERT_EQ(r.images.size(), 2u);
  EXPECT_EQ(r.images[0].file, "wood.png");
  EXPECT_EQ(r.images[0].width, 6);
  EXPECT_EQ(r.images[0].height, 4);
  EXPECT_EQ(r.images[0].stored, "8-bit sRGB");
  EXPECT_GE(r.images[0].memory_bytes, 6u * 4u * 4u);
  EXPECT_TRUE(r.images[0].error.empty());
  EXPECT_EQ(r.images[1].width, 0);
  expect_one_line_with(r.images[1].error, "scene.pbrt:");
  expect_one_line_with(r.images[1].error, "broken.png");
}

TEST_F(SceneReportTest, Text) {
  write_png("wood.png", 6, 4);
  write("broken.png", "no image");
  const SceneReport r = report_scene(write("scene.pbrt", kPbrt));
  const std::string text = report_text(r);
  for (const char* line : {
           "  shapes                         4  2 meshes, 1 sphere, 1 disk",
           "  triangles                      3  7 vertices",
           "  objects                        1  1 mesh; 1 triangle, 3 vertices",
           "  instances                      2  2 triangles",
           "  triangles in all               5  with those of instances",
           "  bounds                (-2 -2 -20) to (11 4 3), size 13 6 23",
           "Materials                    count  textured  opacity  normal  bump",
           "  coated diffuse                 2         2        -       -     -",
           "  image                          3",
           "  emitting shapes                1  1 triangle; 1 two-sided",
           "  point                          1",
           "  distant                        1",
           "  projection            perspective, fov 30 degrees (longer side: 56.374)",
           "  position              0 2 8",
           "  direction             0 0 -1",
           "  up                    0 1 0",
           "  coordinates           left-handed",
           "  lens                  radius 0.25, sharp at 8",
           "  as --camera           origin=0,2,8:target=0,2,-0.24621:up=0,1,0:fov=30:lens=0.25:"
           "focus=8",
           "  resolution            64 x 32",
           "  filter                triangle, radius 1 x 2 px",
           "  samples per pixel     12",
           "Warnings: 1",
       }) {
    EXPECT_TRUE(has_line(text, line)) << line << "\nis missing in\n" << text;
  }
  EXPECT_FALSE(has_line(text, "  spot                           0")) << text;
  EXPECT_NE(text.find("not read"), std::string::npos) << text;
  EXPECT_EQ(text.find(" \n"), std::string::npos) << "blanks at the end of a line\n" << text;
}

TEST_F(SceneReportTest, LargeNumbersAndStrangeNames) {
  SceneReport r;
  r.scene = "a\nb\x1b[2J";
  r.bounds = {glm::vec3(1.0f), glm::vec3(-1.0f)};
  r.own.meshes = 1;
  r.own.triangles = 12345678;
  r.geometry_bytes = 999'600;
  r.images = {{"x", "8-bit sRGB", 16384, 16384, 1'073'741'836, ""}};
  r.textures = {{"image", 1}};
  const std::string text = report_text(r);
  EXPECT_EQ(text.rfind("a?b?[2J\n", 0), 0u) << text;
  EXPECT_NE(text.find("  12,345,678  "), std::string::npos) << text;
  EXPECT_NE(text.find("1.0 MB as read"), std::string::npos) << text;
  EXPECT_TRUE(has_line(text, "   16384 x 16384  8-bit sRGB    1.1 GB  x")) << text;
  EXPECT_TRUE(has_line(text, "  bounds                none")) << text;
}

TEST_F(SceneReportTest, Json) {
  write_png("wood.png", 6, 4);
  write("broken.png", "no image");
  const SceneReport r = report_scene(write("scene.pbrt", kPbrt));
  const nlohmann::ordered_json json = report_json(r);
  EXPECT_EQ(json["format"], "pbrt");
  EXPECT_EQ(json["geometry"]["shapes"]["triangles"], 3);
  EXPECT_EQ(json["geometry"]["in_instances"]["triangles"], 2);
  EXPECT_EQ(json["geometry"]["bounds"][1][0], 11.0f);
  EXPECT_EQ(json["textures"]["image"], 3);
  EXPECT_EQ(json["images"][0]["resolution"], nlohmann::json({6, 4}));
  EXPECT_TRUE(json["images"][1].contains("error"));
  EXPECT_EQ(json["lights"]["emitting_shapes"]["triangles"], 1);
  EXPECT_EQ(json["lights"]["environment"]["mapping"], "constant");
  EXPECT_EQ(json["camera"]["left_handed"], true);
  EXPECT_EQ(json["camera"]["lens_radius"], 0.25f);
  EXPECT_EQ(json["film"]["filter"]["radius"], nlohmann::json({1.0f, 2.0f}));
  EXPECT_EQ(json["spp"], 12);
  EXPECT_EQ(json["warnings"].size(), 1u);
}

TEST_F(SceneReportTest, Mitsuba) {
  const SceneReport r = report_scene(write("scene.xml", R"(<scene version="3.0.0">
    <sensor type="orthographic"><film type="hdrfilm"><integer name="width" value="40"/>
      <integer name="height" value="20"/></film></sensor>
    <shape type="rectangle"><bsdf type="mask"><float name="opacity" value="0.5"/>
      <bsdf type="roughconductor"/></bsdf></shape>
    <shape type="sphere"><float name="radius" value="3"/><bsdf type="diffuse"/></shape>
    <emitter type="spot"/></scene>)"));
  EXPECT_EQ(r.format, SceneFormat::Mitsuba);
  EXPECT_EQ(r.own.triangles, 2u);
  EXPECT_EQ(r.own.spheres, 1u);
  EXPECT_EQ(r.lights.spot, 1);
  EXPECT_FALSE(r.environment);
  EXPECT_EQ(r.bounds.lo, glm::vec3(-3.0f));
  int masked = 0;
  for (const MaterialCounts& m : r.materials) masked += m.model == "conductor" ? m.opacity : 0;
  EXPECT_EQ(masked, 1);
  const std::string text = report_text(r);
  EXPECT_NE(text.find("orthographic, extent"), std::string::npos) << text;
  EXPECT_TRUE(has_line(text, "  coordinates           right-handed")) << text;
  EXPECT_EQ(report_json(r)["lights"]["environment"], nullptr);
}

TEST_F(SceneReportTest, Gltf) {
  const SceneReport r =
      report_scene(write("scene.gltf", R"({"asset":{"version":"2.0"},
    "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
                                       "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"
                                       R"("}],
    "bufferViews":[{"buffer":0,"byteLength":36}],
    "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
    "materials":[{}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
    "nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]})"));
  EXPECT_EQ(r.format, SceneFormat::Gltf);
  EXPECT_EQ(r.own.triangles + r.placed.triangles, 1u);
  EXPECT_EQ(r.bounds.hi, glm::vec3(1, 1, 0));
  EXPECT_TRUE(r.environment);
  EXPECT_EQ(r.warnings.size(), 2u);  // no camera, no light
}

TEST_F(SceneReportTest, ObjAndPly) {
  write("scene.mtl", "newmtl brick\nmap_Kd brick.png\n");
  write_png("brick.png", 3, 2);
  const SceneReport obj = report_scene(write("scene.obj",
                                             "mtllib scene.mtl\nusemtl brick\nv 0 0 0\nv 2 0 0\n"
                                             "v 2 2 0\nv 0 2 0\nf 1 2 3 4\n"));
  EXPECT_EQ(obj.format, SceneFormat::Obj);
  EXPECT_EQ(obj.own.triangles, 2u);
  EXPECT_EQ(obj.own.vertices, 4u);
  ASSERT_EQ(obj.images.size(), 1u);
  EXPECT_EQ(obj.images[0].width, 3);
  const SceneReport ply =
      report_scene(write("scene.ply",
                         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                         "property float y\nproperty float z\nelement face 1\n"
                         "property list uchar int vertex_indices\nend_header\n"
                         "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  EXPECT_EQ(ply.format, SceneFormat::Ply);
  EXPECT_EQ(ply.own.triangles, 1u);
}

TEST_F(SceneReportTest, BuiltinScenes) {
  const SceneReport r = report_scene("cornell");
  EXPECT_EQ(r.format, SceneFormat::Builtin);
  EXPECT_EQ(r.own.triangles, 36u);
  EXPECT_EQ(r.emitters.counts.triangles, 2u);
  EXPECT_TRUE(has_line(report_text(r), "  coordinates           right-handed"));
}

TEST_F(SceneReportTest, EnvironmentMaps) {
  write_png("sky.png", 4, 2);
  write("broken.png", "");
  const auto scene = [&](const std::string& file) {
    return report_scene(
        write("scene.pbrt", "WorldBegin\nLightSource \"infinite\" \"string mapname\" \"" + file +
                                "\"\nShape \"sphere\"\n"));
  };
  const SceneReport good = scene("sky.png");
  ASSERT_TRUE(good.environment);
  EXPECT_EQ(good.environment->image.width, 4);
  EXPECT_EQ(good.environment->image.height, 2);
  EXPECT_EQ(good.environment->image.file, "sky.png");
  EXPECT_NEAR(good.environment->mean_radiance.x, 0.2159f, 1e-3f);  // sRGB 128
  const SceneReport bad = scene("broken.png");
  ASSERT_TRUE(bad.environment);
  expect_one_line_with(bad.environment->image.error, "broken.png");
  EXPECT_NE(report_text(bad).find("not read"), std::string::npos);
  EXPECT_TRUE(report_json(bad)["lights"]["environment"]["image"].contains("error"));
}

TEST_F(SceneReportTest, ScenesThatCannotBeRead) {
  expect_one_line_with(error_of([] { report_scene("nosuch.pbrt"); }), "no such scene file");
  const std::string file = write("bad.pbrt", "WorldBegin\nShape\n");
  expect_one_line_with(error_of([&] { report_scene(file); }), "bad.pbrt:");
}

}  // namespace
}  // namespace lockstep::test_scene_report
