// The pbrt reader: the language, the view, and broken files.
#include "tests/t_pbrt.h"

#include <glm/geometric.hpp>

#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace lockstep::test_pbrt {
namespace {

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
  const SceneDescription other = read("PixelFilter \"sync\" WorldBegin");
  EXPECT_EQ(other.film.filter.kind, PixelFilter::Kind::Gaussian);
  EXPECT_TRUE(warns(other, "scene.pbrt:1: PixelFilter \"sync\" is not supported"));
}

TEST_F(Pbrt, PixelFiltersWithNegativeLobes) {
  const auto filter = [&](const std::string& text) {
    return read(text + " WorldBegin").film.filter;
  };
  for (const std::string film : {"", " Film \"image\""}) {
    const PixelFilter mitchell = filter("PixelFilter \"mitchell\"" + film);
    EXPECT_EQ(mitchell.kind, PixelFilter::Kind::Mitchell);
    EXPECT_EQ(mitchell.radius, glm::vec2(2.0f));
    EXPECT_FLOAT_EQ(mitchell.b, 1.0f / 3.0f);
    EXPECT_FLOAT_EQ(mitchell.c, 1.0f / 3.0f);
    const PixelFilter sinc = filter("PixelFilter \"sinc\"" + film);
    EXPECT_EQ(sinc.kind, PixelFilter::Kind::Lanczos);
    EXPECT_EQ(sinc.radius, glm::vec2(4.0f));
    EXPECT_FLOAT_EQ(sinc.tau, 3.0f);
  }
  const PixelFilter sharp = filter("PixelFilter \"mitchell\" \"float B\" 0 \"float C\" .5");
  EXPECT_EQ(sharp.b, 0.0f);
  EXPECT_EQ(sharp.c, 0.5f);
  const PixelFilter narrow =
      filter("PixelFilter \"sinc\" \"float xwidth\" 3 \"float tau\" 2 Film \"image\"");
  EXPECT_EQ(narrow.radius, glm::vec2(3.0f, 4.0f));
  EXPECT_EQ(narrow.tau, 2.0f);
  expect_one_line_with(error_of("PixelFilter \"mitchell\" \"float B\" 9 WorldBegin"),
                       "needs B between -2 and 2");
  expect_one_line_with(error_of("PixelFilter \"sinc\" \"float tau\" 0 WorldBegin"),
                       "needs a tau above 0");
  // v2's sinc has another window.
  EXPECT_TRUE(warns(read("PixelFilter \"sinc\" SurfaceIntegrator \"path\" WorldBegin WorldEnd"),
                    "PixelFilter \"sinc\" is not supported"));
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
  EXPECT_FLOAT_EQ(scene.camera.lens_radius, 0.1f);
  EXPECT_FLOAT_EQ(scene.camera.focal_distance, 3.0f);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Pbrt, CameraTransformsComposeAsInPbrt) {
  const SceneDescription scene =
      read("Scale -1 1 1 Translate 0 0 5 Camera \"perspective\" WorldBegin");
  // The world point (0, 0, -5) is the eye; +x of the world is to the left.
  expect_near(glm::vec3(scene.camera.camera_to_world[3]), {0, 0, -5});
  expect_near(glm::vec3(scene.camera.camera_to_world[0]), {-1, 0, 0});
}

