// Scenes by name: a built-in scene's name or a file in a format that is understood.
#pragma once

#include "core/scene_description.h"

#include <string>
#include <string_view>
#include <vector>

namespace lockstep {

enum class SceneFormat { Builtin, Pbrt, Mitsuba, Gltf, Obj, Ply };

// As people call it: "built in", "pbrt", "Mitsuba XML", "glTF 2.0", "OBJ", "PLY".
std::string_view format_name(SceneFormat format);

// What `name` is: a built-in scene, or a path to a file of pbrt (v2 to v4), Mitsuba (0.4 to 3),
// glTF 2.0, OBJ or PLY, told apart by content. Throws Error where there is no such file, and for
// files of other formats.
SceneFormat scene_format(const std::string& name);

// Reads the scene as its author wrote it.
// Throws Error ("file:line: what is wrong") on missing or malformed input.
SceneDescription read_scene(const std::string& name);

struct BuiltinScene {
  std::string_view name;
  std::string_view summary;  // one line for `lockstep scenes`
  SceneDescription (*make)();
};

// The scenes made by our own code; each needs no file.
const std::vector<BuiltinScene>& builtin_scenes();

// core/pbrt/reader.cpp; `path` is the file itself.
SceneDescription read_pbrt(const std::string& path);

}  // namespace lockstep
