#include "core/ply.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

namespace lockstep {

namespace {

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

std::optional<Scalar> scalar_named(std::string_view name) {
  constexpr std::pair<std::string_view, Scalar> table[] = {
      {"char", Scalar::Int8},      {"int8", Scalar::Int8},       {"uchar", Scalar::Uint8},
      {"uint8", Scalar::Uint8},    {"short", Scalar::Int16},     {"int16", Scalar::Int16},
      {"ushort", Scalar::Uint16},  {"uint16", Scalar::Uint16},   {"int", Scalar::Int32},
      {"int32", Scalar::Int32},    {"uint", Scalar::Uint32},     {"uint32", Scalar::Uint32},
      {"float", Scalar::Float32},  {"float32", Scalar::Float32}, {"double", Scalar::Float64},
      {"float64", Scalar::Float64}};
  for (const auto& [key, scalar] : table) {
    if (key == name) return scalar;
  }
  return std::nullopt;
}

size_t size_of(Scalar type) {
  constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<int>(type)];
}

// The file's bytes and how far they are read.
class Source {
 public:
  explicit Source(const std::string& path) : path_(path) {
    std::ifstream file(path, std::ios::binary);
    std::error_code ignored;
    if (!file || !std::filesystem::is_regular_file(path, ignored)) {
      throw Error(path + ": cannot be opened; check the path");
    }
    bytes_.assign(std::istreambuf_iterator<char>(file), {});
  }

  [[noreturn]] void fail(const std::string& what) const {
    if (format == Format::Ascii) throw error_at(path_, line_, what);
    throw Error(path_ + ": " + what);
  }

  std::uint64_t bytes_left() const { return bytes_.size() - position_; }

  std::string_view header_line() {
    ++line_;
    const size_t end = bytes_.find('\n', position_);
    if (end == std::string::npos) fail("the PLY header has no end_header");
    std::string_view text(bytes_.data() + position_, end - position_);
    position_ = end + 1;
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }

