#include "core/ply.h"

#include "core/location.h"

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
#include <memory>
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

// A file's bytes, followed by a zero.
struct FileBytes {
  std::unique_ptr<char[]> data;
  size_t size = 0;
};

// The first `most` bytes, or all. The size that the file system tells is a guess.
FileBytes read_bytes(const std::string& path, size_t most) {
  std::error_code failed;
  const bool is_file = std::filesystem::is_regular_file(path, failed);
  const auto told = is_file ? std::filesystem::file_size(path, failed) : 0;
  std::ifstream file;
  if (is_file && !failed) file.open(path, std::ios::binary);
  if (!file.is_open()) throw Error(path + ": cannot be opened; check the path");
  FileBytes bytes;
  // One byte more than expected tells the end of the file.
  size_t capacity = std::min<std::uint64_t>(told, most) + 1;
  bytes.data = std::make_unique_for_overwrite<char[]>(capacity + 1);
  while (bytes.size < most && file) {
    if (bytes.size == capacity) {
      capacity *= 2;
      auto larger = std::make_unique_for_overwrite<char[]>(capacity + 1);
      std::memcpy(larger.get(), bytes.data.get(), bytes.size);
      bytes.data = std::move(larger);
    }
    const size_t wanted = std::min(capacity, most) - bytes.size;
    file.read(bytes.data.get() + bytes.size, static_cast<std::streamsize>(wanted));
    bytes.size += static_cast<size_t>(file.gcount());
  }
  bytes.data[bytes.size] = '\0';
  return bytes;
}

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
constexpr double largest_coordinate = 1e18;

