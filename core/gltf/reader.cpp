#include "core/gltf/reader.h"

#include "core/default_view.h"
#include "core/gltf/camera.h"
#include "core/gltf/lights.h"
#include "core/gltf/materials.h"
#include "core/gltf/meshes.h"
#include "core/gltf/nodes.h"

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <utility>

namespace lockstep {

namespace gltf {

namespace {

// The nodes that one mesh is at.
struct MeshUses {
  std::vector<const PlacedNode*> nodes;
};

std::vector<MeshUses> find_uses(Document& document, const std::vector<PlacedNode>& nodes) {
  const tinygltf::Model& model = document.model;
  std::vector<MeshUses> uses(model.meshes.size());
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = model.nodes[size_t(placed.node)];
    if (node.mesh < 0) continue;
    const std::string name = name_of_node(document, placed.node);
    if (size_t(node.mesh) >= uses.size()) {
      fail(document.path, name + ": mesh " + std::to_string(node.mesh) + " does not exist");
    }
    if (node.skin >= 0) {
      document.warnings.add(name, "skins are not supported; meshes stay as they were bound");
    }
    const auto& weights =
        node.weights.empty() ? model.meshes[size_t(node.mesh)].weights : node.weights;
    if (std::any_of(weights.begin(), weights.end(), [](double w) { return w != 0.0; })) {
      document.warnings.add(name, "morph targets are not supported; meshes keep their base shape");
    }
    uses[size_t(node.mesh)].nodes.push_back(&placed);
  }
  return uses;
}

bool in_range(glm::vec3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

void check_finite(const Document& document, std::span<const glm::vec3> points,
                  const PlacedNode& node) {
  if (std::all_of(points.begin(), points.end(), in_range)) return;
  fail(document.path,
       name_of_node(document, node.node) + " moves its mesh out of the range of float");
}

Shape placed_shape(const Document& document, Shape shape, const PlacedNode& node) {
  auto& mesh = std::get<TriangleMesh>(shape.geometry);
  apply_transform(mesh, glm::mat4(node.to_world));
  check_finite(document, mesh.positions, node);
  return shape;
}

// The corner of the object's bounds, mirrored to all sides, that reaches farthest.
glm::vec3 farthest_corner(const ObjectDescription& object) {
  glm::vec3 corner(0.0f);
  for (const Shape& shape : object.shapes) {
    for (const glm::vec3 p : std::get<TriangleMesh>(shape.geometry).positions) {
      corner = glm::max(corner, glm::abs(p));
    }
  }
  return corner;
}

void add_instances(const Document& document, const MeshUses& uses, ObjectDescription object,
                   SceneDescription& scene) {
  const glm::vec3 far = farthest_corner(object);
  const int index = static_cast<int>(scene.objects.size());
  scene.objects.push_back(std::move(object));
  for (const PlacedNode* node : uses.nodes) {
    const glm::mat4 to_world(node->to_world);
    const glm::mat3 sizes(glm::abs(to_world[0]), glm::abs(to_world[1]), glm::abs(to_world[2]));
    const glm::vec3 reach = sizes * far + glm::abs(glm::vec3(to_world[3]));
    check_finite(document, {&reach, 1}, *node);
    scene.instances.push_back({index, to_world});
  }
}

void place(Document& document, const MeshUses& uses, std::vector<Shape> shapes,
           SceneDescription& scene) {
  ObjectDescription object;
  const bool shared = uses.nodes.size() > 1;
  for (Shape& shape : shapes) {
    if (shared && !shape.emission) {
      object.shapes.push_back(std::move(shape));
      continue;
    }
    const std::size_t corners = 3 * std::get<TriangleMesh>(shape.geometry).triangles.size();
    for (std::size_t i = 0; i + 1 < uses.nodes.size(); ++i) {
      if (corners > document.corners_left) {
        fail(document.path, name_of_node(document, uses.nodes[i]->node) +
                                ": too many copies of a mesh that emits light");
      }
      document.corners_left -= corners;
      scene.shapes.push_back(placed_shape(document, shape, *uses.nodes[i]));
    }
    scene.shapes.push_back(placed_shape(document, std::move(shape), *uses.nodes.back()));
  }
  if (!object.shapes.empty()) add_instances(document, uses, std::move(object), scene);
}

void add_meshes(Document& document, const std::vector<PlacedNode>& nodes, SceneDescription& scene) {
  MaterialTable materials;
  const std::vector<MeshUses> uses = find_uses(document, nodes);
  for (std::size_t m = 0; m < uses.size(); ++m) {
    if (uses[m].nodes.empty()) continue;
    std::vector<Shape> shapes;
    const auto& primitives = document.model.meshes[m].primitives;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const std::string name = "mesh " + std::to_string(m) + " primitive " + std::to_string(p);
      const Surface& surface = surface_of(document, primitives[p].material, materials, scene);
      auto mesh = read_primitive(document, primitives[p], surface.uv_set, name);
      if (mesh) shapes.push_back({std::move(*mesh), surface.material, surface.emission});
    }
    place(document, uses[m], std::move(shapes), scene);
  }
  if (scene.shapes.empty() && scene.instances.empty()) {
    document.warnings.add("", "the scene has no triangles");
  }
}

// Emission by a texture draws screens and indicators on models that are meant to be lit.
bool has_lamp(const SceneDescription& scene) {
  const auto is_lamp = [](const Shape& shape) {
    return shape.emission && shape.emission->radiance.texture < 0;
  };
  return !scene.lights.empty() || std::any_of(scene.shapes.begin(), scene.shapes.end(), is_lamp);
}

void add_environment(Document& document, SceneDescription& scene) {
  if (has_lamp(scene)) return;
  scene.environment = Environment(glm::vec3(1.0f));
  document.warnings.add("", "the file has no lamps; an environment of radiance 1 is used");
}

}  // namespace

}  // namespace gltf

SceneDescription read_gltf(const std::string& path) {
  gltf::Document document = gltf::load_document(path);
  SceneDescription scene;
  scene.name = std::filesystem::path(path).stem().string();
  const std::vector<gltf::PlacedNode> nodes = gltf::placed_nodes(document);
  gltf::add_meshes(document, nodes, scene);
  gltf::add_lights(document, nodes, scene);
  gltf::add_environment(document, scene);
  const bool has_camera = gltf::set_camera(document, nodes, scene);
  scene.warnings = document.warnings.lines();
  if (!has_camera) add_default_camera(scene);
  return scene;
}

}  // namespace lockstep
