// Textures of pbrt files.
#include "tests/t_pbrt.h"

#include <cmath>
#include <string>

namespace lockstep::test_pbrt_textures {
namespace {

class PbrtTextures : public Pbrt {
 protected:
  // The texture "t" of `type` with the parameters `rest`, as a diffuse surface's reflectance.
  SceneDescription read_texture(const std::string& type, const std::string& rest,
                                const std::string& before = "",
                                const std::string& value = "spectrum",
                                const std::string& header = "") const {
    const std::string use = value == "float" ? "Material \"matte\" \"texture sigma\" \"t\""
                                             : "Material \"diffuse\" \"texture reflectance\" \"t\"";
    return read(header + "WorldBegin\n" + before + "Texture \"t\" \"" + value + "\" \"" + type +
                "\" " + rest + "\n" + use + " " + triangle);
  }
  static const ColorInput& reflectance(const SceneDescription& scene) {
    return model_of<DiffuseMaterial>(scene).reflectance;
  }
  static const FloatInput& sigma(const SceneDescription& scene) {
    return model_of<DiffuseMaterial>(scene).sigma;
  }
};

TEST_F(PbrtTextures, ImagesOfV4) {
  const SceneDescription scene = read_texture(
      "imagemap", R"("string filename" "wood.png" "float scale" .5 "string wrap" "clamp"
      "string filter" "trilinear" "string encoding" "linear")");
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(reflectance(scene), ColorInput(glm::vec3(0.5f), 0));
  const ImageTexture& image = image_of(scene);
  EXPECT_EQ(image.file, path("wood.png"));
  EXPECT_EQ(image.where, path("scene.pbrt") + ":2");
  EXPECT_EQ(image.wrap_u, TextureWrap::Clamp);
  EXPECT_EQ(image.wrap_v, TextureWrap::Clamp);
  EXPECT_EQ(image.filter, TextureFilter::Trilinear);
  EXPECT_EQ(image.encoding, TextureEncoding::Linear);
  EXPECT_FALSE(image.invert);
  EXPECT_TRUE(scene.warnings.empty());

  const SceneDescription plain = read_texture("imagemap", "\"string filename\" \"a.png\"");
  EXPECT_EQ(image_of(plain).wrap_u, TextureWrap::Repeat);
  EXPECT_EQ(image_of(plain).filter, TextureFilter::Bilinear);
  EXPECT_EQ(image_of(plain).encoding, TextureEncoding::ByFormat);
  const SceneDescription other = read_texture("imagemap", R"("string filename" "a.png"
      "string wrap" "black" "string filter" "point" "string encoding" "gamma 1.8" "bool invert" true)");
  EXPECT_EQ(image_of(other).wrap_v, TextureWrap::Black);
  EXPECT_EQ(image_of(other).filter, TextureFilter::Nearest);
  EXPECT_EQ(image_of(other).encoding, TextureEncoding::Gamma);
  EXPECT_FLOAT_EQ(image_of(other).gamma, 1.8f);
  EXPECT_TRUE(image_of(other).invert);
}

TEST_F(PbrtTextures, ImagesOfV3AndV2) {
  const std::string v3 = "Film \"image\" ", v2 = "SurfaceIntegrator \"path\" ";
  const auto image = [&](const std::string& header, const std::string& rest) {
    return image_of(
        read_texture("imagemap", "\"string filename\" \"a.png\" " + rest, "", "color", header));
  };
  EXPECT_EQ(image(v3, "").encoding, TextureEncoding::ByFormat);
  for (const std::string& header : {v3, v2}) {
    EXPECT_EQ(image(header, "").filter, TextureFilter::Trilinear) << "ewa";
    EXPECT_EQ(image(header, "\"bool trilinear\" true").filter, TextureFilter::Trilinear);
  }
  EXPECT_EQ(image(v3, "\"bool gamma\" false").encoding, TextureEncoding::Linear);
  EXPECT_EQ(image(v3, "\"bool gamma\" true").encoding, TextureEncoding::Srgb);
  EXPECT_EQ(image(v2, "").encoding, TextureEncoding::Linear);
  const ImageTexture gamma = image(v2, "\"float gamma\" 2.2");
  EXPECT_EQ(gamma.encoding, TextureEncoding::Gamma);
  EXPECT_FLOAT_EQ(gamma.gamma, 2.2f);
}

// pbrt's v points up from an image's lower left corner, ours down from its upper left one.
TEST_F(PbrtTextures, ImagesAreTurnedOver) {
  const auto at = [](const ImageTexture& image, glm::vec2 uv) {
    return glm::vec2(glm::dot(image.uv.u_row, uv), glm::dot(image.uv.v_row, uv)) + image.uv.offset;
  };
  const SceneDescription plain = read_texture("imagemap", "\"string filename\" \"a.png\"");
  EXPECT_EQ(at(image_of(plain), {0.25f, 0.0f}), glm::vec2(0.25f, 1.0f));
  EXPECT_EQ(at(image_of(plain), {0.5f, 0.75f}), glm::vec2(0.5f, 0.25f));
  const SceneDescription moved = read_texture("imagemap", R"("string filename" "a.png"
      "float uscale" 2 "float vscale" 4 "float udelta" .5 "float vdelta" .25)");
  // pbrt's (2 u + 0.5, 4 v + 0.25), turned over.
  EXPECT_EQ(at(image_of(moved), {0.125f, 0.0625f}), glm::vec2(0.75f, 0.5f));
}

TEST_F(PbrtTextures, Checkerboards) {
  const SceneDescription scene = read_texture(
      "checkerboard", R"("rgb tex1" [1 0 0] "texture tex2" "b" "float uscale" 4 "float vscale" 8
      "float vdelta" .5)",
      "Texture \"b\" \"spectrum\" \"imagemap\" \"string filename\" \"b.png\"\n");
  ASSERT_EQ(scene.textures.size(), 2u);
  EXPECT_EQ(reflectance(scene).texture, 1);
  const auto& board = std::get<CheckerboardTexture>(scene.textures[1]);
  EXPECT_EQ(board.even, ColorInput(glm::vec3(1, 0, 0)));
  EXPECT_EQ(board.odd, ColorInput(glm::vec3(1.0f), 0));
  EXPECT_EQ(board.uv.u_row, glm::vec2(4, 0));
  EXPECT_EQ(board.uv.v_row, glm::vec2(0, 8));
  EXPECT_EQ(board.uv.offset, glm::vec2(0, 0.5f));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(PbrtTextures, ProductsAndMixes) {
  const std::string images =
      "Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\" \"float scale\" .5\n"
      "Texture \"f\" \"float\" \"imagemap\" \"string filename\" \"f.png\"\n"
      "Texture \"c\" \"spectrum\" \"constant\" \"rgb value\" [.2 .4 .6]\n";
  const auto make = [&](const std::string& type, const std::string& rest) {
    return read_texture(type, rest, images);
  };
  // A constant factor needs no texture of its own.
  const SceneDescription scaled = make("scale", "\"texture tex\" \"a\" \"float scale\" .5");
  EXPECT_EQ(scaled.textures.size(), 1u);
  EXPECT_EQ(reflectance(scaled), ColorInput(glm::vec3(0.25f), 0));
  const SceneDescription v3 = make("scale", "\"texture tex1\" \"a\" \"texture tex2\" \"c\"");
  EXPECT_EQ(v3.textures.size(), 1u);
  expect_near(reflectance(v3).value, {.1f, .2f, .3f});
  const SceneDescription both = make("scale", "\"texture tex\" \"a\" \"texture scale\" \"f\"");
  ASSERT_EQ(both.textures.size(), 3u);
  EXPECT_EQ(std::get<ProductTexture>(both.textures[2]).a, ColorInput(glm::vec3(0.5f), 0));
  EXPECT_EQ(std::get<ProductTexture>(both.textures[2]).b, ColorInput(glm::vec3(1.0f), 1));
  const SceneDescription mix =
      make("mix", "\"texture tex1\" \"a\" \"rgb tex2\" [1 0 0] \"texture amount\" \"f\"");
  ASSERT_EQ(mix.textures.size(), 3u);
  const auto& texture = std::get<MixTexture>(mix.textures[2]);
  EXPECT_EQ(texture.a, ColorInput(glm::vec3(0.5f), 0));
  EXPECT_EQ(texture.b, ColorInput(glm::vec3(1, 0, 0)));
  EXPECT_EQ(texture.amount.texture, 1);
  const SceneDescription constants = make("mix", "\"rgb tex1\" [0 0 0] \"float amount\" .25");
  EXPECT_TRUE(constants.textures.empty());
  EXPECT_EQ(reflectance(constants), ColorInput(glm::vec3(0.25f)));
}

TEST_F(PbrtTextures, NumbersHaveNamesOfTheirOwn) {
  const SceneDescription scene = read_texture(
      "imagemap", "\"string filename\" \"f.png\" \"float scale\" 30",
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"c.png\"\n", "float");
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(image_of(scene).file, path("f.png"));
  EXPECT_FLOAT_EQ(sigma(scene).value, 30.0f);
  EXPECT_EQ(sigma(scene).texture, 0);
  EXPECT_EQ(sigma(scene).channel, -1);
  EXPECT_EQ(
      error_of("WorldBegin\nTexture \"f\" \"float\" \"constant\"\nMaterial \"diffuse\"\n\"texture "
               "reflectance\" \"f\"\n" +
               triangle),
      "scene.pbrt:4: the spectrum texture \"f\" has not been defined; there is a float texture "
      "of that name");
}

TEST_F(PbrtTextures, NamesMeanWhatWasDeclaredBefore) {
  const SceneDescription scene = read_world(R"(
    Texture "t" "spectrum" "constant" "rgb value" [1 0 0]
    Material "diffuse" "texture reflectance" "t" Shape "sphere"
    Texture "t" "spectrum" "scale" "texture tex" "t" "float scale" .5
    Material "diffuse" "texture reflectance" "t" Shape "sphere"
    Material "diffuse" "texture reflectance" "later" Shape "sphere"
    Texture "later" "spectrum" "constant" "rgb value" [0 1 0])");
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 0).reflectance, ColorInput(glm::vec3(1, 0, 0)));
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 1).reflectance, ColorInput(glm::vec3(.5f, 0, 0)));
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 2).reflectance, ColorInput(glm::vec3(0, 1, 0)));
}

