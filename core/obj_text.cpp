#include "core/obj_text.h"

#include "core/location.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <unordered_map>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::string& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    throw Error(path + ": is not a file; name an OBJ file");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path + ": cannot be opened; check the path");
  // Below, an int numbers all that a file can hold.
  constexpr std::uintmax_t largest = std::uintmax_t(1) << 33;
  const std::uintmax_t size = fs::file_size(path, ignored);
  if (size > largest) throw Error(path + ": is larger than 8 GiB; split it");
  std::string text(size_t(size), '\0');
  file.read(text.data(), std::streamsize(text.size()));
  text.resize(size_t(file.gcount()));
  return text;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// Reads the file line by line, from one buffer.
class Parser {
 public:
  explicit Parser(const std::string& path) : path_(path), text_(text_of(path)) {}

  ObjText parse() {
    contents_.groups.push_back({});
    group_of_[""] = 0;
    while (next_line()) statement();
    check_highest();
    return std::move(contents_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { lockstep::fail({path_, line_}, what); }

  // Moves to the next line; one that ends in a backslash goes on in the line after it.
  bool next_line() {
    line_ += lines_read_;
    lines_read_ = 0;
    if (next_ >= text_.size()) return false;
    at_ = end_ = next_;
    for (;;) {
      end_ = std::min(text_.find('\n', end_), text_.size());
      ++lines_read_;
      size_t last = end_;
      while (last > at_ && text_[last - 1] == '\r') --last;
      if (last == at_ || text_[last - 1] != '\\' || end_ == text_.size()) break;
      std::fill(text_.begin() + long(last) - 1, text_.begin() + long(end_) + 1, ' ');
    }
    next_ = end_ + 1;
    return true;
  }

  std::string_view word() {
    while (at_ < end_ && is_blank(text_[at_])) ++at_;
    const size_t begin = at_;
    while (at_ < end_ && !is_blank(text_[at_])) ++at_;
    return std::string_view(text_).substr(begin, at_ - begin);
  }

  std::string rest_of_line() {
    while (at_ < end_ && is_blank(text_[at_])) ++at_;
    size_t last = end_;
    while (last > at_ && is_blank(text_[last - 1])) --last;
    return text_.substr(at_, last - at_);
  }

  void statement() {
    const std::string_view key = word();
    if (key == "v") {
      contents_.positions.push_back(position());
    } else if (key == "vt") {
      const float u = number(), v = optional_number(0.0f);
      contents_.uvs.emplace_back(u, 1.0f - v);
    } else if (key == "vn") {
      const glm::vec3 n = vector();
      const float length = glm::length(n);
      contents_.normals.push_back(length > 0.0f && std::isfinite(length) ? n / length
                                                                         : glm::vec3(0.0f));
    } else if (key == "f" || key == "fo") {
      face();
    } else if (key == "usemtl") {
      use_material(rest_of_line());
    } else if (key == "mtllib") {
      contents_.libraries.push_back(rest_of_line());
    } else if (key == "curv" || key == "curv2" || key == "surf") {
      if (curved_) return;
      curved_ = true;
      contents_.warnings.push_back(path_ + ":" + std::to_string(line_) +
                                   ": curved surfaces are not supported; they are left out");
    }
  }

  float number() {
    const std::string_view text = word();
    if (text.empty()) fail("the line has too few numbers");
    return to_float(text);
  }

  float optional_number(float fallback) {
    const std::string_view text = word();
    return text.empty() || text.front() == '#' ? fallback : to_float(text);
  }

  float to_float(std::string_view text) const {
    const char* end = text.data() + text.size();
    const char* first = text.data() + (text.front() == '+' ? 1 : 0);
    float value = 0.0f;
    auto [rest, status] = std::from_chars(first, end, value);
    if (status == std::errc::result_out_of_range) value = std::strtof(text.data(), nullptr);
    if (status == std::errc::invalid_argument || rest != end) {
      fail("expected a number, found \"" + std::string(text.substr(0, 40)) + "\"");
    }
    if (!std::isfinite(value)) fail("a number is not finite");
    return value;
  }

  glm::vec3 vector() {
    const float x = number(), y = number();
    return {x, y, number()};
  }

  // Squared lengths beyond would leave the range of float.
  glm::vec3 position() {
    constexpr float largest = 1e18f;
    const glm::vec3 p = vector();
    if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > largest) {
      fail("a vertex is farther than 1e18 from the origin; scale the mesh down");
    }
    return p;
  }

  // An index as the file has it, of `count` things read so far; -1 where the text is empty.
  int index(std::string_view text, size_t count, int kind) {
    if (text.empty()) return -1;
    int value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, status] = std::from_chars(text.data(), end, value);
    if (status != std::errc() || rest != end || value == 0) {
      fail("expected the index of a vertex, found \"" + std::string(text.substr(0, 40)) + "\"");
    }
    if (value < 0) {
      if (std::int64_t(count) + value < 0) fail("an index reaches back beyond the first vertex");
      return int(std::int64_t(count) + value);
    }
    if (value > highest_[size_t(kind)].index) highest_[size_t(kind)] = {value, line_};
    return value - 1;
  }

