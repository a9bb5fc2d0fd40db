// The images inside the report page: float pixels, compressed, for the page's viewer.
#pragma once

#include "experiments/compare/compare.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

namespace lockstep {

struct ReportImages {
  // A list with one entry for each scene of the summary: "size" (pixels), "factor" (1, or how many
  // pixels a side were averaged to one to save room), "reference" (id), "runs": {sampler (index),
  // spp, radiance, flip, weights (ids; null where there are none)}, and "left_out": how many
  // renders the page has no room for.
  nlohmann::ordered_json index;
  std::string elements;  // HTML: a script element of base64 for each id
};

// The first seed's renders, as many as fit into `max_bytes` of HTML: of every scene first one for
// each sampler, those nearest to the longest time that all have in common, then the rest by falling
// sample count. Where not even the first fit, images are averaged down. Reads the renders' EXR
// files in the settings' directory; one that cannot be read counts as left out.
ReportImages report_images(const Comparison& comparison, const nlohmann::ordered_json& summary,
                           std::size_t max_bytes);

// What the viewer decodes. Both give a zlib stream as base64.
//
// Radiance: half floats of radiance times `exposure`, RGB interleaved, row by row. Each becomes a
// 16-bit number: the difference of its bits from those of the same value in `prediction`, modulo
// 2^16, in zigzag code (0, -1, 1, -2, ... are 0, 1, 2, 3, ...). Without a prediction: from the
// value to the left, three numbers back. First all low bytes, then all high ones.
std::string encoded_radiance(const Image& image, float exposure, const Image* prediction);
// A map of one channel in [0, 1]: bytes round(255 v), each less the one before, modulo 256.
std::string encoded_map(const Image& map);

// The image with `factor` x `factor` pixels averaged to one; what is left at the right and bottom
// makes smaller averages.
Image averaged_down(const Image& image, int factor);

}  // namespace lockstep