  void end_header() { ++line_; }

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
  std::string bytes_;
  size_t position_ = 0;
  int line_ = 0;
};

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  size_t begin = 0;
  while ((begin = line.find_first_not_of(" \t", begin)) != std::string_view::npos) {
    const size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    words.emplace_back(line.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

Format parse_format(const Source& source, const std::vector<std::string>& words) {
  if (words.size() == 3 && words[1] == "ascii") return Format::Ascii;
  if (words.size() == 3 && words[1] == "binary_little_endian") return Format::LittleEndian;
  if (words.size() == 3 && words[1] == "binary_big_endian") return Format::BigEndian;
  source.fail("expected \"format ascii|binary_little_endian|binary_big_endian 1.0\"");
}

Element parse_element(const Source& source, const std::vector<std::string>& words) {
  Element element;
  if (words.size() != 3) source.fail("expected \"element NAME COUNT\"");
  element.name = words[1];
  const char* end = words[2].data() + words[2].size();
  const auto [rest, status] = std::from_chars(words[2].data(), end, element.count);
  if (status != std::errc() || rest != end) source.fail("expected \"element NAME COUNT\"");
  return element;
}

Property parse_property(const Source& source, const std::vector<std::string>& words) {
  const bool list = words.size() == 5 && words[1] == "list";
  if (!list && words.size() != 3) source.fail("expected \"property [list TYPE] TYPE NAME\"");
  Property property;
  property.name = words.back();
  const auto type_at = [&](size_t i) {
    const std::optional<Scalar> type = scalar_named(words[i]);
    if (!type) source.fail("unknown type \"" + words[i] + "\"");
    return *type;
  };
  property.type = type_at(words.size() - 2);
  if (list) property.count_type = type_at(2);
  return property;
}

std::vector<Element> parse_header(Source& source) {
  if (words_of(source.header_line()) != std::vector<std::string>{"ply"}) {
    source.fail("not a PLY file: the first line must be \"ply\"");
  }
  std::vector<Element> elements;
  std::optional<Format> format;
  for (;;) {
    const std::vector<std::string> words = words_of(source.header_line());
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      format = parse_format(source, words);
    } else if (words[0] == "element") {
      elements.push_back(parse_element(source, words));
    } else if (words[0] == "property" && !elements.empty()) {
      elements.back().properties.push_back(parse_property(source, words));
    } else {
      source.fail("unexpected \"" + words[0].substr(0, 40) + "\" in the PLY header");
    }
  }
  if (!format) source.fail("the PLY header names no format");
  source.end_header();
  source.format = *format;
  return elements;
}

// Refuses a count that the rest of the file cannot hold, before memory is asked for.
void check_count(const Source& source, const Element& element) {
  std::uint64_t smallest = 0;
  for (const Property& p : element.properties) {
    const bool text = source.format == Format::Ascii;
    smallest += text ? 2 : size_of(p.count_type.value_or(p.type));
  }
  if (smallest == 0) return;
  if (element.count > source.bytes_left() / smallest + 1) {
    source.fail("the file is too short for " + std::to_string(element.count) + " elements \"" +
                element.name + "\"");
  }
}

size_t list_length(Source& source, const Property& property) {
  const double length = source.number(*property.count_type);
  if (!(length >= 0.0 && length <= static_cast<double>(source.bytes_left()))) {
    source.fail("the length of list \"" + property.name + "\" is wrong");
  }
  return static_cast<size_t>(length);
}

void skip(Source& source, const Property& property) {
  const size_t count = property.count_type ? list_length(source, property) : 1;
  for (size_t i = 0; i < count; ++i) source.number(property.type);
}

// Squared lengths of larger values would leave the range of float.
float to_float(const Source& source, double value) {
  constexpr double largest = 1e18;
  if (!std::isfinite(value)) source.fail("a vertex has a coordinate that is not finite");
  if (std::abs(value) > largest) {
    source.fail("a vertex has a coordinate beyond 1e18; scale the mesh down");
  }
  return static_cast<float>(value);
}

// Where a vertex property goes: 0-2 position, 3-5 normal, 6-7 uv, or nowhere.
int vertex_slot(std::string_view name) {
  constexpr std::pair<std::string_view, int> table[] = {
      {"x", 0},         {"y", 1},         {"z", 2},         {"nx", 3},       {"ny", 4},
      {"nz", 5},        {"u", 6},         {"v", 7},         {"s", 6},        {"t", 7},
      {"texture_u", 6}, {"texture_v", 7}, {"texture_s", 6}, {"texture_t", 7}};
  for (const auto& [key, slot] : table) {
    if (key == name) return slot;
  }
  return -1;
}

void read_vertices(Source& source, const Element& element, TriangleMesh& mesh) {
  std::array<bool, 8> present{};
  std::vector<int> slots;
  for (const Property& p : element.properties) {
    slots.push_back(p.count_type ? -1 : vertex_slot(p.name));
    if (slots.back() >= 0) present[slots.back()] = true;
  }
  if (!present[0] || !present[1] || !present[2]) source.fail("vertices lack x, y or z");
  const bool with_normals = present[3] && present[4] && present[5];
  const bool with_uvs = present[6] && present[7];

  mesh.positions.reserve(element.count);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    std::array<float, 8> value{};
    for (size_t p = 0; p < slots.size(); ++p) {
      if (slots[p] < 0) {
        skip(source, element.properties[p]);
      } else {
        value[slots[p]] = to_float(source, source.number(element.properties[p].type));
      }
    }
    mesh.positions.emplace_back(value[0], value[1], value[2]);
    if (with_normals) mesh.normals.emplace_back(value[3], value[4], value[5]);
    if (with_uvs) mesh.uvs.emplace_back(value[6], value[7]);
  }
}

void read_faces(Source& source, const Element& element, std::uint64_t vertex_count,
                TriangleMesh& mesh) {
  const auto is_index_list = [](const Property& p) {
    return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
  };
  if (std::none_of(element.properties.begin(), element.properties.end(), is_index_list)) {
    source.fail("faces lack the list vertex_indices");
  }
  std::vector<unsigned> corners;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const Property& p : element.properties) {
      if (!is_index_list(p)) {
        skip(source, p);
        continue;
      }
      corners.resize(list_length(source, p));
      for (unsigned& corner : corners) {
        const double index = source.number(p.type);
        if (!(index >= 0.0 && index < static_cast<double>(vertex_count))) {
          source.fail("face " + std::to_string(i) + " refers to a vertex that does not exist; " +
                      "there are " + std::to_string(vertex_count));
        }
        corner = static_cast<unsigned>(index);
      }
      if (corners.size() < 3) {
        source.fail("face " + std::to_string(i) + " has fewer than three vertices");
      }
      for (size_t c = 2; c < corners.size(); ++c) {
        mesh.triangles.emplace_back(corners[0], corners[c - 1], corners[c]);
      }
    }
  }
}

}  // namespace

TriangleMesh read_ply(const std::string& path) {
  Source source(path);
  const std::vector<Element> elements = parse_header(source);
  const auto named = [&](std::string_view name) {
    return std::find_if(elements.begin(), elements.end(),
                        [&](const Element& e) { return e.name == name; });
  };
  const auto vertices = named("vertex");
  if (vertices == elements.end()) source.fail("the file has no element \"vertex\"");
  if (named("face") == elements.end()) source.fail("the file has no element \"face\"");

  TriangleMesh mesh;
  for (const Element& element : elements) {
    check_count(source, element);
    if (element.name == "vertex") {
      if (!mesh.positions.empty()) source.fail("the file has two elements \"vertex\"");
      read_vertices(source, element, mesh);
    } else if (element.name == "face") {
      read_faces(source, element, vertices->count, mesh);
    } else {
      for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
        for (const Property& p : element.properties) skip(source, p);
      }
    }
  }
  return mesh;
}

}  // namespace lockstep
