// Profiles of coherence against weight: how fast the rays of a render are traced, by kind, bounce
// and traversal mode, as a weight lets pixels leave their shared sequence, and what that does to
// the image.
//
// Two gains are told apart. Locality: rays that stay together are traced faster even one by one.
// SIMD: packets on the same rays are faster than single rays.
#pragma once

#include "core/image.h"
#include "experiments/profile/hardware_counters.h"
#include "packets/replay.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lockstep {

// How far pixels may leave their shared sequence: one weight for all, or the map of a pilot.
struct ProfileWeight {
  struct Map {
    float c = 4.0f;
    float t = 0.02f;
  };
  float weight = 1.0f;  // for all pixels, where there is no map
  std::optional<Map>
      map;  // min(1, c d) where the pilot's relative difference d is t or more, else 0
};

// "0.125", "c=4 t=0.02".
std::string to_string(const ProfileWeight& weight);

struct ProfileSettings {
  std::string scene;
  SamplerSpec sampler;                 // its weight is what varies
  std::vector<ProfileWeight> weights;  // constant ones first, ascending, each in [0, 1]
  std::vector<LaneLayout> layouts;
  RenderSettings render;
  Metadata overrides;  // of the scene: see override_metadata()
  int repeats = 5;
  int reference_spp = 0;  // of the image that errors are measured against; 0: no errors
  int seeds = 3;          // renders that errors are means of
};

// One weight and lane layout.
struct ProfilePoint {
  ProfileWeight weight;
  LaneLayout lanes;
  Replay replay;
  std::optional<HardwareCounts> counts;  // of a whole render with one thread
};

// Means over seeds.
struct ProfileErrors {
  int spp = 0;
  double cpu_seconds = 0.0;
  std::vector<double> values;  // in the order of metrics()
};

// One weight, in its fastest layout: with the profile's samples, and with those that take the CPU
// time of the base, the largest constant weight.
struct WeightErrors {
  ProfileWeight weight;
  ProfileErrors equal_samples, equal_time;
};

struct Profile {
  std::vector<ProfilePoint> points;
  std::vector<WeightErrors> errors;  // none where there is no reference
  std::string no_counters;           // why hardware counters are missing; empty where they are not
};

// Progress: share done, and what is being measured. Returning false stops it (throws Cancelled).
Profile run_profile(const Scene& scene, const ProfileSettings& settings,
                    const std::function<bool(double, const std::string&)>& progress);

// The largest constant weight in its fastest layout, which others are compared with.
const ProfilePoint& base_point(const Profile& profile);
// The point of `weight` in its fastest layout.
const ProfilePoint& fastest_point(const Profile& profile, const ProfileWeight& weight);

// "camera", "bounce", "shadow".
const char* name(RayKind kind);
double rays_per_second(const ReplayClass& rays, int mode);
// CPU time of all rays one by one over that under the policy.
double gain_over_single(const Replay& replay);

// A row for each weight, layout, kind of ray, bounce and mode:
// scene,sampler,weight,lanes,kind,bounce,mode,rays,cpu_seconds,rays_per_cpu_second
// The weight of a map is its text.
std::string profile_csv(const Profile& profile, const ProfileSettings& settings);

// A row for each weight and layout, with what whole renders cost:
// scene,sampler,weight,lanes,spp,depth,width,isa,paths,cpu_seconds,paths_per_cpu_second,
// sampling_seconds,traversal_seconds,shading_seconds,film_seconds,limit_share,policy_share,
// gain_over_single,mean_weight,cycles,instructions,cache_misses (empty where not counted)
std::string profile_renders_csv(const Profile& profile, const ProfileSettings& settings);

// A row for each weight, layout, kind of ray and bounce, with means over packets of 16 rays:
// scene,sampler,weight,lanes,kind,bounce,rays,lanes_active,direction_spread,triangles,materials,
// best_mode,policy_mode
std::string profile_coherence_csv(const Profile& profile, const ProfileSettings& settings);

// Two rows for each weight: scene,sampler,weight,at,spp,cpu_seconds, then the metrics; `at` is
// equal_samples or equal_time.
std::string profile_errors_csv(const Profile& profile, const ProfileSettings& settings);

// What they tell, for the terminal.
std::string profile_table(const Profile& profile);

}  // namespace lockstep
