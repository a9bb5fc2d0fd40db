// Branching coral: a control mesh grown face by face, for Loop subdivision.
#pragma once

#include "core/mesh.h"

namespace lockstep::builtin {

struct BranchStyle {
  float length = 1.0f;   // of the first branches
  float radius = 0.3f;   // of their control prisms; subdivision takes about a third off
  float shrink = 0.72f;  // length and radius from one generation to the next
  float spread = 0.7f;   // how far children lean away from their parent: 0 not, 1 by 45 degrees
  int generations = 3;
  unsigned seed = 0;
};

// Grows from an icosahedron at the origin, upwards; closed and manifold.
TriangleMesh branches(const BranchStyle& style);

}  // namespace lockstep::builtin
