#include "packets/film.h"

namespace lockstep {
namespace {

// Calls f(channel sum index, pixel) for every value of the image and stores what it returns.
template <class F>
Image make_image(const Film& film, F f) {
  Image image(film.width, film.height);
  for (std::size_t pixel = 0; pixel < film.count.size(); ++pixel) {
    for (std::size_t c = 0; c < 3; ++c)
      image.pixels[pixel * 3 + c] = float(f(pixel * 3 + c, pixel));
  }
  return image;
}

double ratio(double sum, double count) { return count > 0.0 ? sum / count : 0.0; }

}  // namespace

Image mean(const Film& film) {
  return make_image(film, [&](std::size_t i, std::size_t pixel) {
    return ratio(film.sum[i], film.count[pixel]);
  });
}

Image mean(const Film& a, const Film& b) {
  return make_image(a, [&](std::size_t i, std::size_t pixel) {
    return ratio(a.sum[i] + b.sum[i], double(a.count[pixel]) + double(b.count[pixel]));
  });
}

Image interpolate(const Film& a, const Film& b, const Image& weights) {
  return make_image(a, [&](std::size_t i, std::size_t pixel) {
    const double w = double(weights.pixels[pixel]);
    return w * ratio(a.sum[i], a.count[pixel]) + (1.0 - w) * ratio(b.sum[i], b.count[pixel]);
  });
}

}  // namespace lockstep
