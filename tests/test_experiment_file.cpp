// Experiments as TOML files: what is read, and where mistakes are named.
#include "experiments/compare/experiment_file.h"
#include "tests/t_files.h"

#include <gtest/gtest.h>

namespace lockstep::test_experiment_file {
namespace {

struct ExperimentFile : TestWithFiles {
  std::string complaint(const std::string& text) const {
    const std::string file = write("e.toml", text);
    return message_of([&] { read_experiment(file); });
  }
};

TEST_F(ExperimentFile, ValuesAreReadAsTyped) {
  const auto entries = read_experiment(write("e.toml",
                                             "# a comment\n"
                                             "scenes = ['cornell', \"reef\"]\n"
                                             "spp = [4, 16]\n"
                                             "seeds = 8\n\n"
                                             "time_budgets = 0.5\n"
                                             "width = 'auto'\n"
                                             "quiet = true\n"));
  ASSERT_EQ(entries.size(), 6u);
  EXPECT_EQ(entries[0].key->name, "scenes");
  EXPECT_EQ(entries[0].values, (std::vector<std::string>{"cornell", "reef"}));
  EXPECT_EQ(entries[1].values, (std::vector<std::string>{"4", "16"}));
  EXPECT_EQ(entries[2].values, std::vector<std::string>{"8"});
  EXPECT_EQ(entries[2].line, 4);
  EXPECT_EQ(entries[3].values, std::vector<std::string>{"0.5"}) << "one value for a list";
  EXPECT_EQ(entries[5].values, std::vector<std::string>{"true"});
}

TEST_F(ExperimentFile, MistakesAreNamedWithTheirLine) {
  expect_one_line_with(complaint("seeds = 4\nsede = 5\n"), "e.toml:2: there is no key 'sede'");
  expect_one_line_with(complaint("\nseeds = 'four'\n"),
                       "e.toml:2: seeds: a number is expected here, not text");
  expect_one_line_with(complaint("spp = [\n4,\n'x']\n"), "e.toml:3: spp: a number");
  expect_one_line_with(complaint("seeds = [1, 2]\n"),
                       "e.toml:1: seeds: a number is expected here, not a list");
  expect_one_line_with(complaint("quiet = 1\n"), "true or false is expected here");
  expect_one_line_with(complaint("samplers = []\n"), "e.toml:1: samplers: the list is empty");
  expect_one_line_with(complaint("[scenes]\na = 1\n"), "e.toml:1: scenes: text in quotes");
  expect_one_line_with(complaint("seeds = 4\nspp = [4,\n"), "e.toml:2: ");
  expect_one_line_with(complaint("seeds = 4\nseeds = 5\n"), "e.toml:2: ");
  expect_one_line_with(complaint("output = 1979-05-27\n"), "not a date");
  expect_one_line_with(message_of([&] { read_experiment(path("none.toml")); }),
                       "none.toml: no such");
  expect_one_line_with(message_of([&] { read_experiment(directory_.string()); }), "no such file");
}

TEST_F(ExperimentFile, WhatIsWrittenIsReadAgain) {
  const std::string text =
      "scenes = ['a \"b\"', 'c']\nspp = [4, 16]\nseeds = 8\ntime_budgets = [0.005, 2]\n"
      "output = \"it's\"\nthreads = 1\nwidth = 8\nquiet = true\n";
  const std::string once = experiment_text(read_experiment(write("a.toml", text)));
  EXPECT_EQ(once, text);
  EXPECT_EQ(experiment_text(read_experiment(write("b.toml", once))), once);
}

}  // namespace
}  // namespace lockstep::test_experiment_file
