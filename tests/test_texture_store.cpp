// Textures of a scene: expressions by hand, what is held once, and files that cannot be used.
#include "core/texture_store.h"

#include "tests/t_texture.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace lockstep::test_texture_store {
namespace {

// Expressions -----------------------------------------------------------------------------------

Color plus_alpha(glm::vec3 v) { return {double(v.x), double(v.y), double(v.z), 1.0}; }

TEST_F(Textures, ExpressionsAreEvaluated) {
  const Case c =
      png_case("a", 8, TextureEncoding::Linear, TexelFormat::Byte, [](double v) { return v; });
  CheckerboardTexture board;
  board.even = glm::vec3(0.25f, 0.5f, 1.0f);
  board.odd = ColorInput(glm::vec3(0.5f, 2.0f, 1.0f), 0);
  board.uv = {{2.0f, 0.0f}, {0.0f, 3.0f}, {0.1f, 0.0f}};
  const ProductTexture product{ColorInput(glm::vec3(2.0f), 0), ColorInput(glm::vec3(1.0f), 1)};
  MixTexture mix{ColorInput(glm::vec3(1.0f), 2), glm::vec3(0.1f, 0.2f, 0.3f)};
  MixTexture by_channel = mix;
  by_channel.amount.texture = 0, by_channel.amount.channel = 1, by_channel.amount.value = 0.5f;
  by_channel.amount.power = 2.0f;
  MixTexture by_mean = by_channel;
  by_mean.amount.channel = -1, by_mean.amount.power = 1.7f;
  const TextureStore store({Texture(texture_of(c)), board, product, mix, by_channel, by_mean});
  for (std::uint32_t i = 0; i < 300; ++i) {
    const glm::vec2 uv = some_uv(i, 13);
    const Color image = reference_lookup(c.reference, texture_of(c), uv);
    const glm::dvec2 p = transformed(board.uv, uv);
    const bool even = std::fmod(std::floor(p.x) + std::floor(p.y), 2.0) == 0.0;
    Color expected = plus_alpha(board.even.value), a{}, b = plus_alpha(mix.b.value);
    if (!even) expected = {image[0] * 0.5, image[1] * 2.0, image[2], image[3]};
    const auto found = [&](int texture) { return lookup<float>(store.table(), texture, uv); };
    expect_color(found(1), expected, 1e-4, "checkerboard");
    for (size_t k = 0; k < 4; ++k) a[k] = image[k] * (k < 3 ? 2.0 : 1.0) * expected[k];
    expect_color(found(2), a, 1e-4, "product");
    const auto mixed_by = [&](double amount) {
      Color m{};
      for (size_t k = 0; k < 4; ++k) m[k] = (1.0 - amount) * a[k] + amount * b[k];
      return m;
    };
    expect_color(found(3), mixed_by(0.5), 1e-4, "mix");
    expect_color(found(4), mixed_by(0.5 * image[1] * image[1]), 1e-4, "mix by a channel");
    const double mean = (image[0] + image[1] + image[2]) / 3.0;
    expect_color(found(5), mixed_by(0.5 * std::pow(mean, double(1.7f))), 1e-4, "mix by a mean");
  }
}

ProductTexture product_of(int a, int b) {
  return {ColorInput(glm::vec3(1.0f), a), ColorInput(glm::vec3(0.5f), b)};
}

TEST_F(Textures, ExpressionsHaveLimits) {
  const auto error = [](const std::vector<Texture>& textures) {
    return error_of([&] { TextureStore store(textures); });
  };
  expect_one_line_with(error({product_of(0, -1)}), "refers to itself");
  expect_one_line_with(error({product_of(1, -1), product_of(0, -1)}), "refers to itself");
  expect_one_line_with(error({product_of(7, -1)}), "texture 7, which does not exist");
  std::vector<Texture> chain{CheckerboardTexture{}}, tree = chain;
  for (int i = 0; i < max_texture_depth - 1; ++i) {
    chain.push_back(product_of(-1, i));
    tree.push_back(product_of(i, i));
  }
  EXPECT_EQ(error(chain), "");
  expect_one_line_with(error(tree), "parts");
  const TextureStore store(chain);
  const int last = max_texture_depth - 1;
  EXPECT_EQ(lookup<float>(store.table(), last, Vec2<float>(0.5f)).g, std::ldexp(1.0f, -last));
  chain.push_back(product_of(-1, last));
  expect_one_line_with(error(chain), "deep");
}

// Sharing and memory ----------------------------------------------------------------------------

TEST_F(Textures, ImagesAreHeldOncePerEncoding) {
  const Case c = cases()[0];
  const ImageTexture t = texture_of(c);
  ImageTexture mirrored = t, linear = t, detour = t;
  mirrored.wrap_u = TextureWrap::Mirror;
  linear.encoding = TextureEncoding::Linear;
  detour.file = path("./srgb.png");
  const TextureStore one({Texture(t)}), same({Texture(t), mirrored, detour}),
      two({Texture(t), linear});
  EXPECT_EQ(same.image_count(), 1u);
  EXPECT_EQ(two.image_count(), 2u);
  EXPECT_GE(one.memory_bytes(), 7u * 5u * 4u);
  EXPECT_LT(one.memory_bytes(), 4096u);
  EXPECT_EQ(TextureStore().memory_bytes(), 0u);
  EXPECT_EQ(one.fingerprint(), TextureStore({Texture(t)}).fingerprint());
  EXPECT_NE(one.fingerprint(), TextureStore({Texture(mirrored)}).fingerprint());
  EXPECT_NE(one.fingerprint(), TextureStore({Texture(linear)}).fingerprint());
}

std::shared_ptr<const std::vector<unsigned char>> in_memory(const std::string& bytes) {
  return std::make_shared<const std::vector<unsigned char>>(bytes.begin(), bytes.end());
}

TEST_F(Textures, ImagesInMemoryAreRead) {
  const Case c = cases()[0];
  std::ifstream file(c.file, std::ios::binary);
  const std::string png{std::istreambuf_iterator<char>(file), {}};
  ImageTexture t = texture_of(c), on_disk = t;
  t.file = "scene.glb: image 3";
  t.encoded = in_memory(png);
  const TextureStore store({Texture(t), on_disk});
  for (std::uint32_t i = 0; i < 50; ++i) {
    const glm::vec2 uv = some_uv(i, 14);
    EXPECT_EQ(lookup<float>(store.table(), 0, uv).g, lookup<float>(store.table(), 1, uv).g);
  }
  Image grey(16, 16);
  for (float& v : grey.pixels) v = 0.2f;
  for (const std::string name : {"a.jpg", "a.webp", "a.bmp", "a.hdr", "a.exr"}) {
    write_image(path(name), grey);
    std::ifstream other(path(name), std::ios::binary);
    t.encoded = in_memory({std::istreambuf_iterator<char>(other), {}});
    const TextureStore from_memory({Texture(t)});
    EXPECT_NEAR(lookup<float>(from_memory.table(), 0, Vec2<float>(0.5f)).b, 0.2f, 0.01f) << name;
  }
}

// Files that cannot be used ---------------------------------------------------------------------

TEST_F(Textures, BadFilesAreErrors) {
  const auto error = [](const std::string& file) {
    ImageTexture t;
    t.file = file;
    t.where = "scene.pbrt:12";
    const std::string message = error_of([&] { TextureStore store({Texture(t)}); });
    expect_one_line_with(message, "scene.pbrt:12: " + file + ": ");
    return message;
  };
  const std::string png = png_bytes(random_png(3, 8));
  expect_one_line_with(error(path("missing.png")), "no such image file");
  expect_one_line_with(error(path("missing.exr")), "no such image file");
  expect_one_line_with(error(directory_.string()), "directory");
  error(write("text.png", "not an image at all\n"));
  error(write("empty.png", ""));
  error(write("cut.png", png.substr(0, png.size() / 2)));
  error(write("zero.png", png_bytes({0, 0, 3, 8, {}})));
  error(write("zero.ppm", "P6\n0 0\n255\n"));
  error(write("vast.png", png_bytes({60000, 60000, 3, 16, {}})));
  error(write("absurd.png", png_bytes({0x7fffffff, 0x7fffffff, 3, 8, {}})));
  Image noise(64, 64);
  for (std::uint32_t i = 0; i < noise.pixels.size(); ++i) noise.pixels[i] = uniform3(i, 5).x;
  write_image(path("cut.exr"), noise);
  std::filesystem::resize_file(path("cut.exr"), std::filesystem::file_size(path("cut.exr")) / 2);
  error(path("cut.exr"));
}

TEST_F(Textures, BadImagesInMemoryAndBadGammasAreErrors) {
  ImageTexture t;
  t.file = "scene.glb: image 3";
  t.where = "scene.glb: texture 1";
  const std::string png = png_bytes(random_png(3, 8));
  for (const std::string& bytes :
       {std::string(), std::string("GIF89a"), std::string("\x89PNG"), png.substr(0, 60)}) {
    t.encoded = in_memory(bytes);
    const std::string message = error_of([&] { TextureStore store({Texture(t)}); });
    expect_one_line_with(message, "scene.glb: texture 1: scene.glb: image 3: ");
  }
  ImageTexture dark = texture_of(cases()[0]);
  dark.encoding = TextureEncoding::Gamma;
  for (const float gamma : {0.0f, -1.0f, std::nanf("")}) {
    dark.gamma = gamma;
    expect_one_line_with(error_of([&] { TextureStore store({Texture(dark)}); }), "gamma");
  }
}

}  // namespace
}  // namespace lockstep::test_texture_store
