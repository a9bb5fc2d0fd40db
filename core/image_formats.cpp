// The module of image formats: everything that OpenImageIO reads, and what it encodes in memory.
#include "core/image_formats.h"
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
#include <vector>

namespace lockstep {
namespace {

// A result and what it points to.
struct OwnedResult : FormatResult {
  std::string error_text;
  std::vector<float> pixel_values;
  std::vector<std::string> texts;
  std::vector<FormatAttribute> attribute_list;
  std::vector<unsigned char> bytes;
};

// An error of what OpenImageIO says, which may be nothing.
std::runtime_error failure(const std::string& what, const std::string& reason) {
  return std::runtime_error(what + ": " + (reason.empty() ? "unknown reason" : reason));
}

std::unique_ptr<OIIO::ImageInput> open_input(const std::string& path) {
  // Colours as they are stored, not multiplied by an alpha that is dropped.
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
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

bool is_srgb(const OIIO::ImageSpec& spec) {
  if (spec.format.is_floating_point()) return false;
  const std::string space = spec.get_string_attribute("oiio:ColorSpace", "sRGB");
  return !OIIO::Strutil::istarts_with(space, "lin") &&
         spec.get_float_attribute("oiio:Gamma", 2.2f) != 1.0f;
}

void read_pixels(OwnedResult& result, const std::string& path) {
  const auto input = open_input(path);
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.depth > 1 || spec.deep) {
    throw std::runtime_error("volume and deep images are not supported");
  }
  const auto channels = colour_channels(spec);
  const int last = std::max({channels[0], channels[1], channels[2]}) + 1;
  const size_t count = size_t(spec.width) * size_t(spec.height);
  std::vector<float> stored(count * size_t(last));
  if (!input->read_image(0, 0, 0, last, OIIO::TypeFloat, stored.data())) {
    throw failure("damaged image", input->geterror());
  }
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
const FormatResult* encode(const char* path, const FormatImage* image) {
  return guarded([=](OwnedResult& result) { encode_file(result, path, *image); });
}
void release(const FormatResult* result) { delete static_cast<const OwnedResult*>(result); }

constexpr ImageFormats formats{read, read_attributes, encode, release};

}  // namespace
}  // namespace lockstep

extern "C" [[gnu::visibility("default")]] const lockstep::ImageFormats* lockstep_image_formats() {
  return &lockstep::formats;
}
