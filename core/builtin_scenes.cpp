#include "core/builtin/scenes.h"
#include "core/read_scene.h"

namespace lockstep {

const std::vector<BuiltinScene>& builtin_scenes() {
  static const std::vector<BuiltinScene> scenes{
      {"cornell", "box of diffuse walls under one small ceiling light", builtin::make_cornell},
      {"reef", "corals and stones of fine triangles under one large light", builtin::make_reef},
      {"meadow", "hills, bushes and boulders under a constant sky", builtin::make_meadow},
      {"spheres", "metals from polished to rough under lights from small to large",
       builtin::make_spheres},
      {"furnace", "a white sphere in a white sky: every pixel is 1", builtin::make_furnace},
  };
  return scenes;
}

}  // namespace lockstep
