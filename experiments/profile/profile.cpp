#include "experiments/profile/profile.h"

#include "experiments/metrics/metrics.h"
#include "experiments/output/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lockstep {
namespace {

constexpr int single_mode = index({Packets::Single, false});

using Show = std::function<bool(double, const std::string&)>;

SamplerSpec with_weight(SamplerSpec sampler, const ProfileWeight& weight) {
  sampler.weight_source = weight.map ? WeightSource::Map : WeightSource::Constant;
  sampler.weight = weight.weight;
  if (weight.map) {
    sampler.c = weight.map->c;
    sampler.t = weight.map->t;
  }
  return sampler;
}

// With the command that renders the image again, for messages.
RenderSettings named(RenderSettings render, const Scene& scene, const ProfileSettings& settings,
                     const SamplerSpec& sampler) {
  const FilmDescription& film = scene.description().film;
  render.scene_name = settings.scene;
  render.command =
      render_command(settings.scene, sampler, render, film.width, film.height, settings.overrides);
  return render;
}

std::optional<HardwareCounts> counts_of(HardwareCounters& counters, const Scene& scene,
                                        const SamplerSpec& sampler, RenderSettings render_settings,
                                        const Progress& progress) {
  if (!counters.unavailable().empty()) return {};
  render_settings.threads = 1;
  counters.start();
  render(scene, sampler, render_settings, progress);
  return counters.stop();
}

// The means of a weight's errors with `spp` samples per pixel.
ProfileErrors errors_with(const Scene& scene, const ProfileSettings& settings,
                          const ProfilePoint& point, const PreparedReference& reference, int spp,
                          const Progress& progress) {
  const SamplerSpec sampler = with_weight(settings.sampler, point.weight);
  RenderSettings render_settings = settings.render;
  render_settings.lanes = point.lanes;
  render_settings.spp = spp;
  ProfileErrors errors{spp, 0.0, std::vector<double>(metrics().size(), 0.0)};
  for (int seed = 0; seed < settings.seeds; ++seed) {
    render_settings.seed = settings.render.seed + std::uint32_t(seed);
    const RenderResult result =
        render(scene, sampler, named(render_settings, scene, settings, sampler), progress);
    const std::vector<double> values = evaluate(reference, result.image, "render").values;
    errors.cpu_seconds += result.stats.cpu_seconds / settings.seeds;
    for (std::size_t i = 0; i < values.size(); ++i) errors.values[i] += values[i] / settings.seeds;
  }
  return errors;
}

// Samples that take as long as the base's.
int equal_time_spp(const ProfilePoint& base, const ProfilePoint& point) {
  const double ratio = base.replay.render_seconds / point.replay.render_seconds;
  return std::max(1, int(std::lround(point.replay.stats.spp * ratio)));
}

void measure_errors(const Scene& scene, const ProfileSettings& settings, Profile& profile,
                    const Show& show) {
  RenderSettings render_settings = settings.render;
  render_settings.spp = settings.reference_spp;
  render_settings.seed = settings.render.seed + 0x5eed;
  render_settings.clamp.reset();  // the truth is not biased
  const SamplerSpec owen = parse_sampler("owen");
  render_settings = named(render_settings, scene, settings, owen);
  const auto progress_of_reference = [&](double share) { return show(0.5 * share, "reference"); };
  const Image image = render(scene, owen, render_settings, progress_of_reference).image;
  const PreparedReference reference = prepare_reference(image);
  const ProfilePoint& base = base_point(profile);
  for (std::size_t i = 0; i < settings.weights.size(); ++i) {
    const double before = 0.5 + 0.5 * double(i) / double(settings.weights.size());
    const std::string label = "errors, weight " + to_string(settings.weights[i]);
    const auto progress = [&](double) { return show(before, label); };
    const ProfilePoint& point = fastest_point(profile, settings.weights[i]);
    WeightErrors errors{point.weight, {}, {}};
    errors.equal_samples =
        errors_with(scene, settings, point, reference, settings.render.spp, progress);
    errors.equal_time =
        errors_with(scene, settings, point, reference, equal_time_spp(base, point), progress);
    profile.errors.push_back(std::move(errors));
  }
}

bool same(const ProfileWeight& a, const ProfileWeight& b) { return to_string(a) == to_string(b); }

// The same rays at the largest constant weight, where they are least coherent; null where there
// are none.
const ReplayClass* least_coherent(const Profile& profile, const ProfilePoint& point,
                                  const ReplayClass& c) {
  for (auto p = profile.points.rbegin(); p != profile.points.rend(); ++p) {
    if (p->weight.map || p->lanes != point.lanes) continue;
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
  const double single = rays_per_second(c, single_mode);
  fmt::format_to(std::back_inserter(out),
                 "{:<12} {:<8} {:<6} {:>6} {:>9.3f} {:>8.2f} {:>8.2f} {:>8.2f}  {:<18} {:>8.2f} "
                 "{:>6.2f} {:>7.3f} {:>9.1f}\n",
                 to_string(point.weight), to_string(point.lanes), name(c.kind), c.bounce,
                 1e-6 * double(c.rays), 1e-6 * single, 1e-6 * rays_per_second(c, best),
                 1e-6 * rays_per_second(c, policy_replay), replay_name(best),
                 base ? single / rays_per_second(*base, single_mode) : 1.0,
                 rays_per_second(c, best) / single, c.coherence.spread(), c.coherence.triangles);
}

void append_render(const ProfilePoint& point, std::string& out) {
  const Replay& r = point.replay;
  fmt::format_to(std::back_inserter(out), "{:<12} {:<8} {:>10.3f} {:>9.0f}% {:>9.0f}% {:>10.2f}\n",
                 to_string(point.weight), to_string(point.lanes),
                 1e-6 * double(r.stats.paths) / r.render_seconds,
                 100.0 * r.seconds(r.best_mode()) / r.render_seconds, 100.0 * r.policy_share(),
                 gain_over_single(r));
}

}  // namespace

std::string to_string(const ProfileWeight& weight) {
  if (weight.map) return fmt::format("c={:.4g} t={:.4g}", weight.map->c, weight.map->t);
  return fmt::format("{}", weight.weight);
}

Profile run_profile(const Scene& scene, const ProfileSettings& settings, const Show& progress) {
  // Errors take about as long as three points.
  const std::size_t points = settings.weights.size() * settings.layouts.size();
  const double all = double(points) + (settings.reference_spp > 0 ? 3.0 : 0.0);
  Profile profile;
  HardwareCounters counters;
  profile.no_counters = counters.unavailable();
  for (const ProfileWeight& weight : settings.weights) {
    for (const LaneLayout& lanes : settings.layouts) {
      const SamplerSpec sampler = with_weight(settings.sampler, weight);
      RenderSettings render_settings = settings.render;
      render_settings.lanes = lanes;
      render_settings = named(render_settings, scene, settings, sampler);
      const double before = double(profile.points.size());
      const std::string label =
          fmt::format("weight {}, lanes {}", to_string(weight), to_string(lanes));
      const auto show = [&](double share) { return progress((before + share) / all, label); };
      Replay rays = replay(scene, sampler, render_settings, settings.repeats, show);
      const auto keep_on = [&](double) { return show(1.0); };
      profile.points.push_back({weight, lanes, std::move(rays),
                                counts_of(counters, scene, sampler, render_settings, keep_on)});
    }
  }
  if (settings.reference_spp > 0) {
    measure_errors(scene, settings, profile, [&](double share, const std::string& label) {
      return progress((double(points) + 3.0 * share) / all, label);
    });
  }
  return profile;
}

const ProfilePoint& fastest_point(const Profile& profile, const ProfileWeight& weight) {
  const ProfilePoint* fastest = nullptr;
  for (const ProfilePoint& point : profile.points) {
    if (!same(point.weight, weight)) continue;
    if (!fastest || point.replay.render_seconds < fastest->replay.render_seconds) fastest = &point;
  }
  return *fastest;
}

const ProfilePoint& base_point(const Profile& profile) {
  const ProfilePoint* largest = &profile.points.front();
  for (const ProfilePoint& point : profile.points) {
    if (!point.weight.map) largest = &point;
  }
  return fastest_point(profile, largest->weight);
}

const char* name(RayKind kind) {
  constexpr const char* names[ray_kinds] = {"camera", "bounce", "shadow"};
  return names[int(kind)];
}

double rays_per_second(const ReplayClass& rays, int mode) {
  return double(rays.rays) / rays.seconds[mode];
}

double gain_over_single(const Replay& replay) {
  return replay.seconds(single_mode) / replay.seconds(policy_replay);
}

std::string profile_table(const Profile& profile) {
  std::string out = fmt::format(
      "Million rays per CPU second on the same rays. locality: single rays here over single rays\n"
      "at the largest weight. simd: the best fixed mode over single rays. spread: of the\n"
      "directions in a packet, 0 for parallel ones to 1; triangles: different ones that it "
      "hits.\n\n"
      "{:<12} {:<8} {:<6} {:>6} {:>9} {:>8} {:>8} {:>8}  {:<18} {:>8} {:>6} {:>7} {:>9}\n",
      "weight", "lanes", "rays", "bounce", "million", "single", "best", "auto", "best mode",
      "locality", "simd", "spread", "triangles");
  for (const ProfilePoint& p : profile.points) {
    for (const ReplayClass& c : p.replay.classes) append_class(profile, p, c, out);
  }
  fmt::format_to(
      std::back_inserter(out),
      "\nWhole renders, one thread. limit: traversal alone in its best single mode, as a "
      "share of the\nrender's CPU time. policy: time with the best mode for every kind "
      "and bounce over the time\nunder the measuring policy. gain: time of single rays over "
      "that under the policy.\n\n{:<12} {:<8} {:>10} {:>10} {:>10} {:>10}\n",
      "weight", "lanes", "Mpaths/s", "limit", "policy", "gain");
  for (const ProfilePoint& p : profile.points) append_render(p, out);
  if (!profile.no_counters.empty()) out += '\n' + profile.no_counters + '\n';
  return out;
}

}  // namespace lockstep