// A scaled camera space: its lengths are turned into the world's.
TEST_F(Pbrt, OrthographicCamerasAndScaledOnes) {
  const SceneDescription scene = read(R"(
    Scale .5 .5 .5 Film "rgb" "integer xresolution" 300 "integer yresolution" 100
    Camera "orthographic" "float screenwindow" [-3 9 -2 2] "float lensradius" 1
      "float focaldistance" 4 WorldBegin)");
  const CameraDescription& camera = scene.camera;
  EXPECT_EQ(camera.projection, CameraDescription::Projection::Orthographic);
  expect_near(glm::vec3(camera.camera_to_world[0]), {1, 0, 0});
  EXPECT_FLOAT_EQ(camera.extent, 8.0f);
  EXPECT_FLOAT_EQ(camera.lens_radius, 2.0f);
  EXPECT_FLOAT_EQ(camera.focal_distance, 8.0f);
  EXPECT_FLOAT_EQ(camera.shift.x, 0.75f);
  EXPECT_FLOAT_EQ(camera.shift.y, 0.0f);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Pbrt, ScreenWindowsNarrowTheView) {
  const std::string square =
      "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100\n";
  const auto camera = [&](const std::string& more) {
    return read(square + "Camera \"perspective\" " + more + " WorldBegin");
  };
  const SceneDescription corner = camera("\"float screenwindow\" [0 .5 -.5 0]");
  EXPECT_NEAR(corner.camera.fov_degrees, 2.0f * 14.036243f, 1e-4f);  // atan(1/4)
  EXPECT_FLOAT_EQ(corner.camera.shift.x, 0.5f);
  EXPECT_FLOAT_EQ(corner.camera.shift.y, -0.5f);
  EXPECT_TRUE(corner.warnings.empty());
  EXPECT_NEAR(camera("\"float frameaspectratio\" 1").camera.fov_degrees, 90.0f, 1e-4f);
  const SceneDescription stretched = camera("\"float frameaspectratio\" 2");
  EXPECT_NEAR(stretched.camera.fov_degrees, 90.0f, 1e-4f);
  EXPECT_TRUE(warns(stretched, "scene.pbrt:2: Camera: pixels that are not square"));
}

TEST_F(Pbrt, OtherCamerasAndIntegratorsWarn) {
  const SceneDescription scene = read(
      "Camera \"spherical\"\nIntegrator \"bdpt\"\n"
      "Film \"rgb\" \"float cropwindow\" [0 .5 0 1]\nWorldBegin");
  EXPECT_TRUE(warns(scene, "scene.pbrt:1: Camera \"spherical\" is not supported"));
  EXPECT_TRUE(warns(scene, ":2: Integrator \"bdpt\": the scene is rendered with the path tracer"));
  EXPECT_TRUE(warns(scene, ":3: Film: a part of the image is not supported"));
  EXPECT_EQ(scene.warnings.size(), 3u);
}

