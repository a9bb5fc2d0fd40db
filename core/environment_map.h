// Environment maps, loaded and ready for the kernels.
#pragma once

#include "core/environment_map_data.h"
#include "core/light_description.h"
#include "core/texture_image.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lockstep {

// True where the matrix is a rotation or reflection times a number, to a thousandth. Maps are
// placed by the nearest such matrix that keeps the first axis; say so where it is not.
bool keeps_angles(const glm::mat3& to_world);

class EnvironmentMap {
 public:
  // Loads the image of an environment whose mapping is not Constant; values below 0 become 0.
  // Throws Error "where: file: what": see read_texture_image; also where an octahedral map is no
  // square and where the environment's matrix has no inverse.
  explicit EnvironmentMap(const Environment& environment);

  EnvironmentMapData view() const;  // valid while the map lives, moved or not
  glm::vec3 mean_radiance() const { return mean_radiance_; }  // over the sphere
  std::size_t memory_bytes() const;
  std::uint64_t fingerprint() const;  // of all that lookups depend on

 private:
  void build_distribution();

  EnvironmentMapData data_;  // without its pointers
  TextureImage image_;
  std::vector<float> row_cdf_, column_cdf_, row_density_, latitudes_;
  std::vector<std::int32_t> row_guide_, column_guide_;
  glm::vec3 mean_radiance_{0.0f};
};

}  // namespace lockstep
