#include "tests/fuzz/playground.h"

#include "tests/t_png.h"

#include <unistd.h>

#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

namespace lockstep::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::pair<const char*, std::string_view> companions[] = {
    {"a.ply",
     "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
     "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
     "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    {"a.obj",
     "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n"},
    {"a.mtl", "newmtl a\nKd .1 .2 .3\nKe 1 1 1\n"},
    {"a.pbrt", "Shape \"sphere\" \"float radius\" 2\n"},
    {"b.pbrt", "Include \"b.pbrt\"\n"},
    {"a.xml", "<scene version=\"3.0.0\"><shape type=\"sphere\"/></scene>\n"},
    {"b.xml", "<scene version=\"3.0.0\"><include filename=\"b.xml\"/></scene>\n"},
    {"a.spd", "400 .1\n500 .5\n600 .3\n700 .2\n"},
    {"input_mtl.obj",
     "mtllib input.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 2\n"
     "usemtl c d\nf 2 1 3\n"},
};

template <class T>
std::string raw(std::initializer_list<T> values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.begin(), bytes.size());
  return bytes;
}

}  // namespace

Playground::Playground()
    : folder_(fs::temp_directory_path() / ("lockstep-fuzz-" + std::to_string(getpid()))) {
  fs::create_directories(folder_);
  for (const auto& [name, text] : companions) write(name, text.data(), text.size());
  const std::string mesh = small_serialized_mesh();
  write("a.serialized", mesh.data(), mesh.size());
  const std::string floats = raw({0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f});
  write("a.bin", floats.data(), floats.size());
}

Playground::~Playground() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::string Playground::write(const std::string& name, const void* bytes, std::size_t size) const {
  std::ofstream(path(name), std::ios::binary)
      .write(static_cast<const char*>(bytes), std::streamsize(size));
  return path(name);
}

std::string small_serialized_mesh() {
  const std::string content =
      raw<std::uint32_t>({0}) + std::string("a\0", 2) + raw<std::uint64_t>({3, 1}) +
      raw({0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}) + raw<std::uint32_t>({0, 1, 2});
  return raw<std::uint16_t>({0x041c, 4}) + zlib_stored(content) + raw<std::uint64_t>({0}) +
         raw<std::uint32_t>({1});
}

}  // namespace lockstep::fuzz