  // v, v/vt, v//vn or v/vt/vn
  ObjCorner corner(std::string_view text) {
    std::array<std::string_view, 3> fields{};
    for (size_t i = 0; i < 3; ++i) {
      const size_t slash = text.find('/');
      fields[i] = text.substr(0, slash);
      if (slash == text.npos) break;
      text.remove_prefix(slash + 1);
      if (i == 2) fail("a corner of a face has more than three indices");
    }
    if (fields[0].empty()) fail("a corner of a face has no vertex");
    return {index(fields[0], contents_.positions.size(), 0),
            index(fields[1], contents_.uvs.size(), 1),
            index(fields[2], contents_.normals.size(), 2)};
  }

  void face() {
    polygon_.clear();
    for (std::string_view text = word(); !text.empty() && text.front() != '#'; text = word()) {
      polygon_.push_back(corner(text));
    }
    if (polygon_.size() < 3) fail("a face has fewer than three vertices");
    std::vector<ObjCorner>& corners = contents_.groups[group_].corners;
    for (size_t i = 2; i < polygon_.size(); ++i) {
      corners.insert(corners.end(), {polygon_[0], polygon_[i - 1], polygon_[i]});
    }
  }

  void use_material(const std::string& name) {
    const auto [entry, is_new] = group_of_.try_emplace(name, contents_.groups.size());
    if (is_new) contents_.groups.push_back({name, {}});
    group_ = entry->second;
  }

  // Faces may come before their vertices.
  void check_highest() {
    const std::array<size_t, 3> counts{contents_.positions.size(), contents_.uvs.size(),
                                       contents_.normals.size()};
    constexpr std::array<const char*, 3> names{"vertices", "texture coordinates", "normals"};
    for (size_t kind = 0; kind < 3; ++kind) {
      if (size_t(highest_[kind].index) <= counts[kind]) continue;
      line_ = highest_[kind].line;
      fail("a face has the index " + std::to_string(highest_[kind].index) + ", but there are " +
           std::to_string(counts[kind]) + " " + names[kind]);
    }
  }

  struct Highest {
    int index = 0, line = 0;
  };

  std::string path_, text_;
  size_t at_ = 0, end_ = 0, next_ = 0;  // within the current line, its end, the next one
  int line_ = 1, lines_read_ = 0;
  ObjText contents_;
  size_t group_ = 0;
  std::unordered_map<std::string, size_t> group_of_;
  std::array<Highest, 3> highest_{};
  std::vector<ObjCorner> polygon_;
  bool curved_ = false;
};

}  // namespace

ObjText read_obj_text(const std::string& path) { return Parser(path).parse(); }

}  // namespace lockstep
