// Textures of pbrt-v2, v3 and v4. Those for colours and those for numbers have names of their own.
//
// In pbrt v points up; meshes keep the file's (u, v), and UvTransform turns them for images.
#pragma once

#include "core/pbrt/inputs.h"
#include "core/texture_description.h"

#include <string>

namespace lockstep::pbrt {

// The texture `name` as it is understood at `order`; `where` is who asks. Made when first asked
// for. Throws where it is not declared or refers to itself.
ColorInput color_texture(Library& library, const std::string& name, int order,
                         const Location& where);
FloatInput float_texture(Library& library, const std::string& name, int order,
                         const Location& where);

// The product; a texture of its own only where both factors vary.
ColorInput multiply(Library& library, const ColorInput& a, const ColorInput& b);
FloatInput multiply(Library& library, const FloatInput& a, const FloatInput& b);

// Texture "imagemap".
ColorInput image_texture(const Inputs& in);

// An image that a light or material names itself; `p` holds the name.
ImageTexture named_image(const Library& library, const ParameterSet& set, const Parameter& p);

// uscale, vscale, udelta and vdelta, v upwards as in pbrt. Other mappings than by (u, v) warn.
UvTransform uv_transform(const Inputs& in);

}  // namespace lockstep::pbrt
