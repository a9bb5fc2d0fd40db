// The glTF reader: materials, textures and their extensions.
#include "tests/t_gltf.h"

#include <cmath>
#include <string>
#include <variant>
#include <vector>

namespace lockstep::test_gltf_materials {
namespace {

// A triangle whose material 0 has the given members, with texture coordinates and textures 0 to 3.
std::string material_file(const std::string& material, const std::string& rest = "") {
  GltfBuffer buffer;
  buffer.add("VEC3", corner_positions);
  buffer.add("VEC2", std::vector<float>{0, 0, 1, 0, 0, 1});
  buffer.add("VEC2", std::vector<float>{9, 0, 9, 0, 9, 1});
  return buffer.embedded(
      one_mesh("\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1,\"TEXCOORD_1\":2},\"material\":0") +
      ",\"images\":[{\"uri\":\"a%20b.png\"},{\"uri\":\"b+c.png\"}],\"textures\":[{\"source\":0},"
      "{\"source\":1},{\"source\":0},{\"source\":1}],\"materials\":[{" +
      material + "}]" + rest);
}

std::string extension(const std::string& name, const std::string& members) {
  return "\"extensions\":{\"" + name + "\":{" + members + "}}";
}

class GltfMaterials : public Gltf {};

TEST_F(GltfMaterials, DefaultIsWhiteRoughMetal) {
  for (const std::string& bytes :
       {triangle_file("\"nodes\":[{\"mesh\":0}]"), material_file("\"name\":\"plain\"")}) {
    const SceneDescription scene = read(bytes);
    ASSERT_EQ(scene.materials.size(), 1u);
    const auto& m = model_of<PrincipledMaterial>(scene);
    EXPECT_EQ(m.base_color, ColorInput(glm::vec3(1.0f)));
    EXPECT_EQ(m.metallic, FloatInput(1.0f));
    EXPECT_EQ(m.alpha, FloatInput(1.0f));
    EXPECT_EQ(m.eta, 1.5f);
    EXPECT_EQ(m.specular, FloatInput(1.0f));
    EXPECT_EQ(m.transmission, FloatInput(0.0f));
    EXPECT_EQ(m.coat, FloatInput(0.0f));
    EXPECT_EQ(material_of(scene).opacity, FloatInput(1.0f));
    EXPECT_EQ(material_of(scene).normal_map, -1);
    EXPECT_TRUE(material_of(scene).two_sided);
    EXPECT_FALSE(scene.shapes[0].emission);
  }
}

TEST_F(GltfMaterials, FactorsAndTextures) {
  const SceneDescription scene = read(material_file(
      "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,3,0.4],\"metallicFactor\":0.5,"
      "\"roughnessFactor\":0.6,\"baseColorTexture\":{\"index\":0},\"metallicRoughnessTexture\":"
      "{\"index\":1}},\"normalTexture\":{\"index\":2,\"scale\":0.7},\"occlusionTexture\":{"
      "\"index\":3}"));
  const auto& m = model_of<PrincipledMaterial>(scene);
  EXPECT_EQ(m.base_color.value, glm::vec3(0.1f, 0.2f, 1.0f));
  EXPECT_FLOAT_EQ(m.metallic.value, 0.5f);
  EXPECT_EQ(m.metallic.channel, 2);
  EXPECT_EQ(m.metallic.power, 1.0f);
  EXPECT_FLOAT_EQ(m.alpha.value, 0.36f);
  EXPECT_EQ(m.alpha.channel, 1);
  EXPECT_EQ(m.alpha.power, 2.0f);
  EXPECT_EQ(m.alpha.texture, m.metallic.texture);
  EXPECT_FLOAT_EQ(material_of(scene).normal_scale, 0.7f);
  ASSERT_EQ(scene.textures.size(), 3u);  // nothing for occlusion
  const ImageTexture& color = image_of(scene, m.base_color.texture);
  EXPECT_EQ(color.file, path("a b.png"));
  EXPECT_EQ(color.encoding, TextureEncoding::Srgb);
  EXPECT_EQ(image_of(scene, m.alpha.texture).encoding, TextureEncoding::Linear);
  EXPECT_EQ(image_of(scene, m.alpha.texture).file, path("b+c.png"));
  EXPECT_EQ(image_of(scene, material_of(scene).normal_map).encoding, TextureEncoding::Linear);
  EXPECT_NE(color.where.find("scene.gltf: image 0"), std::string::npos);
  EXPECT_FALSE(warns(scene, "occlusion"));
}

TEST_F(GltfMaterials, OnlyWhatIsUsedIsRead) {
  const SceneDescription scene = read(material_file(
      "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}},{\"pbrMetallicRoughness\":"
      "{\"baseColorTexture\":{\"index\":1}}"));
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.textures.size(), 1u);
}

TEST_F(GltfMaterials, Samplers) {
  const auto with_sampler = [&](const std::string& members) {
    GltfBuffer buffer;
    buffer.add("VEC3", corner_positions);
    const SceneDescription scene = read(buffer.embedded(
        one_mesh("\"attributes\":{\"POSITION\":0},\"material\":0") +
        ",\"images\":[{\"uri\":\"a.png\"}],\"samplers\":[{" + members +
        "}],\"textures\":[{\"source\":0,\"sampler\":0}],\"materials\":[{\"pbrMetallicRoughness\":"
        "{\"baseColorTexture\":{\"index\":0}}}]"));
    return image_of(scene, 0);
  };
  const ImageTexture a = with_sampler("\"wrapS\":33071,\"wrapT\":33648,\"magFilter\":9728");
  EXPECT_EQ(a.wrap_u, TextureWrap::Clamp);
  EXPECT_EQ(a.wrap_v, TextureWrap::Mirror);
  EXPECT_EQ(a.filter, TextureFilter::Nearest);
  const ImageTexture b = with_sampler("\"minFilter\":9987,\"magFilter\":9729");
  EXPECT_EQ(b.wrap_u, TextureWrap::Repeat);
  EXPECT_EQ(b.wrap_v, TextureWrap::Repeat);
  EXPECT_EQ(b.filter, TextureFilter::Trilinear);
  for (const char* mipmaps : {"9984", "9985", "9986"}) {
    EXPECT_EQ(with_sampler(std::string("\"minFilter\":") + mipmaps).filter,
              TextureFilter::Trilinear);
  }
  EXPECT_EQ(with_sampler("\"minFilter\":9728").filter, TextureFilter::Bilinear);
  EXPECT_EQ(with_sampler("\"minFilter\":9729").filter, TextureFilter::Bilinear);
  EXPECT_EQ(with_sampler("").filter, TextureFilter::Bilinear);
}

TEST_F(GltfMaterials, ImagesInsideTheFile) {
  GltfBuffer buffer;
  buffer.add("VEC3", corner_positions);
  buffer.add_view("bytes of an image");
  const std::string bytes = buffer.container(
      one_mesh("\"attributes\":{\"POSITION\":0},\"material\":0") +
      ",\"images\":[{\"bufferView\":1,\"mimeType\":\"image/png\",\"name\":\"wood\"},{\"uri\":"
      "\"data:image/"
      "jpeg;base64,QUJD\"}],\"textures\":[{\"source\":0},{\"source\":1}],\"materials\":[{"
      "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},\"metallicRoughnessTexture\":"
      "{\"index\":0}},\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":1}}]");
  const SceneDescription scene = read(bytes);
  const auto& m = model_of<PrincipledMaterial>(scene);
  const ImageTexture& color = image_of(scene, m.base_color.texture);
  ASSERT_TRUE(color.encoded);
  EXPECT_EQ(std::string(color.encoded->begin(), color.encoded->end()), "bytes of an image");
  EXPECT_EQ(color.file, "wood");
  EXPECT_EQ(image_of(scene, m.alpha.texture).encoded, color.encoded);  // one copy
  const ImageTexture& glow = image_of(scene, scene.shapes[0].emission->radiance.texture);
  EXPECT_EQ(std::string(glow.encoded->begin(), glow.encoded->end()), "ABC");
}