float to_float(const Source& source, double value) {
  if (!std::isfinite(value)) source.fail("a vertex has a coordinate that is not finite");
  if (std::abs(value) > largest_coordinate) {
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

// How the file stores vertices, and which of their values the mesh takes.
struct VertexLayout {
  const Element& element;
  std::vector<int> slots;  // per property
  bool with_normals = false, with_uvs = false;
};

VertexLayout vertex_layout(const Source& source, const Element& element) {
  VertexLayout layout{element, {}};
  std::array<bool, 8> present{};
  for (const Property& p : element.properties) {
    layout.slots.push_back(p.count_type ? -1 : vertex_slot(p.name));
    if (layout.slots.back() >= 0) present[layout.slots.back()] = true;
  }
  if (!present[0] || !present[1] || !present[2]) source.fail("vertices lack x, y or z");
  layout.with_normals = present[3] && present[4] && present[5];
  layout.with_uvs = present[6] && present[7];
  return layout;
}

void append_vertex(const VertexLayout& layout, const std::array<float, 8>& value,
                   TriangleMesh& mesh) {
  mesh.positions.emplace_back(value[0], value[1], value[2]);
  if (layout.with_normals) mesh.normals.emplace_back(value[3], value[4], value[5]);
  if (layout.with_uvs) mesh.uvs.emplace_back(value[6], value[7]);
}

void read_vertex(Source& source, const VertexLayout& layout, TriangleMesh& mesh) {
  std::array<float, 8> value{};
  for (size_t p = 0; p < layout.slots.size(); ++p) {
    const Property& property = layout.element.properties[p];
    if (layout.slots[p] < 0) {
      skip(source, property);
    } else {
      value[layout.slots[p]] = to_float(source, source.number(property.type));
    }
  }
  append_vertex(layout, value, mesh);
}

// Where each slot's value stands in the row of a vertex, in bytes; nothing unless rows have one
// length and values are floats.
struct VertexRows {
  std::vector<std::pair<int, size_t>> offsets;  // by slot, in the order of the properties
  size_t stride = 0;
};

std::optional<VertexRows> vertex_rows(const Source& source, const VertexLayout& layout) {
  VertexRows rows;
  for (size_t p = 0; p < layout.slots.size(); ++p) {
    const Property& property = layout.element.properties[p];
    if (property.count_type) return std::nullopt;
    if (layout.slots[p] >= 0) {
      if (property.type != Scalar::Float32) return std::nullopt;
      rows.offsets.emplace_back(layout.slots[p], rows.stride);
    }
    rows.stride += size_of(property.type);
  }
  return source.is_native() ? std::optional(rows) : std::nullopt;
}

// Takes up to `count` whole rows, and stops at the first one that has a value out of range.
std::uint64_t take_rows(Source& source, const VertexLayout& layout, const VertexRows& rows,
                        std::uint64_t count, TriangleMesh& mesh) {
  count = std::min(count, source.bytes_left() / rows.stride);
  for (std::uint64_t i = 0; i < count; ++i) {
    std::array<float, 8> value{};
    bool in_range = true;
    for (const auto& [slot, offset] : rows.offsets) {
      std::memcpy(&value[slot], source.rest() + offset, sizeof(float));
      in_range &= std::abs(double{value[slot]}) <= largest_coordinate;
    }
    if (!in_range) return i;
    append_vertex(layout, value, mesh);
    source.take(rows.stride);
  }
  return count;
}

void read_vertices(Source& source, const Element& element, TriangleMesh& mesh) {
  const VertexLayout layout = vertex_layout(source, element);
  mesh.positions.reserve(element.count);
  if (layout.with_normals) mesh.normals.reserve(element.count);
  if (layout.with_uvs) mesh.uvs.reserve(element.count);
  std::uint64_t done = 0;
  if (const auto rows = vertex_rows(source, layout)) {
    done = take_rows(source, layout, *rows, element.count, mesh);
  }
  for (; done < element.count; ++done) read_vertex(source, layout, mesh);
}

bool is_index_list(const Property& p) {
  return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
}

void append_fan(const std::vector<unsigned>& corners, TriangleMesh& mesh) {
  for (size_t c = 2; c < corners.size(); ++c) {
    mesh.triangles.emplace_back(corners[0], corners[c - 1], corners[c]);
  }
}

// Reads faces one by one.
class FaceReader {
 public:
  FaceReader(Source& source, const Element& element, std::uint64_t vertex_count, TriangleMesh& mesh)
      : source_(source), element_(element), vertex_count_(vertex_count), mesh_(mesh) {}

  // Whether faces are an uchar and so many ints, all as in memory.
  bool is_plain() const {
    if (!source_.is_native() || element_.properties.size() != 1) return false;
    const Property& p = element_.properties[0];
    return *p.count_type == Scalar::Uint8 && size_of(p.type) == 4 && p.type != Scalar::Float32 &&
           vertex_count_ <= 1u << 31;  // so that negative indices are too large ones
  }

  // Takes a plain face; nothing is taken where something is wrong with it.
  bool take_plain() {
    if (source_.bytes_left() < 1) return false;
    const char* rest = source_.rest();
    const auto count = static_cast<unsigned char>(*rest);
    const size_t size = 1 + 4 * size_t{count};
    if (count < 3 || source_.bytes_left() < size) return false;
    if (count == 3) {
      std::uint32_t t[3];
      std::memcpy(t, rest + 1, sizeof t);
      if (std::max({t[0], t[1], t[2]}) >= vertex_count_) return false;
      mesh_.triangles.emplace_back(t[0], t[1], t[2]);
    } else {
      corners_.resize(count);
      std::memcpy(corners_.data(), rest + 1, size - 1);
      if (*std::max_element(corners_.begin(), corners_.end()) >= vertex_count_) return false;
      append_fan(corners_, mesh_);
    }
    source_.take(size);
    return true;
  }

  // The same for any face; `number` names it in errors.
  void read(std::uint64_t number) {
    for (const Property& p : element_.properties) {
      if (is_index_list(p)) {
        read_corners(p, number);
      } else {
        skip(source_, p);
      }
    }
  }

 private:
  void read_corners(const Property& p, std::uint64_t number) {
    corners_.resize(list_length(source_, p));
    for (unsigned& corner : corners_) {
      const double index = source_.number(p.type);
      if (!(index >= 0.0 && index < static_cast<double>(vertex_count_))) {
        source_.fail("face " + std::to_string(number) +
                     " refers to a vertex that does not exist; " + "there are " +
                     std::to_string(vertex_count_));
      }
      corner = static_cast<unsigned>(index);
    }
    if (corners_.size() < 3) {
      source_.fail("face " + std::to_string(number) + " has fewer than three vertices");
    }
    append_fan(corners_, mesh_);
  }

  Source& source_;
  const Element& element_;
  std::uint64_t vertex_count_;
  TriangleMesh& mesh_;
  std::vector<unsigned> corners_;
};

void read_faces(Source& source, const Element& element, std::uint64_t vertex_count,
                TriangleMesh& mesh) {
  if (std::none_of(element.properties.begin(), element.properties.end(), is_index_list)) {
    source.fail("faces lack the list vertex_indices");
  }
  // Exact for triangles, of which few files have less than 8 bytes each.
  if (mesh.triangles.empty()) {
    mesh.triangles.reserve(std::min(element.count, source.bytes_left() / 8));
  }
  FaceReader faces(source, element, vertex_count, mesh);
  const bool plain = faces.is_plain();
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (!plain || !faces.take_plain()) faces.read(i);
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

bool announces_no_face(const std::string& path) {
  // Most headers are short.
  for (const size_t most : {size_t{1} << 12, SIZE_MAX}) {
    try {
      Source source(path, most);
      const std::vector<Element> elements = parse_header(source);
      return std::none_of(elements.begin(), elements.end(),
                          [](const Element& e) { return e.name == "face" && e.count > 0; });
    } catch (const Error&) {
    }
  }
  return false;
}

}  // namespace lockstep
