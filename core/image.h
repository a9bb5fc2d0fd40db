// Images in memory, and files of them. Only exr_file.cpp knows OpenEXR, and only image_formats.cpp,
// a module loaded when it is needed, knows OpenImageIO.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace lockstep {

// Interleaved float pixels, row by row from the top left; colour images are linear Rec. 709 RGB.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 3;
  std::vector<float> pixels;

  Image() = default;
  Image(int w, int h, int c = 3)
      : width(w), height(h), channels(c), pixels(size_t(w) * size_t(h) * size_t(c), 0.0f) {}
  float* at(int x, int y) {
    return &pixels[(size_t(y) * size_t(width) + size_t(x)) * size_t(channels)];
  }
  const float* at(int x, int y) const {
    return &pixels[(size_t(y) * size_t(width) + size_t(x)) * size_t(channels)];
  }
};

// Settings kept in a file's header, as strings: EXR attributes, PNG text.
using Metadata = std::map<std::string, std::string>;

// Reads EXR and any format OpenImageIO reads. Integer formats that are sRGB come back linear; alpha
// is dropped; grey becomes RGB. Throws Error.
Image read_image(const std::string& path);

// Reads the header's settings (those that write_image stored).
Metadata read_metadata(const std::string& path);

// True for the extensions that write_image knows: .exr and .hdr as float; .png, .jpg and some more
// as 8-bit sRGB. Throws Error where the module that writes such a file is missing.
bool can_write_image(const std::string& path);

// Writes float EXR (or what the extension asks for; 8-bit formats get the sRGB curve).
// The file appears whole or not at all: it is written beside its place and renamed. Throws Error.
void write_image(const std::string& path, const Image& image, const Metadata& metadata = {});

}  // namespace lockstep
