// Materials, textures and spectra of pbrt files.
#include "tests/t_pbrt.h"

#include <glm/geometric.hpp>

#include <sstream>
#include <string>
#include <vector>

namespace lockstep::test_pbrt_materials {
namespace {

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
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 0).reflectance, glm::vec3(.1f, .2f, .3f));
  const auto& coated = model_of<CoatedMaterial>(scene, 1);
  EXPECT_TRUE(coated.layered);
  EXPECT_EQ(coated.diffuse, glm::vec3(.4f, .5f, .6f));
  EXPECT_EQ(coated.specular, glm::vec3(1.0f));
  EXPECT_FLOAT_EQ(coated.alpha, 0.5f);
  EXPECT_FLOAT_EQ(coated.eta, 1.5f);
  const auto& gold = model_of<ConductorMaterial>(scene, 2);
  EXPECT_LT(gold.eta.value.x, gold.eta.value.z);
  EXPECT_FLOAT_EQ(gold.alpha.x, 0.2f);
  EXPECT_FLOAT_EQ(gold.alpha.y, 0.3f);
  const auto& given = model_of<ConductorMaterial>(scene, 3);
  EXPECT_EQ(given.eta, glm::vec3(1, 2, 3));
  EXPECT_EQ(given.k, glm::vec3(4, 5, 6));
  EXPECT_FLOAT_EQ(given.alpha.x, 0.3f);
  const auto& mirror = model_of<ConductorMaterial>(scene, 4);
  const glm::vec3 f = mirror.k.value * mirror.k.value /
                      (4.0f + mirror.k.value * mirror.k.value);  // Fresnel for eta 1
  expect_near(f, {.25f, .5f, 1.0f}, 1e-3f);
  EXPECT_EQ(mirror.alpha, glm::vec2(0.0f));
  EXPECT_TRUE(scene.warnings.empty());
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
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 0).reflectance, glm::vec3(.1f, .2f, .3f));
  const auto& plastic = model_of<CoatedMaterial>(scene, 1);
  EXPECT_FALSE(plastic.layered);
  EXPECT_EQ(plastic.diffuse, glm::vec3(.4f, .2f, .2f));
  EXPECT_EQ(plastic.specular, glm::vec3(.5f));
  EXPECT_NEAR(plastic.alpha, 0.21556f, 1e-4f);
  const auto& defaults = model_of<CoatedMaterial>(scene, 2);
  EXPECT_EQ(defaults.diffuse, glm::vec3(.25f));
  EXPECT_EQ(defaults.specular, glm::vec3(.25f));
  EXPECT_FLOAT_EQ(defaults.alpha, 0.2f);
  const auto& silver = model_of<ConductorMaterial>(scene, 3);
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
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 1).reflectance, glm::vec3(1, 0, 0));
}

// They bend no light: leaving them out changes nothing.
TEST_F(Pbrt, InterfacesAreLeftOut) {
  for (const char* name : {"none", "interface", ""}) {
    const std::string material = "Material \"" + std::string(name) + "\"\n";
    const SceneDescription scene = read_world(material + triangle);
    EXPECT_TRUE(scene.shapes.empty());
    EXPECT_TRUE(scene.materials.empty());
    EXPECT_TRUE(scene.warnings.empty());

    const SceneDescription lamp =
        read_world(material + "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n" + triangle);
    ASSERT_EQ(lamp.shapes.size(), 1u);
    EXPECT_TRUE(lamp.shapes[0].emission);
    EXPECT_EQ(model_of<DiffuseMaterial>(lamp).reflectance, glm::vec3(0.0f));
    EXPECT_TRUE(warns(lamp, "scene.pbrt:4: lights with an interface material"));
  }
}

TEST_F(Pbrt, SpectraBecomeColours) {
  const auto reflectance = [&](const std::string& spectrum) {
    return model_of<DiffuseMaterial>(
               read_world("Material \"diffuse\" \"spectrum reflectance\" " + spectrum + triangle))
        .reflectance.value;
  };
  expect_near(reflectance("[300 .5 800 .5]"), glm::vec3(0.5f), 1e-4f);
  const glm::vec3 red = reflectance("[400 0 590 0 600 .9 800 .9]");
  EXPECT_GT(red.x, 0.5f);
  EXPECT_LT(red.y, 0.3f);
  EXPECT_LT(red.z, 0.1f);
}

