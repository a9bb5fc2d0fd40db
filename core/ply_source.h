// A PLY file as its header describes it, and its values one after the other.
#pragma once

#include "core/location.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lockstep::ply {

enum class Format { Ascii, LittleEndian, BigEndian };
enum class Scalar { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

struct Property {
  std::string name;
  Scalar type = Scalar::Float32;
  std::optional<Scalar> count_type;  // present: a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

inline size_t size_of(Scalar type) {
  constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<int>(type)];
}

// A file's bytes, followed by a zero.
struct FileBytes {
  std::unique_ptr<char[]> data;
  size_t size = 0;
};

// The first `most` bytes, or all. Throws Error where the file cannot be opened.
FileBytes read_bytes(const std::string& path, size_t most);

// The file's bytes and how far they are read.
class Source {
 public:
  explicit Source(const std::string& path, size_t most = SIZE_MAX)
      : path_(path), file_(read_bytes(path, most)), bytes_(file_.data.get(), file_.size) {}

  [[noreturn]] void fail(const std::string& what) const {
    if (format == Format::Ascii) lockstep::fail({path_, line_}, what);
    throw Error(path_ + ": " + printable(what));
  }

  std::uint64_t bytes_left() const { return bytes_.size() - position_; }

  std::string_view header_line() {
    ++line_;
    const size_t end = bytes_.find('\n', position_);
    if (end == std::string_view::npos) fail("the PLY header has no end_header");
    std::string_view text(bytes_.data() + position_, end - position_);
    position_ = end + 1;
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }

  void end_header() { ++line_; }

  // Whether numbers stand in the file as they do in memory.
  bool is_native() const {
    constexpr bool big = std::endian::native == std::endian::big;
    return format == (big ? Format::BigEndian : Format::LittleEndian);
  }
  // What is left, for those who look ahead, and how much of it they took.
  const char* rest() const { return bytes_.data() + position_; }
  void take(size_t count) { position_ += count; }

  double number(Scalar type) {
    if (format == Format::Ascii) return text_number();
    switch (type) {
      case Scalar::Int8:
        return binary<std::int8_t>();
      case Scalar::Uint8:
        return binary<std::uint8_t>();
      case Scalar::Int16:
        return binary<std::int16_t>();
      case Scalar::Uint16:
        return binary<std::uint16_t>();
      case Scalar::Int32:
        return binary<std::int32_t>();
      case Scalar::Uint32:
        return binary<std::uint32_t>();
      case Scalar::Float32:
        return static_cast<double>(binary<float>());
      case Scalar::Float64:
        return binary<double>();
    }
    return 0.0;
  }

  Format format = Format::Ascii;

 private:
  template <class T>
  T binary() {
    if (bytes_left() < sizeof(T)) fail("the file ends before its last element");
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + position_, sizeof(T));
    position_ += sizeof(T);
    const bool file_is_big = format == Format::BigEndian;
    if (file_is_big != (std::endian::native == std::endian::big)) {
      std::reverse(raw.begin(), raw.end());
    }
    return std::bit_cast<T>(raw);
  }

  double text_number() {
    while (position_ < bytes_.size() && is_space(bytes_[position_])) {
      if (bytes_[position_++] == '\n') ++line_;
    }
    size_t end = position_;
    while (end < bytes_.size() && !is_space(bytes_[end])) ++end;
    if (end == position_) fail("the file ends before its last element");
    const std::string_view word(bytes_.data() + position_, end - position_);
    position_ = end;

    const char* first = word.data() + (word.front() == '+' ? 1 : 0);
    double value = 0.0;
    const auto [rest, status] = std::from_chars(first, word.data() + word.size(), value);
    const bool whole = rest == word.data() + word.size();
    if (status == std::errc::result_out_of_range && whole) return std::strtod(word.data(), nullptr);
    if (status != std::errc() || !whole) {
      fail("expected a number, found \"" + std::string(word.substr(0, 40)) + "\"");
    }
    return value;
  }

  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  std::string path_;
  FileBytes file_;
  std::string_view bytes_;
  size_t position_ = 0;
  int line_ = 0;
};

// The elements in the order of the file; the source then stands at the first value and knows its
// format. Throws Error as Source::fail does, and so do the functions below.
std::vector<Element> parse_header(Source& source);

// Refuses a count that the rest of the file cannot hold, before memory is asked for.
void check_count(const Source& source, const Element& element);

inline size_t list_length(Source& source, const Property& property) {
  const double length = source.number(*property.count_type);
  if (!(length >= 0.0 && length <= static_cast<double>(source.bytes_left()))) {
    source.fail("the length of list \"" + property.name + "\" is wrong");
  }
  return static_cast<size_t>(length);
}

inline void skip(Source& source, const Property& property) {
  const size_t count = property.count_type ? list_length(source, property) : 1;
  for (size_t i = 0; i < count; ++i) source.number(property.type);
}

}  // namespace lockstep::ply