TEST_F(GltfMaterials, TextureTransforms) {
  const auto transform_of = [&](const std::string& members) {
    const SceneDescription scene =
        read(material_file("\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0," +
                           extension("KHR_texture_transform", members) + "}}"));
    return image_of(scene, 0).uv;
  };
  const auto apply = [](const UvTransform& t, glm::vec2 uv) {
    return glm::vec2(glm::dot(t.u_row, uv), glm::dot(t.v_row, uv)) + t.offset;
  };
  // The extension's own example: the lower left quadrant, turned by 90 degrees.
  const UvTransform a =
      transform_of("\"offset\":[0,1],\"rotation\":1.57079632679,\"scale\":[0.5,0.5]");
  EXPECT_LT(glm::distance(apply(a, {0, 0}), glm::vec2(0.0f, 1.0f)), 1e-6f);
  EXPECT_LT(glm::distance(apply(a, {1, 0}), glm::vec2(0.0f, 0.5f)), 1e-6f);
  EXPECT_LT(glm::distance(apply(a, {0, 1}), glm::vec2(0.5f, 1.0f)), 1e-6f);
  // Scaled before it is turned.
  const UvTransform b = transform_of("\"rotation\":1.57079632679,\"scale\":[2,3]");
  EXPECT_LT(glm::distance(apply(b, {1, 1}), glm::vec2(3.0f, -2.0f)), 1e-6f);
  EXPECT_EQ(apply(transform_of(""), {0.25f, 0.5f}), glm::vec2(0.25f, 0.5f));
}

