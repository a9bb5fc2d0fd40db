// Camera and film as a scene file states them.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

namespace lockstep {

// Camera space has x to the right of the image, y up, z into the scene.
struct CameraDescription {
  enum class Projection { Perspective, Orthographic };
  glm::mat4 camera_to_world{1.0f};
  Projection projection = Projection::Perspective;
  float fov_degrees = 90.0f;    // perspective: full angle along the shorter image axis
  float extent = 2.0f;          // orthographic: the image's shorter side, in the scene's unit
  glm::vec2 shift{0.0f};        // of the image's centre, right and up, in units of the shorter side
  float lens_radius = 0.0f;     // 0: a pinhole
  float focal_distance = 1e6f;  // along z, where a lens is sharp
};

// Reconstruction filter over the pixel, separable, centred on the pixel; radii in pixels.
struct PixelFilter {
  enum class Kind { Box, Triangle, Gaussian, Mitchell, Lanczos };
  Kind kind = Kind::Box;
  glm::vec2 radius{0.5f};
  float sigma = 0.5f;                      // Gaussian only, in pixels
  float b = 1.0f / 3.0f, c = 1.0f / 3.0f;  // Mitchell only (Mitchell and Netravali 1988)
  float tau = 3.0f;  // Lanczos only: sinc(x) sinc(x / tau), cut off at the radius
};

struct FilmDescription {
  int width = 512;
  int height = 512;
  PixelFilter filter;
};

}  // namespace lockstep
