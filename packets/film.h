// Sums of samples per pixel. See FilmView.
#pragma once

#include "core/image.h"
#include "packets/kernel.h"

#include <cstdint>
#include <vector>

namespace lockstep {

// Samples are added up in blocks of so many, and the blocks' sums in their order: so a block may be
// rendered anywhere and the sum has the same bits.
inline constexpr std::uint32_t film_block = 64;

struct Film {
  int width = 0;
  int height = 0;
  std::uint32_t samples = 0;    // per pixel, taken so far
  std::vector<double> sums;     // four per pixel, of the last block begun
  std::vector<double> earlier;  // the same of the blocks before it; empty where there are none

  Film() = default;
  Film(int w, int h) : width(w), height(h), sums(size_t(w) * size_t(h) * 4) {}
  FilmView view() { return {width, sums.data()}; }
};

// Before samples are added: where a block is whole, its sums go to the earlier ones.
void begin_block(Film& film);

// The same for the pixels [x0, x1) x [y0, y1), where a block is known to be whole and `earlier` has
// its size.
void begin_block(Film& film, int x0, int y0, int x1, int y1);

// How many of the next `samples` go together: they stay within a block, or end with one.
std::uint32_t whole_blocks(std::uint32_t done, std::uint32_t samples);

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
