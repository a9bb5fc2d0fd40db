// The boundary between the program and its module lockstep_image_formats, which alone links
// OpenImageIO with its hundreds of libraries: plain data, and no exceptions across.
#pragma once

#include <cstddef>

namespace lockstep {

// A text in an image file's header.
struct FormatAttribute {
  const char* key = nullptr;
  const char* value = nullptr;
};

// What a call gave: a text if it failed, else what it was asked for.
struct FormatResult {
  const char* error = nullptr;
  int width = 0;
  int height = 0;
  const float* pixels = nullptr;  // linear red, green, blue
  const FormatAttribute* attributes = nullptr;
  size_t attribute_count = 0;
  const unsigned char* file = nullptr;
  size_t file_size = 0;
};

struct FormatImage {
  int width = 0;
  int height = 0;
  int channels = 0;
  const float* pixels = nullptr;
  bool eight_bit = false;  // stored as sRGB bytes, else as floats
  const FormatAttribute* attributes = nullptr;
  size_t attribute_count = 0;
};

// Results are the caller's to release; null means that memory ran out.
struct ImageFormats {
  const FormatResult* (*read)(const char* path);
  const FormatResult* (*read_attributes)(const char* path);
  const FormatResult* (*encode)(const char* path, const FormatImage* image);
  void (*release)(const FormatResult* result);
};

// The module's only symbol, a function of this type.
using ImageFormatsFunction = const ImageFormats*();
constexpr const char* image_formats_symbol = "lockstep_image_formats";
constexpr const char* image_formats_file = "lockstep_image_formats.so";

}  // namespace lockstep
