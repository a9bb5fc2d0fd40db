#include "experiments/profile.h"

#include <fmt/format.h>

#include <iterator>

namespace lockstep {
namespace {

constexpr const char* kind_names[ray_kinds] = {"camera", "bounce", "shadow"};
constexpr int single_mode = index({Packets::Single, false});

std::string quoted(const std::string& text) {
  return text.find(',') == std::string::npos ? text : '"' + text + '"';
}

double rate(const ReplayClass& c, int mode) { return double(c.rays) / c.seconds[mode]; }

// The same rays at the largest weight, where they are least coherent; null where there are none.
const ReplayClass* least_coherent(const Profile& profile, const ProfilePoint& point,
                                  const ReplayClass& c) {
  for (auto p = profile.rbegin(); p != profile.rend(); ++p) {
    if (p->lanes != point.lanes) continue;
    for (const ReplayClass& other : p->replay.classes) {
      if (other.kind == c.kind && other.bounce == c.bounce) return &other;
    }
  }
  return nullptr;
}

void append_class(const Profile& profile, const ProfilePoint& point, const ReplayClass& c,
                  std::string& out) {
  const int best = c.best_mode();
  const ReplayClass* base = least_coherent(profile, point, c);
  fmt::format_to(std::back_inserter(out),
                 "{:<8.4g} {:<8} {:<6} {:>6} {:>9.3f} {:>8.2f} {:>8.2f} {:>8.2f}  {:<18} {:>8.2f} "
                 "{:>6.2f}\n",
                 point.weight, to_string(point.lanes), kind_names[int(c.kind)], c.bounce,
                 1e-6 * double(c.rays), 1e-6 * rate(c, single_mode), 1e-6 * rate(c, best),
                 1e-6 * rate(c, policy_replay), replay_name(best),
                 base ? rate(c, single_mode) / rate(*base, single_mode) : 1.0,
                 rate(c, best) / rate(c, single_mode));
}

void append_render(const ProfilePoint& point, std::string& out) {
  const Replay& r = point.replay;
  fmt::format_to(std::back_inserter(out),
                 "{:<8.4g} {:<8} {:>10.3f} {:>9.0f}% {:>9.0f}% {:>10.2f}\n", point.weight,
                 to_string(point.lanes), 1e-6 * double(r.stats.paths) / r.render_seconds,
                 100.0 * r.seconds(r.best_mode()) / r.render_seconds, 100.0 * r.policy_share(),
                 r.seconds(single_mode) / r.seconds(policy_replay));
}

}  // namespace

Profile run_profile(const Scene& scene, const ProfileSettings& settings,
                    const std::function<bool(double, const std::string&)>& progress) {
  Profile profile;
  const std::size_t points = settings.weights.size() * settings.layouts.size();
  for (const float weight : settings.weights) {
    for (const LaneLayout& lanes : settings.layouts) {
      SamplerSpec sampler = settings.sampler;
      sampler.weight_source = WeightSource::Constant;
      sampler.weight = weight;
      RenderSettings render = settings.render;
      render.lanes = lanes;
      const double before = double(profile.size());
      const std::string label = fmt::format("weight {:.4g}, lanes {}", weight, to_string(lanes));
      const auto show = [&](double share) {
        return progress((before + share) / double(points), label);
      };
      profile.push_back({weight, lanes, replay(scene, sampler, render, settings.repeats, show)});
    }
  }
  return profile;
}

std::string profile_csv(const Profile& profile, const ProfileSettings& settings) {
  std::string out =
      "scene,sampler,weight,lanes,kind,bounce,mode,rays,cpu_seconds,"
      "rays_per_cpu_second\n";
  for (const ProfilePoint& p : profile) {
    for (const ReplayClass& c : p.replay.classes) {
      for (int mode = 0; mode < replay_modes; ++mode) {
        if (c.seconds[mode] <= 0.0) continue;
        fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},{},{},{:.6g},{:.6g}\n",
                       quoted(settings.scene), quoted(to_string(settings.sampler)), p.weight,
                       to_string(p.lanes), kind_names[int(c.kind)], c.bounce, replay_name(mode),
                       c.rays, c.seconds[mode], rate(c, mode));
      }
    }
  }
  return out;
}

std::string profile_renders_csv(const Profile& profile, const ProfileSettings& settings) {
  std::string out =
      "scene,sampler,weight,lanes,spp,depth,width,isa,paths,cpu_seconds,"
      "paths_per_cpu_second,sampling_seconds,traversal_seconds,shading_seconds,"
      "film_seconds,limit_share,policy_share,gain_over_single\n";
  for (const ProfilePoint& p : profile) {
    const Replay& r = p.replay;
    const double* stage = r.stats.stage_seconds;
    fmt::format_to(std::back_inserter(out),
                   "{},{},{},{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.4f},{:."
                   "4f},{:.4f}\n",
                   quoted(settings.scene), quoted(to_string(settings.sampler)), p.weight,
                   to_string(p.lanes), r.stats.spp, settings.render.depth, r.stats.width,
                   name(settings.render.isa), r.stats.paths, r.render_seconds,
                   double(r.stats.paths) / r.render_seconds, stage[int(Stage::Sampling)],
                   stage[int(Stage::Traversal)], stage[int(Stage::Shading)],
                   stage[int(Stage::Film)], r.seconds(r.best_mode()) / r.render_seconds,
                   r.policy_share(), r.seconds(single_mode) / r.seconds(policy_replay));
  }
  return out;
}

std::string profile_table(const Profile& profile) {
  std::string out = fmt::format(
      "Million rays per CPU second on the same rays. locality: single rays here over single rays\n"
      "at the largest weight. simd: the best fixed mode over single rays.\n\n"
      "{:<8} {:<8} {:<6} {:>6} {:>9} {:>8} {:>8} {:>8}  {:<18} {:>8} {:>6}\n",
      "weight", "lanes", "rays", "bounce", "million", "single", "best", "auto", "best mode",
      "locality", "simd");
  for (const ProfilePoint& p : profile) {
    for (const ReplayClass& c : p.replay.classes) append_class(profile, p, c, out);
  }
  fmt::format_to(
      std::back_inserter(out),
      "\nWhole renders, one thread. limit: traversal alone in its best single mode, as a "
      "share of the\nrender's CPU time. policy: time with the best mode for every kind "
      "and bounce over the time\nunder the measuring policy. gain: time of single rays over "
      "that under the policy.\n\n{:<8} {:<8} {:>10} {:>10} {:>10} {:>10}\n",
      "weight", "lanes", "Mpaths/s", "limit", "policy", "gain");
  for (const ProfilePoint& p : profile) append_render(p, out);
  return out;
}

}  // namespace lockstep
