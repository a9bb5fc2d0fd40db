#include "core/mitsuba/meshes.h"

#include "core/error.h"
#include "core/ply.h"
#include "core/serialized_mesh.h"

#include <tbb/parallel_for.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace lockstep::mitsuba {
namespace {

glm::vec3 unit_or_zero(glm::vec3 v) {
  const float length = glm::length(v);
  return length > 0.0f && std::isfinite(length) ? v / length : glm::vec3(0.0f);
}

// Of a PLY file, which may have any.
void repair_normals(TriangleMesh& mesh) {
  std::vector<glm::vec3> given = std::move(mesh.normals);
  mesh.normals.clear();
  if (given.empty()) return;
  for (glm::vec3& n : given) n = unit_or_zero(n);
  set_smooth_normals(mesh);
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given[i] != glm::vec3(0.0f)) mesh.normals[i] = given[i];
  }
}

struct PositionHash {
  std::size_t operator()(glm::vec3 p) const {
    std::size_t h = 0;
    for (int i = 0; i < 3; ++i) h = 31 * h + std::hash<float>()(p[i]);
    return h;
  }
};

// For every corner of every triangle the mean, weighted by area, of the normals of those faces
// around its position that turn away from its own by no more than `angle`.
void limit_smoothing(TriangleMesh& mesh, float degrees) {
  const float least_cosine = std::cos(glm::radians(degrees));
  constexpr std::size_t most_faces = 256;  // around a position; beyond that corners are flat
  std::unordered_map<glm::vec3, std::vector<unsigned>, PositionHash> faces_at;
  std::vector<glm::vec3> weighted;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3 t = mesh.triangles[i];
    const glm::vec3 a = mesh.positions[t.x];
    weighted.push_back(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
    for (int k = 0; k < 3; ++k) {
      std::vector<unsigned>& faces = faces_at[mesh.positions[t[k]]];
      if (faces.size() <= most_faces) faces.push_back(unsigned(i));
    }
  }
  TriangleMesh split;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::vec3 own = unit_or_zero(weighted[i]);
    for (int k = 0; k < 3; ++k) {
      const unsigned vertex = mesh.triangles[i][k];
      const std::vector<unsigned>& faces = faces_at[mesh.positions[vertex]];
      glm::vec3 sum = own;
      if (faces.size() <= most_faces) {
        sum = weighted[i];
        for (const unsigned f : faces) {
          const bool near = glm::dot(unit_or_zero(weighted[f]), own) >= least_cosine;
          if (f != i && near) sum += weighted[f];
        }
      }
      const glm::vec3 n = unit_or_zero(sum);
      split.positions.push_back(mesh.positions[vertex]);
      split.normals.push_back(n == glm::vec3(0.0f) ? glm::vec3(0.0f, 0.0f, 1.0f) : n);
      if (!mesh.uvs.empty()) split.uvs.push_back(mesh.uvs[vertex]);
    }
    const auto first = unsigned(3 * i);
    split.triangles.emplace_back(first, first + 1, first + 2);
  }
  mesh = std::move(split);
}

void finish_normals(const Properties& set, TriangleMesh& mesh, bool flat) {
  const bool face_normals = set.get_bool("face_normals", flat);
  const float angle = set.get_float("max_smooth_angle", -1.0f);
  if (face_normals) {
    mesh.normals.clear();
  } else if (angle >= 0.0f) {
    limit_smoothing(mesh, std::min(angle, 180.0f));
  } else if (mesh.normals.empty()) {
    set_smooth_normals(mesh);
  } else {
    agree_with_normals(mesh);
  }
}

void turn_uvs(TriangleMesh& mesh) {
  for (glm::vec2& uv : mesh.uvs) uv.y = 1.0f - uv.y;
}

std::string file_of(const State& state, const Properties& set) {
  const std::string name = set.get_string("filename", "");
  if (name.empty()) fail(set.where(), set.shown() + " needs a filename");
  set.ignore({"srgb", "collapse"});
  return resolve(state.sources, set.element(), name);
}

// Runs a reader; its errors are blamed on the shape that names the file.
template <class Reader>
auto read_file(const Properties& set, const Reader& read) {
  try {
    return read();
  } catch (const Error& error) {
    fail(set.where(), error.what());
  }
}

TriangleMesh mesh_of(const State& state, const Properties& set) {
  const std::string file = file_of(state, set);
  TriangleMesh mesh;
  bool flat = false;
  if (set.type() == "obj") {
    mesh = read_file(set, [&] { return read_obj(file); });
    if (!set.get_bool("flip_tex_coords", true)) turn_uvs(mesh);
  } else if (set.type() == "ply") {
    mesh = read_file(set, [&] { return read_ply(file); });
    repair_normals(mesh);
    if (set.get_bool("flip_tex_coords", false)) turn_uvs(mesh);
  } else {
    const int index = set.get_int("shape_index", 0);
    SerializedMesh read = read_file(set, [&] { return read_serialized_mesh(file, index); });
    mesh = std::move(read.mesh);
    flat = read.face_normals;
  }
  finish_normals(set, mesh, flat);
  return mesh;
}

// Marks what mesh_of() looks at.
void ignore_parameters_of_mesh(const Properties& set) {
  set.ignore({"filename", "srgb", "collapse", "face_normals", "max_smooth_angle",
              set.type() == "serialized" ? "shape_index" : "flip_tex_coords"});
}

}  // namespace

bool is_mesh_file(const std::string& type) {
  return type == "obj" || type == "ply" || type == "serialized";
}

TriangleMesh read_mesh_file(State& state, const Properties& set) {
  const auto ahead = state.meshes_ahead.extract(set.element().node);
  if (!ahead) return mesh_of(state, set);
  if (const auto* error = std::get_if<std::exception_ptr>(&ahead.mapped())) {
    std::rethrow_exception(*error);
  }
  ignore_parameters_of_mesh(set);
  return std::get<TriangleMesh>(std::move(ahead.mapped()));
}

void read_meshes_ahead(State& state, const std::vector<Element>& shapes) {
  std::vector<std::variant<TriangleMesh, std::exception_ptr>> meshes(shapes.size());
  tbb::parallel_for(std::size_t{0}, shapes.size(), [&](std::size_t i) {
    try {
      meshes[i] = mesh_of(state, state.properties(shapes[i]));
    } catch (...) {
      meshes[i] = std::current_exception();
    }
  });
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    state.meshes_ahead.emplace(shapes[i].node, std::move(meshes[i]));
  }
}

ObjFile read_obj_file(State& state, const Properties& set) {
  const std::string path = file_of(state, set);
  ObjFile file = read_file(set, [&] { return read_obj_parts(path); });
  const bool as_they_are = !set.get_bool("flip_tex_coords", true);
  for (ObjPart& part : file.parts) {
    if (as_they_are) turn_uvs(part.mesh);
    finish_normals(set, part.mesh, false);
  }
  return file;
}

void agree_with_normals(TriangleMesh& mesh) {
  for (glm::uvec3& t : mesh.triangles) {
    const glm::vec3 a = mesh.positions[t.x];
    const glm::vec3 face = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
    const glm::vec3 shading = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
    if (glm::dot(face, shading) < 0.0f) std::swap(t.y, t.z);
  }
}

void turn_over(TriangleMesh& mesh) {
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  for (glm::vec3& n : mesh.normals) n = -n;
}

}  // namespace lockstep::mitsuba
