// What a comparison writes, from measurements made up by hand; then one small comparison in full.
#include "core/error.h"
#include "experiments/compare.h"
#include "experiments/demo_plan.h"
#include "experiments/errors_csv.h"
#include "experiments/output_file.h"
#include "experiments/report.h"
#include "experiments/summary.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

Measurement made_run(int sampler, std::uint32_t seed, int spp, double cpu, double error) {
  Measurement run;
  run.sampler = sampler;
  run.seed = seed;
  run.spp = spp;
  run.cpu_seconds = cpu;
  run.wall_seconds = cpu;
  run.errors = {error, error * error, error * error};
  return run;
}

// Two samplers whose error is 1 / sqrt(spp); the second takes half the time.
Comparison made_comparison() {
  Comparison comparison;
  comparison.settings.samplers = {parse_sampler("random"), parse_sampler("owen")};
  comparison.settings.rungs = {4, 16, 64};
  comparison.settings.seeds = 4;
  SceneComparison scene;
  scene.scene = scene.label = "made </script> up";
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    for (int spp : {4, 16, 64}) {
      for (int s = 0; s < 2; ++s) {
        scene.runs.push_back(made_run(s, seed, spp, spp / (s + 1.0), 1.0 / std::sqrt(double(spp))));
      }
    }
  }
  comparison.scenes.push_back(scene);
  return comparison;
}

