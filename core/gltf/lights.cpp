#include "core/gltf/lights.h"

#include "core/gltf/extensions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lockstep::gltf {

namespace {

// Colour times intensity.
glm::vec3 strength(const Document& document, const std::string& name,
                   const tinygltf::Light& source) {
  if (!source.color.empty() && source.color.size() != 3) {
    fail(document.path, name + " needs three numbers as its color");
  }
  glm::vec3 value(to_float(std::max(source.intensity, 0.0)));
  for (size_t i = 0; i < source.color.size(); ++i) {
    value[int(i)] *= to_float(std::max(source.color[i], 0.0));
  }
  return value;
}

SpotLight make_spot(const Document& document, const std::string& name,
                    const tinygltf::SpotLight& source) {
  const double inner = source.innerConeAngle, outer = source.outerConeAngle;
  if (!(inner >= 0.0 && inner <= outer && outer > 0.0 && outer <= 0.5 * std::numbers::pi + 1e-6)) {
    fail(document.path, name + " needs cone angles 0 <= inner < outer <= pi/2");
  }
  SpotLight light;
  light.cos_inner = static_cast<float>(std::cos(inner));
  light.cos_outer = static_cast<float>(std::max(std::cos(outer), 0.0));
  light.falloff = SpotLight::Falloff::Squared;
  return light;
}

// Lights shine along -z of their node.
LightSource make_light(const Document& document, const std::string& name,
                       const tinygltf::Light& source, const PlacedNode& node) {
  const glm::vec3 position(node.to_world[3]), direction = -world_axis(node, 2);
  const glm::vec3 value = strength(document, name, source);
  if (source.type == "point") return PointLight{position, value};
  if (source.type == "directional") return DistantLight{direction, value};
  if (source.type != "spot") fail(document.path, name + " has the unknown type " + source.type);
  SpotLight spot = make_spot(document, name, source.spot);
  spot.position = position;
  spot.direction = direction;
  spot.intensity = value;
  return spot;
}

}  // namespace

void add_lights(Document& document, const std::vector<PlacedNode>& nodes, SceneDescription& scene) {
  const tinygltf::Model& model = document.model;
  for (const PlacedNode& node : nodes) {
    const tinygltf::Value* extension =
        find_extension(model.nodes[size_t(node.node)].extensions, "KHR_lights_punctual");
    if (extension == nullptr) continue;
    const int index = get_index(*extension, "light", -1);
    const std::string name = "light " + std::to_string(index);
    if (index < 0 || size_t(index) >= model.lights.size()) {
      fail(document.path, name_of_node(document, node.node) + ": " + name + " does not exist");
    }
    const tinygltf::Light& source = model.lights[size_t(index)];
    if (source.range > 0.0 && source.type != "directional") {
      document.warnings.add(name, "the range of lights is not supported; they reach everywhere");
    }
    scene.lights.push_back(make_light(document, name, source, node));
  }
}

}  // namespace lockstep::gltf
