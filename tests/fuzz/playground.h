// A folder of a process's own, with small valid files that inputs can refer to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace lockstep::fuzz {

class Playground {
 public:
  // Makes the folder in the system's one for temporary files and fills it with a.ply, a.obj, a.mtl,
  // a.serialized, a.pbrt, b.pbrt (which includes itself), a.xml, b.xml (the same), a.spd, a.bin and
  // input_mtl.obj, whose material file is input.mtl.
  Playground();
  ~Playground();
  Playground(const Playground&) = delete;
  Playground& operator=(const Playground&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // Returns the file's path.
  std::string write(const std::string& name, const void* bytes, std::size_t size) const;

 private:
  std::filesystem::path folder_;
};

// A serialized mesh of Mitsuba's version 4, with one triangle, which is stored, not compressed.
std::string small_serialized_mesh();

}  // namespace lockstep::fuzz
