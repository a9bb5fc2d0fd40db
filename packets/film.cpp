#include "packets/film.h"

namespace lockstep {
namespace {

// Calls f(sums, channel) with the pixel's index of `sums` for every value of the image, and stores
// what it returns.
template <class F>
Image make_image(const Film& film, F f) {
  Image image(film.width, film.height);
  for (std::size_t pixel = 0; pixel < film.sums.size() / 4; ++pixel) {
    for (std::size_t c = 0; c < 3; ++c) image.pixels[pixel * 3 + c] = float(f(pixel * 4, c));
  }
  return image;
}

double ratio(double sum, double count) { return count > 0.0 ? sum / count : 0.0; }

double sum(const Film& film, std::size_t at) {
  return film.earlier.empty() ? film.sums[at] : film.earlier[at] + film.sums[at];
}

double pixel_mean(const Film& film, std::size_t at, std::size_t c) {
  return ratio(sum(film, at + c), sum(film, at + 3));
}

}  // namespace

void begin_block(Film& film) {
  if (film.samples == 0 || film.samples % film_block != 0) return;
  film.earlier.resize(film.sums.size());
  begin_block(film, 0, 0, film.width, film.height);
}

void begin_block(Film& film, int x0, int y0, int x1, int y1) {
  for (int y = y0; y < y1; ++y) {
    const std::size_t row = std::size_t(y) * std::size_t(film.width);
    for (std::size_t at = 4 * (row + std::size_t(x0)); at < 4 * (row + std::size_t(x1)); ++at) {
      film.earlier[at] += film.sums[at];
      film.sums[at] = 0.0;
    }
  }
}

std::uint32_t whole_blocks(std::uint32_t done, std::uint32_t samples) {
  const std::uint32_t end = done + samples, whole = end / film_block * film_block;
  return whole > done ? whole - done : samples;
}

Image mean(const Film& film) {
  return make_image(film, [&](std::size_t at, std::size_t c) { return pixel_mean(film, at, c); });
}

Image mean(const Film& film, int x0, int y0, int x1, int y1) {
  Image part(x1 - x0, y1 - y0);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const std::size_t at = 4 * (std::size_t(y) * std::size_t(film.width) + std::size_t(x));
      float* pixel = part.at(x - x0, y - y0);
      for (std::size_t c = 0; c < 3; ++c) pixel[c] = float(pixel_mean(film, at, c));
    }
  }
  return part;
}

Image mean(const Film& a, const Film& b) {
  return make_image(a, [&](std::size_t at, std::size_t c) {
    return ratio(sum(a, at + c) + sum(b, at + c), sum(a, at + 3) + sum(b, at + 3));
  });
}

Image variance_of_mean(const Film& film, const Film& part) {
  return make_image(film, [&](std::size_t at, std::size_t c) {
    const double n = sum(film, at + 3), first = sum(part, at + 3), second = n - first;
    if (first < 1.0 || second < 1.0) return 0.0;
    const double difference =
        sum(part, at + c) / first - (sum(film, at + c) - sum(part, at + c)) / second;
    // Var(difference) = s^2 (1 / first + 1 / second), Var(mean) = s^2 / n.
    return difference * difference * first * second / (n * n);
  });
}

Image interpolate(const Film& a, const Film& b, const Image& weights) {
  return make_image(a, [&](std::size_t at, std::size_t c) {
    const double w = double(weights.pixels[at / 4]);
    return w * pixel_mean(a, at, c) + (1.0 - w) * pixel_mean(b, at, c);
  });
}

}  // namespace lockstep