TEST_F(PbrtTextures, UnusedOnesAreLeftOut) {
  const SceneDescription scene = read_world(
      "Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\"\n"
      "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" \"texture reflectance\" \"a\"\n" +
      triangle);
  EXPECT_TRUE(scene.textures.empty());
  EXPECT_EQ(scene.materials.size(), 1u);
}

TEST_F(PbrtTextures, OthersGiveTheirMean) {
  struct Case {
    const char *type, *rest;
    float mean;
  };
  for (const Case& c :
       {Case{"bilerp", "\"float v00\" .2 \"float v11\" .6", 0.45f},
        Case{"dots", "\"float inside\" 1 \"float outside\" .3", 0.3f},
        Case{"directionmix", "\"float tex1\" .2 \"float tex2\" .4", 0.3f},
        Case{"checkerboard", "\"integer dimension\" 3 \"float tex1\" .6", 0.3f},
        Case{"fbm", "\"integer octaves\" 4", 0.0f}, Case{"wrinkled", "", 0.5f},
        Case{"marble", "\"float variation\" .1", 0.8f}, Case{"windy", "", 0.0f},
        Case{"ptex", "\"string filename\" \"a.ptx\"", 0.5f}, Case{"plaid", "", 0.5f}}) {
    const SceneDescription scene = read_texture(c.type, c.rest);
    EXPECT_TRUE(scene.textures.empty()) << c.type;
    EXPECT_NEAR(reflectance(scene).value.y, c.mean, 1e-6f) << c.type;
    EXPECT_TRUE(warns(scene, "scene.pbrt:2: Texture \"" + std::string(c.type) + "\"")) << c.type;
    EXPECT_EQ(scene.warnings.size(), 1u) << c.type;
  }
}

