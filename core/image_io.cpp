// Image files through OpenImageIO, encoded in memory and then written in one checked pass:
// encoders may lose errors of their last write, a full disk must not.
#include "core/error.h"
#include "core/image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view key_prefix = "lockstep:";

// IEC 61966-2-1, both ways; values outside [0, 1] are not clamped here.
float linear_from_srgb(float v) {
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}
float srgb_from_linear(float v) {
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
}

// An encoder's message as one line.
std::string one_line(std::string message) {
  while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) {
    message.pop_back();
  }
  std::replace(message.begin(), message.end(), '\n', ' ');
  return message.empty() ? "unknown reason" : message;
}

std::unique_ptr<OIIO::ImageInput> open_input(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) throw Error(path + ": no such image file");
  if (fs::is_directory(path, ignored)) throw Error(path + ": is a directory, not an image file");
  // Colours as they are stored, not multiplied by an alpha that is dropped.
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  auto input = OIIO::ImageInput::open(path, &hints);
  if (!input) throw Error(path + ": cannot read this image: " + one_line(OIIO::geterror()));
  return input;
}

// The channels that hold red, green and blue; grey images name the same channel three times.
std::array<int, 3> colour_channels(const OIIO::ImageSpec& spec) {
  const auto index = [&](const char* name) { return spec.channelindex(name); };
  if (index("R") >= 0 && index("G") >= 0 && index("B") >= 0) {
    return {index("R"), index("G"), index("B")};
  }
  if (spec.nchannels < 3) return {0, 0, 0};
  return {0, 1, 2};
}

bool is_srgb(const OIIO::ImageSpec& spec) {
  if (spec.format.is_floating_point()) return false;
  const std::string space = spec.get_string_attribute("oiio:ColorSpace", "sRGB");
  return !OIIO::Strutil::istarts_with(space, "lin") &&
         spec.get_float_attribute("oiio:Gamma", 2.2f) != 1.0f;
}

Image read_pixels(OIIO::ImageInput& input, const std::string& path) {
  const OIIO::ImageSpec& spec = input.spec();
  if (spec.depth > 1 || spec.deep) throw Error(path + ": volume and deep images are not supported");
  const auto channels = colour_channels(spec);
  const int last = std::max({channels[0], channels[1], channels[2]}) + 1;
  std::vector<float> stored(size_t(spec.width) * size_t(spec.height) * size_t(last));
  if (!input.read_image(0, 0, 0, last, OIIO::TypeFloat, stored.data())) {
    throw Error(path + ": damaged image: " + one_line(input.geterror()));
  }
  const bool decode = is_srgb(spec);
  Image image(spec.width, spec.height);
  for (size_t pixel = 0; pixel < stored.size() / size_t(last); ++pixel) {
    for (size_t c = 0; c < 3; ++c) {
      const float v = stored[pixel * size_t(last) + size_t(channels[c])];
      image.pixels[pixel * 3 + c] = decode ? linear_from_srgb(v) : v;
    }
  }
  return image;
}

enum class Depth { Float, Byte };

// What the formats that can be encoded in memory hold; nothing for any other extension.
std::optional<Depth> depth_of(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  for (const char* known : {".exr", ".hdr"}) {
    if (extension == known) return Depth::Float;
  }
  for (const char* known : {".png", ".jpg", ".jpeg", ".webp", ".tga", ".bmp", ".ppm"}) {
    if (extension == known) return Depth::Byte;
  }
  return std::nullopt;
}

Depth known_depth(const std::string& path) {
  if (const auto depth = depth_of(path)) return *depth;
  throw Error(path + ": cannot write this kind of image: use .exr, .png, .jpg or .hdr");
}

OIIO::ImageSpec output_spec(const Image& image, const Metadata& metadata, Depth depth) {
  OIIO::ImageSpec spec(image.width, image.height, image.channels,
                       depth == Depth::Float ? OIIO::TypeFloat : OIIO::TypeUInt8);
  spec.attribute("Software", "lockstep");
  spec.attribute("DateTime", "");  // OpenImageIO would stamp the file
  if (depth == Depth::Float) {
    spec.attribute("compression", "zip");
  } else {
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("CompressionQuality", 95);
  }
  for (const auto& [key, value] : metadata) {
    spec.attribute(std::string(key_prefix) + key, value);
  }
  return spec;
}

// Nearest code on the sRGB curve; what is not a number turns black.
std::vector<unsigned char> quantised(const Image& image) {
  std::vector<unsigned char> bytes(image.pixels.size());
  std::transform(image.pixels.begin(), image.pixels.end(), bytes.begin(), [](float v) {
    const float clamped = v > 0.0f ? std::min(v, 1.0f) : 0.0f;
    return static_cast<unsigned char>(std::lround(srgb_from_linear(clamped) * 255.0f));
  });
  return bytes;
}

std::vector<unsigned char> encoded(const std::string& path, const Image& image,
                                   const Metadata& metadata) {
  const Depth depth = known_depth(path);
  const auto output = OIIO::ImageOutput::create(path);
  if (!output) throw Error(path + ": cannot write the image: " + one_line(OIIO::geterror()));
  std::vector<unsigned char> file;
  OIIO::Filesystem::IOVecOutput memory(file);
  const bool done =
      output->set_ioproxy(&memory) && output->open(path, output_spec(image, metadata, depth)) &&
      (depth == Depth::Float ? output->write_image(OIIO::TypeFloat, image.pixels.data())
                             : output->write_image(OIIO::TypeUInt8, quantised(image).data())) &&
      output->close();
  if (!done) throw Error(path + ": cannot encode the image: " + one_line(output->geterror()));
  return file;
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
  const auto input = open_input(path);
  try {
    return read_pixels(*input, path);
  } catch (const std::bad_alloc&) {
    throw Error(path + ": image too large for memory, or its header is damaged");
  } catch (const std::length_error&) {
    throw Error(path + ": image too large for memory, or its header is damaged");
  }
}

Metadata read_metadata(const std::string& path) {
  const auto input = open_input(path);
  Metadata metadata;
  for (const auto& attribute : input->spec().extra_attribs) {
    const std::string name = attribute.name().string();
    if (name.starts_with(key_prefix) && attribute.type() == OIIO::TypeString) {
      metadata[name.substr(key_prefix.size())] = attribute.get_string();
    }
  }
  return metadata;
}

bool can_write_image(const std::string& path) { return depth_of(path).has_value(); }

void write_image(const std::string& path, const Image& image, const Metadata& metadata) {
  if (image.width <= 0 || image.height <= 0 || image.channels <= 0) {
    throw Error(path + ": an image without pixels cannot be written");
  }
  write_file(path, encoded(path, image, metadata));
}

}  // namespace lockstep
