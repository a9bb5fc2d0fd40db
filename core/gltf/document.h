// A glTF 2.0 file in memory (Khronos Group 2021, "glTF 2.0 Specification"): its JSON as tinygltf's
// structures, its buffers loaded, its images still encoded.
#pragma once

#include "core/gltf/messages.h"
#include "core/gltf/model.h"
#include "core/gltf/resources.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace lockstep::gltf {

struct ImageSource {
  std::string name;
  std::string uri;
  int buffer_view = -1;                  // where there is no URI
  std::shared_ptr<const Bytes> encoded;  // once used, unless it is a file
};

struct Document {
  std::string path;
  tinygltf::Model model;  // `buffers` have their bytes; `images` stays empty, see below
  std::vector<ImageSource> images;
  Warnings warnings;
  // Corners of triangles still to be read: files may use one accessor any number of times.
  std::size_t corners_left = std::size_t(1) << 27;

  explicit Document(const std::string& file) : path(file), warnings(file) {}
};

// Reads a .gltf or .glb file (told apart by content) and its buffers. Throws Error where the JSON
// is invalid or nested absurdly, the version is not 2, an extension is required that is not known,
// or a buffer is missing or short.
Document load_document(const std::string& path);

}  // namespace lockstep::gltf
