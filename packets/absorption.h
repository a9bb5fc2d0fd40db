// Light lost inside dielectrics, by Beer and Lambert's law.
#pragma once

#include "core/simd_exp.h"
#include "packets/wave.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// What passes through `distance` of the dielectrics that are the lanes' media; 1 without one.
template <class V>
LOCKSTEP_INLINE Vec3<V> transmittance(const SceneData& scene, IntOf<V> medium, V distance) {
  using I = IntOf<V>;
  constexpr int absorption_column = 10;
  const MaskOf<V> inside = !(medium < I(0));
  if (none(inside)) return Vec3<V>(V(1.0f));
  const auto row = gather_rows(scene.materials.parameters + absorption_column,
                               select(inside, medium, I(0)) * I(material_stride));
  // Nothing is lost where nothing is absorbed, however far it goes.
  const auto passed = [&](V absorption) LOCKSTEP_LAMBDA {
    const MaskOf<V> absorbs = inside & (absorption > V(0.0f));
    return exp(-select(absorbs, absorption * distance, V(0.0f)));
  };
  return {passed(row.x), passed(row.y), passed(row.z)};
}

// Dims the rays by what they crossed on the way to their hits.
template <int W>
[[gnu::noinline]] void absorb_on_the_way(const SceneData& scene, const HitArray& hits,
                                         RayQueue& rays) {
  using V = Float<W>;
  for (int i = 0; i < rays.count; i += W) {
    const Int<W> medium = load<Int<W>>(rays.medium + i);
    const Vec3<V> passed = transmittance(scene, medium, load<V>(hits.distance + i));
    store3(rays.throughput, i, load3<V>(rays.throughput, i) * passed);
  }
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
