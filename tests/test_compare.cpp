// What a comparison writes, from measurements made up by hand; then one small comparison in full.
#include "core/error.h"
#include "experiments/commands/demo_plan.h"
#include "experiments/compare/compare.h"
#include "experiments/compare/errors_csv.h"
#include "experiments/compare/summary.h"
#include "experiments/metrics/metrics.h"
#include "experiments/output/output_file.h"
#include "tests/t_compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace lockstep::test_compare {
namespace {

std::string verdict_on(const std::vector<MadeSampler>& samplers, int seeds) {
  const auto summary = summarize(made_comparison(samplers, seeds));
  EXPECT_EQ(summary["verdicts"].size(), 1u);
  return summary["verdicts"][0]["sentence"];
}

// With one space for every run of white space.
std::string squeezed(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  for (std::size_t at = 0; (at = text.find("  ", at)) != std::string::npos;) text.erase(at, 1);
  return text;
}

TEST(ErrorsCsv, HeaderIsWhatScriptsRelyOn) {
  EXPECT_TRUE(errors_csv_header().starts_with(
      "scene,sampler,seed,spp,cpu_seconds,wall_seconds,rmse,relmse,relmse_trimmed"));
  EXPECT_NE(errors_csv_header().find(",low_pass_rmse,"), std::string::npos)
      << "all metrics, not the table's";
  EXPECT_TRUE(errors_csv_header().ends_with(
      ",depth,pilot_spp,mean_weight,lanes,lanes_active,nonfinite,width,threads,cpu"));
}

TEST(ErrorsCsv, FieldsWithCommasAreQuoted) {
  EXPECT_EQ(csv_field("random"), "random");
  EXPECT_EQ(csv_field("rcs:c=4,t=0.02"), "\"rcs:c=4,t=0.02\"");
  EXPECT_EQ(csv_field("a\"b"), "\"a\"\"b\"");
  const std::string row =
      errors_csv_row("cornell", 5, "rcs:c=1,t=0", made_run(0, 3, 16, 1.5, 0.5, 7));
  EXPECT_TRUE(row.starts_with("cornell,\"rcs:c=1,t=0\",3,16,1.5,1.5,0.5,0.25,0.25,7,7,0.5,"))
      << row;
  EXPECT_NE(row.find(",0.5,5,0,0,"), std::string::npos) << "depth after the metrics: " << row;
}

TEST(ErrorsCsv, RowsAreVisibleAtOnce) {
  const TemporaryFolder folder;
  ErrorsCsv csv(folder.path.string(), "earlier\n");
  csv.append("new", 1, "random", made_run(0, 0, 4, 1, 1));
  const std::vector<std::string> lines = lines_of(folder.path / "errors.csv");
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[1], "earlier");
  EXPECT_TRUE(lines[2].starts_with("new,"));
}

