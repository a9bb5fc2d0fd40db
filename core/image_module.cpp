// Loads the module and turns its plain data into the program's.
#include "core/image_module.h"

#include "core/error.h"
#include "core/image_formats.h"

#include <dlfcn.h>

#include <filesystem>
#include <memory>
#include <new>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

fs::path module_path() {
  return fs::read_symlink("/proc/self/exe").parent_path() / image_formats_file;
}

// The module stays loaded: its libraries have threads and state of their own.
const ImageFormats* load_module() {
  check_image_module();
  void* const module = dlopen(module_path().c_str(), RTLD_LAZY | RTLD_LOCAL);
  void* const symbol = module ? dlsym(module, image_formats_symbol) : nullptr;
  if (!symbol) {
    throw Error(std::string("the module for this kind of image cannot be loaded: ") + dlerror() +
                "; build it again, or use .exr");
  }
  return reinterpret_cast<ImageFormatsFunction*>(symbol)();
}

const ImageFormats& image_formats() {
  static const ImageFormats* const formats = load_module();
  return *formats;
}

struct Release {
  void operator()(const FormatResult* result) const { image_formats().release(result); }
};
using Result = std::unique_ptr<const FormatResult, Release>;

Result checked(const FormatResult* given) {
  if (!given) throw std::bad_alloc();
  Result result(given);
  if (result->error) throw Error(result->error);
  return result;
}

}  // namespace

void check_image_module() {
  const fs::path file = module_path();
  if (fs::exists(file)) return;
  throw Error("this kind of image needs the module " + file.string() +
              ", which is missing: put it beside the program, or use .exr");
}

Image read_with_module(const std::string& path) {
  const Result result = checked(image_formats().read(path.c_str()));
  Image image(result->width, result->height);
  image.pixels.assign(result->pixels, result->pixels + image.pixels.size());
  return image;
}

Metadata read_attributes_with_module(const std::string& path) {
  const Result result = checked(image_formats().read_attributes(path.c_str()));
  Metadata attributes;
  for (size_t i = 0; i < result->attribute_count; ++i) {
    attributes[result->attributes[i].key] = result->attributes[i].value;
  }
  return attributes;
}

std::vector<unsigned char> encode_with_module(const std::string& path, const Image& image,
                                              const Metadata& attributes, Depth depth) {
  std::vector<FormatAttribute> list;
  for (const auto& [key, value] : attributes) list.push_back({key.c_str(), value.c_str()});
  const FormatImage plain{image.width,          image.height, image.channels, image.pixels.data(),
                          depth == Depth::Byte, list.data(),  list.size()};
  const Result result = checked(image_formats().encode(path.c_str(), &plain));
  return {result->file, result->file + result->file_size};
}

}  // namespace lockstep
