// Scenes in pbrt's language for tests of its reader.
#pragma once

#include "core/read_scene.h"
#include "tests/t_description.h"
#include "tests/t_files.h"

#include <string>

namespace lockstep {

class Pbrt : public TestWithFiles {
 protected:
  SceneDescription read(const std::string& text) const {
    return read_pbrt(write("scene.pbrt", text));
  }
  SceneDescription read_world(const std::string& text) const { return read("WorldBegin\n" + text); }
  std::string error_of(const std::string& text) const {
    return message_of([&] { read(text); });
  }
};

inline const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] ";

}  // namespace lockstep
