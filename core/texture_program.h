// Texture expressions as flat programs, operands before what uses them.
#pragma once

#include "core/texture_data.h"

#include <vector>

namespace lockstep {

struct TexturePrograms {
  std::vector<TextureProgram> programs;  // one per texture
  std::vector<TextureNode> nodes;
};

// Image nodes of textures[i] refer to image image_of_texture[i].
// Throws Error for textures that refer to themselves or to one that does not exist, and for those
// nested deeper than max_texture_depth or longer than max_texture_nodes.
TexturePrograms compile_textures(const std::vector<Texture>& textures,
                                 const std::vector<int>& image_of_texture);

}  // namespace lockstep
