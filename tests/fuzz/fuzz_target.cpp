#include "tests/fuzz/fuzz_target.h"

#include "core/default_view.h"
#include "core/error.h"
#include "core/gltf/reader.h"
#include "core/mitsuba/reader.h"
#include "core/obj.h"
#include "core/ply.h"
#include "core/read_scene.h"
#include "core/serialized_mesh.h"
#include "tests/fuzz/digest.h"
#include "tests/fuzz/playground.h"

#include <cstdio>
#include <cstdlib>
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

// Each is named as LOCKSTEP_FUZZ_FORMAT has it.
constexpr Format pbrt{"input.pbrt",
                      [](const Playground&, const std::string& path) { return read_pbrt(path); }};
constexpr Format mitsuba{
    "input.xml", [](const Playground&, const std::string& path) { return read_mitsuba(path); }};
constexpr Format gltf{"input.gltf",
                      [](const Playground&, const std::string& path) { return read_gltf(path); }};
constexpr Format obj{
    "input.obj", [](const Playground&, const std::string& path) { return read_obj_scene(path); }};
constexpr Format mtl{"input.mtl", [](const Playground& p, const std::string&) {
                       return read_obj_scene(p.path("input_mtl.obj"));
                     }};
constexpr Format ply{"input.ply", [](const Playground&, const std::string& path) {
                       return mesh_alone(read_ply(path));
                     }};
constexpr Format serialized{"input.serialized", [](const Playground&, const std::string& path) {
                              const SerializedMesh first = read_serialized_mesh(path, 0);
                              check_usable(mesh_alone(first.mesh));
                              return mesh_alone(read_serialized_mesh(path, 1).mesh);
                            }};

[[noreturn]] void report(const std::string& what) {
  std::fprintf(stderr, "%s: %s\n", LOCKSTEP_FUZZ_FORMAT.file, what.c_str());
  std::abort();
}

void check_message(const std::string& message) {
  if (message.empty()) report("an error says nothing");
  if (message.find_first_of("\n\r") != message.npos) report("not one line: " + message);
}

void read_and_digest(const std::string& path, const Playground& playground) {
  try {
    SceneDescription scene = LOCKSTEP_FUZZ_FORMAT.read(playground, path);
    for (const std::string& warning : scene.warnings) check_message(warning);
    check_usable(std::move(scene));
  } catch (const Error& error) {
    check_message(error.what());
  } catch (const UsageError& error) {
    check_message(error.what());
  } catch (const Unusable& broken) {
    report(std::string("the reader accepts what cannot be used: ") + broken.what());
  } catch (const std::exception& other) {
    report(std::string("not an Error: ") + other.what());
  }
}

}  // namespace
}  // namespace lockstep::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lockstep::fuzz;
  static const Playground playground;
  const std::string path = playground.write(LOCKSTEP_FUZZ_FORMAT.file, data, size);
  read_and_digest(path, playground);
  return 0;
}
