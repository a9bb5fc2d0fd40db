// Image files: EXR through OpenEXR, everything else through the module of image formats. Files are
// encoded in memory and then written in one checked pass: encoders may lose errors of their last
// write, a full disk must not.
#include "core/error.h"
#include "core/exr_file.h"
#include "core/image.h"
#include "core/image_module.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view key_prefix = "lockstep:";

// A library's message as one line.
std::string one_line(std::string message) {
  while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) {
    message.pop_back();
  }
  std::replace(message.begin(), message.end(), '\n', ' ');
  return message;
}

// Runs an action on a file; its errors get the file's name.
template <typename Action>
auto naming(const std::string& path, Action action) {
  try {
    return action();
  } catch (const std::bad_alloc&) {
    throw Error(path + ": image too large for memory, or its header is damaged");
  } catch (const std::length_error&) {
    throw Error(path + ": image too large for memory, or its header is damaged");
  } catch (const std::exception& error) {
    throw Error(path + ": " + one_line(error.what()));
  }
}

void check_file(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) throw Error("no such image file");
  if (fs::is_directory(path, ignored)) throw Error("is a directory, not an image file");
}

enum class Format { Exr, Float, Byte, Unknown };

// What a file of this name holds; only formats that can be encoded in memory are known.
Format format_of(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".exr") return Format::Exr;
  if (extension == ".hdr") return Format::Float;
  for (const char* known : {".png", ".jpg", ".jpeg", ".webp", ".tga", ".bmp", ".ppm"}) {
    if (extension == known) return Format::Byte;
  }
  return Format::Unknown;
}

Metadata attributes_of(const Metadata& settings) {
  Metadata attributes{{"Software", "lockstep"}};
  for (const auto& [key, value] : settings) attributes[std::string(key_prefix) + key] = value;
  return attributes;
}

std::vector<unsigned char> encoded(const std::string& path, const Image& image,
                                   const Metadata& metadata) {
  switch (format_of(path)) {
    case Format::Exr:
      return encode_exr(image, attributes_of(metadata));
    case Format::Float:
      return encode_with_module(path, image, attributes_of(metadata), Depth::Float);
    case Format::Byte:
      return encode_with_module(path, image, attributes_of(metadata), Depth::Byte);
    case Format::Unknown:
      break;
  }
  throw Error("cannot write this kind of image: use .exr, .png, .jpg or .hdr");
}

// A name beside `path` that no other process or thread of ours uses.
fs::path temporary_beside(const fs::path& path) {
  static std::atomic<int> counter{0};
  return path.parent_path() /
         fmt::format(".{}.{}-{}.tmp", path.filename().string(), getpid(), counter++);
}

void write_file(const std::string& path, const std::vector<unsigned char>& bytes) {
  const fs::path directory = fs::path(path).parent_path();
  std::error_code error;
  if (!directory.empty() && !fs::is_directory(directory, error)) {
    throw Error(path + ": directory '" + directory.string() + "' does not exist; create it first");
  }
  const fs::path temporary = temporary_beside(path);
  errno = 0;
  std::ofstream file(temporary, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  file.close();
  error.clear();
  if (file.fail()) {
    error.assign(errno ? errno : EIO, std::generic_category());
  } else {
    fs::rename(temporary, path, error);
  }
  if (error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw Error(path + ": cannot write the image: " + error.message());
  }
}

}  // namespace

Image read_image(const std::string& path) {
  return naming(path, [&] {
    check_file(path);
    return is_exr_file(path) ? read_exr(path) : read_with_module(path);
  });
}

Metadata read_metadata(const std::string& path) {
  const Metadata attributes = naming(path, [&] {
    check_file(path);
    return is_exr_file(path) ? read_exr_attributes(path) : read_attributes_with_module(path);
  });
  Metadata settings;
  for (const auto& [key, value] : attributes) {
    if (key.starts_with(key_prefix)) settings[key.substr(key_prefix.size())] = value;
  }
  return settings;
}

bool can_write_image(const std::string& path) {
  const Format format = format_of(path);
  if (format == Format::Unknown) return false;
  if (format != Format::Exr) naming(path, check_image_module);
  return true;
}

void write_image(const std::string& path, const Image& image, const Metadata& metadata) {
  if (image.width <= 0 || image.height <= 0 || image.channels <= 0) {
    throw Error(path + ": an image without pixels cannot be written");
  }
  write_file(path, naming(path, [&] { return encoded(path, image, metadata); }));
}

}  // namespace lockstep
