#include "core/obj.h"

#include "core/default_view.h"
#include "core/error.h"
#include "core/mtl.h"
#include "core/obj_text.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <utility>

namespace lockstep {
namespace {

// Numbers distinct corners in the order of their coming; a hash table with open addressing.
class CornerNumbers {
 public:
  explicit CornerNumbers(size_t expected) {
    size_t capacity = 16;
    while (capacity < 2 * expected) capacity *= 2;
    slots_.assign(capacity, empty);
  }

  // The corner's number and whether it is new.
  std::pair<unsigned, bool> number_of(const ObjCorner& corner) {
    const size_t mask = slots_.size() - 1;
    for (size_t slot = hash(corner) & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot] == empty) {
        slots_[slot] = unsigned(corners_.size());
        corners_.push_back(corner);
        return {slots_[slot], true};
      }
      if (corners_[slots_[slot]] == corner) return {slots_[slot], false};
    }
  }

 private:
  static constexpr unsigned empty = std::numeric_limits<unsigned>::max();

  static size_t hash(const ObjCorner& corner) {
    std::uint64_t h = 0;
    for (const int i : corner) {
      h = (h ^ std::uint64_t(unsigned(i))) * 0x9e3779b97f4a7c15u;
      h ^= h >> 32;
    }
    return size_t(h);
  }

  std::vector<unsigned> slots_;
  std::vector<ObjCorner> corners_;
};

glm::vec3 face_normal(const ObjText& contents, const ObjCorner* corners) {
  const glm::vec3 a = contents.positions[size_t(corners[0][0])];
  const glm::vec3 n = glm::cross(contents.positions[size_t(corners[1][0])] - a,
                                 contents.positions[size_t(corners[2][0])] - a);
  const float length = glm::length(n);
  return length > 0.0f && std::isfinite(length) ? n / length : glm::vec3(0.0f, 0.0f, 1.0f);
}

// `contents` gets more normals where corners have none but others of the group do.
TriangleMesh build_mesh(std::vector<ObjCorner>& corners, ObjText& contents) {
  bool with_uvs = false, with_normals = false;
  for (ObjCorner& c : corners) {
    if (c[2] >= 0 && contents.normals[size_t(c[2])] == glm::vec3(0.0f)) c[2] = -1;
    with_uvs = with_uvs || c[1] >= 0;
    with_normals = with_normals || c[2] >= 0;
  }
  TriangleMesh mesh;
  mesh.triangles.reserve(corners.size() / 3);
  CornerNumbers numbers(corners.size());
  for (size_t i = 0; i < corners.size(); i += 3) {
    const ObjCorner* triangle = &corners[i];
    unsigned vertices[3];
    int own_normal = -1;
    for (int k = 0; k < 3; ++k) {
      ObjCorner c = triangle[k];
      if (with_normals && c[2] < 0) {
        if (own_normal < 0) {
          own_normal = int(contents.normals.size());
          contents.normals.push_back(face_normal(contents, triangle));
        }
        c[2] = own_normal;
      }
      const auto [vertex, is_new] = numbers.number_of(c);
      vertices[k] = vertex;
      if (!is_new) continue;
      mesh.positions.push_back(contents.positions[size_t(c[0])]);
      if (with_uvs) mesh.uvs.push_back(c[1] >= 0 ? contents.uvs[size_t(c[1])] : glm::vec2(0.0f));
      if (with_normals) mesh.normals.push_back(contents.normals[size_t(c[2])]);
    }
    mesh.triangles.emplace_back(vertices[0], vertices[1], vertices[2]);
  }
  return mesh;
}

}  // namespace

ObjFile read_obj_parts(const std::string& path) {
  ObjText contents = read_obj_text(path);
  ObjFile file{{}, std::move(contents.libraries), std::move(contents.warnings)};
  for (ObjGroup& group : contents.groups) {
    if (group.corners.empty()) continue;
    file.parts.push_back({std::move(group.material), build_mesh(group.corners, contents)});
    group.corners = {};
  }
  return file;
}

TriangleMesh read_obj(const std::string& path) {
  ObjText contents = read_obj_text(path);
  std::vector<ObjCorner> all = std::move(contents.groups.front().corners);
  for (size_t i = 1; i < contents.groups.size(); ++i) {
    std::vector<ObjCorner>& corners = contents.groups[i].corners;
    all.insert(all.end(), corners.begin(), corners.end());
    corners = {};
  }
  return build_mesh(all, contents);
}

SceneDescription read_obj_scene(const std::string& path) {
  SceneDescription scene;
  scene.name = std::filesystem::path(path).stem().string();
  ObjFile file = read_obj_parts(path);
  if (file.parts.empty()) throw Error(path + ": has no faces; there is nothing to render");
  scene.warnings = std::move(file.warnings);
  const ObjMaterials materials = read_mtl_libraries(path, file.libraries, scene);
  for (ObjPart& part : file.parts) add_obj_part(std::move(part), materials, scene);
  add_default_view(scene);
  return scene;
}

}  // namespace lockstep
