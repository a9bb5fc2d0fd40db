// Accessors: typed arrays in a glTF file's buffers (specification, section 3.6.2), with strides,
// normalised integers and sparse replacements.
#pragma once

#include "core/gltf/document.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lockstep::gltf {

// Elements at equal distances in a buffer, all of them within it.
struct ElementRange {
  const unsigned char* first = nullptr;  // nullptr: all elements are zero
  std::size_t stride = 0;                // bytes
  std::size_t count = 0;
  int component_type = 0;  // TINYGLTF_COMPONENT_TYPE_...
  int components = 1;
};

struct Accessor {
  ElementRange dense;
  bool normalized = false;              // integers stand for [0, 1] or [-1, 1]
  std::vector<std::uint32_t> replaced;  // elements with a sparse value, rising
  ElementRange replacements;            // one for each of these
  std::size_t count() const { return dense.count; }
};

// The accessor `index`, which must have so many components. `user` says what it is for
// ("mesh 0 primitive 1: POSITION"). Throws Error where it does not fit its buffer. Points into
// `document`.
Accessor open_accessor(const Document& document, int index, int components,
                       const std::string& user);

// Element i < count(), with zeros for missing components.
glm::vec3 element(const Accessor& accessor, std::size_t i);

// All elements of a scalar accessor of unsigned integers. Throws Error for other types.
std::vector<std::uint32_t> read_indices(const Document& document, int index,
                                        const std::string& user);

}  // namespace lockstep::gltf
