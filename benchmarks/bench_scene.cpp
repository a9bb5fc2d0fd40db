#include "bench_scene.h"

#include "core/read_scene.h"
#include "packets/isa.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <utility>

namespace lockstep {
namespace {

const std::filesystem::path killeroo =
    std::filesystem::path(LOCKSTEP_SHARED_DIR) / "scenes/killeroo-quad/killeroo-quad.pbrt";

}  // namespace

std::vector<std::string> bench_scene_names() {
  return bench_scene_names({"killeroo-quad", "cornell", "reef", "meadow", "spheres"});
}

std::vector<std::string> bench_scene_names(const std::vector<std::string>& names) {
  std::vector<std::string> present = names;
  if (!std::filesystem::exists(killeroo)) std::erase(present, "killeroo-quad");
  return present;
}

const Scene& bench_scene(const std::string& name, int pixels) {
  static std::map<std::pair<std::string, int>, std::unique_ptr<Scene>> scenes;
  std::unique_ptr<Scene>& scene = scenes[{name, pixels}];
  if (!scene) {
    SceneDescription description = read_scene(name == "killeroo-quad" ? killeroo.string() : name);
    const double scale = double(pixels) / std::max(description.film.width, description.film.height);
    description.film.width = int(scale * description.film.width);
    description.film.height = int(scale * description.film.height);
    scene = std::make_unique<Scene>(std::move(description), embree_isa(choose_isa()));
  }
  return *scene;
}

}  // namespace lockstep
