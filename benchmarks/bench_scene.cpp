#include "bench_scene.h"

#include "core/read_scene.h"
#include "packets/isa.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

namespace lockstep {
namespace {

const std::filesystem::path killeroo =
    std::filesystem::path(LOCKSTEP_SHARED_DIR) / "scenes/killeroo-quad/killeroo-quad.pbrt";

}  // namespace

std::vector<std::string> bench_scene_names() {
  std::vector<std::string> names{"cornell", "reef", "meadow", "spheres"};
  if (std::filesystem::exists(killeroo)) names.insert(names.begin(), "killeroo-quad");
  return names;
}

const Scene& bench_scene(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Scene>> scenes;
  std::unique_ptr<Scene>& scene = scenes[name];
  if (!scene) {
    SceneDescription description =
        read_scene(name == "killeroo-quad" ? killeroo.string() : name);
    const double scale = 342.0 / std::max(description.film.width, description.film.height);
    description.film.width = int(scale * description.film.width);
    description.film.height = int(scale * description.film.height);
    scene = std::make_unique<Scene>(std::move(description), embree_isa(choose_isa()));
  }
  return *scene;
}

}  // namespace lockstep
