#include "core/pbrt/library.h"

#include <filesystem>
#include <utility>

namespace lockstep::pbrt {

int add_texture(Library& library, Texture texture) {
  library.scene_textures.push_back(std::move(texture));
  return static_cast<int>(library.scene_textures.size()) - 1;
}

int add_material(Library& library, Material material) {
  library.scene_materials.push_back(std::move(material));
  return static_cast<int>(library.scene_materials.size()) - 1;
}

std::string resolve(const Library& library, const std::string& mentioned_in,
                    const std::string& name) {
  namespace fs = std::filesystem;
  const fs::path near = fs::path(mentioned_in).parent_path() / name;
  const fs::path main = fs::path(library.main_file).parent_path() / name;
  std::error_code ignored;
  return !fs::exists(near, ignored) && fs::exists(main, ignored) ? main.string() : near.string();
}

Making::Making(Library& library, Progress& progress, const std::string& what, const Location& where)
    : library_(library) {
  constexpr int deepest = 64;
  if (progress == Progress::Begun) fail(where, what + " refers to itself");
  if (library.nesting == deepest) {
    fail(where, what + " is referred to through more than " + std::to_string(deepest) + " others");
  }
  progress = Progress::Begun;
  ++library.nesting;
}

}  // namespace lockstep::pbrt
