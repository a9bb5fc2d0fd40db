#include "core/environment_map.h"

#include "core/error.h"
#include "core/sphere_mapping.h"

#include <tbb/parallel_for.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <string>

namespace lockstep {
namespace {

// Cells of the distribution at most, so that it stays in a core's cache.
constexpr int max_columns = 1024, max_rows = 512;
constexpr double pi_d = 3.14159265358979323846;

Error error_in(const Environment& environment, const std::string& what) {
  const std::string place = environment.where.empty() ? "" : environment.where + ": ";
  return Error(place + environment.file + ": " + what);
}

TextureImage read_map(const Environment& environment) {
  ImageTexture texture;
  texture.file = environment.file;
  texture.where = environment.where;
  TextureImage image = read_texture_image(texture);
  if (environment.mapping == Environment::Mapping::EqualAreaOctahedral &&
      image.width() != image.height()) {
    throw error_in(environment, "an octahedral environment map must be a square, this one has " +
                                    std::to_string(image.width()) + " x " +
                                    std::to_string(image.height()) + " pixels");
  }
  return image;
}

// Sets values below 0 to 0.
void remove_negative(TextureImage& image) {
  const auto clear = [](std::int32_t word, std::uint32_t sign, std::uint32_t value) {
    return std::uint32_t(word) & sign ? std::int32_t(std::uint32_t(word) & ~value) : word;
  };
  for (std::int32_t& word : image.words) {
    if (image.format == TexelFormat::Float) word = clear(word, 0x80000000u, 0xffffffffu);
    if (image.format == TexelFormat::Half) {
      word = clear(clear(word, 0x8000u, 0xffffu), 0x80000000u, 0xffff0000u);
    }
  }
}

// Gram and Schmidt's: the first axis keeps its direction.
glm::mat3 orthonormal(const Environment& environment) {
  const glm::dmat3 m(environment.to_world);
  const glm::dvec3 x = glm::normalize(m[0]);
  const glm::dvec3 y = glm::normalize(m[1] - glm::dot(m[1], x) * x);
  const glm::dvec3 z = glm::normalize(m[2] - glm::dot(m[2], x) * x - glm::dot(m[2], y) * y);
  const double volume = std::abs(glm::dot(x, glm::cross(y, z)));
  if (!(std::abs(volume - 1.0) < 1e-6)) {
    throw error_in(environment, "the environment's transform has no inverse");
  }
  return glm::mat3(glm::dmat3(x, y, z));
}

int cells(int texels, int most) {
  const int per_cell = (texels + most - 1) / most;
  return (texels + per_cell - 1) / per_cell;
}

double row_edge(int row, int rows) { return pi_d * double(row) / double(rows); }

// Solid angle of one of the cells in a row of a grid over the square.
double solid_angle(SphereMapping mapping, int row, int columns, int rows) {
  if (mapping == SphereMapping::EqualAreaOctahedral) return 4.0 * pi_d / columns / rows;
  const double middle = 0.5 * (row_edge(row, rows) + row_edge(row + 1, rows));
  return 2.0 * pi_d / columns * 2.0 * std::sin(middle) * std::sin(0.5 * pi_d / rows);
}

// The luminance that each texel sends, without what lies between texels.
std::vector<float> luminances(const TextureImage& image, glm::vec3 scale) {
  std::vector<float> values(std::size_t(image.width()) * std::size_t(image.height()));
  tbb::parallel_for(0, image.height(), [&](int y) {
    for (int x = 0; x < image.width(); ++x) {
      const LinearTexel t = texel_at(image, 0, x, y);
      values[std::size_t(y) * std::size_t(image.width()) + std::size_t(x)] =
          luminance(glm::vec3(t.r, t.g, t.b) * scale);
    }
  });
  return values;
}

// What bilinear interpolation gives on average over a texel: an eighth of each neighbour along
// each axis. Above 0 wherever interpolation finds anything above 0.
class SmoothedLuminance {
 public:
  SmoothedLuminance(SphereMapping mapping, const std::vector<float>& values, int width, int height)
      : mapping_(mapping), values_(values), width_(width), height_(height) {}