TEST_F(Pbrt, SpectraByNameAndFromFiles) {
  write("half.spd", "# nm, share\n300 .5\n800 .5\n");
  const SceneDescription scene =
      read_world("Material \"diffuse\" \"spectrum reflectance\" \"half.spd\"" + triangle +
                 "Material \"dielectric\" \"spectrum eta\" \"glass-F11\"" + triangle +
                 "Material \"conductor\" \"spectrum eta\" \"metal-CuZn-eta\"" + triangle +
                 "Material \"diffuse\" \"spectrum reflectance\" \"absent\"\n" + triangle);
  expect_near(model_of<DiffuseMaterial>(scene, 0).reflectance.value, glm::vec3(0.5f), 1e-4f);
  EXPECT_NEAR(model_of<DielectricMaterial>(scene, 1).eta, 1.79f, 1e-2f);
  EXPECT_LT(model_of<ConductorMaterial>(scene, 2).eta.value.x, 0.5f);
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 3).reflectance, glm::vec3(0.5f));
  EXPECT_TRUE(warns(scene, "the spectrum \"absent\" is not known"));
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST_F(Pbrt, TransparentMaterialsOfV4) {
  const SceneDescription scene = read_world(R"(
    Material "dielectric" "float eta" 1.8 "float uroughness" .25 "float vroughness" .04
    Shape "sphere"
    Material "thindielectric" Shape "sphere"
    Material "diffusetransmission" "rgb reflectance" [.2 .4 .6] "float scale" .5 Shape "sphere")");
  const auto& glass = model_of<DielectricMaterial>(scene, 0);
  EXPECT_FLOAT_EQ(glass.eta, 1.8f);
  EXPECT_FLOAT_EQ(glass.alpha.x, 0.5f);
  EXPECT_FLOAT_EQ(glass.alpha.y, 0.2f);
  EXPECT_FALSE(glass.thin);
  EXPECT_EQ(glass.reflectance, glm::vec3(1.0f));
  const auto& pane = model_of<DielectricMaterial>(scene, 1);
  EXPECT_TRUE(pane.thin);
  EXPECT_FLOAT_EQ(pane.eta, 1.5f);
  EXPECT_EQ(pane.alpha, glm::vec2(0.0f));
  const auto& sheet = model_of<DiffuseTransmissionMaterial>(scene, 2);
  expect_near(sheet.reflectance.value, {.1f, .2f, .3f});
  expect_near(sheet.transmittance.value, glm::vec3(0.125f));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Pbrt, TransparentMaterialsOfV3) {
  const SceneDescription scene = read_world(R"(
    Material "glass" "rgb Kr" [.5 .6 .7] "float index" 1.3 Shape "sphere"
    Material "glass" "float eta" 1.4 "float uroughness" .1 "float vroughness" .1 Shape "sphere"
    Material "mirror" "rgb Kr" [.9 .8 .7] Shape "sphere"
    Material "matte" "float sigma" 20 Shape "sphere")");
  const auto& smooth = model_of<DielectricMaterial>(scene, 0);
  EXPECT_FLOAT_EQ(smooth.eta, 1.3f);
  EXPECT_EQ(smooth.alpha, glm::vec2(0.0f));
  EXPECT_EQ(smooth.reflectance, glm::vec3(.5f, .6f, .7f));
  EXPECT_EQ(smooth.transmittance, glm::vec3(1.0f));
  const auto& rough = model_of<DielectricMaterial>(scene, 1);
  EXPECT_FLOAT_EQ(rough.eta, 1.4f);
  EXPECT_NEAR(rough.alpha.x, 0.46176f, 1e-4f);
  const auto& mirror = model_of<ConductorMaterial>(scene, 2);
  EXPECT_EQ(mirror.specular, glm::vec3(.9f, .8f, .7f));
  EXPECT_EQ(mirror.eta, glm::vec3(0.0f));
  EXPECT_EQ(mirror.alpha, glm::vec2(0.0f));
  EXPECT_FLOAT_EQ(model_of<DiffuseMaterial>(scene, 3).sigma.value, 20.0f);
  EXPECT_TRUE(scene.warnings.empty());
}

