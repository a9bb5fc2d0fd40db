// glTF files made of strings, and what tests of their reader share.
#pragma once

#include "core/gltf/reader.h"
#include "tests/t_description.h"
#include "tests/t_files.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lockstep {

inline std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

template <class T>
std::string raw(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

template <class T>
constexpr int component_type() {
  if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
  if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
  if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
  if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
  if constexpr (std::is_same_v<T, std::uint32_t>) return 5125;
  return 5126;
}

// One buffer, with a view and an accessor for each array added to it.
struct GltfBuffer {
  std::string bytes, views, accessors;
  int view_count = 0, accessor_count = 0;

  // A view of `data`, with more members as `extra` (",\"byteStride\":8"); returns its index.
  int add_view(const std::string& data, const std::string& extra = "") {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    if (!views.empty()) views += ',';
    views += "{\"buffer\":0,\"byteOffset\":" + std::to_string(bytes.size());
    views += ",\"byteLength\":" + std::to_string(data.size()) + extra + "}";
    bytes += data;
    return view_count++;
  }

  // An accessor with the given members; returns its index.
  int add_accessor(const std::string& members) {
    if (!accessors.empty()) accessors += ',';
    accessors += "{" + members + "}";
    return accessor_count++;
  }

  template <class T>
  int add(const std::string& type, const std::vector<T>& values, bool normalized = false) {
    const int view = add_view(raw(values));
    const std::size_t components = type == "SCALAR" ? 1 : std::size_t(type[3] - '0');
    return add_accessor("\"bufferView\":" + std::to_string(view) + ",\"componentType\":" +
                        std::to_string(component_type<T>()) + ",\"type\":\"" + type +
                        "\",\"count\":" + std::to_string(values.size() / components) +
                        (normalized ? ",\"normalized\":true" : ""));
  }

  // The members of a file, with the buffer at `uri`, or without one for the binary container.
  std::string json(const std::string& rest, const std::string& uri) const {
    std::string text = "{\"asset\":{\"version\":\"2.0\"}";
    if (!bytes.empty()) {
      text += ",\"buffers\":[{\"byteLength\":" + std::to_string(bytes.size()) +
              (uri.empty() ? "" : ",\"uri\":\"" + uri + "\"") + "}]";
    }
    if (!views.empty()) text += ",\"bufferViews\":[" + views + "]";
    if (!accessors.empty()) text += ",\"accessors\":[" + accessors + "]";
    return text + (rest.empty() ? "" : "," + rest) + "}";
  }

  std::string embedded(const std::string& rest) const {
    return json(rest, "data:application/octet-stream;base64," + base64(bytes));
  }

  std::string container(const std::string& rest) const {
    const auto padded = [](std::string data, char fill) {
      data.resize((data.size() + 3) / 4 * 4, fill);
      return data;
    };
    const auto words = [](std::vector<std::uint32_t> values) { return raw(values); };
    const std::string text = padded(json(rest, ""), ' '), binary = padded(bytes, '\0');
    const auto size_of = [](const std::string& s) { return static_cast<std::uint32_t>(s.size()); };
    return "glTF" + words({2, 12 + 8 + size_of(text) + 8 + size_of(binary)}) +
           words({size_of(text), 0x4e4f534a}) + text + words({size_of(binary), 0x004e4942}) +
           binary;
  }
};

class Gltf : public TestWithFiles {
 protected:
  SceneDescription read(const std::string& bytes) const {
    return read_gltf(write("scene.gltf", bytes));
  }
  std::string error_of(const std::string& bytes) const {
    return message_of([&] { read(bytes); });
  }
  void expect_error(const std::string& bytes, const std::string& part) const {
    const std::string message = error_of(bytes);
    expect_one_line_with(message, part);
    EXPECT_EQ(message.rfind("scene.gltf: ", 0), 0u) << message;
  }
};

inline const std::vector<float> corner_positions{0, 0, 0, 1, 0, 0, 0, 1, 0};

inline std::string mesh(const std::string& primitive) {
  return "{\"primitives\":[{" + primitive + "}]}";
}

// A scene whose node 0 has mesh 0 with the given primitive.
inline std::string one_mesh(const std::string& primitive) {
  return "\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"meshes\":[" + mesh(primitive) +
         "]";
}

// A file with one triangle as mesh 0, facing z, and the given rest.
inline std::string triangle_file(const std::string& rest) {
  GltfBuffer buffer;
  buffer.add("VEC3", corner_positions);
  return buffer.embedded("\"meshes\":[" + mesh("\"attributes\":{\"POSITION\":0}") + "]," + rest);
}

}  // namespace lockstep
