// Profiles of coherence against weight: how fast the rays of a render are traced, by kind, bounce
// and traversal mode, as a weight lets pixels leave their shared sequence.
//
// Two gains are told apart. Locality: rays that stay together are traced faster even one by one.
// SIMD: packets on the same rays are faster than single rays.
#pragma once

#include "packets/replay.h"

#include <functional>
#include <string>
#include <vector>

namespace lockstep {

struct ProfileSettings {
  std::string scene;
  SamplerSpec sampler;         // its weight is what varies
  std::vector<float> weights;  // ascending, each in [0, 1]
  std::vector<LaneLayout> layouts;
  RenderSettings render;
  int repeats = 5;
};

// One weight and lane layout.
struct ProfilePoint {
  float weight = 0.0f;
  LaneLayout lanes;
  Replay replay;
};

using Profile = std::vector<ProfilePoint>;

// Progress: share done, and what is being measured. Returning false stops it (throws Cancelled).
Profile run_profile(const Scene& scene, const ProfileSettings& settings,
                    const std::function<bool(double, const std::string&)>& progress);

// A row for each weight, layout, kind of ray, bounce and mode:
// scene,sampler,weight,lanes,kind,bounce,mode,rays,cpu_seconds,rays_per_cpu_second
std::string profile_csv(const Profile& profile, const ProfileSettings& settings);

// A row for each weight and layout, with what whole renders cost:
// scene,sampler,weight,lanes,spp,depth,width,isa,paths,cpu_seconds,paths_per_cpu_second,
// sampling_seconds,traversal_seconds,shading_seconds,film_seconds,limit_share,policy_share,
// gain_over_single
std::string profile_renders_csv(const Profile& profile, const ProfileSettings& settings);

// What both tell, for the terminal.
std::string profile_table(const Profile& profile);

}  // namespace lockstep
