// Smooth random functions of space: gradient noise (Perlin 2002) and sums of its octaves.
#pragma once

#include <glm/vec3.hpp>

namespace lockstep::builtin {

// Smooth, about [-1, 1], mean 0, features of size 1; zero at integer points.
float noise(glm::vec3 p);

// Octaves of noise: each twice as fine and half as strong as the one before.
float fractal_noise(glm::vec3 p, int octaves);

// Meandering ridges, in [0, 1]: crests where the noise crosses zero.
float ridges(glm::vec3 p, int octaves);

// A number in [0, 1) for each index, the same in every run.
float random_number(unsigned index);

}  // namespace lockstep::builtin
