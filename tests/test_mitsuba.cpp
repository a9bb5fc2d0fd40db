// The Mitsuba reader: documents, transforms and views.
#include "tests/t_mitsuba.h"

#include <glm/trigonometric.hpp>

#include <cmath>
#include <iterator>
#include <string>

namespace lockstep::test_mitsuba {
namespace {

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
  expect_one_line_with(error_of("\n<shape type=\"$x\"/>"),
                       "scene.xml:3: the parameter $x has no value");
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
  expect_one_line_with(
      error_of("<default name=\"r\" value=\"0.25\"/><include filename=\"sub/part.xml\"/>"),
      "sub/part.xml:2: sub/a.obj:1: ");
}

TEST_F(Mitsuba, IncludesThatNeverEndAreRefused) {
  write("loop.xml", "<scene version=\"3.0.0\">\n<include filename=\"loop.xml\"/></scene>");
  expect_one_line_with(error_of("<include filename=\"loop.xml\"/>"), "loop.xml:2: the file");
  // Files that each include the next one ten times.
  const char* names[] = {"a.xml", "b.xml", "c.xml", "d.xml", "e.xml", "f.xml", "g.xml"};
  for (size_t i = 0; i + 1 < std::size(names); ++i) {
    std::string text = "<scene version=\"3.0.0\">";
    for (int k = 0; k < 10; ++k)
      text.append("<include filename=\"").append(names[i + 1]).append("\"/>");
    write(names[i], text + "</scene>");
  }
  write("g.xml", "<scene version=\"3.0.0\"/>");
  expect_one_line_with(error_of("<include filename=\"a.xml\"/>"), "too many files");
}

TEST_F(Mitsuba, BrokenXmlIsRefused) {
  const auto error_in = [&](const std::string& text) {
    return message_of([&] { read_mitsuba(write("x.xml", text)); });
  };
  EXPECT_EQ(error_in("<scene version=\"3.0.0\">\n<shape>\n</scene>").find("x.xml:3: is not proper"),
            0u);
  EXPECT_EQ(error_in("<bsdf type=\"diffuse\"/>").find("x.xml:1: expected <scene>"), 0u);
  EXPECT_EQ(error_in("").find("x.xml:1: "), 0u);
  EXPECT_THROW(read_mitsuba(path("absent.xml")), Error);
  EXPECT_THROW(read_mitsuba(directory_.string()), Error);

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
  expect_one_line_with(error_of(doubled), "a value is too long");
}

TEST_F(Mitsuba, DeepNestingIsRefused) {
  for (const int levels : {100, 10000, 300000}) {
    std::string text;
    for (int i = 0; i < levels; ++i) text += "<bsdf type=\"twosided\">";
    for (int i = 0; i < levels; ++i) text += "</bsdf>";
    expect_one_line_with(error_of(text), "nested more than");
  }
  // The same by references, round in a circle or not.
  std::string chain = "<bsdf type=\"twosided\" id=\"m0\"><ref id=\"m4999\"/></bsdf>";
  for (int i = 1; i < 5000; ++i) {
    chain += "<bsdf type=\"blendbsdf\" id=\"m" + std::to_string(i) + "\">";
    for (int k = 0; k < 2; ++k) chain += "<ref id=\"m" + std::to_string(i - 1) + "\"/>";
    chain += "</bsdf>";
  }
  expect_one_line_with(error_of(chain + with_bsdf("<ref id=\"m4999\"/>")), "nested too deeply");
  expect_one_line_with(
      error_of("<texture type=\"scale\" id=\"t\"><ref id=\"t\"/></texture>" +
               with_bsdf("<bsdf type=\"diffuse\"><ref name=\"reflectance\" id=\"t\"/></bsdf>")),
      "nested too deeply");
  expect_one_line_with(error_of("<shape type=\"sphere\"><ref id=\"nobody\"/></shape>"),
                       "scene.xml:2: there is no object with the id \"nobody\"");
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
  const auto expect_error = [&](const std::string& operation, const std::string& part) {
    expect_one_line_with(error_of("<shape type=\"cube\"><transform name=\"to_world\">\n" +
                                  operation + "</transform></shape>"),
                         part);
  };
  expect_error("<matrix value=\"1 2 3\"/>", "scene.xml:3: <matrix> needs 9 or 16");
  expect_error("<scale value=\"0\"/>", "cannot be inverted");
  expect_error("<scale value=\"nan\"/>", "beyond the range");
  expect_error("<scale value=\"1e300\"/>", "beyond the range");
  expect_error("<scale x=\"two\"/>", "expected a number, found \"two\"");
  expect_error("<rotate angle=\"3\"/>", "needs an axis");
  expect_error("<rotate x=\"1\"/>", "needs a number as its angle");
  expect_error("<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1\"/>", "projective");
  expect_error("<lookat origin=\"0,0,0\" target=\"0,0,0\"/>", "two distinct points");
  expect_error("<warp x=\"1\"/>", "is no transform");
}

// --- View

const std::string default_film =
    "<film type=\"hdrfilm\"><integer name=\"width\" value=\"200\"/>"
    "<integer name=\"height\" value=\"100\"/></film>";

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
  expect_one_line_with(
      error_of("<sensor type=\"perspective\"><float name=\"fov\" value=\"180\"/></sensor>"),
      "a fov between 0 and 180");
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
  expect_one_line_with(
      message_of(
          [&] { scene_with("perspective", "<integer name=\"crop_width\" value=\"201\"/>", ""); }),
      "the crop window");
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

  const auto with_filter = [&](const std::string& type, const std::string& parameters) {
    return read("<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"" + type +
                "\">" + parameters + "</rfilter></film></sensor>");
  };
  EXPECT_TRUE(warns(with_filter("round", ""), "<rfilter type=\"round\"> is not supported"));
  const PixelFilter lanczos =
      with_filter("lanczos", "<integer name=\"lobes\" value=\"2\"/>").film.filter;
  EXPECT_EQ(lanczos.kind, PixelFilter::Kind::Lanczos);
  EXPECT_EQ(lanczos.radius, glm::vec2(2.0f));
  EXPECT_EQ(lanczos.tau, 2.0f);
  EXPECT_EQ(with_filter("lanczos", "").film.filter.tau, 3.0f);
  const PixelFilter mitchell =
      with_filter("mitchell", "<float name=\"C\" value=\"0.25\"/>").film.filter;
  EXPECT_EQ(mitchell.kind, PixelFilter::Kind::Mitchell);
  EXPECT_EQ(mitchell.radius, glm::vec2(2.0f));
  EXPECT_FLOAT_EQ(mitchell.b, 1.0f / 3.0f);
  EXPECT_EQ(mitchell.c, 0.25f);
  const PixelFilter catmull_rom = with_filter("catmullrom", "").film.filter;
  EXPECT_EQ(catmull_rom.b, 0.0f);
  EXPECT_EQ(catmull_rom.c, 0.5f);
  expect_one_line_with(
      message_of([&] { with_filter("mitchell", "<float name=\"B\" value=\"9\"/>"); }),
      "needs B and C between -2 and 2");
  expect_one_line_with(
      error_of("<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" "
               "value=\"1000000\"/></film></sensor>"),
      "<film> needs a width");
}

}  // namespace
}  // namespace lockstep::test_mitsuba
