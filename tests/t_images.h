// Small images: files of which tests know every value, and renders compared with closed forms.
#pragma once

#include "tests/t_files.h"
#include "tests/t_png.h"
#include "tests/t_scenes.h"
#include "tests/t_statistics.h"

#include <functional>
#include <string>
#include <vector>

namespace lockstep {

// The colour of column x and row y; row 0 is the top.
using PixelFunction = std::function<glm::vec3(int x, int y)>;

inline Image image_of(int width, int height, const PixelFunction& color) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec3 c = color(x, y);
      for (int k = 0; k < 3; ++k) image.at(x, y)[k] = c[k];
    }
  }
  return image;
}

class TestWithImages : public TestWithFiles {
 protected:
  // The path of a float file: textures of it are these numbers.
  std::string exr(const std::string& name, int width, int height,
                  const PixelFunction& color) const {
    write_image(path(name + ".exr"), image_of(width, height, color));
    return path(name + ".exr");
  }
  std::string png(const std::string& name, const PngImage& image) const {
    return write(name + ".png", png_bytes(image));
  }
};

inline ImageTexture texture_of(const std::string& file,
                               TextureFilter filter = TextureFilter::Nearest) {
  ImageTexture t;
  t.file = file;
  t.filter = filter;
  t.where = "scene:1";
  return t;
}

// Appends a texture; returns its index.
inline int add_texture(SceneDescription& scene, Texture texture) {
  scene.textures.push_back(std::move(texture));
  return int(scene.textures.size()) - 1;
}

inline ColorInput textured(int texture, glm::vec3 factor = glm::vec3(1.0f)) {
  return {factor, texture};
}

inline FloatInput textured_number(int texture, float factor = 1.0f) {
  FloatInput f(factor);
  f.texture = texture;
  return f;
}

// An orthographic camera at `eye`, looking at `target`, whose image has this many units along its
// shorter side.
inline void look_straight(SceneDescription& scene, glm::vec3 eye, glm::vec3 target, float extent,
                          int width, int height) {
  scene.camera = {};
  scene.camera.camera_to_world = builtin::look_at(eye, target);
  scene.camera.projection = CameraDescription::Projection::Orthographic;
  scene.camera.extent = extent;
  scene.film.width = width;
  scene.film.height = height;
}

// Corners on the texture for a mesh of builtin::add_rectangle(center, a, b): u along a; v against b
// and so down where b is up.
inline void set_uvs(SceneDescription& scene, std::size_t shape, glm::vec2 scale = glm::vec2(1.0f)) {
  auto& mesh = std::get<TriangleMesh>(scene.shapes[shape].geometry);
  glm::vec3 low = mesh.positions[0], a = mesh.positions[1] - low, b = mesh.positions[3] - low;
  mesh.uvs.clear();
  for (const glm::vec3 p : mesh.positions) {
    const float u = glm::dot(p - low, a) / glm::dot(a, a);
    const float v = 1.0f - glm::dot(p - low, b) / glm::dot(b, b);
    mesh.uvs.push_back(glm::vec2(u, v) * scale);
  }
}

struct Plan {
  const char* sampler = "owen";
  int spp = 16;
  int depth = 1;
  int seeds = 16;
};

// Without Russian roulette, which test_path.cpp tests.
inline RenderSettings settings_of(const Plan& plan, int seed = 0) {
  RenderSettings s;
  s.seed = std::uint32_t(seed);
  s.spp = plan.spp;
  s.depth = plan.depth;
  s.roulette_depth = 1000;
  s.threads = 1;
  return s;
}

inline Image rendered(const Scene& scene, const Plan& plan, int seed = 0) {
  return render(scene, parse_sampler(plan.sampler), settings_of(plan, seed)).image;
}

// Statistics over seeds of one channel: of every pixel, and of the image's mean.
struct Observed {
  std::vector<Moments> pixels;
  Moments mean;
};

inline Observed observe(const Scene& scene, const Plan& plan, int channel = 0) {
  Observed o;
  for (int seed = 0; seed < plan.seeds; ++seed) {
    const Image image = rendered(scene, plan, seed);
    o.pixels.resize(image.pixels.size() / 3);
    for (std::size_t p = 0; p < o.pixels.size(); ++p) {
      o.pixels[p].add(double(image.pixels[3 * p + std::size_t(channel)]));
    }
    o.mean.add(channel_mean(image, channel));
  }
  return o;
}

// No file has more t-tests than this; those of an image's pixels share what one may spend.
inline constexpr double tests_at_most = 256;
inline const double level = sidak(significance, tests_at_most);

// `rounding` is the relative error that float arithmetic may add.
inline void expect_mean(const Moments& m, double expected, double rounding = 2e-5) {
  EXPECT_GT(mean_is(m, expected, rounding * expected), level)
      << "mean " << m.mean << " +- " << std::sqrt(m.mean_variance()) << ", expected " << expected;
}

inline void expect_every_pixel(const Observed& o, double expected, double rounding = 2e-5) {
  double least = 1.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < o.pixels.size(); ++i) {
    const double p = mean_is(o.pixels[i], expected, rounding * expected);
    if (p < least) least = p, at = i;
  }
  EXPECT_GT(least, sidak(level, double(o.pixels.size())))
      << "pixel " << at << ": " << o.pixels[at].mean << " +- "
      << std::sqrt(o.pixels[at].mean_variance()) << ", expected " << expected;
  expect_mean(o.mean, expected, rounding);
}

}  // namespace lockstep
