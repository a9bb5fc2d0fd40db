#include "core/gltf/nodes.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace lockstep::gltf {

namespace {

struct Pending {
  int node;
  int depth;
  glm::dmat4 parent_to_world;
};

// q = (x, y, z, w) of any length above 0.
glm::dmat3 rotation_matrix(const glm::dvec4& q) {
  const glm::dvec3 v(q.x, q.y, q.z);
  glm::dmat3 m(0.0);
  for (int column = 0; column < 3; ++column) {
    glm::dvec3 axis(0.0);
    axis[column] = 1.0;
    m[column] = axis + 2.0 / glm::dot(q, q) * glm::cross(v, glm::cross(v, axis) + q.w * axis);
  }
  return m;
}

// The members of `values`, which must be so many or none; then the fallback.
template <int N>
glm::vec<N, double> get_vector(const Document& document, int node, const char* name,
                               const std::vector<double>& values,
                               const glm::vec<N, double>& fallback) {
  if (values.empty()) return fallback;
  if (values.size() != N) {
    fail(document.path,
         name_of_node(document, node) + " needs " + std::to_string(N) + " numbers as its " + name);
  }
  glm::vec<N, double> vector(0.0);
  for (int i = 0; i < N; ++i) vector[i] = values[size_t(i)];
  return vector;
}

glm::dmat4 local_matrix(const Document& document, int index) {
  const tinygltf::Node& node = document.model.nodes[size_t(index)];
  glm::dmat4 matrix(1.0);
  if (!node.matrix.empty()) {
    if (node.matrix.size() != 16) {
      fail(document.path, name_of_node(document, index) + " needs 16 numbers as its matrix");
    }
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[size_t(i)];
    for (int column = 0; column < 4; ++column) matrix[column][3] = column == 3 ? 1.0 : 0.0;
    return matrix;
  }
  const auto scale = get_vector<3>(document, index, "scale", node.scale, glm::dvec3(1.0));
  const auto rotation =
      get_vector<4>(document, index, "rotation", node.rotation, glm::dvec4(0.0, 0.0, 0.0, 1.0));
  const auto translation =
      get_vector<3>(document, index, "translation", node.translation, glm::dvec3(0.0));
  if (!(glm::dot(rotation, rotation) > 0.0)) {
    fail(document.path, name_of_node(document, index) + " has a rotation of zeros");
  }
  const glm::dmat3 turn = rotation_matrix(rotation);
  for (int column = 0; column < 3; ++column) {
    matrix[column] = glm::dvec4(scale[column] * turn[column], 0.0);
  }
  matrix[3] = glm::dvec4(translation, 1.0);
  return matrix;
}

std::vector<int> root_nodes(Document& document) {
  const tinygltf::Model& model = document.model;
  const int scene = model.defaultScene >= 0 ? model.defaultScene : 0;
  if (size_t(scene) < model.scenes.size()) return model.scenes[size_t(scene)].nodes;
  if (model.defaultScene >= 0) {
    fail(document.path, "scene " + std::to_string(scene) + " does not exist");
  }
  std::vector<bool> is_child(model.nodes.size(), false);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && size_t(child) < is_child.size()) is_child[size_t(child)] = true;
    }
  }
  std::vector<int> roots;
  for (size_t i = 0; i < is_child.size(); ++i) {
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

bool is_finite(const glm::dmat4& m) {
  constexpr double largest = 1e30;
  for (int i = 0; i < 16; ++i) {
    if (!(std::abs(m[i / 4][i % 4]) < largest)) return false;
  }
  return true;
}

bool is_hidden(const glm::dmat4& m) { return glm::determinant(glm::dmat3(m)) == 0.0; }

}  // namespace

std::vector<PlacedNode> placed_nodes(Document& document) {
  constexpr int deepest = 1000;
  const tinygltf::Model& model = document.model;
  std::vector<bool> visited(model.nodes.size(), false);
  std::vector<Pending> pending;
  const auto push = [&](const std::vector<int>& nodes, int depth, const glm::dmat4& to_world) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
      pending.push_back({*node, depth, to_world});
    }
  };
  push(root_nodes(document), 0, glm::dmat4(1.0));

  std::vector<PlacedNode> placed;
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    if (next.node < 0 || size_t(next.node) >= model.nodes.size()) {
      fail(document.path, "node " + std::to_string(next.node) + " does not exist");
    }
    const std::string name = name_of_node(document, next.node);
    // A tree visits each node once; this also ends circles.
    if (visited[size_t(next.node)]) {
      fail(document.path, name + " has two parents or is its own; nodes must form a tree");
    }
    visited[size_t(next.node)] = true;
    if (next.depth > deepest) {
      fail(document.path, name + " is more than " + std::to_string(deepest) +
                              " levels below its root; flatten the hierarchy");
    }
    const glm::dmat4 to_world = next.parent_to_world * local_matrix(document, next.node);
    if (!is_finite(to_world)) fail(document.path, name + " leaves the range of numbers");
    if (is_hidden(to_world)) continue;
    placed.push_back({next.node, to_world});
    push(model.nodes[size_t(next.node)].children, next.depth + 1, to_world);
  }
  return placed;
}

glm::vec3 world_axis(const PlacedNode& node, int axis) {
  return glm::vec3(glm::normalize(glm::dvec3(node.to_world[axis])));
}

std::string name_of_node(const Document& document, int node) {
  const std::string& name = document.model.nodes[size_t(node)].name;
  return "node " + std::to_string(node) + (name.empty() ? "" : " (" + name + ")");
}

}  // namespace lockstep::gltf
