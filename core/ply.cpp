#include "core/ply.h"

#include "core/ply_source.h"

#include <cmath>

namespace lockstep {
namespace {

using namespace ply;

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
// length, and values are floats that the mesh takes, each once.
struct VertexRows {
  std::array<size_t, 8> offsets{};
  size_t stride = 0;
};

std::optional<VertexRows> vertex_rows(const Source& source, const VertexLayout& layout) {
  VertexRows rows;
  int values = 0;
  for (size_t p = 0; p < layout.slots.size(); ++p) {
    const Property& property = layout.element.properties[p];
    if (property.count_type) return std::nullopt;
    if (layout.slots[p] >= 0) {
      if (property.type != Scalar::Float32) return std::nullopt;
      rows.offsets[layout.slots[p]] = rows.stride;
      ++values;
    }
    rows.stride += size_of(property.type);
  }
  const bool all_taken = values == 3 + 3 * layout.with_normals + 2 * layout.with_uvs;
  return source.is_native() && all_taken ? std::optional(rows) : std::nullopt;
}

// Takes up to `count` whole rows, and stops at the first one that has a value out of range.
std::uint64_t take_rows(Source& source, const VertexLayout& layout, const VertexRows& rows,
                        std::uint64_t count, TriangleMesh& mesh) {
  count = std::min(count, source.bytes_left() / rows.stride);
  const char* row = source.rest();
  std::uint64_t taken = 0;
  for (; taken < count; ++taken, row += rows.stride) {
    bool in_range = true;
    const auto value = [&](size_t slot) {
      float v;
      std::memcpy(&v, row + rows.offsets[slot], sizeof v);
      in_range &= std::abs(double{v}) <= largest_coordinate;
      return v;
    };
    const glm::vec3 position(value(0), value(1), value(2));
    glm::vec3 normal(0.0f);
    glm::vec2 uv(0.0f);
    if (layout.with_normals) normal = {value(3), value(4), value(5)};
    if (layout.with_uvs) uv = {value(6), value(7)};
    if (!in_range) break;
    mesh.positions.push_back(position);
    if (layout.with_normals) mesh.normals.push_back(normal);
    if (layout.with_uvs) mesh.uvs.push_back(uv);
  }
  source.take(taken * rows.stride);
  return taken;
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

  // Takes up to `count` plain triangles, and stops at the first face that is none or is wrong.
  std::uint64_t take_triangles(std::uint64_t count) {
    constexpr size_t size = 1 + 3 * sizeof(std::uint32_t);
    count = std::min(count, source_.bytes_left() / size);
    const char* face = source_.rest();
    std::uint64_t taken = 0;
    for (; taken < count && *face == 3; ++taken, face += size) {
      std::uint32_t t[3];
      std::memcpy(t, face + 1, sizeof t);
      if (std::max({t[0], t[1], t[2]}) >= vertex_count_) break;
      mesh_.triangles.emplace_back(t[0], t[1], t[2]);
    }
    source_.take(taken * size);
    return taken;
  }

  // Takes a plain face; nothing is taken where something is wrong with it.
  bool take_plain() {
    if (source_.bytes_left() < 1) return false;
    const char* rest = source_.rest();
    const auto count = static_cast<unsigned char>(*rest);
    const size_t size = 1 + 4 * size_t{count};
    if (count < 3 || source_.bytes_left() < size) return false;
    corners_.resize(count);
    std::memcpy(corners_.data(), rest + 1, size - 1);
    if (*std::max_element(corners_.begin(), corners_.end()) >= vertex_count_) return false;
    append_fan(corners_, mesh_);
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
    if (plain) i += faces.take_triangles(element.count - i);
    if (i < element.count && (!plain || !faces.take_plain())) faces.read(i);
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