TEST_F(PbrtTextures, WhatImagesCannotDoWarns) {
  const auto warning = [&](const std::string& rest) {
    const SceneDescription scene =
        read_texture("imagemap", "\"string filename\" \"a.png\" " + rest);
    return scene.warnings.size() == 1 ? scene.warnings[0] : "";
  };
  const auto contains = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(contains(warning("\"string mapping\" \"spherical\""), "the mapping \"spherical\""));
  EXPECT_TRUE(contains(warning("\"string wrap\" \"octahedralsphere\""), "the image repeats"));
  EXPECT_TRUE(contains(warning("\"string filter\" \"best\""), "bilinear is used"));
  EXPECT_TRUE(contains(warning("\"string encoding\" \"log\""), "the file's format decides"));
  EXPECT_TRUE(contains(warning("\"float scale\" 2 \"bool invert\" true"), "inverted before"));
}

TEST_F(PbrtTextures, RoughnessFollowsTheRemapping) {
  const std::string texture =
      "Texture \"r\" \"float\" \"imagemap\" \"string filename\" \"r.png\" \"float scale\" .25\n";
  const auto conductor = [&](const std::string& material) {
    return read_world(texture + material + "\n" + triangle);
  };
  const SceneDescription v4 = conductor("Material \"conductor\" \"texture roughness\" \"r\"");
  const auto& root = model_of<ConductorMaterial>(v4);
  EXPECT_EQ(root.alpha, glm::vec2(1.0f));
  EXPECT_FLOAT_EQ(root.alpha_scale.value, 0.5f);
  EXPECT_FLOAT_EQ(root.alpha_scale.power, 0.5f);
  EXPECT_TRUE(v4.warnings.empty());
  const SceneDescription linear = conductor(
      "Material \"coateddiffuse\" \"texture roughness\" \"r\" \"bool remaproughness\" false");
  EXPECT_FLOAT_EQ(model_of<CoatedMaterial>(linear).alpha_scale.value, 0.25f);
  EXPECT_FLOAT_EQ(model_of<CoatedMaterial>(linear).alpha_scale.power, 1.0f);
  const SceneDescription v3 = conductor("Material \"plastic\" \"texture roughness\" \"r\"");
  EXPECT_TRUE(warns(v3, "power law"));
  // The power law against the polynomial, as plastic of constant roughness has it.
  const FloatInput& law = model_of<CoatedMaterial>(v3).alpha_scale;
  for (const float roughness : {0.01f, 0.03f, 0.1f, 0.3f}) {
    const SceneDescription constant = read_world("Material \"plastic\" \"float roughness\" " +
                                                 std::to_string(roughness) + "\n" + triangle);
    const float exact = model_of<CoatedMaterial>(constant).alpha;
    const float close = law.value * std::pow(roughness / 0.25f, law.power);
    EXPECT_NEAR(close / exact, 1.0f, 0.15f) << roughness;
  }
}

