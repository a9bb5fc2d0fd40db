// Loads the module and turns its plain data into the program's.
#include "core/image_module.h"

#include "core/error.h"
#include "core/image_formats.h"
#include "core/memory.h"

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <new>
#include <string_view>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

// Where shared libraries are looked for; first of all in the folders that the program's rpath
// names.
std::vector<fs::path> library_folders() {
  void* const program = dlopen(nullptr, RTLD_LAZY);
  Dl_serinfo size{};
  if (!program || dlinfo(program, RTLD_DI_SERINFOSIZE, &size) != 0) return {};
  std::vector<Dl_serinfo> storage(size.dls_size / sizeof(Dl_serinfo) + 1, size);
  Dl_serinfo* const list = storage.data();
  if (dlinfo(program, RTLD_DI_SERINFO, list) != 0) return {};
  std::vector<fs::path> folders;
  const Dl_serpath* const paths = list->dls_serpath;
  for (unsigned i = 0; i < list->dls_cnt; ++i) folders.emplace_back(paths[i].dls_name);
  return folders;
}

// Beside the program, as it is built; or where its rpath says, as it is installed.
fs::path find_module() {
  const fs::path beside = fs::read_symlink("/proc/self/exe").parent_path() / image_formats_file;
  if (fs::exists(beside)) return beside;
  for (const fs::path& folder : library_folders()) {
    if (fs::exists(folder / image_formats_file)) return folder / image_formats_file;
  }
  return beside;
}

const fs::path& module_path() {
  static const fs::path path = find_module();
  return path;
}

// What its libraries and their threads take of address space. Where they get less, their own
// constructors crash.
constexpr std::uint64_t module_bytes = std::uint64_t(1) << 30;

void check_address_space() {
  const bool is_loaded = dlopen(module_path().c_str(), RTLD_LAZY | RTLD_NOLOAD) != nullptr;
  if (is_loaded || left_address_space() >= module_bytes) return;
  throw Error(
      "the module for this kind of image needs 1 GiB of address space, and ulimit -v leaves less; "
      "allow more memory, or use .exr");
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

TexelFormat format_of(FormatDepth depth) {
  switch (depth) {
    case FormatDepth::Byte:
      return TexelFormat::Byte;
    case FormatDepth::Short:
      return TexelFormat::Short;
    case FormatDepth::Half:
      return TexelFormat::Half;
    case FormatDepth::Float:
      break;
  }
  return TexelFormat::Float;
}

StoredPixels stored_pixels(const FormatResult& result) {
  StoredPixels pixels{result.width, result.height, format_of(result.depth), {}};
  const size_t words =
      size_t(result.width) * size_t(result.height) * size_t(words_per_texel(pixels.format));
  pixels.words.reserve(words + texel_padding);
  const auto* stored = static_cast<const std::int32_t*>(result.stored);
  pixels.words.assign(stored, stored + words);
  pixels.words.resize(words + texel_padding);
  return pixels;
}

// A name whose extension is that of the file's format, as its first bytes show it: the module
// chooses its reader by the name.
std::string name_of_format(const std::vector<unsigned char>& file) {
  const std::string_view start(reinterpret_cast<const char*>(file.data()),
                               std::min(file.size(), size_t(16)));
  const auto starts = [&](std::string_view bytes) { return start.starts_with(bytes); };
  if (starts("\x89PNG")) return "image.png";
  if (starts("\xff\xd8\xff")) return "image.jpg";
  if (starts("RIFF") && start.substr(std::min(start.size(), size_t(8))).starts_with("WEBP")) {
    return "image.webp";
  }
  if (starts("v/1\x01")) return "image.exr";
  if (starts("#?")) return "image.hdr";
  if (starts("BM")) return "image.bmp";
  if (starts("II*") || starts("MM")) return "image.tif";
  throw Error("the image's format is not known: use PNG or JPEG");
}

}  // namespace

void check_image_module() {
  const fs::path& file = module_path();
  if (fs::exists(file)) return check_address_space();
  throw Error("this kind of image needs the module " + file.string() +
              ", which is missing: put it beside the program, or use .exr");
}

Image read_with_module(const std::string& path) {
  const Result result = checked(image_formats().read(path.c_str()));
  Image image(result->width, result->height);
  image.pixels.assign(result->pixels, result->pixels + image.pixels.size());
  return image;
}

StoredPixels read_stored_with_module(const std::string& path) {
  return stored_pixels(*checked(image_formats().read_stored(path.c_str(), nullptr, 0)));
}

StoredPixels read_stored_with_module(const std::vector<unsigned char>& file) {
  const std::string name = name_of_format(file);
  return stored_pixels(
      *checked(image_formats().read_stored(name.c_str(), file.data(), file.size())));
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
