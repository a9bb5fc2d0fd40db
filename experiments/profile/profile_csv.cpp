#include "experiments/metrics/metrics.h"
#include "experiments/profile/profile.h"

#include <fmt/format.h>

#include <iterator>

namespace lockstep {
namespace {

std::string quoted(const std::string& text) {
  return text.find(',') == std::string::npos ? text : '"' + text + '"';
}

// scene,sampler,weight
std::string first_columns(const ProfileSettings& settings, const ProfileWeight& weight) {
  return fmt::format("{},{},{}", quoted(settings.scene), quoted(to_string(settings.sampler)),
                     to_string(weight));
}

std::string counts_columns(const std::optional<HardwareCounts>& counts) {
  if (!counts) return ",,";
  return fmt::format("{:.0f},{:.0f},{:.0f}", counts->cycles, counts->instructions,
                     counts->cache_misses);
}

std::string errors_row(const ProfileSettings& settings, const ProfileWeight& weight, const char* at,
                       const ProfileErrors& errors) {
  std::string row = fmt::format("{},{},{},{:.6g}", first_columns(settings, weight), at, errors.spp,
                                errors.cpu_seconds);
  for (const double value : errors.values) row += fmt::format(",{:.9g}", value);
  return row + '\n';
}

}  // namespace

std::string profile_csv(const Profile& profile, const ProfileSettings& settings) {
  std::string out =
      "scene,sampler,weight,lanes,kind,bounce,mode,rays,cpu_seconds,rays_per_cpu_second\n";
  for (const ProfilePoint& p : profile.points) {
    for (const ReplayClass& c : p.replay.classes) {
      for (int mode = 0; mode < replay_modes; ++mode) {
        if (c.seconds[mode] <= 0.0) continue;
        fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},{:.6g},{:.6g}\n",
                       first_columns(settings, p.weight), to_string(p.lanes), name(c.kind),
                       c.bounce, replay_name(mode), c.rays, c.seconds[mode],
                       rays_per_second(c, mode));
      }
    }
  }
  return out;
}

std::string profile_renders_csv(const Profile& profile, const ProfileSettings& settings) {
  std::string out =
      "scene,sampler,weight,lanes,spp,depth,width,isa,paths,cpu_seconds,paths_per_cpu_second,"
      "sampling_seconds,traversal_seconds,shading_seconds,film_seconds,limit_share,policy_share,"
      "gain_over_single,mean_weight,cycles,instructions,cache_misses\n";
  for (const ProfilePoint& p : profile.points) {
    const Replay& r = p.replay;
    const double* stage = r.stats.stage_seconds;
    fmt::format_to(std::back_inserter(out),
                   "{},{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.4f},{:.4f},"
                   "{:.4f},{:.4f},{}\n",
                   first_columns(settings, p.weight), to_string(p.lanes), r.stats.spp,
                   settings.render.depth, r.stats.width, name(settings.render.isa), r.stats.paths,
                   r.render_seconds, double(r.stats.paths) / r.render_seconds,
                   stage[int(Stage::Sampling)], stage[int(Stage::Traversal)],
                   stage[int(Stage::Shading)], stage[int(Stage::Film)],
                   r.seconds(r.best_mode()) / r.render_seconds, r.policy_share(),
                   gain_over_single(r), r.stats.mean_weight, counts_columns(p.counts));
  }
  return out;
}

std::string profile_coherence_csv(const Profile& profile, const ProfileSettings& settings) {
  std::string out =
      "scene,sampler,weight,lanes,kind,bounce,rays,lanes_active,direction_spread,triangles,"
      "materials,best_mode,policy_mode\n";
  for (const ProfilePoint& p : profile.points) {
    for (const ReplayClass& c : p.replay.classes) {
      fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{:.4f},{:.6f},{:.4f},{:.4f},{},{}\n",
                     first_columns(settings, p.weight), to_string(p.lanes), name(c.kind), c.bounce,
                     c.rays, c.coherence.lanes_active, c.coherence.spread(), c.coherence.triangles,
                     c.coherence.materials, replay_name(c.best_mode()), to_string(c.policy_mode));
    }
  }
  return out;
}

std::string profile_errors_csv(const Profile& profile, const ProfileSettings& settings) {
  std::string out = "scene,sampler,weight,at,spp,cpu_seconds";
  for (const Metric& metric : metrics()) out += fmt::format(",{}", metric.name);
  out += '\n';
  for (const WeightErrors& errors : profile.errors) {
    out += errors_row(settings, errors.weight, "equal_samples", errors.equal_samples);
    out += errors_row(settings, errors.weight, "equal_time", errors.equal_time);
  }
  return out;
}

}  // namespace lockstep
