#include "core/scene_warnings.h"

#include "core/bounds.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lockstep {

std::string precision_warning(const SceneDescription& scene) {
  const Bounds bounds = bounds_of(scene);
  if (bounds.empty()) return {};
  const double size = double(glm::length(bounds.hi - bounds.lo));
  double farthest = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    farthest =
        std::max({farthest, std::abs(double(bounds.lo[axis])), std::abs(double(bounds.hi[axis]))});
  }
  if (!std::isfinite(farthest) || farthest <= farthest_in_sizes * size) return {};
  return fmt::format(
      "{}: the scene lies {:.2g} times its size from the origin, where float coordinates are "
      "{:.2g} "
      "of its size apart: surfaces leak and lose their shape; move it nearer",
      scene.name, farthest / size, farthest * 0x1p-23 / size);
}

}  // namespace lockstep
