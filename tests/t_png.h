// PNG files put together byte by byte, so that tests know every stored value.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lockstep {

struct PngImage {
  std::uint32_t width = 0, height = 0;
  int channels = 4;  // 1: grey, 2: grey and alpha, 3: colours, 4: colours and alpha
  int bits = 8;      // or 16
  std::vector<std::uint16_t> values;
};

inline std::string big_endian(std::uint32_t v) {
  return {char(v >> 24), char(v >> 16), char(v >> 8), char(v)};
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
  const std::string content = type + data;
  std::uint32_t crc = 0xffffffffu;
  for (const char c : content) {
    crc ^= std::uint8_t(c);
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ (crc & 1u ? 0xedb88320u : 0u);
  }
  return big_endian(std::uint32_t(data.size())) + content + big_endian(~crc);
}

// A zlib stream of stored blocks, without compression.
inline std::string zlib_stored(const std::string& data) {
  std::string stream = "\x78\x01";
  constexpr std::size_t block = 65535;
  for (std::size_t at = 0; at == 0 || at < data.size(); at += block) {
    const std::string part = data.substr(at, block);
    const auto n = std::uint16_t(part.size());
    stream += char(at + block >= data.size());
    stream += {char(n), char(n >> 8), char(~n), char(~n >> 8)};
    stream += part;
  }
  std::uint32_t a = 1, b = 0;
  for (const char c : data) a = (a + std::uint8_t(c)) % 65521u, b = (b + a) % 65521u;
  return stream + big_endian(b << 16 | a);
}

inline std::string png_bytes(const PngImage& image) {
  constexpr char colour_types[] = {0, 4, 2, 6};
  const std::size_t row = std::size_t(image.width) * std::size_t(image.channels);
  std::string lines;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if (i % row == 0) lines += '\0';  // no filter
    if (image.bits == 16) lines += char(image.values[i] >> 8);
    lines += char(image.values[i]);
  }
  const std::string header = big_endian(image.width) + big_endian(image.height) + char(image.bits) +
                             colour_types[image.channels - 1] + std::string(3, '\0');
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + png_chunk("IDAT", zlib_stored(lines)) +
         png_chunk("IEND", "");
}

}  // namespace lockstep
