// A scene ready to be traced: flat arrays for the kernels and an Embree scene over them.
#pragma once

#include "core/scene_data.h"
#include "core/scene_description.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lockstep {

// What a scene contains; kernels skip the stages of what it lacks.
struct Features {
  bool smooth_normals = false;
  bool spheres = false;
  bool diffuse = false;
  bool conductor = false;
  bool coated = false;
  bool area_lights = false;
  bool environment = false;
  bool many_lights = false;   // more than one light: one has to be chosen
  bool filter_table = false;  // a pixel filter other than a box over the pixel

  std::vector<std::string> present() const;
  std::vector<std::string> absent() const;
};

// Owns the arrays that SceneData points into. Immutable after construction; shared by threads.
class Scene {
 public:
  // Builds the acceleration structure with Embree restricted to `embree_isa` ("sse4.2", "avx2",
  // "avx512"), so that hits are those of that instruction set. Throws Error where the scene cannot
  // be rendered (no geometry and no environment).
  Scene(SceneDescription description, const std::string& embree_isa);
  ~Scene();
  Scene(Scene&&) noexcept;

  const SceneDescription& description() const;  // its shapes are moved out: see data()
  const SceneData& data() const;                // for kernels
  const Features& features() const;
  std::size_t triangle_count() const;
  std::uint64_t fingerprint() const;  // of all that images of the scene depend on

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace lockstep
