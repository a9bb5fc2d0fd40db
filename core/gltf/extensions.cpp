#include "core/gltf/extensions.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace lockstep::gltf {

namespace {

constexpr std::array known_extensions = std::to_array<std::string_view>(
    {"EXT_texture_webp", "KHR_lights_punctual", "KHR_materials_clearcoat",
     "KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_pbrSpecularGlossiness",
     "KHR_materials_specular", "KHR_materials_transmission", "KHR_materials_unlit",
     "KHR_materials_volume", "KHR_mesh_quantization", "KHR_texture_transform"});

bool is_known(std::string_view name) {
  return std::find(known_extensions.begin(), known_extensions.end(), name) !=
         known_extensions.end();
}

template <int N>
glm::vec<N, float> get_vector(const tinygltf::Value& object, const std::string& name,
                              glm::vec<N, float> fallback) {
  const tinygltf::Value* array = find_member(object, name);
  if (array == nullptr || !array->IsArray() || array->ArrayLen() != N) return fallback;
  glm::vec<N, float> vector(0.0f);
  for (int i = 0; i < N; ++i) {
    if (!array->Get(i).IsNumber()) return fallback;
    vector[i] = to_float(array->Get(i).GetNumberAsDouble());
  }
  return vector;
}

}  // namespace

void check_extensions(Document& document) {
  for (const std::string& name : document.model.extensionsRequired) {
    if (is_known(name)) continue;
    fail(document.path, "the file requires the extension \"" + name +
                            "\", which is not supported; export it without");
  }
  for (const std::string& name : document.model.extensionsUsed) {
    if (is_known(name)) continue;
    document.warnings.add("", "the extension \"" + name + "\" is not supported; it is ignored");
  }
}

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions,
                                      const std::string& name) {
  const auto found = extensions.find(name);
  return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

const tinygltf::Value* find_member(const tinygltf::Value& object, const std::string& name) {
  return object.IsObject() && object.Has(name) ? &object.Get(name) : nullptr;
}

float get_number(const tinygltf::Value& object, const std::string& name, float fallback) {
  const tinygltf::Value* value = find_member(object, name);
  return value != nullptr && value->IsNumber() ? to_float(value->GetNumberAsDouble()) : fallback;
}

int get_index(const tinygltf::Value& object, const std::string& name, int fallback) {
  const tinygltf::Value* value = find_member(object, name);
  return value != nullptr && value->IsInt() ? value->GetNumberAsInt() : fallback;
}

glm::vec2 get_vec2(const tinygltf::Value& object, const std::string& name, glm::vec2 fallback) {
  return get_vector<2>(object, name, fallback);
}

glm::vec3 get_vec3(const tinygltf::Value& object, const std::string& name, glm::vec3 fallback) {
  return get_vector<3>(object, name, fallback);
}

glm::vec4 get_vec4(const tinygltf::Value& object, const std::string& name, glm::vec4 fallback) {
  return get_vector<4>(object, name, fallback);
}

float to_float(double value) {
  constexpr double largest = 1e12;
  return static_cast<float>(std::clamp(value, -largest, largest));
}

}  // namespace lockstep::gltf