TEST(SpectraCsv, HasARowForEachRing) {
  Comparison comparison = made_comparison();
  comparison.settings.samplers[1] = parse_sampler("rcs:c=1,t=0");
  SceneComparison& scene = comparison.scenes[0];
  scene.scene = "cornell";
  scene.depth = 5;
  scene.spectra.push_back({0, 4, 4, {{{0.125, 0.5}}, 1.0}});  // measured last, written first
  EXPECT_EQ(spectra_csv(comparison),
            "scene,depth,sampler,spp,frequency,power\n"
            "cornell,5,random,4,0.125,0.5\n"
            "cornell,5,random,16,0.125,4\n"
            "cornell,5,random,16,0.375,1\n"
            "cornell,5,\"rcs:c=1,t=0\",16,0.125,4\n"
            "cornell,5,\"rcs:c=1,t=0\",16,0.375,1\n");
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

TEST(Summary, HasSpectra) {
  const auto summary = summarize(made_comparison());
  const auto& scene = summary["scenes"][0];
  EXPECT_EQ(scene["frequencies"].dump(), "[0.125,0.375]");
  const auto& rungs = scene["samplers"][1]["rungs"];
  EXPECT_EQ(rungs[1]["spectrum"]["power"].dump(), "[4.0,1.0]");
  EXPECT_EQ(rungs[1]["spectrum"]["white_noise"], 2.0);
  EXPECT_FALSE(rungs[0].contains("spectrum")) << "none was measured at 4 spp";
}

// All pairs but one say 0.9; the errors come in two clusters, and that pair carries the median into
// the other one.
TEST(Summary, MediansThatContradictTheirRatioAreMarked) {
  const auto low = [](std::uint32_t seed) { return seed < 5 ? 1.0 : 4.0; };
  const auto summary = summarize(made_comparison(
      {{"random", 1.0, [&](int, std::uint32_t seed) { return low(seed); }},
       {"owen", 1.0, [&](int, std::uint32_t seed) { return seed == 0 ? 3.6 : 0.9 * low(seed); }},
       {"strata", 1.0, [&](int, std::uint32_t seed) { return 0.9 * low(seed); }}},
      9));
  const auto& row = summary["scenes"][0]["equal_time"]["budgets"][0]["samplers"];
  EXPECT_NEAR(row[1]["rmse"]["ratio"]["of_medians"], 3.6, 1e-9);
  EXPECT_LT(row[1]["rmse"]["ratio"]["value"], 1.2);
  EXPECT_TRUE(row[1]["rmse"]["ratio"]["medians_disagree"]);
  EXPECT_NEAR(row[2]["rmse"]["ratio"]["of_medians"], 0.9, 1e-9);
  EXPECT_FALSE(row[2]["rmse"]["ratio"]["medians_disagree"]);
  EXPECT_NE(results_table(summary).find("\n  ! the medians' ratio"), std::string::npos);
}

TEST(Summary, AnErrorOfZeroHasNoRatio) {
  Comparison comparison = made_comparison();
  const std::size_t yee = 3;
  ASSERT_EQ(metrics()[yee].name, "yee_pixels");
  for (Measurement& run : comparison.scenes[0].runs) {
    if (run.sampler == 1 && run.seed == 2) run.errors[yee] = 0.0;
  }
  const auto summary = summarize(comparison);
  const auto& row = summary["scenes"][0]["equal_time"]["budgets"][0]["samplers"][1];
  EXPECT_TRUE(row["yee_pixels"]["ratio"].is_null());
  EXPECT_NEAR(row["yee_pixels"]["median"], 1234.0, 1e-6);
  EXPECT_FALSE(row["yee_share"]["ratio"].is_null());
  EXPECT_NE(squeezed(results_table(summary)).find(" 1234 - "), std::string::npos);
}

TEST(Summary, TheTableShowsFiveMetricsInAHundredColumns) {
  const auto summary = summarize(
      made_comparison({{"random", 1, always_one}, {"cpt", 1, above}, {"owen", 1, below}}, 8));
  const std::string table = results_table(summary);
  EXPECT_NE(squeezed(table).find(" sampler RMSE relMSE FLIP Yee pixels low-pass RMSE "),
            std::string::npos)
      << table;
  for (const char* absent : {"SSIM", "ssim", "HDR", "SMAPE", "smape", "trimmed", "share"}) {
    EXPECT_EQ(table.find(absent), std::string::npos) << absent;
  }
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  EXPECT_NE(squeezed(table).find(" owen 0.0794 x0.63* 0.0063 x0.40* 0.0794 x0.63* 1234 x1.00 "),
            std::string::npos)
      << table;
  EXPECT_EQ(summary["metrics"].size(), metrics().size());
}

TEST(Summary, TheTableEndsWithTheVerdict) {
  const auto summary =
      summarize(made_comparison({{"random", 1, always_one}, {"cpt", 1, above}}, 8));
  const std::string sentence = summary["verdicts"][0]["sentence"];
  EXPECT_TRUE(squeezed(results_table(summary)).ends_with(sentence + ' '));
}

TEST(Verdict, NamesThoseThatLoseAndTheBest) {
  const std::vector<MadeSampler> samplers = {
      {"random", 1, always_one}, {"cpt", 1, above}, {"rcs", 1, about_one}, {"owen", 1, below}};
  const auto verdict = summarize(made_comparison(samplers, 8))["verdicts"][0];
  EXPECT_EQ(verdict["scene"], "made");
  EXPECT_EQ(verdict["depth"], 3);
  EXPECT_EQ(verdict["metric"], "flip_ldr");
  EXPECT_TRUE(
      std::string(verdict["sentence"])
          .starts_with("made, depth 3, by FLIP: loses to random at equal time: cpt (x1.23 ["))
      << verdict["sentence"];
  EXPECT_TRUE(
      std::string(verdict["sentence"])
          .find("; no difference to random shown: rcs; best at 64 s: owen. In time: cpt ") !=
      std::string::npos)
      << verdict["sentence"];
  ASSERT_EQ(verdict["loses_to_random"].size(), 1u);
  EXPECT_EQ(verdict["loses_to_random"][0]["sampler"], "cpt");
  EXPECT_EQ(verdict["loses_to_random"][0]["ratios"].size(), 3u) << "64, 16 and 4 seconds";
  EXPECT_GT(verdict["loses_to_random"][0]["ratios"][0]["interval_95"][0], 1.0);
  EXPECT_EQ(verdict["beats_random"][0]["sampler"], "owen");
  EXPECT_EQ(verdict["no_difference_shown"][0]["sampler"], "rcs");
  EXPECT_EQ(verdict["best"]["sampler"], "owen");
}

TEST(Verdict, IsAboutTimeNotSamples) {
  // Twice the time for a sample, a quarter less error: 1.06 times random's at equal time.
  const auto better = [](int, std::uint32_t seed) { return 0.75 + 0.001 * seed; };
  EXPECT_NE(verdict_on({{"random", 1, always_one}, {"owen", 2, better}}, 8)
                .find("loses to random at equal time: owen (x1.0"),
            std::string::npos);
}

TEST(Verdict, SaysWhereNoneLoses) {
  EXPECT_TRUE(
      verdict_on({{"random", 1, always_one}, {"owen", 1, below}}, 8)
          .starts_with("made, depth 3, by FLIP: none loses to random at equal time; best at "
                       "64 s: owen."));
  EXPECT_EQ(verdict_on({{"random", 1, always_one}, {"rcs", 1, about_one}}, 8),
            "made, depth 3, by FLIP: none loses to random at equal time; no difference to random "
            "shown: rcs; best at 64 s: random (no difference shown to rcs). In time: no difference "
            "shown to random in the time for FLIP 0.14: rcs.");
}

TEST(Verdict, ALossAtAnyTimeCounts) {
  const auto at_first = [](int spp, std::uint32_t seed) {
    return (spp > 4 ? 0.7 : 1.4) + 0.01 * seed;
  };
  const std::string sentence = verdict_on({{"random", 1, always_one}, {"rcs", 1, at_first}}, 8);
  EXPECT_NE(sentence.find("loses to random at equal time: rcs (x1.4"), std::string::npos);
  EXPECT_NE(sentence.find("at 4 s); best at 64 s: rcs."), std::string::npos) << sentence;
}

TEST(Verdict, ClaimsNothingWithoutAnInterval) {
  EXPECT_EQ(
      verdict_on({{"random", 1, always_one}, {"cpt", 1, above}}, 3),
      "made, depth 3, by FLIP: no difference to random shown: cpt (an interval needs 4 "
      "seeds); best at 64 s: random (no difference shown to cpt). In time: no difference shown "
      "to random in the time for FLIP 0.16: cpt.");
}

TEST(Verdict, SaysWhatItCannotJudge) {
  EXPECT_TRUE(verdict_on({{"owen", 1, always_one}, {"cpt", 1, above}}, 8)
                  .starts_with("made, depth 3, by FLIP: random was not run; best at 64 s: owen."));
  const auto zero = [](int, std::uint32_t) { return 0.0; };
  EXPECT_NE(verdict_on({{"random", 1, always_one}, {"owen", 1, zero}}, 8)
                .find("not judged, with no time in common or an error of 0: owen"),
            std::string::npos);
  EXPECT_TRUE(summarize(made_comparison({{"random", 1, always_one}}, 8))["verdicts"].empty());
}

TEST(Verdict, FallsBackToTimesInCommonWithRandom) {
  // owen ends before cpt begins; each overlaps with random.
  const std::string sentence =
      verdict_on({{"random", 1, always_one}, {"owen", 0.125, below}, {"cpt", 8, above}}, 8);
  EXPECT_NE(sentence.find("loses to random at equal time: cpt (x"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("no time is common to all, so none is best"), std::string::npos);
  EXPECT_EQ(sentence.find("not judged"), std::string::npos);
}

TEST(Summary, GivenBudgetsAreNeverExtrapolated) {
  Comparison comparison = made_comparison();  // random covers 4 to 64 s, owen 2 to 32 s
  comparison.settings.budgets = {2, 8, 100};
  const auto summary = summarize(comparison);
  const auto& budgets = summary["scenes"][0]["equal_time"]["budgets"];
  ASSERT_EQ(budgets.size(), 3u);
  EXPECT_EQ(budgets[0]["cpu_seconds"], 100);
  for (int s : {0, 1}) {
    EXPECT_TRUE(budgets[0]["samplers"][s]["rmse"].is_null());
    EXPECT_FALSE(budgets[1]["samplers"][s]["rmse"].is_null());
  }
  EXPECT_TRUE(budgets[2]["samplers"][0]["rmse"].is_null()) << "random begins at 4 s";
  EXPECT_NEAR(budgets[2]["samplers"][1]["rmse"]["median"], 0.5, 1e-9);
  const std::string table = squeezed(results_table(summary));
  EXPECT_NE(table.find("at 100 s of CPU time no sampler was measured"), std::string::npos) << table;
  EXPECT_NE(table.find("random - - - - -"), std::string::npos) << table;
}

TEST(Summary, HasMeansAndWhatTheReferenceIsOffBy) {
  Comparison comparison = made_comparison();
  comparison.scenes[0].reference.errors = {{"flip_ldr", 0.05}, {"relmse", 0.001}};
  const auto summary = summarize(comparison);
  const auto& rungs = summary["scenes"][0]["samplers"][0]["rungs"];
  EXPECT_NEAR(rungs[0]["rmse"]["mean"], 0.5, 1e-12);
  EXPECT_EQ(rungs[1]["near_reference"].dump(), "[]") << "0.25 is above three times 0.05";
  EXPECT_EQ(rungs[2]["near_reference"].dump(), "[\"flip_ldr\"]") << "0.125 is below";
  EXPECT_NE(std::string(summary["verdicts"][0]["sentence"])
                .find("Less than three times the reference's own error: random at 64 spp, owen at "
                      "64 spp."),
            std::string::npos);
}

TEST(TimeToError, IsReadBetweenRungs) {
  Comparison comparison = made_comparison();  // owen has the same errors in half the time
  comparison.settings.targets = {{"rmse", 0.25}, {"rmse", 0.2}, {"rmse", 0.01}, {"rmse", 0.6}};
  const auto summary = summarize(comparison);
  const auto& times = summary["scenes"][0]["time_to_error"];
  ASSERT_EQ(times.size(), 4u);
  EXPECT_NEAR(times[0]["samplers"][0]["cpu_seconds"], 16.0, 1e-9);
  EXPECT_NEAR(times[1]["samplers"][0]["cpu_seconds"], 25.0, 1e-9);
  EXPECT_NEAR(times[1]["samplers"][1]["ratio"]["value"], 0.5, 1e-9);
  EXPECT_EQ(times[1]["samplers"][1]["ratio"]["seeds"], 4);
  for (int target : {2, 3}) {  // never reached, and reached before the first rung
    EXPECT_TRUE(times[target]["samplers"][1]["cpu_seconds"].is_null());
    EXPECT_TRUE(times[target]["samplers"][1]["ratio"].is_null());
  }
  EXPECT_EQ(times[1]["sentence"],
            "owen needs 0.50x the time of random for RMSE 0.2, 95 % interval 0.50-0.50");
  EXPECT_EQ(times[2]["sentence"], "not in all seeds measured down to RMSE 0.01: owen");
}

TEST(TimeToError, TheDefaultIsTheLowestFlipThatAllReach) {
  const auto summary =
      summarize(made_comparison({{"random", 1, always_one}, {"owen", 1, below}}, 8));
  const auto& times = summary["scenes"][0]["time_to_error"];
  ASSERT_EQ(times.size(), 1u);
  EXPECT_EQ(times[0]["metric"], "flip_ldr");
  EXPECT_NEAR(times[0]["error"], 0.13, 1e-12) << "0.125 rounded up to two digits";
  const std::string sentence = summary["verdicts"][0]["sentence"];
  EXPECT_NE(sentence.find(" In time: owen needs 0.40x the time of random for FLIP 0.13, 95 % "
                          "interval 0.3"),
            std::string::npos)
      << sentence;
}

TEST(TimeToError, PairsHaveTheirOwnErrorWhereAllHaveNone) {
  // cpt begins below where owen ends; each overlaps with random.
  const auto low = [](int, std::uint32_t) { return 0.26; };  // 0.13 to 0.0325
  const auto high = [](int, std::uint32_t) { return 1.2; };  // 0.6 to 0.15
  const auto summary = summarize(
      made_comparison({{"random", 1, always_one}, {"owen", 1, high}, {"cpt", 1, low}}, 8));
  const auto& times = summary["scenes"][0]["time_to_error"];
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0]["samplers"][1]["sampler"], "owen");
  EXPECT_NEAR(times[0]["error"], 0.15, 1e-12);
  EXPECT_NEAR(times[0]["samplers"][1]["ratio"]["value"], 1.44, 1e-9);
  EXPECT_EQ(times[1]["samplers"][1]["sampler"], "cpt");
  EXPECT_NE(std::string(summary["verdicts"][0]["sentence"])
                .find(" In time: owen needs 1.44x the time of random for FLIP 0.15, 95 % interval "
                      "1.44-1.44; cpt needs 0.068x"),
            std::string::npos)
      << summary["verdicts"][0]["sentence"];
}

