// Image formats other than EXR, through a module that is loaded when the first of them is met: the
// libraries that it needs take longer to load than a small render, and more memory. The texts of
// Errors leave out the image's name, which image_io.cpp adds.
#pragma once

#include "core/image.h"
#include "core/texture_data.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lockstep {

// Throws Error if the module is not beside the program; loads nothing.
void check_image_module();

// Colours, linear.
Image read_with_module(const std::string& path);

// All texts of the header.
Metadata read_attributes_with_module(const std::string& path);

// An image as its file has it: red, green, blue and alpha (1 where there is none) row by row from
// the top left, of 8 or 16 bits, halves or floats, packed into words with the lowest bits first;
// `texel_padding` more words at the end.
struct StoredPixels {
  int width = 0, height = 0;
  TexelFormat format = TexelFormat::Byte;
  std::vector<std::int32_t> words;
};
StoredPixels read_stored_with_module(const std::string& path);

// The same for the content of a file; its format is known by how it begins.
StoredPixels read_stored_with_module(const std::vector<unsigned char>& file);

enum class Depth { Float, Byte };

// The bytes of a file of the format that the extension names.
std::vector<unsigned char> encode_with_module(const std::string& path, const Image& image,
                                              const Metadata& attributes, Depth depth);

}  // namespace lockstep
