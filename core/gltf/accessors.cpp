#include "core/gltf/accessors.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

namespace lockstep::gltf {

namespace {

// Nothing for types that glTF does not have: tinygltf lets int and double pass.
std::optional<std::size_t> component_size(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return std::nullopt;
  }
}

// `range` holds count and types; where its bytes are is filled in. Packed ranges ignore the
// view's stride.
ElementRange locate(const Document& document, ElementRange range, int view_index,
                    std::size_t offset, bool packed, const std::string& user) {
  const tinygltf::Model& model = document.model;
  const auto fail_here = [&](const std::string& what) { fail(document.path, user + ": " + what); };
  const std::string name = "bufferView " + std::to_string(view_index);
  if (view_index < 0 || size_t(view_index) >= model.bufferViews.size()) {
    fail_here(name + " does not exist");
  }
  const tinygltf::BufferView& view = model.bufferViews[size_t(view_index)];
  if (view.buffer < 0 || size_t(view.buffer) >= model.buffers.size()) {
    fail_here(name + " refers to a buffer that does not exist");
  }
  const Bytes& buffer = model.buffers[size_t(view.buffer)].data;
  if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset) {
    fail_here(name + " reaches past the end of its buffer");
  }
  const std::optional<std::size_t> size = component_size(range.component_type);
  if (!size) fail_here("unknown componentType " + std::to_string(range.component_type));
  const std::size_t element_size = *size * std::size_t(range.components);
  range.stride = packed || view.byteStride == 0 ? element_size : view.byteStride;
  const std::size_t available = offset < view.byteLength ? view.byteLength - offset : 0;
  const std::size_t fit =
      available < element_size ? 0 : 1 + (available - element_size) / range.stride;
  if (range.count > fit) {
    fail_here("needs " + std::to_string(range.count) + " elements, but " + name + " holds " +
              std::to_string(fit));
  }
  range.first = buffer.data() + view.byteOffset + std::min(offset, view.byteLength);
  return range;
}

template <class T>
T read(const unsigned char* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

// Specification, section 3.6.2.2: normalised signed integers have two values for -1.
template <class T>
float converted(const unsigned char* from, bool normalized) {
  const auto value = static_cast<float>(read<T>(from));
  if (!normalized) return value;
  return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
}

float component(const unsigned char* from, int component_type, bool normalized) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return converted<std::int8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return converted<std::uint8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return converted<std::int16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return converted<std::uint16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return converted<std::uint32_t>(from, normalized);
    default:
      return read<float>(from);
  }
}

std::uint32_t unsigned_element(const ElementRange& range, std::size_t i) {
  const unsigned char* from = range.first + i * range.stride;
  switch (range.component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *from;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return read<std::uint16_t>(from);
    default:
      return read<std::uint32_t>(from);
  }
}

bool is_unsigned(int component_type) {
  return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

void open_sparse(const Document& document, const tinygltf::Accessor& source, Accessor& accessor,
                 const std::string& user) {
  const auto& sparse = source.sparse;
  if (sparse.count < 1 || std::size_t(sparse.count) > accessor.count()) {
    fail(document.path, user + ": has " + std::to_string(sparse.count) + " sparse values for " +
                            std::to_string(accessor.count()) + " elements");
  }
  ElementRange where;
  where.count = std::size_t(sparse.count);
  where.component_type = sparse.indices.componentType;
  if (!is_unsigned(where.component_type)) {
    fail(document.path, user + ": sparse indices must be unsigned integers");
  }
  // Negative offsets become huge ones.
  where = locate(document, where, sparse.indices.bufferView,
                 static_cast<std::size_t>(sparse.indices.byteOffset), true, user);
  accessor.replaced.resize(where.count);
  for (std::size_t i = 0; i < where.count; ++i) {
    accessor.replaced[i] = unsigned_element(where, i);
    if (accessor.replaced[i] < accessor.count() &&
        (i == 0 || accessor.replaced[i - 1] < accessor.replaced[i])) {
      continue;
    }
    fail(document.path, user + ": sparse indices must rise and be below the accessor's count");
  }
  accessor.replacements = accessor.dense;
  accessor.replacements.count = where.count;
  accessor.replacements = locate(document, accessor.replacements, sparse.values.bufferView,
                                 static_cast<std::size_t>(sparse.values.byteOffset), true, user);
}

}  // namespace

Accessor open_accessor(const Document& document, int index, int components,
                       const std::string& user) {
  const auto& accessors = document.model.accessors;
  if (index < 0 || size_t(index) >= accessors.size()) {
    fail(document.path, user + ": accessor " + std::to_string(index) + " does not exist");
  }
  const tinygltf::Accessor& source = accessors[size_t(index)];
  const std::string name = user + ": accessor " + std::to_string(index);
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(source.type)) != components) {
    fail(document.path, name + " should have " + std::to_string(components) + " components");
  }
  Accessor accessor;
  accessor.normalized = source.normalized;
  accessor.dense.count = source.count;
  accessor.dense.component_type = source.componentType;
  accessor.dense.components = components;
  if (!component_size(source.componentType)) {
    fail(document.path, name + ": unknown componentType " + std::to_string(source.componentType));
  }
  constexpr std::size_t most_zeros = 1 << 22;  // they take no bytes of the file
  if (source.bufferView >= 0) {
    accessor.dense =
        locate(document, accessor.dense, source.bufferView, source.byteOffset, false, name);
  } else if (source.count > most_zeros) {
    fail(document.path, name + " has " + std::to_string(source.count) +
                            " elements without a bufferView; expected at most 4194304");
  }
  if (source.sparse.isSparse) open_sparse(document, source, accessor, name);
  return accessor;
}

glm::vec3 element(const Accessor& accessor, std::size_t i) {
  const ElementRange* range = &accessor.dense;
  if (!accessor.replaced.empty()) {
    const auto found = std::lower_bound(accessor.replaced.begin(), accessor.replaced.end(), i);
    if (found != accessor.replaced.end() && *found == i) {
      range = &accessor.replacements;
      i = std::size_t(found - accessor.replaced.begin());
    }
  }
  glm::vec3 value(0.0f);
  if (range->first == nullptr) return value;
  const unsigned char* from = range->first + i * range->stride;
  const std::size_t size = *component_size(range->component_type);
  for (int c = 0; c < std::min(range->components, 3); ++c) {
    value[c] = component(from + std::size_t(c) * size, range->component_type, accessor.normalized);
  }
  return value;
}

std::vector<std::uint32_t> read_indices(const Document& document, int index,
                                        const std::string& user) {
  const Accessor accessor = open_accessor(document, index, 1, user);
  if (!is_unsigned(accessor.dense.component_type) || accessor.normalized) {
    fail(document.path, user + ": indices must be unsigned integers");
  }
  if (accessor.dense.first == nullptr) fail(document.path, user + ": indices have no bufferView");
  std::vector<std::uint32_t> indices(accessor.count());
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = unsigned_element(accessor.dense, i);
  for (std::size_t i = 0; i < accessor.replaced.size(); ++i) {
    indices[accessor.replaced[i]] = unsigned_element(accessor.replacements, i);
  }
  return indices;
}

}  // namespace lockstep::gltf
