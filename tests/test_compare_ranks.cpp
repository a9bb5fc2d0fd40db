// What several machines measure of a comparison: units, pairs that stay together, and the notice
// about unlike machines. Machines are made up.
#include "experiments/compare/compare_units.h"
#include "experiments/compare/equal_time.h"
#include "experiments/compare/errors_csv.h"
#include "experiments/compare/summary.h"
#include "experiments/output/machine.h"
#include "tests/t_compare.h"
#include "tests/t_files.h"

#include <gtest/gtest.h>

#include <utility>

namespace lockstep::test_compare_ranks {
namespace {

CompareSettings pool_settings() {
  CompareSettings settings;
  settings.scenes = {"short", "long"};
  settings.samplers = {parse_sampler("random"), parse_sampler("owen")};
  settings.rungs = {4, 16};
  settings.seeds = 2;
  settings.timing_repeats = 1;
  settings.timing_spread = 1e9;  // all are steady
  return settings;
}

std::vector<CasePlan> pool_plans() { return {{0, 5, "short", 1.0}, {1, 5, "long", 8.0}}; }

JournalEntry made_entry(const CompareSettings& settings, std::size_t scene, int sampler,
                        std::uint32_t seed, int spp, const std::string& cpu) {
  MeasuredRun measured{made_run(sampler, seed, spp, double(spp), 0.1), {}};
  measured.run.cpu = cpu;
  return {settings.scenes[scene],
          5,
          to_string(settings.samplers[std::size_t(sampler)]),
          "as ever",
          measured,
          0};
}

struct Pool {
  CompareSettings settings = pool_settings();
  std::vector<JournalEntry> recorded;
  std::optional<UnitPool> pool;
  explicit Pool(const std::vector<JournalEntry>& earlier = {}) {
    pool.emplace(settings, pool_plans(), std::vector<std::string>{"as ever", "as ever"}, earlier,
                 [this](const JournalEntry& entry) { recorded.push_back(entry); });
  }
  void measure(const Unit& unit, const std::string& cpu) {
    for (int sampler : {0, 1}) {
      for (int spp : {4, 16}) {
        const auto entry =
            made_entry(settings, unit.plan, sampler, std::uint32_t(unit.seed), spp, cpu);
        EXPECT_EQ(pool->add(entry), "");
      }
    }
  }
};

TEST(UnitPool, HandsOutTheLongestFirstAndEachOnce) {
  Pool made;
  std::vector<std::pair<std::size_t, int>> taken;
  for (int rank = 0; const std::optional<Unit> unit = made.pool->take(rank, "A"); ++rank) {
    taken.emplace_back(unit->plan, unit->seed);
    EXPECT_LT(unit->round, 0);
  }
  const std::vector<std::pair<std::size_t, int>> expected = {{1, 0}, {1, 1}, {0, 0}, {0, 1}};
  EXPECT_EQ(taken, expected);
  EXPECT_TRUE(made.pool->is_taken());
  EXPECT_FALSE(made.pool->done());
}

TEST(UnitPool, WhatALostRankHasNotDoneIsForOthers) {
  Pool made;
  const Unit unit = *made.pool->take(1, "A");
  EXPECT_EQ(made.pool->add(made_entry(made.settings, 1, 0, 0, 4, "A")), "");
  made.pool->release(1);
  const Unit again = *made.pool->take(2, "A");
  EXPECT_EQ(again.plan, unit.plan);
  EXPECT_EQ(again.seed, unit.seed);
  EXPECT_EQ(again.rungs, (std::vector<std::pair<int, int>>{{0, 4}})) << "that much is done";
  made.pool->release(2);
  const Unit elsewhere = *made.pool->take(3, "B");
  EXPECT_EQ(elsewhere.seed, unit.seed);
  EXPECT_TRUE(elsewhere.rungs.empty()) << "a pair would be torn apart";
}

TEST(UnitPool, IsDoneOnceAllSeedsAre) {
  Pool made;
  for (int rank = 0; const std::optional<Unit> unit = made.pool->take(rank, "A"); ++rank) {
    EXPECT_FALSE(made.pool->done());
    made.measure(*unit, "A");
    made.measure(*unit, "A");  // by one that was given up too early
    made.pool->release(rank);
  }
  EXPECT_TRUE(made.pool->done());
  EXPECT_EQ(made.recorded.size(), 2u * 2u * 2u * 2u) << "each render once";
  EXPECT_EQ(made.pool->share_done(), 1.0);
}

TEST(UnitPool, RoundsOfRepeatsFollowTheSeeds) {
  Pool made;
  made.settings.timing_spread = 0.0;
  made.settings.seeds = 4;
  while (const std::optional<Unit> unit = made.pool->take(0, "A")) {
    ASSERT_LT(unit->round, 0);
    for (int sampler : {0, 1}) {
      for (int spp : {4, 16}) {
        JournalEntry entry =
            made_entry(made.settings, unit->plan, sampler, std::uint32_t(unit->seed), spp, "A");
        std::get<MeasuredRun>(entry.what).run.cpu_seconds = 1.0 + unit->seed;  // they spread
        made.pool->add(entry);
      }
    }
    made.pool->release(0);
    if (unit->plan == 1 && unit->seed == 3) break;
  }
  const std::optional<Unit> round = made.pool->take(0, "A");
  ASSERT_TRUE(round);
  EXPECT_EQ(round->plan, 1u);
  EXPECT_EQ(round->round, 0);
  EXPECT_EQ(round->rungs.size(), 4u);
}

TEST(UnitPool, OtherConditionsAreRefused) {
  Pool made;
  JournalEntry entry = made_entry(made.settings, 0, 0, 0, 4, "A");
  entry.conditions = "another scene";
  EXPECT_NE(made.pool->add(entry).find("other conditions"), std::string::npos);
  EXPECT_TRUE(made.recorded.empty());
}

// A comparison of two machines, by seed.
Comparison of_two_machines() {
  Comparison comparison = made_comparison();
  for (Measurement& run : comparison.scenes[0].runs) {
    run.cpu = run.seed < 3 ? "Alpha CPU" : "Beta, CPU";
  }
  return comparison;
}

TEST(UnlikeMachines, AreToldWhereverTimesAreCompared) {
  const Comparison comparison = of_two_machines();
  const std::string notice = unlike_machines(comparison.scenes[0]);
  EXPECT_NE(notice.find("18 on Alpha CPU, 6 on Beta, CPU"), std::string::npos) << notice;
  const auto summary = summarize(comparison);
  EXPECT_EQ(summary["scenes"][0]["unlike_machines"], notice);
  const std::string table = results_table(summary);
  EXPECT_NE(table.find("unlike machines"), std::string::npos) << table;
  const std::string sentence = summary["verdicts"][0]["sentence"];
  EXPECT_NE(sentence.find(notice), std::string::npos) << sentence;
}

TEST(UnlikeMachines, OneMachineNeedsNoNotice) {
  Comparison comparison = of_two_machines();
  for (Measurement& run : comparison.scenes[0].runs) run.cpu = "Alpha CPU";
  EXPECT_EQ(unlike_machines(comparison.scenes[0]), "");
  EXPECT_EQ(results_table(summarize(comparison)).find("unlike"), std::string::npos);
}

TEST(UnlikeMachines, EveryRowNamesItsCpu) {
  Measurement run = made_run(0, 0, 4, 1.0, 0.1);
  run.cpu = "Beta, CPU";
  EXPECT_TRUE(errors_csv_header().ends_with(",threads,cpu"));
  EXPECT_TRUE(errors_csv_row("s", 1, "owen", run).ends_with(",\"Beta, CPU\""));
}

struct OtherCpus : TestWithFiles {};

// Renders the journal's lines say were made on another CPU.
void rename_cpu(const std::string& journal, std::uint32_t seed, const std::string& cpu) {
  std::string text;
  for (auto line : read_journal_lines(journal)) {
    if (line.contains("run") && line["run"]["seed"] == seed) line["run"]["cpu"] = cpu;
    text += line.dump() + '\n';
  }
  std::ofstream(journal) << text;
}

TEST_F(OtherCpus, ASeedOfAnotherCpuCountsIfItIsWhole) {
  CompareSettings settings = small_settings(path("out"));
  settings.timing_repeats = 0;
  compare(settings, {});
  rename_cpu(path("out/journal.jsonl"), 1, "Beta CPU");
  settings.resume = true;
  const Comparison comparison = compare(settings, {});
  const SceneComparison& scene = comparison.scenes.at(0);
  EXPECT_EQ(scene.runs.size(), 12u);
  for (const Measurement& run : scene.runs) {
    EXPECT_EQ(run.cpu, run.seed == 1 ? "Beta CPU" : cpu_name());
  }
  EXPECT_NE(unlike_machines(scene), "");
}

TEST_F(OtherCpus, ASeedBegunOnAnotherCpuIsMeasuredAgain) {
  CompareSettings settings = small_settings(path("out"));
  settings.timing_repeats = 0;
  compare(settings, {});
  const std::string journal = path("out/journal.jsonl");
  rename_cpu(journal, 1, "Beta CPU");
  // One render of the seed is missing.
  const std::vector<std::string> lines = lines_of(journal);
  std::string text;
  bool left_out = false;
  for (const std::string& line : lines) {
    const bool of_seed = line.find("Beta CPU") != std::string::npos;
    if (!of_seed || std::exchange(left_out, true)) text += line + '\n';
  }
  ASSERT_TRUE(left_out);
  std::ofstream(journal) << text;
  settings.resume = true;
  const Comparison comparison = compare(settings, {});
  const SceneComparison& scene = comparison.scenes.at(0);
  EXPECT_EQ(scene.runs.size(), 12u);
  for (const Measurement& run : scene.runs) EXPECT_EQ(run.cpu, cpu_name());
  for (const RunSpectrum& spectrum : scene.spectra) EXPECT_EQ(spectrum.renders, 2);
}

}  // namespace
}  // namespace lockstep::test_compare_ranks
