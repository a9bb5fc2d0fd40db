#include "core/pbrt/shapes.h"

#include "core/pbrt/bilinear.h"
#include "core/pbrt/curves.h"
#include "core/pbrt/placement.h"
#include "core/pbrt/quadrics.h"
#include "core/ply.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <exception>
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

std::string ply_file(const ParameterSet& set, const ShapeContext& context) {
  const std::string name = set.get_string("filename", "");
  if (name.empty()) fail(set.where(), set.owner() + " needs \"string filename\"");
  return context.resolve(name);
}

TriangleMesh read_ply_of_shape(const std::string& path, const Location& where) {
  try {
    return read_ply(path);
  } catch (const Error& error) {
    fail(where, error.what());
  }
}

TriangleMesh ply_mesh(const ParameterSet& set, const ShapeContext& context) {
  return read_ply_of_shape(ply_file(set, context), set.where());
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
    {"curve", curve},
};

std::optional<Geometry> make_quadric(const std::string& type, const ParameterSet& set,
                                     const ShapeContext& context, Warnings& warnings) {
  if (type == "sphere") return make_sphere(set, context, warnings);
  if (type == "disk") return make_disk(set, context);
  if (type == "cylinder") return make_cylinder(set, context);
  return std::nullopt;
}

// Only files that have a surface can wait: whether a shape is left out decides what its light adds
// to the scene.
std::optional<MeshFile> find_mesh_file(const std::string& type, const ParameterSet& set,
                                       const ShapeContext& context) {
  if (type != "plymesh") return std::nullopt;
  std::string path = ply_file(set, context);
  if (announces_no_face(path)) return std::nullopt;
  return MeshFile{std::move(path), placement_of(set, context)};
}

// Lowers `value` to `other`.
void lower(std::atomic<size_t>& value, size_t other) {
  for (size_t now = value; other < now && !value.compare_exchange_weak(now, other);) {
  }
}

}  // namespace

Placement placement_of(const ParameterSet& set, const ShapeContext& context) {
  return {set.where(), set.owner(), glm::mat4(context.object_to_world),
          context.reverse_orientation};
}

std::vector<TriangleMesh> read_mesh_files(const std::vector<MeshFile>& files) {
  std::vector<TriangleMesh> meshes(files.size());
  std::vector<std::exception_ptr> errors(files.size());
  std::atomic<size_t> first_bad = files.size();
  tbb::parallel_for(size_t{0}, files.size(), [&](size_t i) {
    if (i > first_bad) return;
    const auto& [path, placement] = files[i];
    try {
      meshes[i] = to_world(read_ply_of_shape(path, placement.where), placement);
    } catch (...) {
      errors[i] = std::current_exception();
      lower(first_bad, i);
    }
  });
  if (first_bad < files.size()) std::rethrow_exception(errors[first_bad]);
  return meshes;
}

std::optional<std::variant<Geometry, MeshFile>> make_shape(const std::string& type,
                                                           const ParameterSet& set,
                                                           const ShapeContext& context,
                                                           Warnings& warnings) {
  if (std::optional<MeshFile> file = find_mesh_file(type, set, context)) {
    set.warn_unused(warnings);
    return *file;
  }
  if (std::optional<Geometry> quadric = make_quadric(type, set, context, warnings)) {
    set.warn_unused(warnings);
    return quadric;
  }
  for (const MeshType& known : mesh_types) {
    if (known.name != type) continue;
    TriangleMesh mesh = known.make(set, context);
    set.warn_unused(warnings);
    if (!mesh.triangles.empty()) return Geometry(to_world(std::move(mesh), set, context));
    warnings.add(set.where(), set.owner() + " has no triangles; it is left out");
    return std::nullopt;
  }
  warnings.add(set.where(), "Shape \"" + type + "\" is not supported; it is left out");
  return std::nullopt;
}

}  // namespace lockstep::pbrt
