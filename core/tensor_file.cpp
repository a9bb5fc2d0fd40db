#include "core/tensor_file.h"

#include "core/error.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace lockstep {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view tensor_magic("tensor_file\0\1\0", 14);
constexpr std::uintmax_t most_tensor_bytes = 512u << 20;
constexpr std::uint32_t most_fields = 256;
constexpr std::size_t most_dimensions = 8;
constexpr std::uint8_t float32_type = 10;

}  // namespace

TensorFile::TensorFile(const std::string& path) : path_(path) {
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  std::ifstream in;
  if (!failed) in.open(path, std::ios::binary);
  if (failed || !in) throw Error(path + ": cannot be read; check the path");
  if (size > most_tensor_bytes) {
    fail(fmt::format("has {} MiB; such files may have {}", size >> 20, most_tensor_bytes >> 20));
  }
  bytes_.resize(size);
  in.read(bytes_.data(), std::streamsize(size));
  if (!in) fail("cannot be read to its end");
  if (!std::string_view(bytes_).starts_with(tensor_magic)) {
    fail("is no file of RGL's tensors, version 1.0");
  }
  std::size_t at = tensor_magic.size();
  const auto count = take<std::uint32_t>(at);
  if (count > most_fields) fail(fmt::format("claims {} fields, more than {}", count, most_fields));
  for (std::uint32_t i = 0; i < count; ++i) read_field(at);
}

void TensorFile::read_field(std::size_t& at) {
  const std::size_t length = take<std::uint16_t>(at);
  if (length > bytes_.size() - at) fail("ends in the name of a field; get the file again");
  const std::string name = bytes_.substr(at, length);
  at += length;
  const std::size_t dimensions = take<std::uint16_t>(at);
  if (dimensions > most_dimensions) fail(fmt::format("has a field of {} dimensions", dimensions));
  Field field;
  field.type = take<std::uint8_t>(at);
  field.offset = take<std::uint64_t>(at);
  for (std::size_t i = 0; i < dimensions; ++i) field.shape.push_back(take<std::uint64_t>(at));
  fields_[name] = field;
}

template <class T>
T TensorFile::take(std::size_t& at) const {
  if (bytes_.size() - at < sizeof(T)) fail("ends before its last field; get the file again");
  T value;
  std::memcpy(&value, bytes_.data() + at, sizeof(T));
  at += sizeof(T);
  return value;
}

FloatTensor TensorFile::floats(const std::string& name, std::size_t dimensions) const {
  const auto found = fields_.find(name);
  if (found == fields_.end()) fail(fmt::format("has no field \"{}\"", name));
  const Field& field = found->second;
  if (field.type != float32_type || field.shape.size() != dimensions) {
    fail(fmt::format("field \"{}\" should have {} dimensions of float32", name, dimensions));
  }
  std::uint64_t count = 1;
  for (const std::size_t n : field.shape) {
    if (n == 0 || n > bytes_.size() / count) {
      fail(fmt::format("field \"{}\" has dimensions that the file cannot hold", name));
    }
    count *= n;
  }
  if (field.offset > bytes_.size() || count > (bytes_.size() - field.offset) / sizeof(float)) {
    fail(fmt::format("ends before field \"{}\" does; get the file again", name));
  }
  FloatTensor tensor{field.shape, std::vector<float>(count)};
  std::memcpy(tensor.values.data(), bytes_.data() + field.offset, count * sizeof(float));
  for (const float value : tensor.values) {
    if (!(std::abs(value) <= 1e12f)) {
      fail(fmt::format("field \"{}\" holds the value {}; get the file again", name, value));
    }
  }
  return tensor;
}

void TensorFile::fail(const std::string& what) const { throw Error(path_ + ": " + what); }

}  // namespace lockstep
