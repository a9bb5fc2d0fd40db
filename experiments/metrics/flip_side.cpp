#include "experiments/metrics/flip_side.h"

#include "core/vector_clones.h"
#include "experiments/metrics/separable_filter.h"
#include "experiments/output/fast_power.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace lockstep {
namespace {

// Andersson et al. 2020, section 4.
constexpr float kColourExponent = 0.7f;  // q_c
constexpr float kTurningPoint = 0.4f;    // p_c, as a share of the largest distance
constexpr float kTurningValue = 0.95f;   // p_t

constexpr float kLabKnee = 6.0f / 29.0f;

// Columns are the XYZ values of the primaries of Rec. 709 with white D65.
const glm::dmat3 kXyzFromRgb(10135552.0 / 24577794.0, 2613072.0 / 12288897.0,
                             1425312.0 / 73733382.0, 8788810.0 / 24577794.0, 8788810.0 / 12288897.0,
                             8788810.0 / 73733382.0, 4435075.0 / 24577794.0, 887015.0 / 12288897.0,
                             70074185.0 / 73733382.0);

// XYZ as shares of white's.
glm::dmat3 shares_of_white() {
  const glm::dvec3 white = kXyzFromRgb * glm::dvec3(1.0, 1.0, 1.0);
  glm::dmat3 result = kXyzFromRgb;
  for (int column = 0; column < 3; ++column) result[column] /= white;
  return result;
}
const glm::mat3 kXyzShareFromRgb(shares_of_white());
const glm::mat3 kRgbFromXyzShare(glm::inverse(shares_of_white()));

// Narkowicz's fit of the ACES curve with its exposure of 0.6: n(x) / d(x).
constexpr float kAcesN[] = {0.6f * 0.6f * 2.51f, 0.6f * 0.03f, 0.0f};
constexpr float kAcesD[] = {0.6f * 0.6f * 2.43f, 0.6f * 0.59f, 0.14f};
constexpr float kJustBelowWhite = 0.85f;
constexpr float kLargest = 1e9f;  // its square is finite

inline float clamped(float x) { return std::min(std::max(x, 0.0f), 1.0f); }

inline float aces(float x) {
  x = std::min(x, kLargest);
  const float y = (kAcesN[0] * x * x + kAcesN[1] * x + kAcesN[2]) /
                  (kAcesD[0] * x * x + kAcesD[1] * x + kAcesD[2]);
  return clamped(y);
}

LOCKSTEP_VECTOR_CLONES
void clamp_values(float* values, int count) {
  for (int i = 0; i < count; ++i) values[i] = clamped(values[i]);
}

LOCKSTEP_VECTOR_CLONES
void tone_map(float* values, int count, float gain) {
  for (int i = 0; i < count; ++i) values[i] = aces(gain * values[i]);
}

// The opponent space YCxCz, linear in XYZ, without its factors and offset: they would be taken
// back after filtering. Y is in [0, 1].
LOCKSTEP_VECTOR_CLONES
void to_opponent(const float* __restrict rgb, int count, const glm::mat3& to_share,
                 float* __restrict y, float* __restrict cx, float* __restrict cz) {
  const glm::mat3 m = to_share;
  for (int i = 0; i < count; ++i) {
    const float r = rgb[3 * i], g = rgb[3 * i + 1], b = rgb[3 * i + 2];
    const float share_x = m[0][0] * r + m[1][0] * g + m[2][0] * b;
    const float share_y = m[0][1] * r + m[1][1] * g + m[2][1] * b;
    const float share_z = m[0][2] * r + m[1][2] * g + m[2][2] * b;
    y[i] = share_y;
    cx[i] = share_x - share_y;
    cz[i] = share_y - share_z;
  }
}

inline float lab_curve(float share) {
  const float root = fast_power(share, 1.0f / 3.0f);
  const float line = share / (3.0f * kLabKnee * kLabKnee) + 4.0f / 29.0f;
  return share > kLabKnee * kLabKnee * kLabKnee ? root : line;
}

// CIELAB with chroma that grows with lightness: the Hunt effect.
LOCKSTEP_VECTOR_CLONES
void to_hunt_lab(const float* __restrict y, const float* __restrict cx, const float* __restrict cz,
                 int count, const glm::mat3& to_rgb, const glm::mat3& to_share,
                 float* __restrict lightness, float* __restrict a, float* __restrict b) {
  const glm::mat3 m = to_rgb, n = to_share;
  for (int i = 0; i < count; ++i) {
    const float x = y[i] + cx[i], z = y[i] - cz[i];
    const float red = clamped(m[0][0] * x + m[1][0] * y[i] + m[2][0] * z);
    const float green = clamped(m[0][1] * x + m[1][1] * y[i] + m[2][1] * z);
    const float blue = clamped(m[0][2] * x + m[1][2] * y[i] + m[2][2] * z);
    const float fx = lab_curve(n[0][0] * red + n[1][0] * green + n[2][0] * blue);
    const float fy = lab_curve(n[0][1] * red + n[1][1] * green + n[2][1] * blue);
    const float fz = lab_curve(n[0][2] * red + n[1][2] * green + n[2][2] * blue);
    const float light = 116.0f * fy - 16.0f;
    const float hunt = 0.01f * light;
    lightness[i] = light;
    a[i] = hunt * 500.0f * (fx - fy);
    b[i] = hunt * 200.0f * (fy - fz);
  }
}

// The length of the vector of a derivative's horizontal and vertical response.
LOCKSTEP_VECTOR_CLONES
void lengths(const float* __restrict across, const float* __restrict down, int count,
             float* __restrict result) {
  for (int i = 0; i < count; ++i) {
    result[i] = std::sqrt(across[i] * across[i] + down[i] * down[i]);
  }
}

// HyAB distance (Abasi et al. 2019), compressed.
inline float colour_distance(float light, float a, float b) {
  return fast_power(std::abs(light) + std::sqrt(a * a + b * b), kColourExponent);
}

// Between green and blue: no two colours are farther apart.
float largest_distance() {
  const float rgb[] = {0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f};
  float y[2], cx[2], cz[2], light[2], a[2], b[2];
  to_opponent(rgb, 2, kXyzShareFromRgb, y, cx, cz);
  to_hunt_lab(y, cx, cz, 2, kRgbFromXyzShare, kXyzShareFromRgb, light, a, b);
  return colour_distance(light[0] - light[1], a[0] - a[1], b[0] - b[1]);
}

// One row of both sides.
struct SideRow {
  const float *lightness, *a, *b, *edges, *points;
};

SideRow row_of(const FlipSide& side, int row) {
  const std::size_t at = std::size_t(row) * kFlipTileWidth;
  return {&side.lightness[at], &side.a[at], &side.b[at], &side.edges[at], &side.points[at]};
}

// The colour difference, brought to [0, 1] in two straight pieces so that large distances take
// little of the range, and raised to one minus the feature difference, whose exponent q_f is 1/2.
LOCKSTEP_VECTOR_CLONES
void row_errors(const SideRow& p, const SideRow& q, int count, float largest,
                float* __restrict errors) {
  const float turn = kTurningPoint * largest;
  for (int i = 0; i < count; ++i) {
    const float distance =
        colour_distance(p.lightness[i] - q.lightness[i], p.a[i] - q.a[i], p.b[i] - q.b[i]);
    const float near = kTurningValue / turn * distance;
    const float far = kTurningValue + (distance - turn) / (largest - turn) * (1.0f - kTurningValue);
    const float colour = distance < turn ? near : far;
    const float edge = std::abs(p.edges[i] - q.edges[i]);
    const float point = std::abs(p.points[i] - q.points[i]);
    const float feature = std::sqrt(std::max(edge, point) / std::numbers::sqrt2_v<float>);
    errors[i] = fast_power(colour, 1.0f - feature);
  }
}

// Row y of the image from column `begin` on; beyond the borders the nearest pixel counts.
void copy_clamped(const Image& image, int y, int begin, int count, float* to) {
  const float* row = image.at(0, std::clamp(y, 0, image.height - 1));
  const int left = std::clamp(-begin, 0, count);
  const int right = std::clamp(begin + count - image.width, 0, count - left);
  const int middle = count - left - right;
  for (int i = 0; i < left; ++i) to = std::copy_n(row, 3, to);
  to = std::copy_n(row + std::ptrdiff_t(3) * (begin + left), 3 * middle, to);
  const float* last = row + std::ptrdiff_t(3) * (image.width - 1);
  for (int i = 0; i < right; ++i) to = std::copy_n(last, 3, to);
}

// The tile and what filters reach around it, as planes of the opponent space.
void show_patch(const Image& image, const FlipTile& tile, const FlipDisplay& display, int radius,
                FlipScratch& scratch) {
  const int width = kFlipTileWidth + 2 * radius, height = tile.height + 2 * radius;
  scratch.rgb.resize(std::size_t(3 * width));
  for (auto* plane : {&scratch.y, &scratch.cx, &scratch.cz}) {
    plane->resize(std::size_t(width) * std::size_t(height));
  }
  float* rgb = scratch.rgb.data();
  for (int row = 0; row < height; ++row) {
    copy_clamped(image, tile.y - radius + row, tile.x - radius, width, rgb);
    if (display.tone_mapped) {
      tone_map(rgb, 3 * width, display.gain);
    } else {
      clamp_values(rgb, 3 * width);
    }
    const std::size_t at = std::size_t(row) * std::size_t(width);
    to_opponent(rgb, width, kXyzShareFromRgb, &scratch.y[at], &scratch.cx[at], &scratch.cz[at]);
  }
}

// What is filtered across, in the order of FlipScratch::across.
enum Across { kSeenY, kSeenCx, kSeenCz1, kSeenCz2, kSmooth, kEdge, kPoint };

void filter_across(int height, const FlipFilters& filters, FlipScratch& scratch) {
  const std::size_t width = std::size_t(kFlipTileWidth + 2 * filters.radius);
  const auto filter = [&](const std::vector<float>& plane, const FlipFilters::Weights& weights,
                          std::vector<float>& result) {
    result.resize(std::size_t(height) * kFlipTileWidth);
    const std::size_t skipped = std::size_t(filters.radius) - weights.size() / 2;
    for (std::size_t row = 0; row < std::size_t(height); ++row) {
      weighted_sums(&result[row * kFlipTileWidth], &plane[row * width + skipped], 1, weights,
                    kFlipTileWidth);
    }
  };
  filter(scratch.y, filters.achromatic, scratch.across[kSeenY]);
  filter(scratch.cx, filters.red_green, scratch.across[kSeenCx]);
  filter(scratch.cz, filters.blue_yellow1, scratch.across[kSeenCz1]);
  filter(scratch.cz, filters.blue_yellow2, scratch.across[kSeenCz2]);
  filter(scratch.y, filters.smooth, scratch.across[kSmooth]);
  filter(scratch.y, filters.edge, scratch.across[kEdge]);
  filter(scratch.y, filters.point, scratch.across[kPoint]);
}

using Row = float[kFlipTileWidth];

void see_row(int row, const FlipFilters& filters, const FlipScratch& scratch, FlipSide& side) {
  const auto down = [&](Across plane, const FlipFilters::Weights& weights, Row& result) {
    const std::size_t first = std::size_t(row + filters.radius) - weights.size() / 2;
    weighted_sums(result, &scratch.across[plane][first * kFlipTileWidth], kFlipTileWidth, weights,
                  kFlipTileWidth);
  };
  const std::size_t at = std::size_t(row) * kFlipTileWidth;
  Row y, cx, cz, other;
  down(kSeenY, filters.achromatic, y);
  down(kSeenCx, filters.red_green, cx);
  down(kSeenCz1, filters.blue_yellow1, cz);
  down(kSeenCz2, filters.blue_yellow2, other);
  for (int i = 0; i < kFlipTileWidth; ++i) cz[i] += other[i];
  to_hunt_lab(y, cx, cz, kFlipTileWidth, kRgbFromXyzShare, kXyzShareFromRgb, &side.lightness[at],
              &side.a[at], &side.b[at]);
  Row across, along;
  down(kEdge, filters.smooth, across);
  down(kSmooth, filters.edge, along);
  lengths(across, along, kFlipTileWidth, &side.edges[at]);
  down(kPoint, filters.smooth, across);
  down(kSmooth, filters.point, along);
  lengths(across, along, kFlipTileWidth, &side.points[at]);
}

}  // namespace

