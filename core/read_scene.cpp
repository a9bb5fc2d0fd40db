#include "core/read_scene.h"

#include "core/error.h"
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

// pbrt files by name, or by the directive that they begin with.
bool is_pbrt(const std::string& path) {
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
  const std::string word = first_word(path);
  if (fs::path(path).extension() == ".pbrt") return true;
  return std::find(directives.begin(), directives.end(), word) != directives.end();
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
  if (is_pbrt(name)) {
    SceneDescription scene = read_pbrt(name);
    substitute_unsupported(scene);
    return scene;
  }
  throw Error(name + ": unknown scene format; pbrt files (version 3 or 4) are understood");
}

}  // namespace lockstep
