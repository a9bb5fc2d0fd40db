// Camera and film as a scene file states them.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

namespace lockstep {

// Perspective pinhole camera. Camera space has x to the right of the image, y up, z into the scene.
struct CameraDescription {
  glm::mat4 camera_to_world{1.0f};
  float fov_degrees = 90.0f;  // full angle along the shorter image axis
};

// Reconstruction filter over the pixel, separable, centred on the pixel; radii in pixels.
struct PixelFilter {
  enum class Kind { Box, Triangle, Gaussian };
  Kind kind = Kind::Box;
  glm::vec2 radius{0.5f};
  float sigma = 0.5f;  // Gaussian only, in pixels
};

struct FilmDescription {
  int width = 512;
  int height = 512;
  PixelFilter filter;
};

}  // namespace lockstep