// A mix shows each part to a share of the light only: the parts are the brighter for it.
TEST_F(Pbrt, SumsOfReflectionsBecomeMixes) {
  const SceneDescription scene = read_world(R"(
    Material "uber" "rgb Kd" [.3 .3 .3] "rgb Ks" [.2 .2 .2] "rgb Kt" [.5 .25 0] "float eta" 1.6
      "rgb opacity" [.7 .7 .7] Shape "sphere"
    Material "uber" "rgb Kd" [.9 .3 .3] Shape "sphere"
    Material "translucent" "rgb Kd" [.6 .6 .6] "rgb Ks" [.4 .4 .4] "rgb transmit" [1 1 1]
      "rgb reflect" [.5 .5 .5] Shape "sphere")");
  const auto& mix = model_of<MixMaterial>(scene, 0);
  EXPECT_FLOAT_EQ(mix.amount.value, 0.5f);
  const auto& coat = std::get<CoatedMaterial>(scene.materials.at(mix.first).model);
  expect_near(coat.diffuse.value, glm::vec3(0.6f));
  expect_near(coat.specular.value, glm::vec3(0.4f));
  EXPECT_FLOAT_EQ(coat.eta, 1.6f);
  EXPECT_FALSE(coat.layered);
  const auto& glass = std::get<DielectricMaterial>(scene.materials.at(mix.second).model);
  expect_near(glass.transmittance.value, {1.0f, 0.5f, 0.0f});
  expect_near(glass.reflectance.value, glm::vec3(0.0f));
  EXPECT_FLOAT_EQ(scene.materials.at(scene.shapes[0].material).opacity.value, 0.7f);

  expect_near(model_of<CoatedMaterial>(scene, 1).diffuse.value, {.9f, .3f, .3f});
  const auto& sheet = model_of<MixMaterial>(scene, 2);
  EXPECT_FLOAT_EQ(sheet.amount.value, 0.4f);
  const auto& diffuse =
      std::get<DiffuseTransmissionMaterial>(scene.materials.at(sheet.first).model);
  expect_near(diffuse.reflectance.value, glm::vec3(0.5f));
  expect_near(diffuse.transmittance.value, glm::vec3(1.0f));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Pbrt, PrincipledMaterials) {
  const SceneDescription scene = read_world(R"(
    Material "disney" "rgb color" [.1 .2 .3] "float metallic" .7 "float roughness" .3 "float eta" 1.4
      "float spectrans" .2 "float clearcoat" 1 Shape "sphere"
    Material "coatedconductor" "rgb reflectance" [.25 .25 .25] "float interface.eta" 1
      "float conductor.roughness" .09 "float interface.roughness" .04 Shape "sphere")");
  const auto& disney = model_of<PrincipledMaterial>(scene, 0);
  EXPECT_EQ(disney.base_color, glm::vec3(.1f, .2f, .3f));
  EXPECT_FLOAT_EQ(disney.metallic.value, 0.7f);
  EXPECT_FLOAT_EQ(disney.alpha.value, 0.09f);
  EXPECT_FLOAT_EQ(disney.eta, 1.4f);
  EXPECT_FLOAT_EQ(disney.transmission.value, 0.2f);
  EXPECT_FLOAT_EQ(disney.coat.value, 0.25f);
  const auto& coated = model_of<PrincipledMaterial>(scene, 1);
  expect_near(coated.base_color.value, glm::vec3(0.25f), 1e-4f);
  EXPECT_FLOAT_EQ(coated.metallic.value, 1.0f);
  EXPECT_FLOAT_EQ(coated.alpha.value, 0.3f);
  EXPECT_FLOAT_EQ(coated.coat.value, 1.0f);
  EXPECT_FLOAT_EQ(coated.coat_alpha.value, 0.2f);
  EXPECT_TRUE(warns(scene, ":5: Material \"coatedconductor\": the nearest model is used"));
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST_F(Pbrt, StandInsKeepTheColour) {
  const SceneDescription scene = read_world(R"(
    Material "subsurface" Shape "sphere"
    Material "kdsubsurface" "rgb Kd" [.1 .2 .3] Shape "sphere"
    Material "hair" "rgb reflectance" [.4 .3 .2] Shape "sphere"
    Material "substrate" "rgb Kd" [.2 .2 .2] "rgb Ks" [.04 .04 .04] Shape "sphere"
    Material "shinymetal" "rgb Ks" [.5 .5 .5] Shape "sphere")");
  const glm::vec3 skin = model_of<CoatedMaterial>(scene, 0).diffuse.value;
  EXPECT_GT(skin.x, skin.z);
  EXPECT_GT(skin.z, 0.5f);
  EXPECT_LT(skin.x, 1.0f);
  EXPECT_EQ(model_of<CoatedMaterial>(scene, 1).diffuse, glm::vec3(.1f, .2f, .3f));
  EXPECT_EQ(model_of<DiffuseMaterial>(scene, 2).reflectance, glm::vec3(.4f, .3f, .2f));
  const auto& substrate = model_of<CoatedMaterial>(scene, 3);
  EXPECT_NEAR(substrate.eta, 1.5f, 1e-4f);  // ((1.5 - 1) / (1.5 + 1))^2 = 0.04
  expect_near(substrate.specular.value, glm::vec3(1.0f));
  EXPECT_TRUE(substrate.layered);
  EXPECT_EQ(model_of<MixMaterial>(scene, 4).amount.value, 0.5f);
  EXPECT_EQ(scene.warnings.size(), 5u);
}

TEST_F(Pbrt, MixesNameTheirParts) {
  const SceneDescription scene = read_world(R"(
    Texture "mask" "float" "imagemap" "string filename" "mask.png"
    MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [1 0 0]
    Material "mix" "string materials" ["red" "blue"] "texture amount" "mask" Shape "sphere"
    MakeNamedMaterial "blue" "string type" "matte" "rgb Kd" [0 0 1]
    Material "mix" "string namedmaterial1" "red" "string namedmaterial2" "blue"
      "float amount" .25 Shape "sphere")");
  const auto reflectance = [&](int material) {
    return std::get<DiffuseMaterial>(scene.materials.at(material).model).reflectance.value;
  };
  const auto& v4 = model_of<MixMaterial>(scene, 0);
  EXPECT_EQ(reflectance(v4.first), glm::vec3(1, 0, 0));
  EXPECT_EQ(reflectance(v4.second), glm::vec3(0, 0, 1));
  EXPECT_EQ(v4.amount.texture, 0);
  // v3's amount is the share of the first.
  const auto& v3 = model_of<MixMaterial>(scene, 1);
  EXPECT_EQ(reflectance(v3.second), glm::vec3(1, 0, 0));
  EXPECT_FLOAT_EQ(v3.amount.value, 0.25f);
  EXPECT_EQ(scene.materials.size(), 4u);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Pbrt, MediaInsideOfGlassAbsorb) {
  const SceneDescription scene = read_world(R"(
    MakeNamedMedium "green" "string type" "homogeneous" "rgb sigma_a" [.5 .2 .4]
      "rgb sigma_s" [0 0 0] "float scale" 2
    MakeNamedMedium "fog" "string type" "cloud"
    MakeNamedMaterial "pane" "string type" "dielectric"
    MakeNamedMaterial "grey" "string type" "diffuse"
    NamedMaterial "pane" AttributeBegin MediumInterface "green" "" Shape "sphere" Shape "sphere"
    Material "mix" "string materials" ["grey" "pane"] Shape "sphere" AttributeEnd Shape "sphere"
    MediumInterface "" "fog" Shape "sphere"
    MediumInterface "fog" Shape "sphere"
    MediumInterface "green" "" NamedMaterial "grey" Shape "sphere")");
  expect_near(model_of<DielectricMaterial>(scene, 0).absorption, {1.0f, 0.4f, 0.8f});
  EXPECT_EQ(scene.shapes[0].material, scene.shapes[1].material);
  const auto& mix = model_of<MixMaterial>(scene, 2);
  const auto& part = std::get<DielectricMaterial>(scene.materials.at(mix.second).model);
  expect_near(part.absorption, {1.0f, 0.4f, 0.8f});
  EXPECT_EQ(model_of<DielectricMaterial>(scene, 3).absorption, glm::vec3(0.0f));
  EXPECT_EQ(scene.shapes[3].material, scene.shapes[4].material);
  EXPECT_EQ(scene.shapes[3].material, scene.shapes[5].material);
  EXPECT_EQ(scene.shapes[6].material, mix.first) << "no light gets into grey";
  EXPECT_TRUE(warns(scene, ":10: media outside of dielectrics are not supported"));
  EXPECT_TRUE(warns(scene, ":5: media of the type \"cloud\" are not supported"));
  EXPECT_EQ(scene.warnings.size(), 2u);
}

TEST_F(Pbrt, ScatteringAndPresetsWarn) {
  const SceneDescription scene = read_world(R"(
    Material "glass" MakeNamedMedium "milk" "string type" "homogeneous" "string preset" "Milk"
    MakeNamedMedium "default" "string type" "homogeneous"
    MediumInterface "milk" "" Shape "sphere" MediumInterface "default" "" Shape "sphere")");
  EXPECT_EQ(model_of<DielectricMaterial>(scene, 0).absorption, glm::vec3(0.0f));
  expect_near(model_of<DielectricMaterial>(scene, 1).absorption, {.0011f, .0024f, .014f});
  EXPECT_TRUE(warns(scene, ":3: named presets of media"));
  EXPECT_TRUE(warns(scene, ":4: scattering inside of media is not supported"));
  EXPECT_EQ(scene.warnings.size(), 2u);
}

// --- Broken materials

// Materials "0" to "count": the first of `type`, each other a mix of twice the one before.
std::string chain_of_mixes(const char* type, int count) {
  std::ostringstream text;
  text << "MakeNamedMaterial \"0\" \"string type\" \"" << type << "\"\n";
  for (int i = 1; i <= count; ++i) {
    text << "MakeNamedMaterial \"" << i << "\" \"string type\" \"mix\" \"string materials\" [\""
         << i - 1 << "\" \"" << i - 1 << "\"]\n";
  }
  return text.str();
}

TEST_F(Pbrt, BrokenMaterialsSayWhereAndWhat) {
  const std::string world = "WorldBegin\n",
                    red = "MakeNamedMaterial \"red\" \"string type\" \"mix\"";
  const std::string chain = world + chain_of_mixes("diffuse", 100);
  struct Case {
    std::string text, message;
  };
  const Case cases[] = {
      {world + red + "\n\"string materials\" [\"red\" \"red\"] NamedMaterial \"red\"\n" + triangle,
       "scene.pbrt:2: MakeNamedMaterial \"red\" refers to itself"},
      {world + red +
           "\"string materials\" [\"a\" \"a\"] MakeNamedMaterial \"a\" \"string type\" "
           "\"mix\" \"string materials\" [\"red\" \"red\"] NamedMaterial \"a\"" +
           triangle,
       "MakeNamedMaterial \"a\" refers to itself"},
      {world + red + "\"string materials\" [\"a\" \"b\"] NamedMaterial \"red\"" + triangle,
       ":2: MakeNamedMaterial \"red\" refers to the material \"a\", which has not been defined"},
      {world + red + "\n\"string materials\" \"a\" NamedMaterial \"red\"" + triangle,
       ":3: MakeNamedMaterial \"red\" needs two names"},
      {world + red + " NamedMaterial \"red\"" + triangle, "needs \"string materials\""},
      {world + red +
           "\"string materials\" [\"a\" \"a\"] MakeNamedMaterial \"a\" \"string type\" "
           "\"interface\" NamedMaterial \"red\"" +
           triangle,
       "refers to the interface \"a\""},
      {chain + "NamedMaterial \"100\"" + triangle, "referred to through more than 64 others"},
      {world + "Material \"diffuse\" \"string normalmap\" [\"a\" \"b\"]" + triangle,
       "\"string normalmap\" must name one image file"},
      {world + "Material \"diffuse\"\n\"texture reflectance\" [\"a\" \"b\"]" + triangle,
       ":3: \"texture reflectance\" must have one value"},
  };
  for (const Case& c : cases) expect_one_line_with(error_of(c.text), c.message);
}

// Sixty mixes of twice the one before, in a medium: no more copies than materials.
TEST_F(Pbrt, SharedPartsOfMixesAreCopiedOnce) {
  const SceneDescription scene = read_world(
      chain_of_mixes("dielectric", 60) +
      "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 1 1] \"rgb "
      "sigma_s\" [0 0 0]\nMediumInterface \"m\" \"\" NamedMaterial \"60\"" +
      triangle);
  EXPECT_EQ(scene.materials.size(), 121u);
}

}  // namespace
}  // namespace lockstep::test_pbrt_materials
