// The stress battery: extreme scenes and inputs with known answers, and a verdict on each for every
// packet width and sampler. docs/stress.md describes it.
//
// To add a case: append it to its family's list in experiments/stress/.
#pragma once

#include "core/image.h"
#include "core/scene_description.h"
#include "packets/render.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lockstep {

// A scene, made in memory, of whose renders a number is known: by default the mean of all pixels
// and channels. Seeds are what the estimate is repeated over.
struct StressScene {
  // Files that the scene needs are written to `folder`, which exists.
  std::function<SceneDescription(const std::string& folder)> make;
  double expected = 1.0;
  double rounding = 1e-4;  // what float arithmetic may add: relative, absolute where 0 is expected
  int spp = 16;
  int depth = 1;
  int roulette_depth = 1 << 20;                   // none
  std::function<double(const Image&)> measure{};  // none: the mean
  std::vector<std::string> samplers{};            // none: those of the battery
  bool overflows = false;                         // samples beyond float's range are expected
};

// What a computation without sampling error gave.
struct StressFinding {
  double expected = 0.0;
  double got = 0.0;
  double tolerance = 0.0;  // absolute
  bool at_most = false;    // `expected` is a bound: got may lie anywhere below
  std::string refusal{};   // what the program says where it does not support the input
};

struct StressSetting {
  int width = 1;  // lanes
  SamplerSpec sampler;
  std::string folder;
};

// A direct computation with the library's functions.
struct StressComputation {
  std::function<StressFinding(const StressSetting&)> run;
  bool every_width = false;
  bool every_sampler = false;
};

struct StressCase {
  std::string name;      // unique
  std::string family;    // scale, light, material, sampling, stiff
  std::string extreme;   // what is
  std::string argument;  // why the answer is known
  std::variant<StressScene, StressComputation> test;
};

std::vector<StressCase> stress_cases();

// Those whose name has `pattern` in it or, where it holds * or ?, matches it as a whole.
std::vector<StressCase> matching_cases(std::vector<StressCase> cases, std::string_view pattern);

struct StressPlan {
  // Chance is judged at the first, whose kernels also come specialised; the others must repeat its
  // bits.
  std::vector<int> widths{8, 1, 16};
  std::vector<std::string> samplers{"random", "owen", "cpt", "rcs", "strata"};
  int seeds = 32;       // renders per sampler
  bool quick = false;   // all seeds at one width only, the first at the others
  double level = 1e-3;  // chance that a correct program fails any of the battery's tests
  int threads = 0;      // cases at a time; 0: one for each processor
  std::string folder;   // for files that scenes need
};

// Unsupported: the answer is wrong or missing, and the program says so by itself.
// Vague: the interval is so wide that nothing could be wrong.
enum class StressVerdict { Right, Unsupported, Vague, Wrong };
std::string_view name(StressVerdict verdict);

struct StressBadSample {
  BadSample at;
  std::uint32_t seed = 0;
};

// One case at one width with one sampler.
struct StressRow {
  int width = 0;        // 0: does not depend on it
  std::string sampler;  // empty: does not depend on it
  double expected = 0.0, got = 0.0;
  double standard_error = 0.0;
  double tolerance = 0.0;  // largest difference that is judged right
  bool judged = true;      // false: one seed only, compared with the first width bit for bit
  StressVerdict verdict = StressVerdict::Wrong;
  std::string message;  // why not right
  std::uint64_t nonfinite = 0;
  std::vector<StressBadSample> bad;  // the first of them
  std::uint64_t fireflies = 0;       // pixels brighter than 100 times what is expected
  double seconds = 0.0;
};

struct StressPicture {
  std::string sampler;
  Image image;
};

struct StressResult {
  StressCase tested;
  std::vector<StressRow> rows;
  std::vector<StressPicture> pictures;  // of the first seed
  double seconds = 0.0;
};

StressVerdict verdict(const StressResult& result);  // the worst of its rows
const StressRow& worst_row(
    const StressResult& result);  // and of those farthest off for its tolerance

// The largest difference between a mean of `seeds` values and its expectation that chance explains
// at this level, in standard errors (Student's t, two-sided).
double reach_of_chance(int seeds, double level);

// How a mean is judged. `reach`: see above.
StressVerdict judge_mean(double expected, double got, double standard_error, double reach,
                         double rounding);

// Called after each case, from one thread at a time.
using StressProgress = std::function<void(const StressResult& done, double share)>;

// The results of all cases, in their order; without those that had not begun when the user stopped
// the run. Errors of a case become its verdict.
std::vector<StressResult> run_stress(const std::vector<StressCase>& cases, const StressPlan& plan,
                                     const StressProgress& progress);

// A line for each case, and the sum.
std::string stress_table(const std::vector<StressResult>& results);

// stress.csv: a line for each row.
std::string stress_csv_header();
std::string stress_csv_rows(const StressResult& result);

// stress.html: one page with pictures, all inside.
std::string stress_page(const std::vector<StressResult>& results, const StressPlan& plan);

}  // namespace lockstep