float radiance_below_white() {
  const float a = kAcesN[0] - kJustBelowWhite * kAcesD[0];
  const float b = kAcesN[1] - kJustBelowWhite * kAcesD[1];
  const float c = kAcesN[2] - kJustBelowWhite * kAcesD[2];
  const float middle = -0.5f * b / a;
  return middle + std::sqrt(middle * middle - c / a);
}

std::vector<FlipTile> flip_tiles(const Image& image) {
  std::vector<FlipTile> tiles;
  for (int y = 0; y < image.height; y += kFlipTileHeight) {
    for (int x = 0; x < image.width; x += kFlipTileWidth) {
      tiles.push_back({x, y, std::min(kFlipTileWidth, image.width - x),
                       std::min(kFlipTileHeight, image.height - y)});
    }
  }
  return tiles;
}

void see_tile(const Image& image, const FlipTile& tile, const FlipDisplay& display,
              const FlipFilters& filters, FlipScratch& scratch, FlipSide& side) {
  show_patch(image, tile, display, filters.radius, scratch);
  filter_across(tile.height + 2 * filters.radius, filters, scratch);
  for (auto* plane : {&side.lightness, &side.a, &side.b, &side.edges, &side.points}) {
    plane->resize(std::size_t(tile.height) * kFlipTileWidth);
  }
  for (int row = 0; row < tile.height; ++row) see_row(row, filters, scratch, side);
}

void flip_errors(const FlipSide& p, const FlipSide& q, const FlipTile& tile, int row,
                 float* errors) {
  static const float largest = largest_distance();
  row_errors(row_of(p, row), row_of(q, row), tile.width, largest, errors);
}

}  // namespace lockstep
