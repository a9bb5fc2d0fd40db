// The images of textures and environment maps, in the format that their files have.
#pragma once

#include "core/fingerprint.h"
#include "core/texture_data.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lockstep {

// Texels as TexelData describes them, with the rows of their levels.
struct TextureImage {
  TexelFormat format = TexelFormat::Byte;
  std::vector<std::int32_t> words;
  std::vector<std::int32_t> levels;
  std::vector<float> decode;

  int width() const { return levels[0]; }
  int height() const { return levels[1]; }
  TexelData view() const;
  std::size_t memory_bytes() const;
  void add_to(Fingerprint& print) const;
};

struct LinearTexel {
  float r, g, b, a;
};

// The texel in column x of row y of a level, as kernels see it.
LinearTexel texel_at(const TextureImage& image, int level, int x, int y);

// Reads the file (or the bytes in memory) that `texture` names. 8- and 16-bit images and halves
// stay what they are, floats become halves where that changes none of them, and 16-bit or float
// images that are not linear become linear floats. Infinite values become the largest half, what is
// not a number 0. Of EXR files on disk alpha is 1.
// Throws Error "where: file: what" for files that cannot be read and images above 8 GiB.
TextureImage read_texture_image(const ImageTexture& texture);

// Adds smaller levels down to a single texel: sides are halved, rounded down, and texels averaged
// by the area that they cover, linearly. Images above 4 GiB stay as they are.
void add_pyramid(TextureImage& image);

}  // namespace lockstep
