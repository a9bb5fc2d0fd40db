// Wavefront MTL files, the materials of OBJ files.
#pragma once

#include "core/obj.h"
#include "core/scene_description.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lockstep {

struct ObjMaterial {
  Material material;
  std::optional<Emission> emission;
};

using ObjMaterials = std::map<std::string, ObjMaterial>;  // by name

// Reads the `libraries` that the OBJ file at `obj_path` names, from beside it; appends textures and
// warnings to `scene`. A library that is missing gives a warning. Colours are taken as linear.
// Understood are Kd Ks Ke Ns Ni d Tr illum, Pr and Pm (Exocortex's extension), their maps, bump and
// norm, with the options -s -o -bm -clamp:
//   illum 4, 6, 7, 9  a dielectric of index Ni
//   illum 3, 5, 8     over a black Kd: a metal that reflects Ks
//   Pr or Pm          the principled model
//   Ks > 0, Ns > 0    a diffuse base and a rough coat, alpha = sqrt(2 / (Ns + 2)) (Walter et al.
//                     2007), added
//   else              diffuse
ObjMaterials read_mtl_libraries(const std::string& obj_path,
                                const std::vector<std::string>& libraries, SceneDescription& scene);

// Appends `part` as a shape; a material that is not among `materials` is a diffuse grey.
void add_obj_part(ObjPart part, const ObjMaterials& materials, SceneDescription& scene);

}  // namespace lockstep
