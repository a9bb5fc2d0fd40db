// Scene files of pbrt-v2, v3 and v4 (pbrt.org/fileformat, fileformat-v3, fileformat-v4).
#include "core/pbrt/directives.h"
#include "core/pbrt/lights.h"
#include "core/pbrt/surfaces.h"
#include "core/read_scene.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace lockstep {

namespace pbrt {

namespace {

// See Version for what tells it.
Version version_of(const State& state) {
  if (state.v2_directive) return Version::v2;
  if (!state.film_type.empty()) return state.film_type == "image" ? Version::v3 : Version::v4;
  return state.world_ended ? Version::v3 : Version::v4;
}

// Gives shapes the geometry of their files.
void settle_mesh_files(State& state) {
  std::vector<TriangleMesh> meshes = read_mesh_files(state.mesh_files);
  for (size_t i = 0; i < meshes.size(); ++i) {
    const auto& [shapes, index, power] = state.file_shapes[i];
    Shape& shape = (*shapes)[index];
    shape.geometry = std::move(meshes[i]);
    if (shape.emission) set_power(power, shape.geometry, *shape.emission);
  }
}

// An error in a mesh's file is the scene's if the shape stands before any other error.
void read_files(State& state, const std::string& path) {
  try {
    read_file(state, path, {});
  } catch (const Error&) {
    read_mesh_files(state.mesh_files);
    throw;
  }
  settle_mesh_files(state);
}

void check_complete(const State& state) {
  if (!state.scopes.empty()) {
    const Scope& open = state.scopes.back();
    fail(open.where, open.begin + " is never closed");
  }
  if (!state.in_world) {
    throw Error(state.library.main_file + ": the file has no WorldBegin, so it describes no scene");
  }
}

void finish_view(State& state) {
  const Version version = state.library.version;
  Warnings& warnings = state.library.warnings;
  const auto given = [](const std::optional<ParameterSet>& set) { return set ? &*set : nullptr; };
  state.scene.film = make_film(version, given(state.film), warnings);
  state.scene.film.filter =
      make_filter(version, state.filter.first, given(state.filter.second), warnings);
  apply_window(state.window, state.scene.film, warnings, state.scene.camera);
}

// The spots' penumbra differs between the versions.
void finish_lights(State& state) {
  if (state.library.version == Version::v4) return;
  for (LightSource& light : state.scene.lights) {
    auto* spot = std::get_if<SpotLight>(&light);
    if (spot != nullptr) spot->falloff = SpotLight::Falloff::Quartic;
  }
}

}  // namespace

}  // namespace pbrt

SceneDescription read_pbrt(const std::string& path) {
  pbrt::State state;
  state.library.main_file = path;
  state.scene.name = std::filesystem::path(path).stem().string();
  // Of shapes before the first Material.
  state.library.materials.push_back({"diffuse", pbrt::ParameterSet("Material \"diffuse\""), 0});
  pbrt::read_files(state, path);
  pbrt::check_complete(state);
  state.library.version = pbrt::version_of(state);
  pbrt::finish_view(state);
  pbrt::finish_lights(state);
  pbrt::settle_surfaces(state);
  state.scene.warnings = state.library.warnings.lines();
  return std::move(state.scene);
}

}  // namespace lockstep
