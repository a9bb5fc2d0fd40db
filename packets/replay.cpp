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

bool is_measured(int mode) {
  return mode == policy_replay || traversal_mode(mode) != TraversalMode{Packets::Single, true};
}

// CPU seconds per class of one pass over the log: ticks, scaled to what the thread was charged.
std::vector<double> replay_once(const Scene& scene, const Kernel& kernel, const RayLog& log,
                                int mode, const std::vector<std::size_t>& class_of_queue,
                                std::size_t classes) {
  TraversalPolicy policy(mode == policy_replay ? std::nullopt : std::optional(traversal_mode(mode)),
                         default_width(kernel.isa));
  std::vector<std::uint64_t> ticks(log.queues.size());
  const double cpu = thread_cpu_seconds();
  const std::uint64_t start = read_ticks();
  kernel.replay(scene.data(), log, policy, ticks.data());
  const double seconds_per_tick =
      (thread_cpu_seconds() - cpu) / double(std::max<std::uint64_t>(read_ticks() - start, 1));
  std::vector<double> seconds(classes, 0.0);
  for (std::size_t q = 0; q < ticks.size(); ++q) {
    seconds[class_of_queue[q]] += double(ticks[q]) * seconds_per_tick;
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
  RayLog log;
  one.log = &log;
  Replay result;
  result.stats = render(scene, sampler, one).stats;
  one.log = nullptr;

  std::vector<std::size_t> class_of_queue;
  std::map<std::pair<RayKind, int>, std::size_t> known;
  for (const RayLog::Queue& q : log.queues) {
    const auto [entry, is_new] = known.try_emplace({q.kind, q.bounce}, result.classes.size());
    if (is_new) result.classes.push_back({q.kind, q.bounce, 0, {}});
    result.classes[entry->second].rays += std::uint64_t(q.count);
    class_of_queue.push_back(entry->second);
  }

  const Kernel& kernel = find_kernel(settings.isa, settings.width);
  std::vector<double> renders;
  std::vector<std::vector<double>> times(result.classes.size() * replay_modes);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    renders.push_back(render(scene, sampler, one).stats.cpu_seconds);
    for (int mode = 0; mode < replay_modes; ++mode) {
      if (!is_measured(mode)) continue;
      const auto seconds =
          replay_once(scene, kernel, log, mode, class_of_queue, result.classes.size());
      for (std::size_t c = 0; c < seconds.size(); ++c) {
        times[c * replay_modes + std::size_t(mode)].push_back(seconds[c]);
      }
      const double done = (repeat + double(mode + 1) / replay_modes) / repeats;
      if (progress && !progress(done)) throw Cancelled();
    }
  }
  for (std::size_t c = 0; c < result.classes.size(); ++c) {
    judge_policy(&times[c * replay_modes], result.classes[c]);
  }
  result.render_seconds = median(renders);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i].empty()) continue;
    result.classes[i / replay_modes].seconds[i % replay_modes] = median(times[i]);
  }
  return result;
}

}  // namespace lockstep
