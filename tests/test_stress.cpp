// How the stress battery judges; what it judges is run by the program itself.
#include "core/builtin/parts.h"
#include "core/error.h"
#include "core/scene_warnings.h"
#include "experiments/stress/stress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace lockstep::test_stress {
namespace {

constexpr double nan_double = std::numeric_limits<double>::quiet_NaN();

TEST(StressJudge, TakesWhatChanceOrRoundingExplains) {
  using enum StressVerdict;
  EXPECT_EQ(judge_mean(1.0, 1.0, 0.0, 5.0, 0.0), Right);
  EXPECT_EQ(judge_mean(1.0, 1.04, 0.01, 5.0, 0.0), Right);
  EXPECT_EQ(judge_mean(1.0, 1.06, 0.01, 5.0, 0.0), Wrong);
  EXPECT_EQ(judge_mean(1.0, 1.06, 0.01, 5.0, 0.02), Right);
  EXPECT_EQ(judge_mean(1e30, 1.001e30, 0.0, 5.0, 1e-4), Wrong);
  EXPECT_EQ(judge_mean(0.0, 1e-30, 0.0, 5.0, 0.0), Wrong);
}

TEST(StressJudge, CallsAnIntervalThatTellsNothingVague) {
  EXPECT_EQ(judge_mean(1.0, 1.2, 0.2, 5.0, 0.0), StressVerdict::Vague);
  EXPECT_EQ(judge_mean(1.0, 3.0, 0.2, 5.0, 0.0), StressVerdict::Wrong);
}

TEST(StressJudge, NeverTakesWhatIsNoNumber) {
  EXPECT_EQ(judge_mean(1.0, nan_double, 0.1, 5.0, 1.0), StressVerdict::Wrong);
  EXPECT_EQ(judge_mean(1.0, 1.0, nan_double, 5.0, 0.0), StressVerdict::Right)
      << "one value has no standard error";
}

// Student's t: 2.776 of four degrees of freedom at 5 %, 4.541 of three at 2 %.
TEST(StressJudge, ReachesAsFarAsStudentsT) {
  EXPECT_NEAR(reach_of_chance(5, 0.05), 2.776, 1e-3);
  EXPECT_NEAR(reach_of_chance(4, 0.02), 4.541, 1e-3);
  EXPECT_GT(reach_of_chance(8, 1e-6), reach_of_chance(32, 1e-6));
}

TEST(StressCases, AreManyAndHaveNamesOfTheirOwn) {
  const std::vector<StressCase> cases = stress_cases();
  EXPECT_GE(cases.size(), 40u);
  std::set<std::string> names;
  for (const StressCase& c : cases) {
    EXPECT_TRUE(names.insert(c.name).second) << c.name;
    EXPECT_FALSE(c.extreme.empty() || c.argument.empty()) << c.name;
  }
}

TEST(StressCases, AreFoundByPartsOfTheirNamesAndByPatterns) {
  const auto count = [](const char* pattern) {
    return matching_cases(stress_cases(), pattern).size();
  };
  EXPECT_EQ(count(""), stress_cases().size());
  EXPECT_EQ(count("gap-"), 2u);
  EXPECT_EQ(count("gap*"), 2u);
  EXPECT_EQ(count("ap-*"), 0u);
  EXPECT_EQ(count("nothing of the kind"), 0u);
}

SceneDescription square_in_front() {
  SceneDescription scene;
  scene.name = "square";
  builtin::add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                         builtin::add_material(scene, DiffuseMaterial{glm::vec3(0.0f)}),
                         Emission{glm::vec3(2.0f)});
  scene.camera.camera_to_world = builtin::look_at({0, 0, 1}, {0, 0, 0});
  scene.camera.fov_degrees = 10.0f;
  scene.film.width = scene.film.height = 4;
  return scene;
}

StressResult run_one(const StressScene& scene) {
  StressPlan plan;
  plan.samplers = {"random", "cpt"};
  plan.seeds = 3;
  plan.threads = 1;
  return run_stress({{"square", "test", "nothing", "it shows", scene}}, plan,
                    [](const StressResult&, double) {})[0];
}

// A row for each sampler and width; what is expected decides.
TEST(StressRun, JudgesEverySamplerAtEveryWidth) {
  StressScene scene{.make = [](const std::string&) { return square_in_front(); }, .expected = 2.0};
  const StressResult right = run_one(scene);
  EXPECT_EQ(right.rows.size(), 6u);
  EXPECT_EQ(verdict(right), StressVerdict::Right);
  EXPECT_EQ(right.pictures.size(), 2u);
  scene.expected = 2.01;
  const StressResult wrong = run_one(scene);
  EXPECT_EQ(verdict(wrong), StressVerdict::Wrong);
  EXPECT_NE(stress_table({wrong}).find("0 right, 0 unsupported, 0 vague, 1 wrong"),
            std::string::npos);
}

TEST(StressRun, MakesErrorsVerdicts) {
  const StressScene scene{
      .make = [](const std::string&) -> SceneDescription { throw Error("the disk, \"full\""); }};
  const StressResult result = run_one(scene);
  EXPECT_EQ(verdict(result), StressVerdict::Wrong);
  EXPECT_NE(stress_csv_rows(result).find("\"the disk, \"\"full\"\"\""), std::string::npos);
}

TEST(SceneWarnings, TellWhatLiesTooFarFromTheOrigin) {
  const auto moved = [](float distance) {
    SceneDescription scene = square_in_front();
    for (glm::vec3& p : std::get<TriangleMesh>(scene.shapes[0].geometry).positions) p.x += distance;
    return precision_warning(scene);
  };
  EXPECT_EQ(moved(0.0f), "");
  EXPECT_EQ(moved(2e3f), "");
  EXPECT_NE(moved(1e5f).find("times its size from the origin"), std::string::npos);
  EXPECT_EQ(precision_warning(SceneDescription()), "");
}

}  // namespace
}  // namespace lockstep::test_stress
