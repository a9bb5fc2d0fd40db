// Reads row by row and writes into memory. OpenEXR's thread pool stays empty: rendering uses all
// processors already.
#include "core/exr_file.h"

#include "core/error.h"
#include "core/image_limits.h"
#include "core/location.h"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTestFile.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <tuple>
#include <utility>

namespace lockstep {
namespace {

constexpr int no_threads = 0;

// What OpenEXR says, without the name of the file.
std::string reason(const Iex::BaseExc& exception) {
  const std::string text = exception.what();
  const size_t quote = text.rfind("\". ");
  return quote == std::string::npos ? text : text.substr(quote + 3);
}

// Whatever a header claims, OpenEXR then takes no memory for.
void limit_headers() {
  static const bool once = [] {
    Imf::Header::setMaxImageSize(max_image_side, max_image_side);
    Imf::Header::setMaxTileSize(max_image_side, max_image_side);
    return true;
  }();
  static_cast<void>(once);
}

// OpenEXR takes whatever memory an attribute claims to need: no more, here, than the file has.
// Headers are lists of name, type and value, an empty name at their end; those of several parts
// follow one another.
void check_attribute_sizes(const std::string& path) {
  constexpr std::uint32_t multi_part = 0x1000;
  std::error_code ignored;
  const std::uintmax_t file_size = std::filesystem::file_size(path, ignored);
  std::ifstream file(path, std::ios::binary);
  std::uint32_t magic_and_version[2] = {}, size = 0;
  file.read(reinterpret_cast<char*>(magic_and_version), sizeof(magic_and_version));
  bool after_end = !(magic_and_version[1] & multi_part);
  for (std::string name, type; std::getline(file, name, '\0');) {
    if (name.empty() && std::exchange(after_end, true)) return;
    if (name.empty()) continue;
    after_end = !(magic_and_version[1] & multi_part);
    std::getline(file, type, '\0');
    file.read(reinterpret_cast<char*>(&size), sizeof(size));
    if (file && size > file_size) {
      throw Error("damaged image: its header's \"" + printable(name) +
                  "\" claims to be larger than the file");
    }
    file.seekg(size, std::ios::cur);
  }
}

std::unique_ptr<Imf::MultiPartInputFile> open_exr(const std::string& path) {
  limit_headers();
  check_attribute_sizes(path);
  try {
    return std::make_unique<Imf::MultiPartInputFile>(path.c_str(), no_threads);
  } catch (const Iex::BaseExc& exception) {
    throw Error("cannot read this image: " + reason(exception));
  }
}

// Sorts names layer by layer, colours first and alpha last: "view.R" before "view.G" before
// "view.A".
std::tuple<std::string, size_t, std::string> colours_first(const std::string& name) {
  const size_t start = name.rfind('.') + 1;  // 0 without a layer
  std::string channel = name.substr(start);
  for (char& c : channel) c = char(std::tolower(static_cast<unsigned char>(c)));
  const char* const colours[] = {"r", "red", "g", "green", "b", "blue"};
  auto rank = size_t(std::find(colours, std::end(colours), channel) - colours);
  if (channel == "a" || channel == "alpha") ++rank;
  return {name.substr(0, start), rank, channel};
}

// The names of the channels that hold red, green and blue; one name for a grey image.
std::vector<std::string> colour_channels(const Imf::ChannelList& channels) {
  const std::vector<std::string> colours{"R", "G", "B"};
  const auto present = [&](const std::string& name) { return channels.findChannel(name); };
  if (std::all_of(colours.begin(), colours.end(), present)) return colours;
  std::vector<std::string> names;
  for (auto c = channels.begin(); c != channels.end(); ++c) names.emplace_back(c.name());
  if (names.empty()) throw Error("this image has no channels");
  std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
    return colours_first(a) < colours_first(b);
  });
  names.resize(names.size() < 3 ? 1 : 3);
  return names;
}

void check_supported(const Imf::Header& header, const std::vector<std::string>& names) {
  if (header.hasType() && Imf::isDeepData(header.type())) {
    throw Error("volume and deep images are not supported");
  }
  for (const std::string& name : names) {
    const Imf::Channel& channel = header.channels()[name];
    if (channel.xSampling != 1 || channel.ySampling != 1) {
      throw Error("cannot read this image: subsampled channels are not supported (" + name + ")");
    }
  }
}