TEST_F(GltfMaterials, SetsOfTextureCoordinates) {
  const auto scene_with = [&](const std::string& color, const std::string& data) {
    return read(material_file("\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0," +
                              color + "},\"metallicRoughnessTexture\":{\"index\":1," + data +
                              "}}"));
  };
  const SceneDescription first = scene_with("\"texCoord\":0", "\"texCoord\":0");
  EXPECT_EQ(mesh_of(first).uvs[0], glm::vec2(0, 0));
  const SceneDescription second = scene_with(
      "\"texCoord\":1", "\"texCoord\":0," + extension("KHR_texture_transform", "\"texCoord\":1"));
  EXPECT_EQ(mesh_of(second).uvs[0], glm::vec2(9, 0));
  EXPECT_FALSE(warns(second, "different texture coordinates"));
  const SceneDescription mixed = scene_with("\"texCoord\":1", "\"texCoord\":0");
  EXPECT_EQ(mesh_of(mixed).uvs[0], glm::vec2(9, 0));
  EXPECT_TRUE(warns(mixed, "different texture coordinates"));
  const SceneDescription missing = scene_with("\"texCoord\":2", "\"texCoord\":2");
  EXPECT_EQ(mesh_of(missing).uvs[0], glm::vec2(0, 0));
  EXPECT_TRUE(warns(missing, "lacks TEXCOORD_2"));
}

TEST_F(GltfMaterials, Emission) {
  const SceneDescription scene = read(material_file(
      "\"emissiveFactor\":[1,0.5,0],\"emissiveTexture\":{\"index\":0},\"doubleSided\":true," +
      extension("KHR_materials_emissive_strength", "\"emissiveStrength\":8")));
  ASSERT_TRUE(scene.shapes[0].emission);
  EXPECT_EQ(scene.shapes[0].emission->radiance.value, glm::vec3(8, 4, 0));
  EXPECT_EQ(image_of(scene, scene.shapes[0].emission->radiance.texture).encoding,
            TextureEncoding::Srgb);
  EXPECT_TRUE(scene.shapes[0].emission->two_sided);
  EXPECT_TRUE(scene.environment);  // what glows by a texture is no lamp

  const SceneDescription lamp = read(material_file("\"emissiveFactor\":[1,1,1]"));
  EXPECT_FALSE(lamp.shapes[0].emission->two_sided);
  EXPECT_FALSE(lamp.environment);
  EXPECT_FALSE(read(material_file("\"emissiveTexture\":{\"index\":0}")).shapes[0].emission);
}

