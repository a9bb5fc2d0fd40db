// Traversal: queues of rays through Embree. The only place that calls it. Compiled once per
// instruction set; packets of any width are filled from the queues whatever width kernels have.
#pragma once

#include "packets/wave.h"

namespace lockstep {
inline namespace LOCKSTEP_ISA_NAMESPACE {

// The closest hits of rays [begin, end) of the queue.
void trace_closest(const SceneData& scene, TraversalMode mode, const RayQueue& rays, int begin,
                   int end, HitArray& hits);

// Whether shadow rays [begin, end) reach their lights: where something is in the way, distance
// becomes -infinity.
void trace_occluded(const SceneData& scene, TraversalMode mode, ShadowQueue& shadows, int begin,
                    int end);

// The whole queue, as the policy says; counted by kind and mode.
void trace_closest(const SceneData& scene, TraversalPolicy& policy, RayKind kind, int bounce,
                   const RayQueue& rays, HitArray& hits, TileCounts& counts);
void trace_occluded(const SceneData& scene, TraversalPolicy& policy, int bounce,
                    ShadowQueue& shadows, TileCounts& counts);

// See Kernel.
void replay(const SceneData& scene, const RayLog& log, QueueRange queues, TraversalPolicy& policy,
            std::uint64_t* ticks);

}  // namespace LOCKSTEP_ISA_NAMESPACE
}  // namespace lockstep
