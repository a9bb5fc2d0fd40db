// Comparisons that are stopped and continued, and the files that this rests on.
#include "core/error.h"
#include "experiments/compare/errors_csv.h"
#include "experiments/compare/journal.h"
#include "experiments/compare/run_list.h"
#include "experiments/compare/summary.h"
#include "experiments/output/output_file.h"
#include "tests/t_compare.h"
#include "tests/t_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <map>
#include <sstream>

namespace lockstep::test_resume {
namespace {

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// What of a comparison's results does not depend on time, by name.
std::map<std::string, std::string> timeless(const Comparison& comparison) {
  const fs::path folder = comparison.settings.directory;
  std::map<std::string, std::string> results;
  for (const auto& file : fs::directory_iterator(folder)) {
    const std::string name = file.path().filename().string();
    if (name.ends_with(".png") || name.starts_with("reference-")) {
      results[name] = bytes_of(file.path());
    }
  }
  results["spectra.csv"] = spectra_csv(comparison);
  std::string& errors = results["errors"];
  for (const Measurement& run : comparison.scenes.at(0).runs) {
    errors += fmt::format("{} {} {} {} {}:", run.sampler, run.seed, run.spp, run.pilot_spp,
                          run.mean_weight);
    for (double error : run.errors) errors += fmt::format(" {}", error);
    errors += '\n';
  }
  return results;
}

// Runs the comparison until `renders` of its renders are done.
Comparison stopped_after(const CompareSettings& settings, std::size_t renders) {
  const fs::path journal = fs::path(settings.directory) / kJournalFile;
  return compare(settings, [&](double, std::string_view label) {
    if (label.find("seed") == std::string_view::npos) return true;
    std::size_t done = 0;
    for (const auto& line : read_journal_lines(journal.string())) done += line.contains("run");
    return done + 1 < renders;
  });
}

struct Folders : TestWithFiles {
  CompareSettings settings_in(const std::string& folder) const {
    return small_settings(path(folder));
  }
};

TEST_F(Folders, AResumedComparisonIsTheSameWhereverItWasStopped) {
  const auto whole = timeless(compare(settings_in("whole"), {}));
  ASSERT_GE(whole.size(), 2u * 3u + 3u);
  for (std::size_t renders : {1, 5, 11}) {
    CompareSettings settings = settings_in("part" + std::to_string(renders));
    const Comparison part = stopped_after(settings, renders);
    EXPECT_FALSE(part.complete);
    ASSERT_EQ(part.scenes.at(0).runs.size(), renders) << "the render under way is finished";
    settings.resume = true;
    const Comparison resumed = compare(settings, {});
    EXPECT_TRUE(resumed.complete);
    EXPECT_EQ(timeless(resumed), whole) << renders;
    EXPECT_EQ(lines_of(path("part" + std::to_string(renders)) + "/errors.csv").size(), 13u);
  }
}

TEST_F(Folders, WhatIsCompleteIsNotRenderedAgain) {
  CompareSettings settings = settings_in("out");
  compare(settings, {});
  const std::string errors = bytes_of(path("out/errors.csv"));
  settings.resume = true;
  int calls = 0;
  const Comparison again = compare(settings, [&](double, std::string_view) { return ++calls > 0; });
  EXPECT_EQ(calls, 0);
  EXPECT_TRUE(again.complete);
  EXPECT_EQ(bytes_of(path("out/errors.csv")), errors) << "times included";
}

TEST_F(Folders, MoreSeedsAddToWhatThereIs) {
  CompareSettings settings = settings_in("out");
  compare(settings, {});
  settings.resume = true;
  settings.seeds = 3;
  const Comparison more = compare(settings, {});
  EXPECT_EQ(more.scenes.at(0).runs.size(), 3u * 2u * 3u);
  CompareSettings fresh = settings_in("fresh");
  fresh.seeds = 3;
  EXPECT_EQ(timeless(more), timeless(compare(fresh, {})));
}

TEST_F(Folders, ALastLineThatWasCutShortIsRenderedAgain) {
  CompareSettings settings = settings_in("out");
  const auto whole = timeless(compare(settings, {}));
  const std::string journal = path("out/journal.jsonl");
  const std::string text = bytes_of(journal);
  const std::size_t last_run = text.rfind("{\"scene\"");
  fs::resize_file(journal, last_run + 40);
  settings.resume = true;
  EXPECT_EQ(timeless(compare(settings, {})), whole);
}

TEST_F(Folders, ADamagedLineIsNamed) {
  CompareSettings settings = settings_in("out");
  stopped_after(settings, 2);
  std::ofstream(path("out/journal.jsonl"), std::ios::app) << "{\"scene\": 1}\n";
  const std::size_t lines = lines_of(path("out/journal.jsonl")).size();
  settings.resume = true;
  expect_one_line_with(message_of([&] { compare(settings, {}); }),
                       "journal.jsonl:" + std::to_string(lines) + ": ");
}

TEST_F(Folders, OtherConditionsAreRefused) {
  CompareSettings settings = settings_in("out");
  compare(settings, {});
  settings.resume = true;
  settings.render.threads = 3;
  const std::string message = message_of([&] { compare(settings, {}); });
  expect_one_line_with(message, "journal.jsonl:2: cornell at depth");
  expect_one_line_with(message, "3 threads");
}

TEST_F(Folders, WithoutResumeEarlierResultsAreSetAside) {
  const CompareSettings settings = settings_in("out");
  compare(settings, {});
  const std::string first = bytes_of(path("out/errors.csv"));
  compare(settings, {});
  compare(settings, {});
  EXPECT_EQ(bytes_of(path("out/errors-previous.csv")), first);
  EXPECT_TRUE(fs::exists(path("out/errors-previous-2.csv")));
  EXPECT_TRUE(fs::exists(path("out/journal-previous-2.jsonl")));
}

TEST_F(Folders, AStoppedReferenceGoesOn) {
  CompareSettings settings = settings_in("whole");
  settings.reference_spp = 512;
  const auto whole = timeless(compare(settings, {}));
  settings.directory = path("part");
  settings.resume = true;
  const Comparison stopped = compare(settings, [](double fraction, std::string_view label) {
    return label.find("reference") == std::string_view::npos || fraction < 0.3;
  });
  EXPECT_TRUE(stopped.scenes.empty());
  const auto states = [&] {
    int count = 0;
    for (const auto& file : fs::directory_iterator(path("part"))) {
      count += file.path().extension() == ".state";
    }
    return count;
  };
  EXPECT_GT(states(), 0);
  double first = 1.0;
  const Comparison resumed = compare(settings, [&](double fraction, std::string_view label) {
    if (label.find("reference") != std::string_view::npos) first = std::min(first, fraction);
    return true;
  });
  EXPECT_GT(first, 0.1) << "the part that was done is not rendered again";
  EXPECT_EQ(states(), 0);
  EXPECT_EQ(timeless(resumed), whole);
}

TEST_F(Folders, ResultsWithoutAJournalAreSetAside) {
  CompareSettings settings = settings_in("out");
  settings.resume = true;
  write("out/errors.csv", "older\n");
  compare(settings, {});
  EXPECT_EQ(bytes_of(path("out/errors-previous.csv")), "older\n");
}

TEST_F(Folders, OneProcessAtATimeWrites) {
  write("out/journal.jsonl", "");
  {
    const AppendFile running(path("out/journal.jsonl"));
    for (bool resume : {false, true}) {
      expect_one_line_with(message_of([&] { Journal(path("out"), resume); }), "another process");
    }
  }
  EXPECT_FALSE(fs::exists(path("out/journal-previous.jsonl")));
  AppendFile file(path("a"));
  EXPECT_TRUE(is_being_appended(path("a")));
  expect_one_line_with(message_of([&] { AppendFile second(path("a")); }), "another process");
  EXPECT_FALSE(is_being_appended(path("b")));
}

// Files of this process may not grow beyond `bytes` while this lives: a disk that is full.
struct FileLimit {
  explicit FileLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit limit{bytes, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() { setrlimit(RLIMIT_FSIZE, &before); }
  rlimit before{};
};

TEST_F(Folders, AFullDiskLosesNothingThatWasWritten) {
  AppendFile file(path("a"));
  file.append("first\n");
  write_text_file(path("b"), "first\n");
  {
    const FileLimit limit(10);
    expect_one_line_with(message_of([&] { file.append("second\n"); }), "a: cannot be written: ");
    expect_one_line_with(message_of([&] { write_text_file(path("b"), "a longer text\n"); }),
                         "b: cannot be written: ");
  }
  EXPECT_EQ(bytes_of(path("a")), "first\n");
  EXPECT_EQ(bytes_of(path("b")), "first\n");
  file.append("third\n");
  EXPECT_EQ(bytes_of(path("a")), "first\nthird\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()), 2);
}

TEST_F(Folders, UnsteadyTimesAreRepeatedAndKept) {
  CompareSettings settings = settings_in("out");
  settings.timing_spread = 0.0;
  settings.timing_repeats = 2;
  const Comparison comparison = compare(settings, {});
  EXPECT_EQ(comparison.scenes.at(0).repeats.size(), 2u * 2u * 3u);
  EXPECT_EQ(lines_of(path("out/errors.csv")).size(), 13u) << "repeats have no errors";
  const auto rung = summarize(comparison)["scenes"][0]["samplers"][0]["rungs"][0];
  EXPECT_EQ(rung["cpu_seconds"]["renders"], 2 + 2);
  EXPECT_EQ(rung["cpu_seconds"]["steady"], false);
  settings.resume = true;
  EXPECT_EQ(compare(settings, {}).scenes.at(0).repeats.size(), 12u) << "counted on resuming";
}

TEST_F(Folders, DepthsAreExperimentsOfTheirOwn) {
  CompareSettings settings = settings_in("out");
  settings.depths = {1, 3};
  settings.seeds = 1;
  int partial = 0;
  const Comparison comparison = compare(settings, {}, [&](const Comparison& so_far) {
    ++partial;
    EXPECT_FALSE(so_far.complete);
    EXPECT_EQ(so_far.scenes.size(), 1u);
  });
  EXPECT_EQ(partial, 1);
  ASSERT_EQ(comparison.scenes.size(), 2u);
  EXPECT_EQ(comparison.scenes[0].label, "cornell-depth1");
  EXPECT_EQ(comparison.scenes[1].depth, 3);
  EXPECT_NE(comparison.scenes[0].runs[0].errors, comparison.scenes[1].runs[0].errors);
  EXPECT_TRUE(fs::exists(path("out/cornell-depth3-cpt-8spp.png")));
}

TEST_F(Folders, RunsAreListed) {
  compare(settings_in("all/complete"), {});
  stopped_after(settings_in("all/deep/stopped"), 3);
  write("all/damaged/journal.jsonl",
        "nothing\n" + std::string(1'000'000, '[') + std::string(1'000'000, ']') + "\n");
  const std::vector<ListedRun> runs = list_runs(path("all"));
  ASSERT_EQ(runs.size(), 3u);
  std::map<std::string, ListedRun> by_name;
  for (const ListedRun& run : runs) by_name[fs::path(run.directory).filename()] = run;
  EXPECT_EQ(by_name["complete"].state, RunState::Complete);
  EXPECT_EQ(by_name["complete"].renders, 12u);
  EXPECT_EQ(by_name["stopped"].state, RunState::Stopped);
  EXPECT_EQ(by_name["stopped"].renders, 3u);
  EXPECT_EQ(by_name["stopped"].planned, 12u);
  EXPECT_EQ(by_name["damaged"].state, RunState::Damaged);
  EXPECT_NE(run_table(runs).find("3/12  cornell: random,cpt,rcs"), std::string::npos)
      << run_table(runs);
  expect_one_line_with(message_of([&] { list_runs(path("none")); }), "no such folder");
}

}  // namespace
}  // namespace lockstep::test_resume