TEST_F(Pbrt, DirectivesOfV2) {
  const SceneDescription scene = read(R"(
    Renderer "sampler" VolumeIntegrator "emission" SurfaceIntegrator "path" "integer maxdepth" 7
    Sampler "stratified" "integer xsamples" 3 "integer ysamples" 5
    WorldBegin Volume "homogeneous" "color sigma_a" [1 1 1] WorldEnd)");
  EXPECT_EQ(scene.film.width, 640);
  EXPECT_EQ(scene.defaults.depth, 7);
  EXPECT_EQ(scene.defaults.spp, 15);
  EXPECT_TRUE(warns(scene, ":4: volumes are not supported"));
  EXPECT_EQ(scene.warnings.size(), 1u);
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

// --- What is not supported

TEST_F(Pbrt, UnsupportedThingsWarnOncePerKind) {
  const SceneDescription scene = read_world(
      "Material \"velvet\" Shape \"sphere\"\nMaterial \"velvet\" Shape \"cone\"\nShape \"cone\"\n"
      "LightSource \"laser\" LightSource \"laser\"\n"
      "Shape \"sphere\" \"float shadowalpha\" 0.5 \"string note\" \"x\"\n"
      "ColorSpace \"rec2020\"\n"
      "ActiveTransform EndTime Translate 9 9 9 ActiveTransform All Shape \"sphere\"\n");
  EXPECT_TRUE(warns(scene, ":2: Material \"velvet\" is not supported; a diffuse grey is used"));
  EXPECT_TRUE(warns(scene, ":3: Shape \"cone\" is not supported"));
  EXPECT_TRUE(warns(scene, ":5: LightSource \"laser\" is not supported"));
  EXPECT_TRUE(warns(scene, ":6: Shape \"sphere\": the parameter \"float shadowalpha\""));
  EXPECT_TRUE(warns(scene, ":6: Shape \"sphere\": the parameter \"string note\""));
  EXPECT_TRUE(warns(scene, ":7: ColorSpace \"rec2020\""));
  EXPECT_TRUE(warns(scene, ":8: motion"));
  EXPECT_EQ(scene.warnings.size(), 7u);
  ASSERT_EQ(scene.shapes.size(), 3u);
  expect_near(sphere_of(scene, 2).center, {0, 0, 0});
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 0).reflectance, glm::vec3(0.5f));
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
      {"Camera \"perspective\" \"float screenwindow\" [0 1]", "must have four values"},
      {"Camera \"perspective\" \"float screenwindow\" [1 0 0 1]", "x from, x to, y from, y to"},
      {"Camera \"perspective\" \"float frameaspectratio\" 0", "frameaspectratio between"},
      {"Camera \"perspective\" \"float lensradius\" -1", "needs a lensradius of 0 or more"},
      {"Camera \"perspective\" \"float lensradius\" 1 \"float focaldistance\" 0",
       "needs a focaldistance above 0"},
      {"Sampler \"stratified\" \"integer xsamples\" 100000", "xsamples and ysamples"},
      {world + "ObjectInstance \"x\"", "scene.pbrt:2: the object \"x\" has not been defined"},
      {world + "ObjectBegin \"x\"\nObjectBegin \"y\"", ":3: ObjectBegin inside another object"},
      {world + "ObjectBegin \"x\"\nObjectInstance \"x\"", ":3: ObjectInstance inside an object"},
      {world + "ObjectBegin \"x\"\n", ":2: ObjectBegin is never closed"},
      {world + "ObjectBegin \"x\" AttributeBegin ObjectEnd", "does not close the AttributeBegin"},
      {world + "MakeNamedMedium \"x\"", ":2: MakeNamedMedium \"x\" needs \"string type\""},
      {world + "MediumInterface \"x\" \"\" Material \"dielectric\"\n" + triangle,
       "scene.pbrt:3: the medium \"x\" has not been defined"},
      {world + "Shape \"disk\" \"float innerradius\" 1", "innerradius from 0 to below the radius"},
      {world + "Shape \"cylinder\" \"float phimax\" 0", "needs a phimax above 0"},
      {world + "Shape \"cylinder\" \"float zmax\" -1", "needs zmin and zmax that differ"},
      {world + "Shape \"sphere\" \"texture alpha\" [\"a\" \"b\"]", "must have one value"},
      {world + "Shape \"sphere\"\n\"texture alpha\" \"a\"",
       "the float texture \"a\" has not been defined"},
      {world + "LightSource \"distant\" \"point from\" [0 0 1]", "needs two distinct points"},
      {world + "LightSource \"point\" \"point from\" [0 0 1 1 1 1]", "must have three values"},
      {world + "LightSource \"point\" \"rgb I\" [1e38 1 1] \"float scale\" 1e9", "brighter than"},
      {world + "LightSource \"infinite\" \"string mapname\" [\"a\" \"b\"]", "must name one image"},
      {world + "AreaLightSource \"diffuse\" \"string filename\" \"a.exr\" \"rgb L\" [1 1 1]",
       "both \"L\" and \"filename\""},
  };
  for (const Case& c : cases) expect_one_line_with(error_of(c.text), c.message);
  EXPECT_THROW(read_pbrt(path("absent.pbrt")), Error);
  EXPECT_THROW(read_pbrt(directory_.string()), Error);
}

