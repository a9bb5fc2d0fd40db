#include "packets/replay.h"

#include "core/cpu_clock.h"
#include "packets/kernel.h"
#include "packets/ray_log.h"

#include <algorithm>
#include <map>

namespace lockstep {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct ClassifiedLog {
  RayLog rays;
  std::vector<ReplayClass> classes;         // in order of appearance, without times
  std::vector<std::size_t> class_of_queue;  // index in classes
};

void classify(ClassifiedLog& log) {
  std::map<std::pair<RayKind, int>, std::size_t> known;
  for (const RayLog::Queue& q : log.rays.queues) {
    const auto [entry, is_new] = known.try_emplace({q.kind, q.bounce}, log.classes.size());
    if (is_new) {
      log.classes.emplace_back();
      log.classes.back().kind = q.kind;
      log.classes.back().bounce = q.bounce;
    }
    log.classes[entry->second].rays += std::uint64_t(q.count);
    log.class_of_queue.push_back(entry->second);
  }
}

bool is_measured(int mode) {
  return mode == policy_replay || traversal_mode(mode) != TraversalMode{Packets::Single, true};
}

// Modes take turns after each block, so that a machine that is slow for a while slows them all.
constexpr std::size_t block_queues = 32;

// By class and mode: entry class * replay_modes + mode.
using Seconds = std::vector<double>;

// Adds the CPU seconds of one block in one mode: ticks, scaled to what the thread was charged.
void replay_block(const Scene& scene, const Kernel& kernel, const ClassifiedLog& log,
                  QueueRange block, int mode, TraversalPolicy& policy, Seconds& seconds) {
  std::uint64_t ticks[block_queues];
  const double cpu = thread_cpu_seconds();
  const std::uint64_t start = read_ticks();
  kernel.replay(scene.data(), log.rays, block, policy, ticks);
  const double seconds_per_tick =
      (thread_cpu_seconds() - cpu) / double(std::max<std::uint64_t>(read_ticks() - start, 1));
  for (std::size_t q = block.begin; q < block.end; ++q) {
    seconds[log.class_of_queue[q] * replay_modes + std::size_t(mode)] +=
        double(ticks[q - block.begin]) * seconds_per_tick;
  }
}

std::vector<TraversalPolicy> policies_by_mode(int width) {
  std::vector<TraversalPolicy> policies;
  for (int mode = 0; mode < replay_modes; ++mode) {
    policies.emplace_back(
        mode == policy_replay ? std::nullopt : std::optional(traversal_mode(mode)), width);
  }
  return policies;
}

// All rays once in every mode, with a policy for each. `progress` gets a share.
Seconds replay_all(const Scene& scene, const Kernel& kernel, const ClassifiedLog& log,
                   std::vector<TraversalPolicy>& policies, const Progress& progress) {
  Seconds seconds(log.classes.size() * replay_modes, 0.0);
  const std::size_t queues = log.rays.queues.size();
  for (std::size_t begin = 0; begin < queues; begin += block_queues) {
    const QueueRange block{begin, std::min(begin + block_queues, queues)};
    for (int turn = 0; turn < replay_modes; ++turn) {
      const int mode = int((std::size_t(turn) + begin / block_queues) % replay_modes);
      if (!is_measured(mode)) continue;
      replay_block(scene, kernel, log, block, mode, policies[std::size_t(mode)], seconds);
    }
    if (progress && !progress(double(block.end) / double(queues))) throw Cancelled();
  }
  return seconds;
}

// Every second value from `first` on; all where there is only one.
double median_of_half(const std::vector<double>& values, std::size_t first) {
  if (values.size() < 2) return median(values);
  std::vector<double> half;
  for (std::size_t i = first; i < values.size(); i += 2) half.push_back(values[i]);
  return median(half);
}

// `times` of the class by mode, a value for each repeat.
void judge_policy(const std::vector<double>* times, ReplayClass& c) {
  int best = 0;
  for (int mode = 1; mode < traversal_modes; ++mode) {
    if (!is_measured(mode)) continue;
    if (median_of_half(times[mode], 0) < median_of_half(times[best], 0)) best = mode;
  }
  c.best_seconds = median_of_half(times[best], 1);
  c.policy_seconds = median_of_half(times[policy_replay], 1);
}

}  // namespace

std::string replay_name(int mode) {
  return mode == policy_replay ? "auto" : to_string(traversal_mode(mode));
}

int ReplayClass::best_mode() const {
  int best = 0;
  for (int mode = 1; mode < traversal_modes; ++mode) {
    if (seconds[mode] > 0.0 && seconds[mode] < seconds[best]) best = mode;
  }
  return best;
}

double Replay::seconds(int mode) const {
  double sum = 0.0;
  for (const ReplayClass& c : classes) sum += c.seconds[mode];
  return sum;
}

int Replay::best_mode() const {
  int best = 0;
  for (int mode = 1; mode < traversal_modes; ++mode) {
    if (is_measured(mode) && seconds(mode) < seconds(best)) best = mode;
  }
  return best;
}

double Replay::best_by_class_seconds() const {
  double sum = 0.0;
  for (const ReplayClass& c : classes) sum += c.seconds[c.best_mode()];
  return sum;
}

double Replay::policy_share() const {
  double best = 0.0, policy = 0.0;
  for (const ReplayClass& c : classes) {
    best += c.best_seconds;
    policy += c.policy_seconds;
  }
  return best / policy;
}

Replay replay(const Scene& scene, const SamplerSpec& sampler, const RenderSettings& settings,
              int repeats, const Progress& progress) {
  RenderSettings one = settings;
  one.threads = 1;
  ClassifiedLog log;
  one.log = &log.rays;
  Replay result;
  result.stats = render(scene, sampler, one).stats;
  one.log = nullptr;
  classify(log);
  result.classes = log.classes;

  const Kernel& kernel = find_kernel(settings.isa, settings.width);
  std::vector<TraversalPolicy> policies;
  std::vector<double> renders;
  std::vector<std::vector<double>> times(result.classes.size() * replay_modes);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    renders.push_back(render(scene, sampler, one).stats.cpu_seconds);
    const auto show = [&](double share) {
      return !progress || progress((repeat + share) / repeats);
    };
    // The policy learns from the beginning.
    policies = policies_by_mode(default_width(kernel.isa));
    const Seconds seconds = replay_all(scene, kernel, log, policies, show);
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      if (is_measured(int(i % replay_modes))) times[i].push_back(seconds[i]);
    }
  }
  const std::vector<Coherence> coherence =
      coherence_of(scene.data(), log.rays, log.class_of_queue, log.classes.size());
  for (std::size_t i = 0; i < result.classes.size(); ++i) {
    ReplayClass& c = result.classes[i];
    judge_policy(&times[i * replay_modes], c);
    c.coherence = coherence[i];
    const int spread = spread_class(float(coherence[i].cosine));
    c.policy_mode = policies[policy_replay].plan({c.kind, c.bounce, spread}, 1).mode;
  }
  result.render_seconds = median(renders);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i].empty()) continue;
    result.classes[i / replay_modes].seconds[i % replay_modes] = median(times[i]);
  }
  return result;
}

}  // namespace lockstep
