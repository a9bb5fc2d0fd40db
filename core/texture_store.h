// All textures of a scene, loaded and ready for the kernels.
#pragma once

#include "core/texture_image.h"
#include "core/texture_program.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lockstep {

class TextureStore {
 public:
  TextureStore() = default;
  // Loads every image once per encoding, on all of oneTBB's threads. Throws the Error of the first
  // texture that has one: see read_texture_image and compile_textures.
  explicit TextureStore(const std::vector<Texture>& textures);

  // Programs in the order of the scene's textures; valid while the store lives, moved or not.
  TextureTable table() const;
  std::size_t memory_bytes() const;
  std::size_t image_count() const { return images_.size(); }  // that are held, shared or not
  std::uint64_t fingerprint() const;                          // of all that lookups depend on

 private:
  std::vector<TextureImage> images_;
  std::vector<ImageLookup> lookups_;  // one per image texture
  TexturePrograms programs_;
};

}  // namespace lockstep