std::vector<std::string> lines_of(const fs::path& path) {
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

struct TemporaryFolder {
  fs::path path = fs::temp_directory_path() / ("lockstep-compare-" + std::to_string(::getpid()));
  TemporaryFolder() { fs::create_directories(path); }
  ~TemporaryFolder() { fs::remove_all(path); }
};

TEST(ErrorsCsv, HeaderIsWhatScriptsRelyOn) {
  EXPECT_TRUE(errors_csv_header().starts_with(
      "scene,sampler,seed,spp,cpu_seconds,wall_seconds,rmse,relmse,relmse_trimmed"));
}

TEST(ErrorsCsv, FieldsWithCommasAreQuoted) {
  EXPECT_EQ(csv_field("random"), "random");
  EXPECT_EQ(csv_field("rcs:c=4,t=0.02"), "\"rcs:c=4,t=0.02\"");
  EXPECT_EQ(csv_field("a\"b"), "\"a\"\"b\"");
  EXPECT_EQ(errors_csv_row("cornell", "rcs:c=1,t=0", made_run(0, 3, 16, 1.5, 0.5)),
            "cornell,\"rcs:c=1,t=0\",3,16,1.5,1.5,0.5,0.25,0.25");
}

TEST(ErrorsCsv, AnEarlierFileIsKept) {
  const TemporaryFolder folder;
  ErrorsCsv(folder.path.string()).append("old", "random", made_run(0, 0, 4, 1, 1));
  ErrorsCsv csv(folder.path.string());
  csv.append("new", "random", made_run(0, 0, 4, 1, 1));
  ASSERT_EQ(lines_of(folder.path / "errors.csv").size(), 2u);  // visible while the file is open
  EXPECT_TRUE(lines_of(folder.path / "errors.csv")[1].starts_with("new,"));
  EXPECT_TRUE(lines_of(folder.path / "errors-previous.csv")[1].starts_with("old,"));
}

TEST(OutputFile, NamesAreMadeSafe) {
  EXPECT_EQ(file_name_safe("rcs:c=4,t=0.02"), "rcs_c=4_t=0.02");
  EXPECT_EQ(file_name_safe("a/b c"), "a_b_c");
}

TEST(OutputFile, PlacesThatCannotBeWrittenAreFoundBefore) {
  const TemporaryFolder folder;
  EXPECT_THROW(check_writable(folder.path.string()), Error);
  EXPECT_THROW(check_writable((folder.path / "none" / "a.exr").string()), Error);
  EXPECT_THROW(check_writable_image((folder.path / "a.txt").string()), UsageError);
  EXPECT_NO_THROW(check_writable_image((folder.path / "a.exr").string()));
  EXPECT_TRUE(fs::is_empty(folder.path)) << "the check leaves nothing behind";
}

TEST(Summary, EqualTimeErrorsAreInterpolated) {
  const auto summary = summarize(made_comparison());
  const auto& equal = summary["scenes"][0]["equal_time"];
  EXPECT_EQ(equal["common_range"][0], 4.0);   // random's first
  EXPECT_EQ(equal["common_range"][1], 32.0);  // owen's last
  ASSERT_EQ(equal["budgets"].size(), 2u);     // 32 and 8 seconds
  const auto& at_32 = equal["budgets"][0]["samplers"];
  EXPECT_NEAR(at_32[0]["rmse"]["median"], 1.0 / std::sqrt(32.0), 1e-9);
  EXPECT_NEAR(at_32[1]["rmse"]["median"], 1.0 / std::sqrt(64.0), 1e-9);
  EXPECT_NEAR(at_32[1]["rmse"]["ratio"]["value"], std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(at_32[1]["relmse"]["ratio"]["value"], 0.5, 1e-9);
  EXPECT_NEAR(at_32[1]["rmse"]["ratio"]["interval_95"][0], std::sqrt(0.5), 1e-9);
}

TEST(Summary, RungsHaveMedianAndSpread) {
  Comparison comparison = made_comparison();
  std::vector<Measurement>& runs = comparison.scenes[0].runs;
  runs.clear();
  for (std::uint32_t seed = 0; seed < 5; ++seed)
    runs.push_back(made_run(0, seed, 4, 2.0, 1.0 + seed));
  const auto summary = summarize(comparison);
  const auto& rung = summary["scenes"][0]["samplers"][0]["rungs"][0];
  EXPECT_EQ(rung["rmse"]["median"], 3.0);
  EXPECT_NEAR(rung["rmse"]["p5"], 1.2, 1e-12);
  EXPECT_NEAR(rung["rmse"]["p95"], 4.8, 1e-12);
  EXPECT_EQ(rung["cpu_seconds"]["median"], 2.0);
  EXPECT_EQ(rung["runs"].size(), 5u);
  EXPECT_TRUE(summary["scenes"][0]["equal_time"]["budgets"].empty()) << "owen has no runs";
  EXPECT_NE(results_table(summary).find("nothing to compare at equal time"), std::string::npos);
}

TEST(Summary, BiasedSamplersAreMarked) {
  Comparison comparison = made_comparison();
  comparison.settings.samplers[1] = parse_sampler("rcs:combine=weight");
  const auto summary = summarize(comparison);
  EXPECT_EQ(summary["scenes"][0]["samplers"][0]["biased"], false);
  EXPECT_EQ(summary["scenes"][0]["samplers"][1]["biased"], true);
  EXPECT_NE(results_table(summary).find("rcs:combine=weight is biased"), std::string::npos);
}

TEST(Report, IsOnePageThatNeedsNothingElse) {
  const std::string html = report_html(summarize(made_comparison()));
  for (const char* mark : {"{{CSS}}", "{{D3}}", "{{DATA}}", "{{JS}}", "<script src", "<link"}) {
    EXPECT_EQ(html.find(mark), std::string::npos) << mark;
  }
  EXPECT_EQ(html.find("made </script>"), std::string::npos) << "data must not end its element";
  EXPECT_NE(html.find("made <\\/script> up"), std::string::npos);
}

TEST(DemoPlan, FitsIntoTheTimeAtAnySpeed) {
  for (double seconds_per_path : {1e-8, 1e-7, 4e-7, 1e-6, 4e-6, 1e-5}) {
    const DemoPlan plan = plan_demo({seconds_per_path, seconds_per_path}, {480, 320}, 3, 65.0);
    EXPECT_LE(plan.seconds, 65.0) << seconds_per_path;
    EXPECT_GE(plan.seeds, 4) << seconds_per_path;
    EXPECT_GE(plan.rungs.size(), 2u) << seconds_per_path;
    EXPECT_GE(plan.reference_spp, 8 * plan.rungs.back()) << seconds_per_path;
  }
}

CompareSettings small_settings(const fs::path& folder) {
  CompareSettings settings;
  settings.scenes = {"cornell"};
  settings.samplers = {parse_sampler("random"), parse_sampler("cpt"), parse_sampler("rcs")};
  settings.rungs = {2, 8};
  settings.seeds = 2;
  settings.reference_spp = 32;
  settings.resolution = glm::ivec2(32, 32);
  settings.directory = folder.string();
  return settings;
}

TEST(Compare, MeasuresEveryCombinationOnce) {
  const TemporaryFolder folder;
  const Comparison comparison = compare(small_settings(folder.path), {});
  ASSERT_EQ(comparison.scenes.size(), 1u);
  EXPECT_TRUE(comparison.complete);
  EXPECT_EQ(comparison.scenes[0].runs.size(), 2u * 2u * 3u);
  EXPECT_EQ(lines_of(folder.path / "errors.csv").size(), 1u + 12u);
  for (const Measurement& run : comparison.scenes[0].runs) EXPECT_GT(run.cpu_seconds, 0.0);
  for (const char* file :
       {"cornell-random-8spp.exr", "cornell-cpt-2spp.png", "cornell-reference.png",
        "cornell-rcs-8spp-weights.exr", "cornell-rcs-8spp-weights.png"}) {
    EXPECT_TRUE(fs::exists(folder.path / file)) << file;
  }
  EXPECT_GT(comparison.scenes[0].reference.relmse.value_or(0.0), 0.0);
}

TEST(Compare, TheReferenceIsKeptUntilSettingsChange) {
  const TemporaryFolder folder;
  CompareSettings settings = small_settings(folder.path);
  settings.rungs = {2};
  settings.seeds = 1;
  const std::string first = compare(settings, {}).scenes[0].reference.origin;
  const std::string second = compare(settings, {}).scenes[0].reference.origin;
  settings.reference_spp = 64;
  const std::string third = compare(settings, {}).scenes[0].reference.origin;
  EXPECT_TRUE(first.starts_with("rendered")) << first;
  EXPECT_TRUE(second.starts_with("from an earlier run")) << second;
  EXPECT_TRUE(third.starts_with("rendered")) << third;
}

TEST(Compare, StoppingKeepsWhatWasMeasured) {
  const TemporaryFolder folder;
  int seed_2_calls = 0;
  const Comparison comparison =
      compare(small_settings(folder.path), [&](double, std::string_view label) {
        seed_2_calls += label.find("seed 2") != std::string_view::npos;
        return seed_2_calls == 0;
      });
  EXPECT_FALSE(comparison.complete);
  ASSERT_EQ(comparison.scenes.size(), 1u);
  EXPECT_GE(comparison.scenes[0].runs.size(), 6u);
  EXPECT_EQ(lines_of(folder.path / "errors.csv").size(), 1u + comparison.scenes[0].runs.size());
}

TEST(Compare, AReferenceOfAnotherSizeIsRefused) {
  const TemporaryFolder folder;
  CompareSettings settings = small_settings(folder.path);
  settings.reference_file = (folder.path / "small.exr").string();
  write_image(settings.reference_file, Image(16, 16));
  EXPECT_THROW(compare(settings, {}), Error);
  settings.samplers.push_back(settings.samplers.front());
  EXPECT_THROW(compare(settings, {}), UsageError) << "a sampler named twice";
}

}  // namespace
}  // namespace lockstep
