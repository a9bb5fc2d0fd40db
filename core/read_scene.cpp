#include "core/read_scene.h"

#include "core/default_view.h"
#include "core/error.h"
#include "core/gltf/reader.h"
#include "core/mitsuba/reader.h"
#include "core/obj.h"
#include "core/ply.h"
#include "core/scene_warnings.h"

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

const BuiltinScene* find_builtin(const std::string& name) {
  const auto& scenes = builtin_scenes();
  const auto at = std::find_if(scenes.begin(), scenes.end(),
                               [&](const BuiltinScene& scene) { return scene.name == name; });
  return at == scenes.end() ? nullptr : &*at;
}

void check_file(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) {
    throw Error(path + ": no such scene file; the built-in scenes are " + builtin_names());
  }
  if (fs::is_directory(path, ignored)) {
    throw Error(path + ": is a directory; name the scene file in it");
  }
}

// By content: names may lie. Empty and comment-only files are left to the reader their name asks
// for.
SceneFormat file_format(const std::string& path) {
  const std::string word = first_word(path), extension = fs::path(path).extension().string();
  if (word.starts_with("glTF") || word.starts_with('{')) return SceneFormat::Gltf;
  if (word.starts_with('<') || word.starts_with("\xef\xbb\xbf<")) return SceneFormat::Mitsuba;
  if (word == "ply") return SceneFormat::Ply;
  if (extension == ".pbrt" || is_pbrt(word)) return SceneFormat::Pbrt;
  if (extension == ".obj" || is_obj(word)) return SceneFormat::Obj;
  throw Error(path +
              ": unknown scene format; pbrt (version 2 to 4), Mitsuba XML, glTF 2.0, OBJ and PLY "
              "files are understood");
}

SceneDescription read_format(const std::string& name) {
  switch (scene_format(name)) {
    case SceneFormat::Builtin:
      return find_builtin(name)->make();
    case SceneFormat::Pbrt:
      return read_pbrt(name);
    case SceneFormat::Mitsuba:
      return read_mitsuba(name);
    case SceneFormat::Gltf:
      return read_gltf(name);
    case SceneFormat::Obj:
      return read_obj_scene(name);
    case SceneFormat::Ply:
      break;
  }
  return read_ply_scene(name);
}

}  // namespace

std::string_view format_name(SceneFormat format) {
  constexpr std::string_view names[] = {"built in", "pbrt", "Mitsuba XML",
                                        "glTF 2.0", "OBJ",  "PLY"};
  return names[int(format)];
}

SceneFormat scene_format(const std::string& name) {
  if (find_builtin(name)) return SceneFormat::Builtin;
  check_file(name);
  return file_format(name);
}

SceneDescription read_scene(const std::string& name) {
  SceneDescription scene = read_format(name);
  const std::string warning = precision_warning(scene);
  if (!warning.empty()) scene.warnings.push_back(warning);
  return scene;
}

}  // namespace lockstep
