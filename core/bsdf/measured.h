// Measured isotropic reflectance from a table over half and difference angles; see
// core/measured_table.h. Interpolated linearly along each of the three.
//
// Sampling mixes two techniques: the cosine hemisphere, and half vectors by the table's own
// marginal: the share of theta_half in the light that the table scatters between all pairs of
// directions. wi is wo mirrored at the half vector.
//
// Row of MaterialTable: 0 number of the table.
#pragma once

#include "core/bsdf/scatter.h"
#include "core/measured_table.h"
#include "core/simd_atan.h"
#include "core/warp.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct MeasuredBsdf {
  const float* tables;
  IntOf<V> first;  // float of the lane's table
  V half_share;    // of directions that half vectors are drawn for
};

template <class I>
LOCKSTEP_INLINE MeasuredBsdf<FloatOf<I>> load_measured(const MaterialTable& t, I index) {
  using V = FloatOf<I>;
  // Lanes that are not active may be on materials of another kind.
  const V table = clamp(material_rows(t, index, 0).x, V(0.0f), V(float(t.measured_count - 1)));
  const I first = to_int(table) * I(measured_floats);
  return {t.measured, first, gather(t.measured, first)};
}

// Where a pair of directions lies in the table: [0, 1] along each axis. The same to the last bit
// for wo and wi swapped.
template <class V>
struct HalfAngles {
  V half, difference, azimuth;
  V cos_difference;
};

template <class V>
LOCKSTEP_INLINE HalfAngles<V> half_angles(const Vec3<V>& wo, const Vec3<V>& wi) {
  const Vec3<V> h = wi + wo, d = wi - wo;
  const V h_length = length(h);
  const V theta = atan2_turns(sqrt(fma(h.x, h.x, h.y * h.y)), h.z);
  // Twice wi's parts along the meridian and the parallel of h, both times |h| sin(theta).
  const V along = abs(d.z) * h_length;
  const V across = abs(fma(h.x, d.y, -(h.y * d.x)));
  return {sqrt(theta * V(4.0f)), atan2_turns(length(d), h_length) * V(4.0f),
          atan2_turns(across, along) * V(4.0f), h_length * V(0.5f)};
}

// The first of the two cells between whose middles a coordinate in [0, 1] lies, and how far.
template <class V>
struct CellPair {
  V first, within;
};

template <class V>
LOCKSTEP_INLINE CellPair<V> cells_at(V coordinate, int count) {
  const V x = clamp(fma(coordinate, V(float(count)), V(-0.5f)), V(0.0f), V(float(count - 1)));
  const V first = min(floor(x), V(float(count - 2)));
  return {first, x - first};
}

// Reflectance per solid angle, in 1/sr.
template <class V>
LOCKSTEP_INLINE Vec3<V> table_value(const MeasuredBsdf<V>& bsdf, const HalfAngles<V>& at) {
  using I = IntOf<V>;
  const CellPair<V> h = cells_at(at.half, measured_halves);
  const CellPair<V> d = cells_at(at.difference, measured_differences);
  const CellPair<V> p = cells_at(at.azimuth, measured_azimuths);
  const I row = to_int(h.first) * I(measured_differences) + to_int(d.first);
  const I cell = row * I(measured_azimuths) + to_int(p.first);
  const I corner = bsdf.first + I(measured_cells_at) + cell * I(4);
  const auto along_azimuth = [&](int half, int difference) LOCKSTEP_LAMBDA {
    const int offset = 4 * measured_azimuths * (half * measured_differences + difference);
    const auto a = gather_rows(bsdf.tables, corner + I(offset));
    const auto b = gather_rows(bsdf.tables, corner + I(offset + 4));
    return Vec3<V>(fma(p.within, b.x - a.x, a.x), fma(p.within, b.y - a.y, a.y),
                   fma(p.within, b.z - a.z, a.z));
  };
  const auto along_difference = [&](int half) LOCKSTEP_LAMBDA {
    const Vec3<V> a = along_azimuth(half, 0), b = along_azimuth(half, 1);
    return fma(d.within, b - a, a);
  };
  const Vec3<V> a = along_difference(0), b = along_difference(1);
  return fma(h.within, b - a, a);
}

