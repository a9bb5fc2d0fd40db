// Scene files of pbrt-v3 and v4 (pbrt.org/fileformat-v3, pbrt.org/fileformat-v4).
#include "core/pbrt/directives.h"
#include "core/read_scene.h"

#include <filesystem>
#include <utility>

namespace lockstep {

namespace pbrt {

namespace {

// See Version for what tells it.
Version version_of(const State& state) {
  if (!state.film_type.empty()) return state.film_type == "image" ? Version::v3 : Version::v4;
  return state.world_ended ? Version::v3 : Version::v4;
}

void check_complete(const State& state) {
  if (!state.scopes.empty()) {
    const Scope& open = state.scopes.back();
    fail(open.where, open.begin + " is never closed");
  }
  if (!state.in_world) {
    throw Error(state.main_file + ": the file has no WorldBegin, so it describes no scene");
  }
}

void finish_view(State& state) {
  const Version version = version_of(state);
  const auto given = [](const std::optional<ParameterSet>& set) { return set ? &*set : nullptr; };
  state.scene.film = make_film(version, given(state.film), state.warnings);
  state.scene.film.filter =
      make_filter(version, state.filter.first, given(state.filter.second), state.warnings);
}

}  // namespace

}  // namespace pbrt

SceneDescription read_pbrt(const std::string& path) {
  pbrt::State state;
  state.main_file = path;
  state.scene.name = std::filesystem::path(path).stem().string();
  state.materials.push_back({DiffuseMaterial{}, -1});  // of shapes before the first Material
  pbrt::read_file(state, path, {});
  pbrt::check_complete(state);
  pbrt::finish_view(state);
  state.scene.warnings = state.warnings.lines();
  return std::move(state.scene);
}

}  // namespace lockstep