TEST_F(GltfMaterials, AlphaModes) {
  const std::string pbr =
      "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.5],\"baseColorTexture\":{\"index\":0}"
      "}";
  const SceneDescription opaque = read(material_file(pbr));
  EXPECT_EQ(material_of(opaque).opacity, FloatInput(1.0f));

  const SceneDescription blend = read(material_file(pbr + ",\"alphaMode\":\"BLEND\""));
  EXPECT_EQ(material_of(blend).opacity.value, 0.5f);
  EXPECT_EQ(material_of(blend).opacity.channel, 3);
  EXPECT_EQ(material_of(blend).opacity.texture,
            model_of<PrincipledMaterial>(blend).base_color.texture);
  EXPECT_EQ(material_of(blend).opacity_cutoff, 0.0f);

  const SceneDescription mask = read(material_file(pbr + ",\"alphaMode\":\"MASK\""));
  EXPECT_EQ(material_of(mask).opacity_cutoff, 0.5f);
  const SceneDescription all =
      read(material_file(pbr + ",\"alphaMode\":\"MASK\",\"alphaCutoff\":0"));
  EXPECT_EQ(material_of(all).opacity, FloatInput(1.0f));
}

TEST_F(GltfMaterials, GlassWithThinWallsAndWithAVolume) {
  const std::string pbr =
      "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,1,1,1],\"metallicFactor\":0,"
      "\"roughnessFactor\":0.5},\"extensions\":{\"KHR_materials_transmission\":"
      "{\"transmissionFactor\":1},\"KHR_materials_ior\":{\"ior\":1.33}";
  const SceneDescription pane = read(material_file(pbr + "}"));
  const auto& thin = model_of<DielectricMaterial>(pane);
  EXPECT_TRUE(thin.thin);
  EXPECT_FLOAT_EQ(thin.eta, 1.33f);
  EXPECT_EQ(thin.alpha, glm::vec2(0.25f));
  EXPECT_EQ(thin.alpha_scale, FloatInput(1.0f));
  EXPECT_EQ(thin.transmittance.value, glm::vec3(0.5f, 1, 1));
  EXPECT_EQ(thin.reflectance.value, glm::vec3(1.0f));
  EXPECT_EQ(thin.absorption, glm::vec3(0.0f));

  const SceneDescription solid =
      read(material_file(
          pbr + ",\"KHR_materials_volume\":{\"thicknessFactor\":0.1,\"attenuationDistance\":2,"
                "\"attenuationColor\":[0.5,1,0]}}"));
  const auto& glass = model_of<DielectricMaterial>(solid);
  EXPECT_FALSE(glass.thin);
  EXPECT_FLOAT_EQ(std::exp(-2.0f * glass.absorption.x), 0.5f);
  EXPECT_EQ(glass.absorption.y, 0.0f);
  EXPECT_TRUE(std::isfinite(glass.absorption.z) && glass.absorption.z > 5.0f);
}

