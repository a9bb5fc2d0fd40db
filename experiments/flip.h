// FLIP, the difference a person sees when two images alternate (Andersson et al. 2020, "FLIP: A
// Difference Evaluator for Alternating Images"), and HDR-FLIP (Andersson et al. 2021, "Visualizing
// Errors in Rendered High Dynamic Range Images"). As in NVIDIA's program, version 1.6.
// Images are linear RGB of one size; maps have one channel, from 0 (equal) to 1.
#pragma once

#include "core/image.h"

namespace lockstep {

// 3840 pixels over 0.7 m, seen from 0.7 m away: 3840 pi / 180.
constexpr float kPixelsPerDegree = 67.02064f;

// FLIP of the images clamped to [0, 1].
Image flip_ldr_map(const Image& reference, const Image& test,
                   float pixels_per_degree = kPixelsPerDegree);

// Exposures in stops, from that which shows the reference's brightest pixel to that which shows
// its median just below white, about one stop apart.
struct Exposures {
  float start = 0.0f;
  float stop = 0.0f;
  int count = 2;
};
// Where more than half of the reference is black, the median is that of the rest.
Exposures flip_exposures(const Image& reference);

// The largest FLIP of each pixel over the exposures, tone-mapped with the ACES curve.
Image flip_hdr_map(const Image& reference, const Image& test,
                   float pixels_per_degree = kPixelsPerDegree);

double mean_of(const Image& map);

}  // namespace lockstep
