// A scene ready to be traced: flat arrays for the kernels and an Embree scene over them.
#pragma once

#include "core/scene_data.h"
#include "core/scene_description.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lockstep {

// Bytes that a scene takes.
struct SceneMemory {
  std::size_t geometry = 0;     // the arrays that Embree and the kernels read
  std::size_t textures = 0;     // images of textures and of the environment, with its distribution
  std::size_t embree = 0;       // Embree's structures
  std::size_t embree_peak = 0;  // and what it took at most while building them
};

// Owns the arrays that SceneData points into. Immutable after construction; shared by threads.
class Scene {
 public:
  // Builds the acceleration structure with Embree restricted to `embree_isa` ("sse4.2", "avx2",
  // "avx512"; empty: as it is), so that hits are those of that instruction set. Throws Error where
  // the scene cannot be rendered (no geometry and no environment).
  Scene(SceneDescription description, const std::string& embree_isa);
  ~Scene();
  Scene(Scene&&) noexcept;

  const SceneDescription& description() const;  // its shapes are moved out: see data()
  const SceneData& data() const;                // for kernels
  FeatureMask features() const;
  std::size_t triangle_count() const;
  SceneMemory memory() const;
  std::uint64_t fingerprint() const;  // of all that images of the scene depend on

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace lockstep