TEST_F(GltfMaterials, PartialTransmission) {
  const auto file = [](const std::string& metallic, const std::string& extensions) {
    return material_file("\"pbrMetallicRoughness\":{\"metallicFactor\":" + metallic +
                         "},\"normalTexture\":{\"index\":2},\"extensions\":{"
                         "\"KHR_materials_transmission\":{\"transmissionFactor\":0.75,"
                         "\"transmissionTexture\":{\"index\":1}}" +
                         extensions + "}");
  };
  const SceneDescription scene = read(file("0", ""));
  const auto& mix = model_of<MixMaterial>(scene);
  EXPECT_EQ(mix.amount.value, 0.75f);
  EXPECT_EQ(mix.amount.channel, 0);
  EXPECT_EQ(image_of(scene, mix.amount.texture).file, path("b+c.png"));
  const Material& first = scene.materials.at(size_t(mix.first));
  const Material& second = scene.materials.at(size_t(mix.second));
  EXPECT_EQ(std::get<PrincipledMaterial>(first.model).transmission, FloatInput(0.0f));
  EXPECT_TRUE(std::get<DielectricMaterial>(second.model).thin);
  EXPECT_GE(first.normal_map, 0);
  EXPECT_EQ(first.normal_map, second.normal_map);

  // The principled model has the plain solid itself.
  const SceneDescription solid =
      read(file("0", ",\"KHR_materials_volume\":{\"thicknessFactor\":1}"));
  EXPECT_EQ(model_of<PrincipledMaterial>(solid).transmission.value, 0.75f);
  EXPECT_TRUE(solid.warnings ==
              read(file("0.5", ",\"KHR_materials_volume\":{\"thicknessFactor\":1}")).warnings);
  const SceneDescription metal = read(file("0.5", ""));
  EXPECT_EQ(model_of<PrincipledMaterial>(metal).transmission.value, 0.75f);
  EXPECT_TRUE(warns(metal, "partly metallic"));
}

TEST_F(GltfMaterials, SpecularCoatAndIor) {
  const SceneDescription scene = read(material_file(
      "\"extensions\":{\"KHR_materials_ior\":{\"ior\":2},\"KHR_materials_specular\":"
      "{\"specularFactor\":0.5,\"specularTexture\":{\"index\":1}},\"KHR_materials_clearcoat\":"
      "{\"clearcoatFactor\":0.25,\"clearcoatTexture\":{\"index\":0},\"clearcoatRoughnessFactor\":0."
      "5,"
      "\"clearcoatRoughnessTexture\":{\"index\":0}}}"));
  const auto& m = model_of<PrincipledMaterial>(scene);
  EXPECT_EQ(m.eta, 2.0f);
  EXPECT_EQ(m.specular.value, 0.5f);
  EXPECT_EQ(m.specular.channel, 3);
  EXPECT_EQ(m.coat.value, 0.25f);
  EXPECT_EQ(m.coat.channel, 0);
  EXPECT_EQ(m.coat_alpha.value, 0.25f);
  EXPECT_EQ(m.coat_alpha.channel, 1);
  EXPECT_EQ(m.coat_alpha.power, 2.0f);
  EXPECT_EQ(m.coat.texture, m.coat_alpha.texture);
  EXPECT_EQ(image_of(scene, m.coat.texture).encoding, TextureEncoding::Linear);

  const SceneDescription tinted =
      read(material_file(extension("KHR_materials_specular", "\"specularColorFactor\":[0,1,0]")));
  EXPECT_FLOAT_EQ(model_of<PrincipledMaterial>(tinted).specular.value, 0.7152f);
  EXPECT_TRUE(warns(tinted, "specular colours"));
  // A factor of 0 needs no texture.
  const SceneDescription zero = read(
      material_file("\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"metallicRoughnessTexture\":"
                    "{\"index\":0}}"));
  EXPECT_EQ(model_of<PrincipledMaterial>(zero).metallic, FloatInput(0.0f));
  EXPECT_GE(model_of<PrincipledMaterial>(zero).alpha.texture, 0);
  const SceneDescription low = read(material_file(extension("KHR_materials_ior", "\"ior\":0.5")));
  EXPECT_EQ(model_of<PrincipledMaterial>(low).eta, 1.0f);
  EXPECT_TRUE(warns(low, "ior below 1"));
}

TEST_F(GltfMaterials, UnlitSurfacesEmitTheirColour) {
  const SceneDescription scene =
      read(material_file("\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,1,1],"
                         "\"baseColorTexture\":{\"index\":1}},"
                         "\"emissiveFactor\":[1,1,1]," +
                         extension("KHR_materials_unlit", "")));
  EXPECT_EQ(model_of<DiffuseMaterial>(scene).reflectance.value, glm::vec3(0.0f));
  ASSERT_TRUE(scene.shapes[0].emission);
  EXPECT_EQ(scene.shapes[0].emission->radiance.value, glm::vec3(0.5f, 0.25f, 1.0f));
  EXPECT_GE(scene.shapes[0].emission->radiance.texture, 0);
}

