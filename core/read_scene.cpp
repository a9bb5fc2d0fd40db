#include "core/read_scene.h"

#include "core/default_view.h"
#include "core/error.h"
#include "core/gltf/reader.h"
#include "core/mitsuba/reader.h"
#include "core/obj.h"
#include "core/ply.h"
#include "core/substitutes.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

std::string builtin_names() {
  std::string names;
  for (const BuiltinScene& scene : builtin_scenes()) {
    names += (names.empty() ? "" : ", ") + std::string(scene.name);
  }
  return names;
}

// The file's first word, comments skipped.
std::string first_word(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(path + ": cannot open the scene file for reading");
  std::string word;
  while (file >> word && word.front() == '#') std::getline(file, word);
  return file ? word : "";
}

// By the directive that they begin with.
bool is_pbrt(const std::string& word) {
  static constexpr std::array directives{"Accelerator",
                                         "AttributeBegin",
                                         "Attribute",
                                         "Camera",
                                         "ColorSpace",
                                         "ConcatTransform",
                                         "CoordinateSystem",
                                         "Film",
                                         "Identity",
                                         "Import",
                                         "Include",
                                         "Integrator",
                                         "LookAt",
                                         "MakeNamedMedium",
                                         "Option",
                                         "PixelFilter",
                                         "Renderer",
                                         "ReverseOrientation",
                                         "Rotate",
                                         "Sampler",
                                         "Scale",
                                         "SurfaceIntegrator",
                                         "Transform",
                                         "TransformTimes",
                                         "Translate",
                                         "WorldBegin"};
  return std::find(directives.begin(), directives.end(), word) != directives.end();
}

bool is_obj(const std::string& word) {
  static constexpr std::array keywords{"mtllib", "usemtl", "o", "g", "s", "v", "vt", "vn", "f"};
  return std::find(keywords.begin(), keywords.end(), word) != keywords.end();
}

// A mesh alone, grey under the default light.
SceneDescription read_ply_scene(const std::string& path) {
  SceneDescription scene;
  scene.name = path;
  scene.materials.emplace_back(DiffuseMaterial{});
  scene.shapes.push_back({read_ply(path), 0, {}});
  add_default_view(scene);
  return scene;
}

// By content: names may lie. Empty and comment-only files are left to the reader their name asks
// for.
SceneDescription read_file(const std::string& path) {
  const std::string word = first_word(path), extension = fs::path(path).extension().string();
  if (word.starts_with("glTF") || word.starts_with('{')) return read_gltf(path);
  if (word.starts_with('<') || word.starts_with("\xef\xbb\xbf<")) return read_mitsuba(path);
  if (word == "ply") return read_ply_scene(path);
  if (extension == ".pbrt" || is_pbrt(word)) return read_pbrt(path);
  if (extension == ".obj" || is_obj(word)) return read_obj_scene(path);
  throw Error(path +
              ": unknown scene format; pbrt (version 2 to 4), Mitsuba XML, glTF 2.0, OBJ and PLY "
              "files are understood");
}

}  // namespace

SceneDescription read_scene(const std::string& name) {
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (scene.name == name) return scene.make();
  }
  std::error_code ignored;
  if (!fs::exists(name, ignored)) {
    throw Error(name + ": no such scene file; the built-in scenes are " + builtin_names());
  }
  if (fs::is_directory(name, ignored)) {
    throw Error(name + ": is a directory; name the scene file in it");
  }
  SceneDescription scene = read_file(name);
  substitute_unsupported(scene);
  return scene;
}

}  // namespace lockstep
