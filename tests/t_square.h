// A square that fills the image, for renders compared with closed forms. Diffuse under a constant
// sky it has no variance: it shows its albedo.
#pragma once

#include "tests/t_images.h"

namespace lockstep {

inline constexpr float sky = 2.0f;

// The square [-1, 1]^2 in z = 0 that fills the image: u to the right, v down.
inline SceneDescription square(const Material& material, int side = 8) {
  SceneDescription d;
  d.name = "square";
  builtin::add_rectangle(d, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, builtin::add_material(d, material));
  set_uvs(d, 0);
  look_straight(d, {0, 0, 3}, {0, 0, 0}, 2.0f, side, side);
  d.environment = glm::vec3(sky);
  return d;
}

// Samples lie in the middle of pixels.
inline void sample_centres(SceneDescription& d) { d.film.filter.radius = glm::vec2(1e-4f); }

// Every pixel of one render, in which there is no noise.
inline void expect_pixels(const Scene& scene, const PixelFunction& expected,
                          float tolerance = 1e-4f) {
  const Image image = rendered(scene, {.spp = 4, .depth = 1});
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const glm::vec3 e = expected(x, y);
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(image.at(x, y)[c], e[c], tolerance) << x << ' ' << y << ' ' << c;
      }
    }
  }
}

}  // namespace lockstep
