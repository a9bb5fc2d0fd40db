#include "core/gltf/meshes.h"

#include "core/gltf/accessors.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace lockstep::gltf {

namespace {

using Indices = std::vector<std::uint32_t>;

struct PrimitiveReader {
  Document& document;
  const tinygltf::Primitive& primitive;
  const std::string& name;

  [[noreturn]] void fail_here(const std::string& what) const {
    fail(document.path, name + ": " + what);
  }
  // -1 where the primitive has no such attribute.
  int attribute(const std::string& semantic) const {
    const auto found = primitive.attributes.find(semantic);
    return found == primitive.attributes.end() ? -1 : found->second;
  }
};

bool is_finite(glm::vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Checked before memory is asked for: zeros need no bytes in the file.
void spend_corners(const PrimitiveReader& reader, std::size_t count) {
  if (count > reader.document.corners_left) {
    reader.fail_here("the file has more than 44 million triangles; split it");
  }
  reader.document.corners_left -= count;
}

Indices read_corners(const PrimitiveReader& reader, std::size_t vertex_count) {
  const int index = reader.primitive.indices;
  if (index < 0) {
    spend_corners(reader, vertex_count);
    Indices corners(vertex_count);
    std::iota(corners.begin(), corners.end(), 0u);
    return corners;
  }
  const auto& accessors = reader.document.model.accessors;
  if (size_t(index) < accessors.size()) spend_corners(reader, accessors[size_t(index)].count);
  Indices corners = read_indices(reader.document, index, reader.name + ": indices");
  for (const std::uint32_t corner : corners) {
    if (corner >= vertex_count) {
      reader.fail_here("index " + std::to_string(corner) + " is out of range; there are " +
                       std::to_string(vertex_count) + " vertices");
    }
  }
  return corners;
}

// Strips are often joined by triangles of no area.
void add_if_proper(std::vector<glm::uvec3>& triangles, glm::uvec3 t) {
  if (t.x != t.y && t.y != t.z && t.z != t.x) triangles.push_back(t);
}

// Section 3.7.2.1 of the specification gives the order of each triangle's corners.
std::vector<glm::uvec3> make_triangles(const PrimitiveReader& reader, const Indices& corners) {
  std::vector<glm::uvec3> triangles;
  const std::size_t count = corners.size();
  switch (reader.primitive.mode) {
    case TINYGLTF_MODE_TRIANGLE_STRIP:
      for (std::size_t i = 0; i + 2 < count; ++i) {
        const std::size_t odd = i % 2;
        add_if_proper(triangles, {corners[i], corners[i + 1 + odd], corners[i + 2 - odd]});
      }
      return triangles;
    case TINYGLTF_MODE_TRIANGLE_FAN:
      for (std::size_t i = 0; i + 2 < count; ++i) {
        add_if_proper(triangles, {corners[i + 1], corners[i + 2], corners[0]});
      }
      return triangles;
    default:
      if (count % 3 != 0) {
        reader.fail_here("has " + std::to_string(count) + " corners; expected a multiple of 3");
      }
      triangles.reserve(count / 3);
      for (std::size_t i = 0; i < count; i += 3) {
        triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
      }
      return triangles;
  }
}

// The vertices that corners use, rising; the triangles then refer to these. Empty: all, as they
// are. Primitives that share one large array would otherwise each copy all of it.
Indices keep_used(const Indices& corners, std::size_t vertex_count,
                  std::vector<glm::uvec3>& triangles) {
  if (corners.size() >= vertex_count) return {};
  Indices used = corners;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (glm::uvec3& t : triangles) {
    for (int c = 0; c < 3; ++c) {
      t[c] = static_cast<unsigned>(std::lower_bound(used.begin(), used.end(), t[c]) - used.begin());
    }
  }
  return used;
}

// Calls add(value of the accessor) for each vertex that is kept.
template <class Add>
void for_each_vertex(const Accessor& accessor, const Indices& used, Add add) {
  const std::size_t count = used.empty() ? accessor.count() : used.size();
  for (std::size_t i = 0; i < count; ++i) add(element(accessor, used.empty() ? i : used[i]));
}

// An accessor with one value for each vertex; nothing where the primitive lacks the attribute.
std::optional<Accessor> open_attribute(const PrimitiveReader& reader, const std::string& semantic,
                                       int components, std::size_t vertex_count) {
  const int index = reader.attribute(semantic);
  if (index < 0) return std::nullopt;
  Accessor accessor =
      open_accessor(reader.document, index, components, reader.name + ": " + semantic);
  if (accessor.count() != vertex_count) {
    reader.fail_here(semantic + " has " + std::to_string(accessor.count()) + " elements for " +
                     std::to_string(vertex_count) + " vertices");
  }
  return accessor;
}

void read_positions(const PrimitiveReader& reader, const Accessor& accessor, const Indices& used,
                    TriangleMesh& mesh) {
  for_each_vertex(accessor, used, [&](glm::vec3 p) {
    if (!is_finite(p)) reader.fail_here("POSITION has a value that is not finite");
    mesh.positions.push_back(p);
  });
}

// Files have normals of no length, and NaN; those become smooth ones.
void read_normals(const PrimitiveReader& reader, const Accessor& accessor, const Indices& used,
                  TriangleMesh& mesh) {
  std::vector<glm::vec3> given;
  bool all_proper = true;
  for_each_vertex(accessor, used, [&](glm::vec3 n) {
    const float length = glm::length(n);
    const bool proper = length > 0.0f && std::isfinite(length);
    all_proper = all_proper && proper;
    given.push_back(proper ? n / length : glm::vec3(0.0f));
  });
  if (!all_proper) {
    reader.document.warnings.add(reader.name, "normals without a direction are replaced");
    set_smooth_normals(mesh);
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (given[i] == glm::vec3(0.0f)) given[i] = mesh.normals[i];
    }
  }
  mesh.normals = std::move(given);
}

void read_uvs(const PrimitiveReader& reader, const Accessor& accessor, const Indices& used,
              TriangleMesh& mesh) {
  for_each_vertex(accessor, used, [&](glm::vec3 uv) {
    const bool finite = is_finite(uv);
    if (!finite) {
      reader.document.warnings.add(reader.name, "texture coordinates that are not finite become 0");
    }
    mesh.uvs.push_back(finite ? glm::vec2(uv) : glm::vec2(0.0f));
  });
}

std::string uv_semantic(const PrimitiveReader& reader, int uv_set) {
  const std::string wanted = "TEXCOORD_" + std::to_string(uv_set);
  if (uv_set == 0 || reader.attribute(wanted) >= 0) return wanted;
  reader.document.warnings.add(reader.name, "lacks " + wanted + "; TEXCOORD_0 is used");
  return "TEXCOORD_0";
}

void warn_of_omissions(const PrimitiveReader& reader) {
  if (reader.attribute("COLOR_0") >= 0) {
    reader.document.warnings.add(reader.name, "vertex colours (COLOR_0) are not supported");
  }
}

// False, with a warning, where there is nothing to draw as triangles.
bool has_triangles(const PrimitiveReader& reader) {
  const int mode = reader.primitive.mode;
  if (mode < TINYGLTF_MODE_POINTS || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    reader.fail_here("unknown mode " + std::to_string(mode));
  }
  if (mode < TINYGLTF_MODE_TRIANGLES) {
    reader.document.warnings.add(reader.name, "points and lines are left out");
    return false;
  }
  if (reader.attribute("POSITION") < 0) {
    reader.document.warnings.add(reader.name, "primitives without POSITION are left out");
    return false;
  }
  return true;
}

}  // namespace

