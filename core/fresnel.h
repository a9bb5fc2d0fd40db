// Fresnel reflectance of unpolarised light at a smooth interface.
#pragma once

#include "core/vec.h"

#include <cmath>

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// Dielectric; `eta` = index inside / index outside, cos_i in [0, 1] measured outside.
template <class V>
LOCKSTEP_INLINE V fresnel_dielectric(V cos_i, V eta) {
  const V sin2_t = (V(1.0f) - cos_i * cos_i) / (eta * eta);
  const V cos_t = sqrt(max(V(0.0f), V(1.0f) - sin2_t));
  const V parallel = (eta * cos_i - cos_t) / fma(eta, cos_i, cos_t);
  const V perpendicular = (cos_i - eta * cos_t) / fma(eta, cos_t, cos_i);
  const V r = V(0.5f) * fma(parallel, parallel, perpendicular * perpendicular);
  return select(sin2_t >= V(1.0f), V(1.0f), r);
}

// Conductor with complex index eta + i k against vacuum, one channel; cos_i in [0, 1].
// (Born and Wolf 1999, section 14.2, in the form without complex numbers.)
template <class V>
LOCKSTEP_INLINE V fresnel_conductor(V cos_i, V eta, V k) {
  const V cos2 = cos_i * cos_i;
  const V sin2 = V(1.0f) - cos2;
  const V eta2 = eta * eta, k2 = k * k;
  const V t0 = eta2 - k2 - sin2;
  const V a2_plus_b2 = sqrt(max(V(0.0f), fma(t0, t0, V(4.0f) * eta2 * k2)));
  const V a = sqrt(max(V(0.0f), V(0.5f) * (a2_plus_b2 + t0)));
  const V t1 = a2_plus_b2 + cos2;
  const V t2 = V(2.0f) * a * cos_i;
  const V perpendicular = (t1 - t2) / (t1 + t2);
  const V t3 = fma(cos2, a2_plus_b2, sin2 * sin2);
  const V t4 = t2 * sin2;
  const V parallel = perpendicular * (t3 - t4) / (t3 + t4);
  return V(0.5f) * (parallel + perpendicular);
}

// Of diffuse light that meets a dielectric's surface from inside: 1 - (1 - r) / eta^2, with r the
// cosine-weighted mean of Fresnel's formula outside (Egan and Hilgeman 1973). Slow: for tables.
// Where what it crosses on its way there and back is `thickness` mean free paths thick, only what
// arrives counts.
inline float inner_reflectance(float eta, float thickness = 0.0f) {
  constexpr int steps = 512;
  double outside = 0.0, lost = 0.0;
  for (int i = 0; i < steps; ++i) {
    const float cos_i = (float(i) + 0.5f) / steps;
    const double weight = 2.0 * double(cos_i) / steps;
    outside += weight * double(fresnel_dielectric(cos_i, eta));
    const double dimmed = -std::expm1(-2.0 * double(thickness) / double(cos_i));
    lost += weight * dimmed * double(fresnel_dielectric(cos_i, 1.0f / eta));
  }
  return float(1.0 - (1.0 - outside) / (double(eta) * double(eta)) - lost);
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
