// All perturbations. To add one, write its file (constant.h is an example) and name it here.
#pragma once

#include "samplers/perturbations/blue_noise.h"
#include "samplers/perturbations/constant.h"
#include "samplers/perturbations/fresh.h"
#include "samplers/perturbations/morton.h"
#include "samplers/perturbations/none.h"
#include "samplers/type_list.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

using Perturbations =
    TypeList<NoOffset, FreshOffset, ConstantOffset, BlueNoiseOffset, MortonOffset>;

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