TEST(Verdict, NamesTimesThatAreNotWellKnown) {
  Comparison comparison = made_comparison();
  for (Measurement& run : comparison.scenes[0].runs) {
    if (run.sampler == 1 && run.spp == 16) run.cpu_seconds *= 1.0 + 0.2 * run.seed;
  }
  const auto sentence = [&] {
    return std::string(summarize(comparison)["verdicts"][0]["sentence"]);
  };
  EXPECT_NE(sentence().find("The timing spread is large, medians are uncertain by more than 3 %: "
                            "owen at 16 spp."),
            std::string::npos)
      << sentence();
  for (int i = 0; i < 40; ++i) comparison.scenes[0].repeats.push_back({1, 0, 16, 8.0, 8.0, {}});
  EXPECT_EQ(sentence().find("spread"), std::string::npos) << "forty further times agree";
}

TEST(Summary, BiasedSamplersAreMarked) {
  Comparison comparison = made_comparison();
  comparison.settings.samplers[1] = parse_sampler("rcs:combine=weight");
  const auto summary = summarize(comparison);
  EXPECT_EQ(summary["scenes"][0]["samplers"][0]["biased"], false);
  EXPECT_EQ(summary["scenes"][0]["samplers"][1]["biased"], true);
  EXPECT_NE(results_table(summary).find("rcs:combine=weight is biased"), std::string::npos);
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

TEST(Compare, AveragesTheSpectraOfAllSeeds) {
  const TemporaryFolder folder;
  const Comparison comparison = compare(small_settings(folder.path), {});
  const SceneComparison& scene = comparison.scenes[0];
  ASSERT_EQ(scene.spectra.size(), 2u * 3u);
  for (const RunSpectrum& spectrum : scene.spectra) {
    EXPECT_EQ(spectrum.renders, 2);
    ASSERT_FALSE(spectrum.mean.rings.empty());
    EXPECT_GT(spectrum.mean.rings[0].power, 0.0);
    EXPECT_GT(spectrum.mean.white, 0.0);
  }
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
}  // namespace lockstep::test_compare
