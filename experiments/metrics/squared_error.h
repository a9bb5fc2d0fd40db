// Errors made of differences of linear RGB values, value by value. Both images have the same size;
// means run over pixels and channels.
#pragma once

#include "core/image.h"

namespace lockstep {

// mean (t - r)^2, in units of radiance squared.
double mse(const Image& reference, const Image& test);

// sqrt(mean (t - r)^2), in units of radiance.
double rmse(const Image& reference, const Image& test);

// mean (t - r)^2 / (r^2 + 0.01), without unit: dark regions count as much as bright ones.
double relmse(const Image& reference, const Image& test);

// relMSE without the worst pixels, one in a thousand (rounded down): what is left when fireflies
// are removed.
double relmse_trimmed(const Image& reference, const Image& test);

// Symmetric mean absolute percentage error: mean |t - r| / (|t| + |r| + 0.01), from 0 to 1, in the
// form that denoisers are trained with (Vogels et al. 2018).
double smape(const Image& reference, const Image& test);

}  // namespace lockstep
