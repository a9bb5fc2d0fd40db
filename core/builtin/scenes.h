// The built-in scenes, one function each; core/builtin_scenes.cpp lists them.
#pragma once

#include "core/scene_description.h"

namespace lockstep::builtin {

SceneDescription make_cornell();
SceneDescription make_reef();
SceneDescription make_meadow();
SceneDescription make_spheres();
SceneDescription make_furnace();

}  // namespace lockstep::builtin
