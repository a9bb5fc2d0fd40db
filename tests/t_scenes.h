// Small scenes for tests of the renderer, and what tests do with renders.
#pragma once

#include "core/builtin/parts.h"
#include "core/builtin/scenes.h"
#include "core/read_scene.h"
#include "core/scene.h"
#include "packets/render.h"

#include <cstring>

namespace lockstep {

inline Scene build(SceneDescription description, Isa isa = choose_isa()) {
  return Scene(std::move(description), embree_isa(isa));
}

inline SceneDescription resized(SceneDescription description, int width, int height) {
  description.film.width = width;
  description.film.height = height;
  return description;
}

inline bool same_bytes(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

// The mean of one channel over the image.
inline double channel_mean(const Image& image, int channel) {
  double sum = 0.0;
  for (std::size_t i = size_t(channel); i < image.pixels.size(); i += 3) {
    sum += double(image.pixels[i]);
  }
  return sum / double(image.pixels.size() / 3);
}

inline double mean_of(const Image& image) {
  return (channel_mean(image, 0) + channel_mean(image, 1) + channel_mean(image, 2)) / 3.0;
}

// A camera at `eye` that sees little more than the point `target`.
inline void look_closely(SceneDescription& scene, glm::vec3 eye, glm::vec3 target) {
  scene.camera.camera_to_world = builtin::look_at(eye, target);
  scene.camera.fov_degrees = 0.02f;
  scene.film.width = scene.film.height = 8;
}

}  // namespace lockstep