TEST_F(PbrtTextures, AlphaCutsACopyOfTheMaterial) {
  const SceneDescription scene = read_world(R"(
    Texture "leaf" "float" "imagemap" "string filename" "leaf.png"
    Material "diffuse" Shape "sphere"
    Shape "sphere" "texture alpha" "leaf" Shape "sphere" "texture alpha" "leaf"
    Shape "sphere" "float alpha" .25 Shape "sphere" "float alpha" 1)");
  const auto opacity = [&](size_t shape) {
    return scene.materials.at(scene.shapes.at(shape).material).opacity;
  };
  ASSERT_EQ(scene.shapes.size(), 5u);
  EXPECT_EQ(opacity(0), FloatInput(1.0f));
  EXPECT_EQ(opacity(1).texture, 0);
  EXPECT_EQ(scene.shapes[1].material, scene.shapes[2].material);
  EXPECT_EQ(opacity(3), FloatInput(0.25f));
  EXPECT_EQ(scene.shapes[0].material, scene.shapes[4].material);
  EXPECT_EQ(scene.materials.size(), 3u);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(PbrtTextures, NormalAndBumpMaps) {
  const SceneDescription scene = read_world(R"(
    Texture "d" "float" "imagemap" "string filename" "d.png" "float scale" .01
    Material "diffuse" "string normalmap" "n.png" Shape "sphere"
    Material "diffuse" "texture displacement" "d" Shape "sphere"
    Material "matte" "texture bumpmap" "d" Shape "sphere")");
  const Material& normal = scene.materials.at(0);
  ASSERT_GE(normal.normal_map, 0);
  EXPECT_EQ(image_of(scene, normal.normal_map).file, path("n.png"));
  EXPECT_EQ(image_of(scene, normal.normal_map).encoding, TextureEncoding::Linear);
  EXPECT_EQ(image_of(scene, normal.normal_map).uv.v_row, glm::vec2(0, -1));
  for (int i : {1, 2}) {
    ASSERT_TRUE(scene.materials.at(i).bump);
    EXPECT_FLOAT_EQ(scene.materials.at(i).bump->value, 0.01f);
    EXPECT_GE(scene.materials.at(i).bump->texture, 0);
  }
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(PbrtTextures, BrokenTexturesSayWhereAndWhat) {
  const auto broken = [&](const std::string& text) {
    return error_of("WorldBegin\n" + text + triangle);
  };
  const std::string use = "Material \"diffuse\"\n\"texture reflectance\" \"t\" ";
  const std::string head = "Texture \"t\" \"spectrum\" ";
  EXPECT_EQ(broken(use), "scene.pbrt:3: the spectrum texture \"t\" has not been defined");
  EXPECT_EQ(
      broken("Texture \"t\" \"colour\" \"constant\"" + use),
      "scene.pbrt:2: Texture \"t\" is of the type \"colour\"; it must be spectrum, color or float");
  EXPECT_EQ(broken(head + "\"imagemap\" " + use),
            "scene.pbrt:2: Texture \"imagemap\" needs \"string filename\"");
  EXPECT_EQ(broken(head + "\"scale\" \"texture tex\" \"t\" " + use),
            "scene.pbrt:2: the texture \"t\" refers to itself");
  EXPECT_EQ(broken(head +
                   "\"scale\" \"texture tex\" \"s\"\nTexture \"s\" \"spectrum\" \"mix\" "
                   "\"texture tex1\" \"t\" " +
                   use),
            "scene.pbrt:3: the texture \"t\" refers to itself");
  std::string chain = "Texture \"0\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\"\n";
  for (int i = 1; i <= 100000; ++i) {
    chain += "Texture \"" + std::to_string(i) + "\" \"spectrum\" \"scale\" \"texture tex\" \"" +
             std::to_string(i - 1) + "\"\n";
  }
  EXPECT_NE(broken(chain + "Material \"diffuse\" \"texture reflectance\" \"100000\"")
                .find("is referred to through more than 64 others"),
            std::string::npos);
}

}  // namespace
}  // namespace lockstep::test_pbrt_textures
