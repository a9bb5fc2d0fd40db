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

double pixel_mean(const Film& film, std::size_t at, std::size_t c) {
  return ratio(film.sums[at + c], film.sums[at + 3]);
}

}  // namespace

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
    return ratio(a.sums[at + c] + b.sums[at + c], a.sums[at + 3] + b.sums[at + 3]);
  });
}

Image variance_of_mean(const Film& film, const Film& part) {
  return make_image(film, [&](std::size_t at, std::size_t c) {
    const double n = film.sums[at + 3], first = part.sums[at + 3], second = n - first;
    if (first < 1.0 || second < 1.0) return 0.0;
    const double difference =
        part.sums[at + c] / first - (film.sums[at + c] - part.sums[at + c]) / second;
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
