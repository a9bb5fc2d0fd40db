// The Mitsuba reader: materials and textures, in the spellings of both generations.
#include "tests/t_mitsuba.h"

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace lockstep::test_mitsuba_materials {
namespace {

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
  expect_one_line_with(error_of(with_bsdf("<bsdf type=\"dielectric\"><string name=\"int_ior\" "
                                          "value=\"butter\"/></bsdf>")),
                       "the index of refraction of \"butter\" is not known");
  expect_one_line_with(error_of(with_bsdf("<bsdf type=\"dielectric\"><float name=\"int_ior\" "
                                          "value=\"0\"/></bsdf>")),
                       "above 0");
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
  expect_one_line_with(error_of(missing), "scene.xml:2: gone.spd: cannot be opened");
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
  EXPECT_EQ(image_of(scene, normals).encoding, TextureEncoding::Linear);
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
  expect_one_line_with(error_of(with_bsdf("<bsdf type=\"mixturebsdf\"><string name=\"weights\" "
                                          "value=\"1\"/>" +
                                          a + b + "</bsdf>")),
                       "a weight of 0 or more for each of its 2 models");
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
    return image_of(scene, model_of<DiffuseMaterial>(scene).reflectance.texture);
  };
  const auto string = [](const char* name, const char* value) {
    return std::string("<string name=\"") + name + "\" value=\"" + value + "\"/>";
  };
  const ImageTexture plain = texture("", false);
  EXPECT_EQ(plain.file, path("sub/a.png"));
  EXPECT_EQ(plain.filter, TextureFilter::Bilinear);
  EXPECT_EQ(plain.encoding, TextureEncoding::ByFormat);
  EXPECT_EQ(plain.wrap_u, TextureWrap::Repeat);
  EXPECT_NE(plain.where.find("scene.xml:2"), std::string::npos);
  EXPECT_EQ(texture("", true).filter, TextureFilter::Trilinear) << "ewa";
  EXPECT_EQ(texture(string("filterType", "trilinear"), true).filter, TextureFilter::Trilinear);
  EXPECT_EQ(texture(string("filterType", "nearest"), true).filter, TextureFilter::Nearest);
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

}  // namespace
}  // namespace lockstep::test_mitsuba_materials
