#include "core/gltf/resources.h"

#include "core/error.h"

#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace lockstep::gltf {

namespace {

namespace fs = std::filesystem;

// Values of the base64 digits, and of the URL-safe ones; -1 for other characters.
constexpr std::array<signed char, 256> digit_values = [] {
  std::array<signed char, 256> values{};
  values.fill(-1);
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < digits.size(); ++i) {
    values[static_cast<unsigned char>(digits[i])] = static_cast<signed char>(i);
  }
  values['-'] = 62;
  values['_'] = 63;
  return values;
}();

std::optional<Bytes> decode_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    const int value = digit_values[static_cast<unsigned char>(c)];
    if (value < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes.push_back(static_cast<unsigned char>(bits >> bit_count & 0xff));
  }
  return bytes;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// A stray percent sign stands for itself.
std::string decode_percent(std::string_view text) {
  std::string decoded;
  decoded.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    const bool complete = text[i] == '%' && i + 2 < text.size();
    const int high = complete ? hex_digit(text[i + 1]) : -1;
    const int low = complete ? hex_digit(text[i + 2]) : -1;
    const bool escaped = high >= 0 && low >= 0;
    decoded += escaped ? static_cast<char>(high * 16 + low) : text[i];
    if (escaped) i += 2;
  }
  return decoded;
}

std::uint32_t word_at(std::string_view bytes, size_t offset) {
  static_assert(std::endian::native == std::endian::little, "glTF's numbers are little-endian");
  std::uint32_t word;
  std::memcpy(&word, bytes.data() + offset, sizeof(word));
  return word;
}

}  // namespace

std::optional<Bytes> read_file(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  const std::uintmax_t size = fs::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) return std::nullopt;
  Bytes bytes(size);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(file.gcount()) != size) return std::nullopt;
  return bytes;
}

std::optional<Bytes> decode_data_uri(std::string_view uri) {
  const size_t comma = uri.find(',');
  if (!is_data_uri(uri) || comma == std::string_view::npos) return std::nullopt;
  const std::string data = decode_percent(uri.substr(comma + 1));
  if (uri.substr(0, comma).ends_with(";base64")) return decode_base64(data);
  return Bytes(data.begin(), data.end());
}

std::string resolve_uri(const std::string& file, std::string_view uri) {
  return (fs::path(file).parent_path() / decode_percent(uri)).string();
}

bool is_container(std::string_view file) { return file.starts_with("glTF"); }

Container split_container(std::string_view file) {
  constexpr size_t header_size = 12, chunk_header_size = 8;
  constexpr std::uint32_t json_type = 0x4e4f534a, binary_type = 0x004e4942;
  if (file.size() < header_size) throw Error("the binary glTF header is cut short");
  const std::uint32_t version = word_at(file, 4), length = word_at(file, 8);
  if (version != 2) throw Error("binary glTF version " + std::to_string(version) + " is not 2");
  if (length < header_size || length > file.size()) {
    throw Error("the file has " + std::to_string(file.size()) + " bytes, but its header says " +
                std::to_string(length));
  }
  file = file.substr(0, length);

  Container container;
  size_t offset = header_size;
  for (int chunk = 0; file.size() - offset >= chunk_header_size; ++chunk) {
    const std::uint32_t size = word_at(file, offset), type = word_at(file, offset + 4);
    offset += chunk_header_size;
    if (size > file.size() - offset) {
      throw Error("chunk " + std::to_string(chunk) + " is longer than the file");
    }
    const std::string_view data = file.substr(offset, size);
    if (chunk == 0 && type != json_type) throw Error("the first chunk is not JSON");
    if (chunk == 0) container.json = data;
    if (chunk == 1 && type == binary_type) container.binary = data;
    offset += size;
  }
  return container;
}

}  // namespace lockstep::gltf
