// Extensions of glTF that are understood, and the values in them.
#pragma once

#include "core/gltf/document.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <string>

namespace lockstep::gltf {

// Throws Error where the file requires an extension that is not known; warns of those it uses.
void check_extensions(Document& document);

// The extension's object, or nullptr where the element does not have it.
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions,
                                      const std::string& name);

// A member of an object; nullptr where there is none.
const tinygltf::Value* find_member(const tinygltf::Value& object, const std::string& name);

// Members with their defaults, which also replace what has another type.
float get_number(const tinygltf::Value& object, const std::string& name, float fallback);
int get_index(const tinygltf::Value& object, const std::string& name, int fallback);
glm::vec2 get_vec2(const tinygltf::Value& object, const std::string& name, glm::vec2 fallback);
glm::vec3 get_vec3(const tinygltf::Value& object, const std::string& name, glm::vec3 fallback);
glm::vec4 get_vec4(const tinygltf::Value& object, const std::string& name, glm::vec4 fallback);

// A number of the file within float's range, so that products of a few stay finite.
float to_float(double value);

}  // namespace lockstep::gltf