  double operator()(int x, int y) const {
    constexpr double share[3] = {0.125, 0.75, 0.125};
    double sum = 0.0;
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) sum += share[i + 1] * share[j + 1] * at(x + i, y + j);
    }
    return sum;
  }

 private:
  double at(std::int32_t x, std::int32_t y) const {
    if (x < 0 || x >= width_ || y < 0 || y >= height_) cross_edge(mapping_, width_, height_, x, y);
    return double(values_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]);
  }

  SphereMapping mapping_;
  const std::vector<float>& values_;
  std::int32_t width_, height_;
};

// Texels [first, end) that a cell covers, wholly or in part.
struct Cover {
  double lo, hi;
  int first, end;

  Cover(int cell, int count, int texels)
      : lo(double(cell) * texels / count),
        hi(double(cell + 1) * texels / count),
        first(int(lo)),
        end(std::min(texels, int(std::ceil(hi)))) {}
  double share(int texel) const {
    return (std::min(hi, texel + 1.0) - std::max(lo, double(texel))) / (hi - lo);
  }
};

double cell_mean(const SmoothedLuminance& smoothed, const Cover& x, const Cover& y) {
  double sum = 0.0;
  for (int j = y.first; j < y.end; ++j) {
    for (int i = x.first; i < x.end; ++i) sum += x.share(i) * y.share(j) * smoothed(i, j);
  }
  return sum;
}

// Cumulative distribution in whole steps of 2^-24, at least one for every weight above 0; all
// alike where there is none. The steps beyond those are shared out in proportion.
void append_cdf(std::vector<double> weights, std::vector<float>& cdf) {
  double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(sum > 0.0 && std::isfinite(sum))) {
    std::fill(weights.begin(), weights.end(), 1.0);
    sum = double(weights.size());
  }
  const auto above_0 = [](double w) { return w > 0.0; };
  const auto to_share = 0x1p24 - double(std::count_if(weights.begin(), weights.end(), above_0));
  double below = 0.0, steps = 0.0;
  for (const double w : weights) {
    cdf.push_back(float((steps + std::floor(to_share * (below / sum))) * 0x1p-24));
    below += w;
    steps += double(above_0(w));
  }
  cdf.push_back(1.0f);
}

// Cells per entry of a guide, on average.
constexpr int cells_per_guide = 2;

int guide_count(int cells) {
  return std::max(1, int(std::bit_floor(unsigned(cells))) / cells_per_guide);
}

// The guide of the distribution over `cells` cells that starts at `cdf`.
void append_guide(const float* cdf, int cells, std::vector<std::int32_t>& guides) {
  const int count = guide_count(cells);
  std::int32_t cell = 0;
  for (int k = 0; k <= count; ++k) {
    while (cell + 1 < cells && cdf[cell + 1] <= float(k) / float(count)) ++cell;
    guides.push_back(cell);
  }
}

glm::dvec3 mean_of(const TextureImage& image, SphereMapping mapping) {
  glm::dvec3 sum(0.0);
  for (int y = 0; y < image.height(); ++y) {
    glm::dvec3 row(0.0);
    for (int x = 0; x < image.width(); ++x) {
      const LinearTexel t = texel_at(image, 0, x, y);
      row += glm::dvec3(t.r, t.g, t.b);
    }
    sum += row * solid_angle(mapping, y, image.width(), image.height());
  }
  return sum / (4.0 * pi_d);
}

// Weights of the cells, row by row: the mean luminance there times the solid angle.
std::vector<double> cell_weights(const SmoothedLuminance& smoothed, SphereMapping mapping,
                                 const TextureImage& image, int columns, int rows) {
  std::vector<double> weights(std::size_t(columns) * std::size_t(rows));
  tbb::parallel_for(0, rows, [&](int row) {
    const Cover y(row, rows, image.height());
    const double scale = solid_angle(mapping, row, columns, rows);
    for (int column = 0; column < columns; ++column) {
      weights[std::size_t(row) * std::size_t(columns) + std::size_t(column)] =
          scale * cell_mean(smoothed, Cover(column, columns, image.width()), y);
    }
  });
  return weights;
}

}  // namespace

