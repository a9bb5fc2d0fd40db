#include "core/gltf/camera.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lockstep::gltf {

namespace {

constexpr int longer_side = 768;

// Of a shape width / height, within which even the shorter side has a pixel.
void set_resolution(const Document& document, const std::string& name, double aspect,
                    FilmDescription& film) {
  if (!(aspect > 1.0 / longer_side && aspect < longer_side)) {
    fail(document.path, name + " has an image " + std::to_string(aspect) +
                            " times as wide as high; expected 1/768 to 768");
  }
  film.width = aspect >= 1.0 ? longer_side : int(std::lround(longer_side * aspect));
  film.height = aspect >= 1.0 ? int(std::lround(longer_side / aspect)) : longer_side;
}

// A node's camera looks along -z; the node's scale does not count.
glm::mat4 camera_to_world(const PlacedNode& node) {
  const glm::vec3 forward = -world_axis(node, 2);
  const glm::vec3 right = glm::normalize(glm::cross(forward, world_axis(node, 1)));
  const glm::vec3 up = glm::cross(right, forward);
  return glm::mat4(glm::vec4(right, 0.0f), glm::vec4(up, 0.0f), glm::vec4(forward, 0.0f),
                   glm::vec4(glm::vec3(node.to_world[3]), 1.0f));
}

void set_perspective(const Document& document, const std::string& name,
                     const tinygltf::PerspectiveCamera& source, SceneDescription& scene) {
  if (!(source.yfov > 0.0 && source.yfov < std::numbers::pi)) {
    fail(document.path, name + " needs a yfov between 0 and pi");
  }
  const double aspect = source.aspectRatio != 0.0 ? source.aspectRatio : 1.0;
  set_resolution(document, name, aspect, scene.film);
  const double half_height = std::tan(0.5 * source.yfov);
  const double half_angle = std::atan(half_height * std::min(aspect, 1.0));
  scene.camera.fov_degrees = static_cast<float>(2.0 * half_angle * 180.0 / std::numbers::pi);
}

void set_orthographic(const Document& document, const std::string& name,
                      const tinygltf::OrthographicCamera& source, SceneDescription& scene) {
  const double half_width = std::abs(source.xmag), half_height = std::abs(source.ymag);
  if (!(half_width > 0.0 && half_height > 0.0)) {
    fail(document.path, name + " needs xmag and ymag other than 0");
  }
  set_resolution(document, name, half_width / half_height, scene.film);
  scene.camera.projection = CameraDescription::Projection::Orthographic;
  scene.camera.extent = static_cast<float>(2.0 * std::min(half_width, half_height));
}

}  // namespace

bool set_camera(Document& document, const std::vector<PlacedNode>& nodes, SceneDescription& scene) {
  const tinygltf::Model& model = document.model;
  bool found = false;
  for (const PlacedNode& node : nodes) {
    const int index = model.nodes[size_t(node.node)].camera;
    if (index < 0) continue;
    const std::string name = "camera " + std::to_string(index);
    if (found) {
      document.warnings.add(name, "the file has several cameras; the first is used");
      return true;
    }
    found = true;
    if (size_t(index) >= model.cameras.size()) fail(document.path, name + " does not exist");
    const tinygltf::Camera& source = model.cameras[size_t(index)];
    scene.camera = CameraDescription{};
    scene.camera.camera_to_world = camera_to_world(node);
    if (source.type == "perspective") {
      set_perspective(document, name, source.perspective, scene);
    } else {
      set_orthographic(document, name, source.orthographic, scene);
    }
  }
  return found;
}

}  // namespace lockstep::gltf
