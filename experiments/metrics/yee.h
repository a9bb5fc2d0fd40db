// The pixels that a person sees differ (Yee, Pattanaik and Greenberg 2001, "Spatiotemporal
// Sensitivity and Visual Attention for Efficient Rendering of Dynamic Environments"), without
// motion, as the program perceptualdiff counts them.
#pragma once

#include "core/image.h"

#include <cstddef>
#include <vector>

namespace lockstep {

struct YeeSettings {
  float field_of_view = 45.0f;  // of the image's width, in degrees
  float gamma = 2.2f;           // of the display that shows the 8-bit sRGB codes
  float luminance = 100.0f;     // of its white, in cd/m^2
  float colour_factor = 1.0f;   // weight of the colour test, 0 to 1
  bool luminance_only = false;  // no colour test
};

struct YeeDifference {
  std::size_t pixels = 0;
  Image failing;  // one channel: 1 where the pixels differ visibly, else 0
};

// What a person sees of one image.
struct YeeView {
  std::vector<Image> luminances;  // in cd/m^2, blurred more and more (Burt and Adelson 1983)
  Image ab;                       // CIELAB's a and b
};

// A linear RGB image is taken as the 8-bit sRGB file that it would be saved to.
YeeView yee_view(const Image& image, const YeeSettings& settings = {});

// Of two images of one size, seen under the same settings.
YeeDifference yee_difference(const YeeView& reference, const YeeView& test,
                             const YeeSettings& settings = {});
YeeDifference yee_difference(const Image& reference, const Image& test,
                             const YeeSettings& settings = {});

}  // namespace lockstep
