// Errors made of squared differences of linear RGB values. Both images have the same size; means
// run over pixels and channels.
#pragma once

#include "core/image.h"

namespace lockstep {

// sqrt(mean (t - r)^2), in units of radiance.
double rmse(const Image& reference, const Image& test);

// mean (t - r)^2 / (r^2 + 0.01), without unit: dark regions count as much as bright ones.
double relmse(const Image& reference, const Image& test);

// relMSE without the worst pixels, one in a thousand (rounded down): what is left when fireflies
// are removed.
double relmse_trimmed(const Image& reference, const Image& test);

}  // namespace lockstep
