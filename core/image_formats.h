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

// How the values of an image are stored: whole numbers as fractions of their largest value.
enum class FormatDepth { Byte, Short, Half, Float };

// What a call gave: a text if it failed, else what it was asked for.
struct FormatResult {
  const char* error = nullptr;
  int width = 0;
  int height = 0;
  const float* pixels = nullptr;  // linear red, green, blue
  FormatDepth depth = FormatDepth::Byte;
  const void* stored = nullptr;  // red, green, blue, alpha of that depth, as the file has them
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

constexpr size_t max_stored_bytes = size_t(8) << 30;  // of an image that read_stored gives

// Results are the caller's to release; null means that memory ran out.
struct ImageFormats {
  const FormatResult* (*read)(const char* path);
  const FormatResult* (*read_attributes)(const char* path);
  // An image in memory, or where `bytes` is null the file of that name.
  const FormatResult* (*read_stored)(const char* path, const unsigned char* bytes, size_t size);
  const FormatResult* (*encode)(const char* path, const FormatImage* image);
  void (*release)(const FormatResult* result);
};

// The module's only symbol, a function of this type.
using ImageFormatsFunction = const ImageFormats*();
constexpr const char* image_formats_symbol = "lockstep_image_formats";
constexpr const char* image_formats_file = "lockstep_image_formats.so";

}  // namespace lockstep
