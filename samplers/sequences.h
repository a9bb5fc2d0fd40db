// All sequences. To add one, write its file (random.h is the shortest) and name it here: it then is
// a sampler of that name, an option of all others, and in the tests that go over all sequences.
#pragma once

#include "samplers/sequences/halton.h"
#include "samplers/sequences/lattice.h"
#include "samplers/sequences/linked.h"
#include "samplers/sequences/owen.h"
#include "samplers/sequences/pmj02.h"
#include "samplers/sequences/random.h"
#include "samplers/sequences/sobol.h"
#include "samplers/sequences/stratified.h"
#include "samplers/sequences/zsobol.h"
#include "samplers/type_list.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

using Sequences =
    TypeList<RandomSequence, StratifiedSequence, OwenSequence, SobolSequence, Pmj02Sequence,
             HaltonSequence, LatticeSequence, LinkedSequence, ZSobolSequence>;

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