// Everything that the language has, for what follows to damage.
const char* everything = R"(
Film "rgb" "integer xresolution" [32] "float cropwindow" [0 1 0 1] Sampler "stratified" "integer xsamples" 2
LookAt 1 2 3 0 0 0 0 1 0 Camera "orthographic" "float screenwindow" [-1 1 -1 1] "float lensradius" 1
PixelFilter "gaussian" "float sigma" .5 Integrator "path" "integer maxdepth" 3 ColorSpace "srgb"
WorldBegin
Texture "a" "spectrum" "imagemap" "string filename" "a.png" "string wrap" "clamp" "float vscale" 2
Texture "b" "float" "imagemap" "string filename" "b.png" "bool invert" true "string encoding" "gamma 2.2"
Texture "c" "spectrum" "checkerboard" "texture tex1" "a" "rgb tex2" [1 0 0] "integer dimension" 2
Texture "d" "spectrum" "mix" "texture tex1" "c" "texture tex2" "a" "texture amount" "b"
Texture "e" "spectrum" "scale" "texture tex" "d" "texture scale" "b"
MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [1 2 3] "rgb sigma_s" [0 0 0]
MakeNamedMaterial "x" "string type" "coateddiffuse" "texture reflectance" "e" "texture roughness" "b"
MakeNamedMaterial "y" "string type" "dielectric" "spectrum eta" "glass-BK7" "float roughness" .1
MakeNamedMaterial "z" "string type" "mix" "string materials" ["x" "y"] "texture amount" "b"
AttributeBegin MediumInterface "m" "" NamedMaterial "z" Shape "sphere" "texture alpha" "b" AttributeEnd
Material "uber" "rgb Kt" [.1 .1 .1] "rgb Kr" [.1 .1 .1] "texture Kd" "a" Shape "disk" "float phimax" 90
Material "translucent" "texture Ks" "a" "texture reflect" "c" Shape "cylinder" "float zmax" 2
Material "disney" "texture color" "a" "string normalmap" "n.png" Rotate 30 1 2 3 Shape "sphere"
Material "substrate" "texture bumpmap" "b" Scale 1 2 3 Shape "sphere"
Material "subsurface" "rgb sigma_a" [1 2 3] Shape "disk"
Material "coatedconductor" "spectrum conductor.eta" "metal-Cu-eta" Shape "disk"
Material "metal" "rgb reflectance" [.1 .2 .3] "float uroughness" .1 Shape "disk"
ObjectBegin "o" Material "glass" Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "point2 uv" [0 0 1 0 0 1]
ObjectEnd AttributeBegin Translate 1 0 0 ObjectInstance "o" AttributeEnd ObjectInstance "o"
AreaLightSource "diffuse" "rgb L" [1 2 3] "float power" 5 "bool twosided" true
Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 1] Shape "loopsubdiv" "integer levels" 1
"point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]
LightSource "spot" "point3 from" [0 1 0] "point3 to" [0 0 0] "float coneangle" 40 "float power" 7
LightSource "distant" "blackbody L" 5000 "float illuminance" 2 LightSource "point" "spectrum I" [400 1 700 2]
LightSource "infinite" "string mapname" "sky.exr" Attribute "shape" "float alpha" .5
)";

// Swaps two of the text's words, or changes some of its characters, or cuts it short.
std::string damaged(std::string text, int way, std::mt19937& random) {
  if (way == 0) return text.substr(0, random() % text.size());
  if (way == 1) {
    for (int flips = 3; flips > 0; --flips) {
      text[random() % text.size()] = static_cast<char>(random() % 256);
    }
    return text;
  }
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) words.push_back(word);
  for (int swaps = way - 1; swaps > 0; --swaps) {
    std::swap(words[random() % words.size()], words[random() % words.size()]);
  }
  std::string joined;
  for (const std::string& word : words) joined += word + "\n";
  return joined;
}

TEST_F(Pbrt, DamagedFilesAreReadOrRefused) {
  const SceneDescription whole = read(everything);
  EXPECT_EQ(whole.shapes.size(), 10u);
  EXPECT_EQ(whole.instances.size(), 2u);
  std::mt19937 random(1);
  int refused = 0;
  constexpr int trials = 1500;
  for (int trial = 0; trial < trials; ++trial) {
    const std::string message = error_of(damaged(everything, trial % 4, random));
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    if (message.empty()) continue;
    ++refused;
    EXPECT_TRUE(message.starts_with("scene.pbrt:")) << message;
  }
  EXPECT_GT(refused, trials / 4);
  EXPECT_LT(refused, trials);
}

}  // namespace
}  // namespace lockstep::test_pbrt
