// Sums of samples per pixel. See FilmView.
#pragma once

#include "core/image.h"
#include "packets/kernel.h"

#include <cstdint>
#include <vector>

namespace lockstep {

struct Film {
  int width = 0;
  int height = 0;
  std::uint32_t samples = 0;  // per pixel, taken so far
  std::vector<double> sums;   // four per pixel

  Film() = default;
  Film(int w, int h) : width(w), height(h), sums(size_t(w) * size_t(h) * 4) {}
  FilmView view() { return {width, sums.data()}; }
};

// Means of the finite samples; black where a pixel has none.
Image mean(const Film& film);

// The same of the pixels [x0, x1) x [y0, y1) alone.
Image mean(const Film& film, int x0, int y0, int x1, int y1);

// The mean over both films' samples together: sample-count weighted, hence unbiased.
Image mean(const Film& a, const Film& b);

// The variance of mean(film), by channel, from the difference of the first part of its samples to
// the others: one degree of freedom, so smooth it. 0 where a part has no samples.
Image variance_of_mean(const Film& film, const Film& part);

// w a + (1 - w) b per pixel of the films' means, by a one-channel map of w. Biased where w depends
// on a.
Image interpolate(const Film& a, const Film& b, const Image& weights);

}  // namespace lockstep
