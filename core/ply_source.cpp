#include "core/ply_source.h"

#include <filesystem>
#include <fstream>
#include <utility>

namespace lockstep::ply {
namespace {

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

}  // namespace

// The size that the file system tells is a guess.
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

}  // namespace lockstep::ply
