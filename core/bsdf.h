// Reflection models. Each model is a struct in core/bsdf/ with three functions side by side:
//   eval(bsdf, wo, wi)          f cos and the pdf with which sample() gives wi
//   sample(bsdf, wo, lobe, u)   a direction, f cos / pdf, and its pdf
//   load_<model>(table, index)  the parameters of the lanes' materials
// Conventions: local shading frame with the normal along +z; wo and wi point away from the surface
// and both lie above it (wo.z > 0, else results are meaningless and masked by the caller); pdfs are
// per solid angle; f cos includes the cosine of wi.
#pragma once

#include "core/scene_data.h"
#include "core/vec.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

template <class V>
struct BsdfValue {
  Vec3<V> f_cos;
  V pdf;
};

// pdf = 0 marks a direction that carries nothing.
template <class V>
struct BsdfSample {
  Vec3<V> wi;
  Vec3<V> weight;  // f cos / pdf
  V pdf;
};

// Parameters `column` to `column` + 3 of the lanes' materials.
template <class I>
LOCKSTEP_INLINE Rows<FloatOf<I>> material_rows(const MaterialTable& t, I index, int column) {
  return gather_rows(t.parameters + column, index * I(material_stride));
}

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep

#include "core/bsdf/coated.h"
#include "core/bsdf/conductor.h"
#include "core/bsdf/diffuse.h"