// Of wi by its half vector, per solid angle.
template <class V>
LOCKSTEP_INLINE V half_vector_pdf(const MeasuredBsdf<V>& bsdf, const HalfAngles<V>& at) {
  using I = IntOf<V>;
  const V ring = clamp(at.half * V(float(measured_halves)), V(0.0f), V(measured_halves - 0.5f));
  const auto row =
      gather_rows(bsdf.tables, bsdf.first + I(measured_rings_at) + to_int(ring) * I(4));
  const V density = row.y * V(0.5f * inv_pi) / row.w;
  return density / (V(4.0f) * max(at.cos_difference, V(1e-6f)));
}

template <class V>
LOCKSTEP_INLINE BsdfValue<V> eval(const MeasuredBsdf<V>& bsdf, const Vec3<V>& wo,
                                  const Vec3<V>& wi) {
  const HalfAngles<V> at = half_angles(wo, wi);
  const V cosine = cosine_hemisphere_pdf(wi.z);
  const V pdf = fma(bsdf.half_share, half_vector_pdf(bsdf, at) - cosine, cosine);
  return {table_value(bsdf, at) * wi.z, pdf};
}

// The ring that u in [0, 1) falls to: the last that begins at or before it.
template <class V>
LOCKSTEP_INLINE IntOf<V> choose_ring(const MeasuredBsdf<V>& bsdf, V u) {
  using I = IntOf<V>;
  I ring(0);
  for (int step = 64; step > 0; step /= 2) {
    const I last(measured_halves - 1), further = ring + I(step);
    const I next = select(further < last, further, last);
    const V before = gather(bsdf.tables, bsdf.first + I(measured_rings_at) + next * I(4));
    ring = select(before <= u, next, ring);
  }
  return ring;
}

template <class V>
LOCKSTEP_INLINE Vec3<V> sample_half_vector(const MeasuredBsdf<V>& bsdf, Vec2<V> u) {
  using I = IntOf<V>;
  const I ring = choose_ring(bsdf, u.x);
  const auto row = gather_rows(bsdf.tables, bsdf.first + I(measured_rings_at) + ring * I(4));
  // Samples are multiples of 2^-24: half a step more lies in the middle of what each stands for.
  const V within = (u.x - row.x + V(0x1p-25f)) / max(row.y, V(0x1p-25f));
  const V rise = fma(min(within, V(1.0f)), row.w, row.z);  // 1 - cos
  const V sine = sqrt(max(rise * (V(2.0f) - rise), V(0.0f)));
  const SinCos<V> phi = sincos_turns(u.y);
  return {sine * phi.cos, sine * phi.sin, V(1.0f) - rise};
}

template <class V>
LOCKSTEP_INLINE BsdfSample<V> sample(const MeasuredBsdf<V>& bsdf, const Vec3<V>& wo, V lobe,
                                     Vec2<V> u) {
  const MaskOf<V> by_half = lobe < bsdf.half_share;
  const Vec3<V> h = sample_half_vector(bsdf, u);
  const Vec3<V> mirrored = normalize(fma(V(2.0f) * dot(wo, h), h, -wo));
  const Vec3<V> wi = select<V>(by_half, mirrored, cosine_hemisphere(u));
  const BsdfValue<V> value = eval(bsdf, wo, wi);
  // Mirrored at a half vector that faces away, wi has another half vector.
  const MaskOf<V> valid =
      (wi.z > V(0.0f)) & (value.pdf > V(0.0f)) & !(by_half & (dot(wo, h) <= V(0.0f)));
  const V pdf = select(valid, value.pdf, V(0.0f));
  return {wi, value.f_cos * (V(1.0f) / select(valid, pdf, V(1.0f))), pdf};
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