bool keeps_angles(const glm::mat3& to_world) {
  const float size = glm::dot(to_world[0], to_world[0]);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      const float expected = i == j ? size : 0.0f;
      if (!(std::abs(glm::dot(to_world[i], to_world[j]) - expected) <= 1e-3f * size)) return false;
    }
  }
  return size > 0.0f;
}

EnvironmentMap::EnvironmentMap(const Environment& environment) : image_(read_map(environment)) {
  remove_negative(image_);
  const bool octahedral = environment.mapping == Environment::Mapping::EqualAreaOctahedral;
  data_.mapping = octahedral ? SphereMapping::EqualAreaOctahedral : SphereMapping::LatLong;
  data_.scale = environment.radiance;
  data_.to_world = orthonormal(environment);
  mean_radiance_ = glm::vec3(mean_of(image_, data_.mapping)) * environment.radiance;
  if (luminance(mean_radiance_) > 0.0f) {
    data_.columns = cells(image_.width(), octahedral ? max_rows : max_columns);
    data_.rows = cells(image_.height(), max_rows);
  }
  build_distribution();
}

void EnvironmentMap::build_distribution() {
  const int columns = data_.columns, rows = data_.rows;
  const std::vector<float> values = luminances(image_, data_.scale);
  const SmoothedLuminance smoothed(data_.mapping, values, image_.width(), image_.height());
  const auto weights = cell_weights(smoothed, data_.mapping, image_, columns, rows);
  std::vector<double> row_weights;
  for (int row = 0; row < rows; ++row) {
    const auto first = weights.begin() + std::ptrdiff_t(row) * columns;
    append_cdf({first, first + columns}, column_cdf_);
    append_guide(&column_cdf_.end()[-columns - 1], columns, column_guide_);
    row_weights.push_back(std::accumulate(first, first + columns, 0.0));
  }
  append_cdf(row_weights, row_cdf_);
  append_guide(row_cdf_.data(), rows, row_guide_);
  for (int row = 0; row < rows; ++row) {
    const double share =
        double(row_cdf_[std::size_t(row + 1)]) - double(row_cdf_[std::size_t(row)]);
    row_density_.push_back(float(share / solid_angle(data_.mapping, row, columns, rows)));
  }
  for (int row = 0; row <= rows; ++row) {
    const double half = 0.5 * row_edge(row, rows);
    latitudes_.push_back(float(std::sin(half) * std::sin(half)));
    latitudes_.push_back(row == rows ? 0.0f : float(std::cos(half) * std::cos(half)));
  }
}

EnvironmentMapData EnvironmentMap::view() const {
  EnvironmentMapData data = data_;
  data.texels = image_.view();
  data.row_cdf = {data.rows, guide_count(data.rows), row_cdf_.data(), row_guide_.data()};
  data.column_cdf = {data.columns, guide_count(data.columns), column_cdf_.data(),
                     column_guide_.data()};
  data.row_density = row_density_.data();
  data.latitudes = latitudes_.data();
  return data;
}

std::uint64_t EnvironmentMap::fingerprint() const {
  Fingerprint print;
  image_.add_to(print);
  print.add(std::int32_t(data_.mapping));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) print.add(data_.to_world[i][j]);
    print.add(data_.scale[i]);
  }
  return print.value();
}

std::size_t EnvironmentMap::memory_bytes() const {
  std::size_t bytes =
      image_.memory_bytes() + (row_guide_.size() + column_guide_.size()) * sizeof(std::int32_t);
  for (const auto* values : {&row_cdf_, &column_cdf_, &row_density_, &latitudes_}) {
    bytes += values->size() * sizeof(float);
  }
  return bytes;
}

}  // namespace lockstep
