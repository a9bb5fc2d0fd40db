// A camera and a light for files that describe objects alone: OBJ, PLY, many glTF files.
#pragma once

#include "core/scene_description.h"

namespace lockstep {

// Replaces the camera by one that sees the whole scene: from the direction (1, 0.6, 1) of its
// centre, y up, a fov of 40 degrees that encloses the bounding sphere of all shapes and instances,
// sharp at the centre. A scene without geometry is looked at as if it were the unit sphere. The
// film stays as it is. Adds a warning that says so.
void add_default_camera(SceneDescription& scene);

// An environment of constant radiance 1 and a warning that says so; nothing where the scene has an
// environment, a light or an emitting shape.
void add_default_light(SceneDescription& scene);

// Both: for files that have neither camera nor light.
void add_default_view(SceneDescription& scene);

}  // namespace lockstep
