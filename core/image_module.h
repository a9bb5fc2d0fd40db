// Image formats other than EXR, through a module that is loaded when the first of them is met: the
// libraries that it needs take longer to load than a small render, and more memory. The texts of
// Errors leave out the image's name, which image_io.cpp adds.
#pragma once

#include "core/image.h"

#include <string>
#include <vector>

namespace lockstep {

// Throws Error if the module is not beside the program; loads nothing.
void check_image_module();

// Colours, linear.
Image read_with_module(const std::string& path);

// All texts of the header.
Metadata read_attributes_with_module(const std::string& path);

enum class Depth { Float, Byte };

// The bytes of a file of the format that the extension names.
std::vector<unsigned char> encode_with_module(const std::string& path, const Image& image,
                                              const Metadata& attributes, Depth depth);

}  // namespace lockstep