std::optional<TriangleMesh> read_primitive(Document& document, const tinygltf::Primitive& primitive,
                                           int uv_set, const std::string& name) {
  const PrimitiveReader reader{document, primitive, name};
  if (!has_triangles(reader)) return std::nullopt;
  warn_of_omissions(reader);
  const Accessor positions =
      open_accessor(document, reader.attribute("POSITION"), 3, name + ": POSITION");
  const std::size_t vertex_count = positions.count();
  const Indices corners = read_corners(reader, vertex_count);

  TriangleMesh mesh;
  mesh.triangles = make_triangles(reader, corners);
  if (mesh.triangles.empty()) {
    document.warnings.add(name, "primitives without triangles are left out");
    return std::nullopt;
  }
  const Indices used = keep_used(corners, vertex_count, mesh.triangles);
  mesh.positions.reserve(used.empty() ? vertex_count : used.size());
  read_positions(reader, positions, used, mesh);
  // Without normals faces are flat (section 3.7.2.1).
  if (const auto normals = open_attribute(reader, "NORMAL", 3, vertex_count)) {
    read_normals(reader, *normals, used, mesh);
  }
  if (const auto uvs = open_attribute(reader, uv_semantic(reader, uv_set), 2, vertex_count)) {
    read_uvs(reader, *uvs, used, mesh);
  }
  return mesh;
}

}  // namespace lockstep::gltf
