// FLIP, the difference a person sees when two images alternate (Andersson et al. 2020, "FLIP: A
// Difference Evaluator for Alternating Images"), and HDR-FLIP (Andersson et al. 2021, "Visualizing
// Errors in Rendered High Dynamic Range Images"). As in NVIDIA's program, version 1.6.
// Images are linear RGB of one size; maps have one channel, from 0 (equal) to 1.
#pragma once

#include "core/image.h"
#include "experiments/metrics/flip_side.h"

#include <cstddef>
#include <vector>

namespace lockstep {

// 3840 pixels over 0.7 m, seen from 0.7 m away: 3840 pi / 180.
constexpr float kPixelsPerDegree = 67.02064f;

// Exposures in stops, from that which shows the reference's brightest pixel to that which shows
// its median just below white, about one stop apart.
struct Exposures {
  float start = 0.0f;
  float stop = 0.0f;
  int count = 2;
};
// Where more than half of the reference is black, the median is that of the rest.
Exposures flip_exposures(const Image& reference);

struct HdrFlip {
  Image map;       // the largest FLIP of each pixel over the exposures
  Image exposure;  // at which it was found: 0 for the first exposure, 1 for the last
};

// A reference that many images are compared with: what FLIP sees of it is worked out once, for as
// many exposures as fit into `most_bytes` (five floats a pixel and exposure); the rest is worked
// out for each image. The reference must live as long.
class FlipReference {
 public:
  explicit FlipReference(const Image& reference, float pixels_per_degree = kPixelsPerDegree,
                         std::size_t most_bytes = std::size_t(1) << 30);

  // FLIP of the images clamped to [0, 1].
  Image ldr_map(const Image& test) const;

  // FLIP over the exposures, tone-mapped with the ACES curve.
  HdrFlip hdr_map(const Image& test) const;

 private:
  // The reference's side of a tile: the one that is kept, or worked out in `made`.
  const FlipSide& side(std::size_t display, std::size_t tile, FlipScratch& scratch,
                       FlipSide& made) const;

  const Image* reference_;
  FlipFilters filters_;
  std::vector<FlipTile> tiles_;
  std::vector<FlipDisplay> displays_;        // clamped, then the exposures
  std::vector<std::vector<FlipSide>> kept_;  // by display and tile
};

// The same for a single image, with nothing kept.
Image flip_ldr_map(const Image& reference, const Image& test,
                   float pixels_per_degree = kPixelsPerDegree);
Image flip_hdr_map(const Image& reference, const Image& test,
                   float pixels_per_degree = kPixelsPerDegree);

double mean_of_map(const Image& map);

}  // namespace lockstep