// Interleaved floats, given by the address of the pixel at the data window's corner; all rows of
// a frame buffer whose row stride is 0 lie in the same place.
Imf::FrameBuffer frame_buffer(float* corner, const Imath::Box2i& window,
                              const std::vector<std::string>& names, size_t row_stride) {
  const size_t stride = names.size() * sizeof(float);
  char* base = reinterpret_cast<char*>(corner) - ptrdiff_t(stride) * window.min.x -
               ptrdiff_t(row_stride) * window.min.y;
  Imf::FrameBuffer buffer;
  for (const std::string& name : names) {
    buffer.insert(name, Imf::Slice(Imf::FLOAT, base, stride, row_stride));
    base += sizeof(float);
  }
  return buffer;
}

// The image grows row by row, so that a damaged header that claims a vast image takes no memory.
Image read_rows(Imf::MultiPartInputFile& parts, const std::vector<std::string>& names) {
  Imf::InputPart file(parts, 0);
  const Imath::Box2i window = file.header().dataWindow();
  Image image;
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  if (size_t(image.width) * size_t(image.height) > max_image_pixels) {
    throw Error("an image of " + std::to_string(image.width) + " x " +
                std::to_string(image.height) + " pixels is too large; scale it down");
  }
  image.pixels.reserve(size_t(image.width) * size_t(image.height) * 3);
  std::vector<float> row(size_t(image.width) * names.size());
  file.setFrameBuffer(frame_buffer(row.data(), window, names, 0));
  float scale[3];
  for (size_t c = 0; c < 3; ++c) {
    const std::string& name = names[std::min(c, names.size() - 1)];
    scale[c] = file.header().channels()[name].type == Imf::UINT ? 1.0f / float(UINT32_MAX) : 1.0f;
  }
  for (int y = window.min.y; y <= window.max.y; ++y) {
    file.readPixels(y);
    for (size_t pixel = 0; pixel < row.size(); pixel += names.size()) {
      for (size_t c = 0; c < 3; ++c) {
        image.pixels.push_back(row[pixel + std::min(c, names.size() - 1)] * scale[c]);
      }
    }
  }
  return image;
}

std::vector<std::string> names_of(int channels) {
  if (channels == 1) return {"Y"};
  if (channels == 2) return {"Y", "A"};
  std::vector<std::string> names{"R", "G", "B", "A"};
  for (int c = 4; c < channels; ++c) names.push_back("channel" + std::to_string(c));
  names.resize(size_t(channels));
  return names;
}

class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory") {}
  void write(const char c[], int n) override {
    bytes.resize(std::max(bytes.size(), position_ + size_t(n)));
    std::copy_n(c, n, bytes.begin() + ptrdiff_t(position_));
    position_ += size_t(n);
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }

  std::vector<unsigned char> bytes;

 private:
  size_t position_ = 0;
};

}  // namespace

bool is_exr_file(const std::string& path) { return Imf::isOpenExrFile(path.c_str()); }

Image read_exr(const std::string& path) {
  const auto file = open_exr(path);
  const std::vector<std::string> names = colour_channels(file->header(0).channels());
  check_supported(file->header(0), names);
  try {
    return read_rows(*file, names);
  } catch (const Iex::BaseExc& exception) {
    throw Error("damaged image: " + reason(exception));
  }
}

Metadata read_exr_attributes(const std::string& path) {
  const auto file = open_exr(path);
  Metadata attributes;
  const Imf::Header& header = file->header(0);
  for (auto a = header.begin(); a != header.end(); ++a) {
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute())) {
      attributes[a.name()] = text->value();
    }
  }
  return attributes;
}

std::vector<unsigned char> encode_exr(const Image& image, const Metadata& attributes) {
  Imf::Header header(image.width, image.height);
  const std::vector<std::string> names = names_of(image.channels);
  for (const std::string& name : names) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  for (const auto& [key, value] : attributes) header.insert(key, Imf::StringAttribute(value));
  const size_t row_stride = size_t(image.width) * names.size() * sizeof(float);
  auto* const pixels = const_cast<float*>(image.pixels.data());  // a frame buffer serves both ways
  MemoryStream memory;
  try {
    Imf::OutputFile file(memory, header, no_threads);
    file.setFrameBuffer(frame_buffer(pixels, header.dataWindow(), names, row_stride));
    file.writePixels(image.height);
  } catch (const Iex::BaseExc& exception) {
    throw Error("cannot encode the image: " + reason(exception));
  }
  return std::move(memory.bytes);
}

}  // namespace lockstep
