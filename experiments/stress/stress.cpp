// Runs the battery and judges it.
#include "experiments/stress/stress.h"

#include "core/scene.h"
#include "core/scene_warnings.h"
#include "experiments/compare/statistics.h"
#include "experiments/output/command_line.h"
#include "experiments/output/machine.h"
#include "experiments/output/progress.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

namespace lockstep {
namespace {

constexpr double kWidest = 0.5;     // of what is expected: a wider interval says nothing
constexpr double kFirefly = 100.0;  // times what is expected
constexpr std::size_t kBadKept = 8;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double mean_of_all(const Image& image) {
  double sum = 0.0;
  for (const float x : image.pixels) sum += double(x);
  return sum / double(image.pixels.size());
}

bool same_bytes(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

std::uint64_t count_fireflies(const Image& image, double expected) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i + 2 < image.pixels.size(); i += 3) {
    const float brightest = std::max({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
    if (double(brightest) > kFirefly * std::abs(expected)) ++count;
  }
  return count;
}

bool all_finite(const Image& image) {
  return std::all_of(image.pixels.begin(), image.pixels.end(),
                     [](float x) { return std::isfinite(x); });
}

struct MeanAndError {
  double mean = 0.0, error = 0.0;
};

MeanAndError mean_and_error(const std::vector<double>& values) {
  const double n = double(values.size());
  MeanAndError m;
  for (const double x : values) m.mean += x / n;
  if (values.size() < 2) return m;
  double squares = 0.0;
  for (const double x : values) squares += (x - m.mean) * (x - m.mean);
  m.error = std::sqrt(squares / (n - 1.0) / n);
  return m;
}

// The images of one sampler at the first width, by seed: those of the others have the same bits.
using Images = std::vector<Image>;

// Renders of one case with one sampler, at one width after the other.
class SceneRun {
 public:
  SceneRun(const std::string& case_name, const StressScene& test, const Scene& scene,
           std::string sampler, std::string warning, const StressPlan& plan, double reach)
      : case_(case_name),
        test_(test),
        scene_(scene),
        sampler_(std::move(sampler)),
        warning_(std::move(warning)),
        plan_(plan),
        reach_(reach) {}

  StressRow run(int width) {
    const auto start = std::chrono::steady_clock::now();
    StressRow row;
    row.width = width, row.sampler = sampler_, row.expected = test_.expected;
    std::vector<double> values;
    const bool first = images_.empty();
    const int seeds = first || !plan_.quick ? plan_.seeds : 1;
    for (int seed = 0; seed < seeds && !interrupted(); ++seed) {
      values.push_back(render_seed(width, seed, first, row));
    }
    judge(values, first || !plan_.quick, row);
    row.seconds = seconds_since(start);
    return row;
  }

  const Images& images() const { return images_; }

 private:
  double render_seed(int width, int seed, bool first, StressRow& row) {
    RenderSettings s;
    s.seed = std::uint32_t(seed);
    s.spp = test_.spp, s.depth = test_.depth, s.roulette_depth = test_.roulette_depth;
    s.threads = 1;
    s.width = width;
    s.scene_name = case_;
    s.command = "lockstep stress -o again --case " + shell_quoted(case_);
    RenderResult r = render(scene_, parse_sampler(sampler_), s);
    row.nonfinite += r.stats.nonfinite;
    for (const BadSample& bad : r.stats.bad_samples) {
      if (row.bad.size() < kBadKept) row.bad.push_back({bad, s.seed});
    }
    row.fireflies += count_fireflies(r.image, test_.expected);
    if (!all_finite(r.image)) row.message = fmt::format("NaN or infinity in seed {}'s image", seed);
    const double value = test_.measure ? test_.measure(r.image) : mean_of_all(r.image);
    if (first) {
      images_.push_back(std::move(r.image));
    } else if (!same_bytes(images_[std::size_t(seed)], r.image)) {
      row.message = fmt::format("seed {}'s image is not that of width {}, bit for bit", seed,
                                plan_.widths[0]);
    }
    return value;
  }

  void judge(const std::vector<double>& values, bool all_seeds, StressRow& row) const {
    const MeanAndError m = mean_and_error(values);
    row.got = m.mean, row.standard_error = m.error;
    const double size = test_.expected == 0.0 ? 1.0 : std::abs(test_.expected);
    row.tolerance = (m.error > 0.0 ? reach_ * m.error : 0.0) + test_.rounding * size;
    row.judged = all_seeds;
    if (!row.message.empty()) return;
    row.verdict = all_seeds ? judge_mean(test_.expected, m.mean, m.error, reach_, test_.rounding)
                            : StressVerdict::Right;  // the bits are those of a width that is judged
    if (row.nonfinite > 0) {
      row.message =
          fmt::format("{} samples were not finite and were left out of the image", row.nonfinite);
      row.verdict = test_.overflows ? StressVerdict::Unsupported : StressVerdict::Wrong;
    } else if (row.verdict == StressVerdict::Wrong) {
      row.message = warning_.empty() ? "not the expected value" : warning_;
      if (!warning_.empty()) row.verdict = StressVerdict::Unsupported;
    } else if (row.verdict == StressVerdict::Vague) {
      row.message = "the interval is too wide to tell";
    }
  }

  const std::string& case_;
  const StressScene& test_;
  const Scene& scene_;
  std::string sampler_, warning_;
  const StressPlan& plan_;
  double reach_;
  Images images_;
};

const std::vector<std::string>& samplers_of(const StressScene& test, const StressPlan& plan) {
  return test.samplers.empty() ? plan.samplers : test.samplers;
}

void run_scene(const StressScene& test, const StressPlan& plan, double reach,
               StressResult& result) {
  SceneDescription description = test.make(plan.folder);
  const std::string warning = precision_warning(description);
  const Scene scene(std::move(description), embree_isa(choose_isa()));
  for (const std::string& sampler : samplers_of(test, plan)) {
    SceneRun run(result.tested.name, test, scene, sampler, warning, plan, reach);
    for (const int width : plan.widths) {
      if (!interrupted()) result.rows.push_back(run.run(width));
    }
    if (!run.images().empty()) result.pictures.push_back({sampler, run.images()[0]});
  }
}

StressRow row_of(const StressFinding& f) {
  StressRow row;
  row.expected = f.expected, row.got = f.got, row.tolerance = f.tolerance;
  const double above = f.got - f.expected;
  const bool right = f.at_most ? above <= f.tolerance : std::abs(above) <= f.tolerance;
  row.verdict = !right              ? StressVerdict::Wrong
                : f.refusal.empty() ? StressVerdict::Right
                                    : StressVerdict::Unsupported;
  row.message = !right ? "not the expected value" : f.refusal;
  return row;
}

void run_computation(const StressComputation& test, const StressPlan& plan, StressResult& result) {
  const std::vector<int> widths = test.every_width ? plan.widths : std::vector<int>{0};
  const std::vector<std::string> samplers =
      test.every_sampler ? plan.samplers : std::vector<std::string>{""};
  for (const std::string& sampler : samplers) {
    for (const int width : widths) {
      if (interrupted()) return;
      const auto start = std::chrono::steady_clock::now();
      const SamplerSpec spec = sampler.empty() ? SamplerSpec() : parse_sampler(sampler);
      StressRow row = row_of(test.run({std::max(width, 1), spec, plan.folder}));
      row.width = width, row.sampler = sampler;
      row.seconds = seconds_since(start);
      result.rows.push_back(std::move(row));
    }
  }
}

StressResult run_case(const StressCase& tested, const StressPlan& plan, double reach) {
  const auto start = std::chrono::steady_clock::now();
  StressResult result{tested, {}, {}, 0.0};
  try {
    if (const auto* scene = std::get_if<StressScene>(&tested.test)) {
      run_scene(*scene, plan, reach, result);
    } else {
      run_computation(std::get<StressComputation>(tested.test), plan, result);
    }
  } catch (const std::exception& error) {
    StressRow row;
    row.message = error.what();
    result.rows.push_back(row);
  }
  result.seconds = seconds_since(start);
  return result;
}

// Bonferroni: what each of the tests by chance may spend. Widths repeat each other's bits.
double level_of_each(const std::vector<StressCase>& cases, const StressPlan& plan) {
  std::size_t tests = 0;
  for (const StressCase& c : cases) {
    if (const auto* s = std::get_if<StressScene>(&c.test)) tests += samplers_of(*s, plan).size();
  }
  return plan.level / double(std::max<std::size_t>(tests, 1));
}

}  // namespace

std::string_view name(StressVerdict verdict) {
  constexpr std::string_view names[] = {"right", "unsupported", "vague", "wrong"};
  return names[int(verdict)];
}

StressVerdict verdict(const StressResult& result) {
  StressVerdict worst = StressVerdict::Right;
  for (const StressRow& row : result.rows) worst = std::max(worst, row.verdict);
  return worst;
}

const StressRow& worst_row(const StressResult& result) {
  const auto error = [](const StressRow& row) {
    if (!row.judged) return 0.0;
    const double difference = std::abs(row.got - row.expected);
    return difference > 0.0 ? difference / std::max(row.tolerance, 1e-300) : 0.0;
  };
  return *std::max_element(result.rows.begin(), result.rows.end(),
                           [&](const StressRow& a, const StressRow& b) {
                             if (a.verdict != b.verdict) return a.verdict < b.verdict;
                             return error(a) < error(b);
                           });
}

double reach_of_chance(int seeds, double level) {
  if (seeds < 2) return 0.0;
  return student_quantile(double(seeds - 1), 0.5 * level);
}

StressVerdict judge_mean(double expected, double got, double standard_error, double reach,
                         double rounding) {
  const double size = expected == 0.0 ? 1.0 : std::abs(expected);
  const double chance = standard_error > 0.0 ? reach * standard_error : 0.0;
  if (!(std::abs(got - expected) <= chance + rounding * size)) return StressVerdict::Wrong;
  return chance > kWidest * size ? StressVerdict::Vague : StressVerdict::Right;
}

std::vector<StressCase> matching_cases(std::vector<StressCase> cases, std::string_view pattern) {
  const std::string text(pattern);
  const bool glob = text.find_first_of("*?[") != text.npos;
  std::erase_if(cases, [&](const StressCase& c) {
    return glob ? fnmatch(text.c_str(), c.name.c_str(), 0) != 0 : c.name.find(text) == text.npos;
  });
  return cases;
}

std::vector<StressResult> run_stress(const std::vector<StressCase>& cases, const StressPlan& plan,
                                     const StressProgress& progress) {
  const double reach = reach_of_chance(plan.seeds, level_of_each(cases, plan));
  std::vector<std::optional<StressResult>> found(cases.size());
  std::atomic<std::size_t> next = 0, done = 0;
  std::mutex reporting;
  std::exception_ptr failure;
  // Threads of their own: a render limits the tasks of the whole program to its threads.
  const auto judge_cases = [&] {
    for (std::size_t i = next++; i < cases.size() && !interrupted(); i = next++) {
      StressResult result = run_case(cases[i], plan, reach);
      if (interrupted()) return;  // it may lack renders
      const std::lock_guard lock(reporting);
      progress(result, double(++done) / double(cases.size()));
      found[i] = std::move(result);
    }
  };
  const auto work = [&] {
    try {
      judge_cases();
    } catch (...) {
      const std::lock_guard lock(reporting);
      if (!failure) failure = std::current_exception();
      next = cases.size();
    }
  };
  std::vector<std::jthread> threads;
  const int count = plan.threads > 0 ? plan.threads : cpu_count();
  try {
    for (int i = 1; i < std::min(count, int(cases.size())); ++i) threads.emplace_back(work);
  } catch (const std::system_error&) {
    // Fewer threads than wanted do the same.
  }
  work();
  threads.clear();
  if (failure) std::rethrow_exception(failure);
  std::vector<StressResult> results;
  for (auto& result : found) {
    if (result && !result->rows.empty()) results.push_back(std::move(*result));
  }
  return results;
}

}  // namespace lockstep
