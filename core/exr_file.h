// OpenEXR files; only exr_file.cpp knows the OpenEXR library. The texts of Errors leave out the
// file's name, which image_io.cpp adds.
#pragma once

#include "core/image.h"

#include <string>
#include <vector>

namespace lockstep {

// True for files that begin as EXR files do, whatever their name.
bool is_exr_file(const std::string& path);

// The colours of the first part: channels R, G and B, or those of the first layer; a file of one
// or two channels is grey. Half floats are widened, whole numbers become fractions of their
// largest value.
Image read_exr(const std::string& path);

// All text attributes of the first part's header.
Metadata read_exr_attributes(const std::string& path);

// The bytes of a file with these text attributes: float channels, losslessly compressed.
std::vector<unsigned char> encode_exr(const Image& image, const Metadata& attributes);

}  // namespace lockstep
