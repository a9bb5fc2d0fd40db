#include "core/pbrt/shapes.h"

#include "core/pbrt/bilinear.h"
#include "core/pbrt/placement.h"
#include "core/pbrt/quadrics.h"
#include "core/ply.h"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace lockstep::pbrt {

namespace {

void check_indices(const ParameterSet& set, const std::vector<int>& indices, size_t group,
                   size_t vertex_count) {
  const Parameter* p = set.any("indices");
  const Location where = p != nullptr ? set.where(*p) : set.where();
  if (indices.size() % group != 0) {
    fail(where, set.owner() + " has " + std::to_string(indices.size()) +
                    " indices; expected a multiple of " + std::to_string(group));
  }
  for (const int index : indices) {
    if (index >= 0 && static_cast<size_t>(index) < vertex_count) continue;
    fail(where, set.owner() + " has the index " + std::to_string(index) + ", but only " +
                    std::to_string(vertex_count) + " points");
  }
}

std::vector<glm::vec3> required_points(const ParameterSet& set) {
  std::vector<glm::vec3> points = set.get_points("P");
  if (points.empty()) fail(set.where(), set.owner() + " needs \"point3 P\"");
  return points;
}

// P, N and uv of a mesh; the last two must match the first in number where given.
TriangleMesh read_vertices(const ParameterSet& set) {
  TriangleMesh mesh;
  mesh.positions = required_points(set);
  mesh.normals = set.get_normals("N");
  mesh.uvs = set.get_uvs();
  const auto check_count = [&](size_t count, const char* name) {
    if (count == 0 || count == mesh.positions.size()) return;
    fail(set.where(), set.owner() + " has " + std::to_string(mesh.positions.size()) +
                          " points but " + std::to_string(count) + " values of \"" + name + "\"");
  };
  check_count(mesh.normals.size(), "N");
  check_count(mesh.uvs.size(), "uv");
  return mesh;
}

// Without "indices" the points themselves come in groups.
std::vector<int> read_indices(const ParameterSet& set, size_t group, size_t vertex_count) {
  std::vector<int> indices = set.get_ints("indices");
  if (indices.empty()) {
    if (vertex_count % group != 0) fail(set.where(), set.owner() + " needs \"integer indices\"");
    indices.resize(vertex_count);
    std::iota(indices.begin(), indices.end(), 0);
  }
  check_indices(set, indices, group, vertex_count);
  return indices;
}

void set_triangles(const std::vector<int>& indices, TriangleMesh& mesh) {
  mesh.triangles.reserve(indices.size() / 3);
  for (size_t i = 0; i < indices.size(); i += 3) {
    mesh.triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
  }
}

TriangleMesh triangle_mesh(const ParameterSet& set, const ShapeContext&) {
  TriangleMesh mesh = read_vertices(set);
  set_triangles(read_indices(set, 3, mesh.positions.size()), mesh);
  return mesh;
}

TriangleMesh bilinear_mesh(const ParameterSet& set, const ShapeContext&) {
  const TriangleMesh vertices = read_vertices(set);
  return triangulate_patches(vertices, read_indices(set, 4, vertices.positions.size()));
}

TriangleMesh ply_mesh(const ParameterSet& set, const ShapeContext& context) {
  const std::string name = set.get_string("filename", "");
  if (name.empty()) fail(set.where(), set.owner() + " needs \"string filename\"");
  try {
    return read_ply(context.resolve(name));
  } catch (const Error& error) {
    fail(set.where(), error.what());
  }
}

TriangleMesh loop_surface(const ParameterSet& set, const ShapeContext& context) {
  TriangleMesh control;
  control.positions = required_points(set);
  const std::vector<int> indices = set.get_ints("indices");
  if (indices.empty()) fail(set.where(), set.owner() + " needs \"integer indices\"");
  check_indices(set, indices, 3, control.positions.size());
  set_triangles(indices, control);
  set.ignore({"scheme"});

  const int levels = set.get_int("levels", set.get_int("nlevels", 3));
  const double triangles = static_cast<double>(control.triangles.size()) * std::pow(4.0, levels);
  if (levels < 0 || !(triangles <= context.triangles_left)) {
    fail(set.where(), set.owner() + " cannot have " + std::to_string(levels) +
                          " levels; give 0 or more, and no more than 67 million triangles in all");
  }
  try {
    TriangleMesh surface = subdivide_loop(control, levels);
    turn_over(surface);  // pbrt's normals of these surfaces oppose the winding
    return surface;
  } catch (const std::invalid_argument& error) {
    fail(set.where(), set.owner() + ": " + error.what());
  }
}

struct MeshType {
  std::string_view name;
  TriangleMesh (*make)(const ParameterSet&, const ShapeContext&);  // in object space
};

// To support another shape made of triangles, write its function and add it here.
constexpr MeshType mesh_types[] = {
    {"trianglemesh", triangle_mesh},
    {"bilinearmesh", bilinear_mesh},
    {"loopsubdiv", loop_surface},
    {"plymesh", ply_mesh},
};

std::optional<Geometry> make_quadric(const std::string& type, const ParameterSet& set,
                                     const ShapeContext& context, Warnings& warnings) {
  if (type == "sphere") return make_sphere(set, context, warnings);
  if (type == "disk") return make_disk(set, context);
  if (type == "cylinder") return make_cylinder(set, context);
  return std::nullopt;
}

}  // namespace

std::optional<Geometry> make_shape(const std::string& type, const ParameterSet& set,
                                   const ShapeContext& context, Warnings& warnings) {
  if (std::optional<Geometry> quadric = make_quadric(type, set, context, warnings)) {
    set.warn_unused(warnings);
    return quadric;
  }
  for (const MeshType& known : mesh_types) {
    if (known.name != type) continue;
    TriangleMesh mesh = known.make(set, context);
    set.warn_unused(warnings);
    if (!mesh.triangles.empty()) return to_world(std::move(mesh), set, context);
    warnings.add(set.where(), set.owner() + " has no triangles; it is left out");
    return std::nullopt;
  }
  warnings.add(set.where(), "Shape \"" + type + "\" is not supported; it is left out");
  return std::nullopt;
}

}  // namespace lockstep::pbrt
