// Traversal on its own: the rays of a render traced again in every mode. It tells what the fastest
// possible render would cost, how good the policy's choices are, and, by single rays against
// packets on the same rays, how much of a gain is locality and how much is SIMD.
#pragma once

#include "packets/coherence.h"
#include "packets/render.h"

#include <vector>

namespace lockstep {

// Replays by mode: index(mode) for the fixed ones, then the policy.
inline constexpr int replay_modes = traversal_modes + 1;
inline constexpr int policy_replay = traversal_modes;

// "packet8" and the like; "auto" for the policy.
std::string replay_name(int mode);

// Rays of one kind and bounce, and the CPU seconds they take by mode; 0 where not measured.
struct ReplayClass {
  RayKind kind = RayKind::Camera;
  int bounce = 0;  // interactions before the ray
  std::uint64_t rays = 0;
  double seconds[replay_modes] = {};
  // Of the fixed mode that was fastest in every other repeat, and of the policy, both measured in
  // the repeats between: the minimum of noisy figures would flatter the fixed mode.
  double best_seconds = 0.0, policy_seconds = 0.0;
  TraversalMode policy_mode;  // that the policy has come to
  Coherence coherence;

  int best_mode() const;  // the fastest fixed one
};

// Medians over the repeats.
struct Replay {
  RenderStats stats;            // of the render whose rays these are
  double render_seconds = 0.0;  // CPU time of the whole render
  std::vector<ReplayClass> classes;

  double seconds(int mode) const;        // all rays in one mode
  int best_mode() const;                 // the one fixed mode that is fastest for all rays together
  double best_by_class_seconds() const;  // each class in its fastest fixed mode
  double policy_share() const;  // time in the best fixed mode of each class / under the policy
};

// Renders with one thread, whatever the settings say, then renders and replays in turn, `repeats`
// times each; modes take turns every few thousand rays. Keeps some 30 bytes per ray.
Replay replay(const Scene& scene, const SamplerSpec& sampler, const RenderSettings& settings,
              int repeats, const Progress& progress = {});

}  // namespace lockstep
