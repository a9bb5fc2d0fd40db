// Readers of scenes. Which of them it is, LOCKSTEP_FUZZ_FORMAT says when this is compiled.

#include "core/default_view.h"
#include "core/gltf/reader.h"
#include "core/mitsuba/reader.h"
#include "core/obj.h"
#include "core/ply.h"
#include "core/read_scene.h"
#include "core/serialized_mesh.h"
#include "tests/fuzz/digest.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/own_errors.h"
#include "tests/fuzz/playground.h"

#include <string>
#include <utility>

namespace lockstep::fuzz {
namespace {

SceneDescription mesh_alone(TriangleMesh mesh) {
  SceneDescription scene;
  scene.materials.emplace_back(DiffuseMaterial{});
  scene.shapes.push_back({std::move(mesh), 0, {}});
  add_default_view(scene);
  return scene;
}

struct Format {
  const char* file;  // name of the input among the companions
  SceneDescription (*read)(const Playground&, const std::string& path);
};

// Each is named as LOCKSTEP_FUZZ_FORMAT has it; a target uses one of them.
[[maybe_unused]] constexpr Format pbrt{
    "input.pbrt", [](const Playground&, const std::string& path) { return read_pbrt(path); }};
[[maybe_unused]] constexpr Format mitsuba{
    "input.xml", [](const Playground&, const std::string& path) { return read_mitsuba(path); }};
[[maybe_unused]] constexpr Format gltf{
    "input.gltf", [](const Playground&, const std::string& path) { return read_gltf(path); }};
[[maybe_unused]] constexpr Format obj{
    "input.obj", [](const Playground&, const std::string& path) { return read_obj_scene(path); }};
[[maybe_unused]] constexpr Format mtl{"input.mtl", [](const Playground& p, const std::string&) {
                                        return read_obj_scene(p.path("input_mtl.obj"));
                                      }};
[[maybe_unused]] constexpr Format ply{"input.ply", [](const Playground&, const std::string& path) {
                                        return mesh_alone(read_ply(path));
                                      }};
[[maybe_unused]] constexpr Format serialized{
    "input.serialized", [](const Playground&, const std::string& path) {
      const SerializedMesh first = read_serialized_mesh(path, 0);
      check_usable(mesh_alone(first.mesh));
      return mesh_alone(read_serialized_mesh(path, 1).mesh);
    }};

void read_and_digest(const std::string& path, const Playground& playground) {
  SceneDescription scene = LOCKSTEP_FUZZ_FORMAT.read(playground, path);
  for (const std::string& warning : scene.warnings) {
    check_message(LOCKSTEP_FUZZ_FORMAT.file, warning);
  }
  check_usable(std::move(scene));
}

}  // namespace
}  // namespace lockstep::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lockstep::fuzz;
  static const Playground playground;
  const std::string path = playground.write(LOCKSTEP_FUZZ_FORMAT.file, data, size);
  expect_own_errors(LOCKSTEP_FUZZ_FORMAT.file, [&] { read_and_digest(path, playground); });
  return 0;
}
