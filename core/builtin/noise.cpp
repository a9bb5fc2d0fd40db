#include "core/builtin/noise.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lockstep::builtin {
namespace {

// Mixes the bits of x: multiply-xorshift rounds with odd constants.
uint32_t mix_bits(uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

// The gradient that `hash` picks among the twelve edge directions of a cube, times `offset`.
float gradient(uint32_t hash, glm::vec3 offset) {
  const float a = hash & 1 ? 1.0f : -1.0f;
  const float b = hash & 2 ? 1.0f : -1.0f;
  switch ((hash >> 2) % 3) {
    case 0:
      return a * offset.x + b * offset.y;
    case 1:
      return a * offset.y + b * offset.z;
    default:
      return a * offset.z + b * offset.x;
  }
}

float smooth_step(float t) { return t * t * t * (t * (6.0f * t - 15.0f) + 10.0f); }

}  // namespace

float noise(glm::vec3 p) {
  const glm::vec3 cell = glm::floor(p);
  const glm::vec3 f = p - cell;
  const float fade[3] = {smooth_step(f.x), smooth_step(f.y), smooth_step(f.z)};
  // Weigh the ramps of the cell's eight corners.
  float sum = 0.0f;
  for (int k = 0; k < 2; ++k) {
    const uint32_t hash_z = mix_bits(uint32_t(int(cell.z) + k));
    const float weight_z = k ? fade[2] : 1.0f - fade[2];
    for (int j = 0; j < 2; ++j) {
      const uint32_t hash_y = mix_bits(uint32_t(int(cell.y) + j) + hash_z);
      const float weight_y = weight_z * (j ? fade[1] : 1.0f - fade[1]);
      for (int i = 0; i < 2; ++i) {
        const uint32_t hash_x = mix_bits(uint32_t(int(cell.x) + i) + hash_y);
        const float weight = weight_y * (i ? fade[0] : 1.0f - fade[0]);
        sum += weight * gradient(hash_x, f - glm::vec3(i, j, k));
      }
    }
  }
  return sum;
}

float fractal_noise(glm::vec3 p, int octaves) {
  float sum = 0.0f, strength = 1.0f;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += strength * noise(p);
    strength *= 0.5f;
    p = 2.0f * p + glm::vec3(17.3f, 5.7f, 11.9f);  // no two octaves share their lattice points
  }
  return sum;
}

float ridges(glm::vec3 p, int octaves) {
  float sum = 0.0f, strength = 0.5f;
  for (int octave = 0; octave < octaves; ++octave) {
    const float distance = std::abs(noise(p));
    sum += strength * (1.0f - std::min(1.0f, 2.0f * distance));
    strength *= 0.5f;
    p = 2.0f * p + glm::vec3(3.1f, 29.7f, 7.3f);
  }
  return sum;
}

float random_number(unsigned index) { return float(mix_bits(index + 1) >> 8) * 0x1p-24f; }

}  // namespace lockstep::builtin
