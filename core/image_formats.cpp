// The module of image formats: everything that OpenImageIO reads, and what it encodes in memory.
#include "core/image_formats.h"

#include "core/image_limits.h"
#include "core/srgb.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace lockstep {
namespace {

// A result and what it points to.
struct OwnedResult : FormatResult {
  std::string error_text;
  std::vector<float> pixel_values;
  std::unique_ptr<unsigned char[]> stored_values;
  std::vector<std::string> texts;
  std::vector<FormatAttribute> attribute_list;
  std::vector<unsigned char> bytes;
};

// An error of what OpenImageIO says, which may be nothing.
std::runtime_error failure(const std::string& what, const std::string& reason) {
  return std::runtime_error(what + ": " + (reason.empty() ? "unknown reason" : reason));
}

// The extension of `path` names the format; no file of that name is looked for.
std::unique_ptr<OIIO::ImageInput> open_memory(const std::string& path, const OIIO::ImageSpec& hints,
                                              OIIO::Filesystem::IOProxy* memory) {
  auto input = OIIO::ImageInput::create(path.substr(path.rfind('.') + 1));
  if (!input) throw failure("cannot read this image", OIIO::geterror());
  OIIO::ImageSpec ignored;
  if (!input->set_ioproxy(memory) || !input->open(path, ignored, hints)) {
    throw failure("cannot read this image", input->geterror());
  }
  return input;
}

std::unique_ptr<OIIO::ImageInput> open_input(const std::string& path,
                                             OIIO::Filesystem::IOProxy* memory = nullptr) {
  // Colours as they are stored, not multiplied by alpha.
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  if (memory) return open_memory(path, hints, memory);
  auto input = OIIO::ImageInput::open(path, &hints);
  if (!input) throw failure("cannot read this image", OIIO::geterror());
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

// Fills `values`. Where a JPEG breaks off libjpeg makes up the rest and only says so; what it says
// of bytes too many is harmless.
void read_whole(OIIO::ImageInput& input, int channels, OIIO::TypeDesc type, void* values,
                OIIO::stride_t stride = OIIO::AutoStride) {
  const bool read = input.read_image(0, 0, 0, channels, type, values, stride);
  const std::string said = input.geterror();
  const bool made_up = std::string_view(input.format_name()) == "jpeg" && !said.empty() &&
                       said.find("extraneous bytes") == said.npos;
  if (!read || made_up) throw failure("damaged image", said);
}

void check_flat(const OIIO::ImageSpec& spec) {
  if (spec.depth > 1 || spec.deep) {
    throw std::runtime_error("volume and deep images are not supported");
  }
}

size_t pixel_count(const OIIO::ImageSpec& spec) {
  if (spec.width <= 0 || spec.height <= 0) throw std::runtime_error("the image has no pixels");
  return size_t(spec.width) * size_t(spec.height);
}

std::runtime_error too_large(const OIIO::ImageSpec& spec) {
  return std::runtime_error("an image of " + std::to_string(spec.width) + " x " +
                            std::to_string(spec.height) + " pixels is too large; scale it down");
}

bool is_srgb(const OIIO::ImageSpec& spec) {
  if (spec.format.is_floating_point()) return false;
  const std::string space = spec.get_string_attribute("oiio:ColorSpace", "sRGB");
  return !OIIO::Strutil::istarts_with(space, "lin") &&
         spec.get_float_attribute("oiio:Gamma", 2.2f) != 1.0f;
}

void read_pixels(OwnedResult& result, const std::string& path) {
  const auto input = open_input(path);
  const OIIO::ImageSpec& spec = input->spec();
  check_flat(spec);
  const auto channels = colour_channels(spec);
  const int last = std::max({channels[0], channels[1], channels[2]}) + 1;
  const size_t count = pixel_count(spec);
  if (count > max_image_pixels) throw too_large(spec);
  // Not touched before the pixels come.
  const auto stored = std::make_unique_for_overwrite<float[]>(count * size_t(last));
  read_whole(*input, last, OIIO::TypeFloat, stored.get());
  const bool decode = is_srgb(spec);
  result.pixel_values.resize(count * 3);
  for (size_t pixel = 0; pixel < count; ++pixel) {
    for (size_t c = 0; c < 3; ++c) {
      const float v = stored[pixel * size_t(last) + size_t(channels[c])];
      result.pixel_values[pixel * 3 + c] = decode ? linear_from_srgb(v) : v;
    }
  }
  result.width = spec.width;
  result.height = spec.height;
  result.pixels = result.pixel_values.data();
}

FormatDepth depth_of(const OIIO::TypeDesc& type) {
  if (type == OIIO::TypeUInt8) return FormatDepth::Byte;
  if (type == OIIO::TypeUInt16) return FormatDepth::Short;
  return type == OIIO::TypeHalf ? FormatDepth::Half : FormatDepth::Float;
}

struct StoredType {
  OIIO::TypeDesc type;
  size_t size;
  std::array<unsigned char, 4> one;  // bytes of the value 1
};

StoredType stored_type(FormatDepth depth) {
  switch (depth) {
    case FormatDepth::Byte:
      return {OIIO::TypeUInt8, 1, {0xff}};
    case FormatDepth::Short:
      return {OIIO::TypeUInt16, 2, {0xff, 0xff}};
    case FormatDepth::Half:
      return {OIIO::TypeHalf, 2, {0x00, 0x3c}};
    case FormatDepth::Float:
      break;
  }
  return {OIIO::TypeFloat, 4, {0x00, 0x00, 0x80, 0x3f}};
}

// Interleaved values of `stride` bytes per pixel become red, green, blue and alpha, in place.
void reorder(unsigned char* values, size_t count, size_t stride, const std::array<int, 3>& channels,
             int alpha, const StoredType& type) {
  for (size_t pixel = 0; pixel < count; ++pixel) {
    const unsigned char* from = values + pixel * stride;
    std::array<unsigned char, 16> texel;
    for (size_t c = 0; c < 3; ++c) {
      std::copy_n(from + size_t(channels[c]) * type.size, type.size, &texel[c * type.size]);
    }
    std::copy_n(alpha < 0 ? type.one.data() : from + size_t(alpha) * type.size, type.size,
                &texel[3 * type.size]);
    std::copy_n(texel.data(), 4 * type.size, values + pixel * 4 * type.size);
  }
}

// Memory is asked for but not touched before the pixels come: a damaged header may claim much.
void read_stored_pixels(OwnedResult& result, const std::string& path,
                        OIIO::Filesystem::IOProxy* memory) {
  const auto input = open_input(path, memory);
  const OIIO::ImageSpec& spec = input->spec();
  check_flat(spec);
  const size_t count = pixel_count(spec);
  result.depth = depth_of(spec.format);
  const StoredType type = stored_type(result.depth);
  const auto channels = colour_channels(spec);
  const int alpha = spec.alpha_channel;
  const int last = std::max({channels[0], channels[1], channels[2], alpha}) + 1;
  const size_t stride = size_t(std::max(last, 4)) * type.size;
  if (count * stride > max_stored_bytes) throw too_large(spec);
  result.stored_values.reset(new unsigned char[count * stride]);
  read_whole(*input, last, type.type, result.stored_values.get(), OIIO::stride_t(stride));
  reorder(result.stored_values.get(), count, stride, channels, alpha, type);
  result.width = spec.width;
  result.height = spec.height;
  result.stored = result.stored_values.get();
}

void read_stored_file(OwnedResult& result, const char* path, const unsigned char* bytes,
                      size_t size) {
  if (!bytes) return read_stored_pixels(result, path, nullptr);
  OIIO::Filesystem::IOMemReader memory(const_cast<unsigned char*>(bytes), size);
  read_stored_pixels(result, path, &memory);
}

void read_texts(OwnedResult& result, const std::string& path) {
  const auto input = open_input(path);
  for (const auto& attribute : input->spec().extra_attribs) {
    if (attribute.type() != OIIO::TypeString) continue;
    result.texts.push_back(attribute.name().string());
    result.texts.push_back(attribute.get_string());
  }
  for (size_t i = 0; i < result.texts.size(); i += 2) {
    result.attribute_list.push_back({result.texts[i].c_str(), result.texts[i + 1].c_str()});
  }
  result.attributes = result.attribute_list.data();
  result.attribute_count = result.attribute_list.size();
}

OIIO::ImageSpec output_spec(const FormatImage& image) {
  OIIO::ImageSpec spec(image.width, image.height, image.channels,
                       image.eight_bit ? OIIO::TypeUInt8 : OIIO::TypeFloat);
  spec.attribute("DateTime", "");  // OpenImageIO would stamp the file
  if (image.eight_bit) {
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("CompressionQuality", 95);
  }
  for (size_t i = 0; i < image.attribute_count; ++i) {
    spec.attribute(image.attributes[i].key, image.attributes[i].value);
  }
  return spec;
}

// Nearest code on the sRGB curve; what is not a number turns black.
std::vector<unsigned char> quantised(const FormatImage& image) {
  std::vector<unsigned char> bytes(size_t(image.width) * size_t(image.height) *
                                   size_t(image.channels));
  std::transform(image.pixels, image.pixels + bytes.size(), bytes.begin(), [](float v) {
    const float clamped = v > 0.0f ? std::min(v, 1.0f) : 0.0f;
    return static_cast<unsigned char>(std::lround(srgb_from_linear(clamped) * 255.0f));
  });
  return bytes;
}

void encode_file(OwnedResult& result, const std::string& path, const FormatImage& image) {
  const auto output = OIIO::ImageOutput::create(path);
  if (!output) throw failure("cannot write the image", OIIO::geterror());
  OIIO::Filesystem::IOVecOutput memory(result.bytes);
  const bool done = output->set_ioproxy(&memory) && output->open(path, output_spec(image)) &&
                    (image.eight_bit ? output->write_image(OIIO::TypeUInt8, quantised(image).data())
                                     : output->write_image(OIIO::TypeFloat, image.pixels)) &&
                    output->close();
  if (!done) throw failure("cannot encode the image", output->geterror());
  result.file = result.bytes.data();
  result.file_size = result.bytes.size();
}

// Runs a call; what it throws becomes the result's text.
template <typename Call>
const FormatResult* guarded(Call call) noexcept {
  std::unique_ptr<OwnedResult> result(new (std::nothrow) OwnedResult);
  if (!result) return nullptr;
  try {
    try {
      call(*result);
    } catch (const std::bad_alloc&) {
      return nullptr;
    } catch (const std::length_error&) {
      return nullptr;
    } catch (const std::exception& exception) {
      result->error_text = exception.what();
      result->error = result->error_text.c_str();
    }
  } catch (...) {
    return nullptr;  // no memory for the text
  }
  return result.release();
}

const FormatResult* read(const char* path) {
  return guarded([=](OwnedResult& result) { read_pixels(result, path); });
}
const FormatResult* read_attributes(const char* path) {
  return guarded([=](OwnedResult& result) { read_texts(result, path); });
}
const FormatResult* read_stored(const char* path, const unsigned char* bytes, size_t size) {
  return guarded([=](OwnedResult& result) { read_stored_file(result, path, bytes, size); });
}
const FormatResult* encode(const char* path, const FormatImage* image) {
  return guarded([=](OwnedResult& result) { encode_file(result, path, *image); });
}
void release(const FormatResult* result) { delete static_cast<const OwnedResult*>(result); }

constexpr ImageFormats formats{read, read_attributes, read_stored, encode, release};

}  // namespace
}  // namespace lockstep

extern "C" [[gnu::visibility("default")]] const lockstep::ImageFormats* lockstep_image_formats() {
  return &lockstep::formats;
}
