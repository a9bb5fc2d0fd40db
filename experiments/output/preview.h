// Images for people: one exposure for all renders of a scene, chosen from its reference.
#pragma once

#include "core/image.h"

namespace lockstep {

// Factor on radiance that brings all but the brightest twentieth of the image below display white.
float preview_exposure(const Image& reference);

// The image times `exposure`.
Image exposed(const Image& image, float exposure);

// A one-channel weight map as grey RGB: black is w = 0, white is w = 1. The values are display
// values: the sRGB curve that 8-bit files get is undone.
Image weights_as_grey(const Image& weights);

}  // namespace lockstep