TEST_F(GltfMaterials, SpecularGlossinessIsApproximated) {
  const SceneDescription scene = read(
      material_file(extension("KHR_materials_pbrSpecularGlossiness",
                              "\"diffuseFactor\":[0.5,0.25,1,0.5],\"diffuseTexture\":{\"index\":0},"
                              "\"glossinessFactor\":0.5") +
                    ",\"alphaMode\":\"BLEND\""));
  const auto& m = model_of<PrincipledMaterial>(scene);
  EXPECT_EQ(m.base_color.value, glm::vec3(0.5f, 0.25f, 1.0f));
  EXPECT_GE(m.base_color.texture, 0);
  EXPECT_EQ(m.metallic, FloatInput(0.0f));
  EXPECT_FLOAT_EQ(m.alpha.value, 0.25f);
  EXPECT_TRUE(warns(scene, "specular-glossiness"));
  EXPECT_EQ(material_of(scene).opacity.value, 0.5f);
  EXPECT_EQ(material_of(scene).opacity.texture, m.base_color.texture);
}

TEST_F(GltfMaterials, TexturesThatAreWrong) {
  const auto color = [](int index) {
    return "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":" + std::to_string(index) +
           "}}";
  };
  expect_error(material_file(color(4)), "texture 4 does not exist");
  expect_error(material_file(color(-2)), "texture -2 does not exist");
  const auto file = [](const std::string& image, const std::string& texture) {
    GltfBuffer buffer;
    buffer.add("VEC3", corner_positions);
    return buffer.embedded(one_mesh("\"attributes\":{\"POSITION\":0},\"material\":0") +
                           ",\"images\":[{" + image + "}],\"textures\":[{" + texture +
                           "}],\"materials\":[{\"normalTexture\":{\"index\":0}}]");
  };
  expect_error(file("\"uri\":\"a.png\"", "\"source\":1"), "image 1 does not exist");
  expect_error(file("\"uri\":\"a.png\"", "\"source\":0,\"sampler\":0"),
               "texture 0 has a sampler that does not exist");
  expect_error(file("\"uri\":\"data:image/png;base64,???\"", "\"source\":0"),
               "image 0 has a malformed data URI");
  expect_error(file("", "\"source\":0"), "image 0 has neither a URI nor a bufferView");
  expect_error(file("\"bufferView\":3", "\"source\":0"), "image 0 has neither");
  const SceneDescription unknown =
      read(file("\"uri\":\"a.ktx2\"", "\"extensions\":{\"KHR_texture_basisu\":{\"source\":0}}"));
  EXPECT_EQ(material_of(unknown).normal_map, -1);
  EXPECT_TRUE(warns(unknown, "without an image of a known kind"));
  const SceneDescription webp =
      read(file("\"uri\":\"a.webp\"", extension("EXT_texture_webp", "\"source\":0")));
  EXPECT_EQ(image_of(webp, material_of(webp).normal_map).file, path("a.webp"));
}

// A view past its buffer's end, which an image reader would follow.
TEST_F(GltfMaterials, ImagesPastTheirBuffer) {
  GltfBuffer buffer;
  buffer.add("VEC3", corner_positions);
  buffer.views += ",{\"buffer\":0,\"byteOffset\":4000000000,\"byteLength\":9}";
  expect_error(buffer.container(one_mesh("\"attributes\":{\"POSITION\":0},\"material\":0") +
                                ",\"images\":[{\"bufferView\":1}],\"textures\":[{\"source\":0}],"
                                "\"materials\":[{\"normalTexture\":{\"index\":0}}]"),
               "image 0 reaches past the end of its buffer");
}

}  // namespace
}  // namespace lockstep::test_gltf_materials
