// Sequences and perturbations from outside: the library's own, added, give the same values at every
// width. That whole programs with additions work, install/install_test.sh sees.
#include "samplers/added.h"

#include "core/error.h"
#include "samplers/presets.h"
#include "tests/t_samples.h"

#include <cstdlib>
#include <list>
#include <string>

namespace lockstep {
namespace test_added {

// Samples 3 to 20 of some pixels of a tile: two packets of 16 and a part of one.
Couples some_couples(int width) {
  Couples c;
  for (std::uint32_t k = 3; k <= 20; ++k) {
    for (const std::uint32_t x : {1u, 6u}) c.add(k % 5 * std::uint32_t(width) + x, k);
  }
  return c;
}

void expect_same_values(const SamplerState& own, const SamplerState& added) {
  for (const int width : {1, 4, 8, 16}) {
    const Kernel& kernel = find_kernel(available_isas().back(), width);
    for (const int pair : {0, 2, 9}) {
      const Couples c = some_couples(own.width);
      EXPECT_EQ(draw_batch(kernel, own, c, pair), draw_batch(kernel, added, c, pair))
          << "width " << width << ", pair " << pair;
    }
  }
}

const SamplePlan plan{32, 24, 16};

TEST(Added, SequenceOfAPixelHasTheValuesOfTheSameOneCompiledIn) {
  const SamplerState own = state_of("owen", 5, plan);
  SamplerState added = state_of("random", 5, plan);
  added.added_points = points_of<OwenSequence>();
  expect_same_values(own, added);
}

TEST(Added, SharedSequenceHasTheValuesOfTheSameOneCompiledIn) {
  for (const char* options : {"share=image", "share=tile,offset=constant,interleave=2",
                              "share=image,offset=morton,mix=xor,pairs=2"}) {
    const SamplerState own = state_of(std::string("owen:") + options, 5, plan);
    SamplerState added = state_of(std::string("random:") + options, 5, plan);
    added.added_points = points_of<OwenSequence>();
    expect_same_values(own, added);
  }
}

TEST(Added, OffsetHasTheValuesOfTheSameOneCompiledIn) {
  const SamplerState own = state_of("cpt:offset=fresh,weight=0.5", 5, plan);
  SamplerState added = state_of("cpt:offset=constant,weight=0.5", 5, plan);
  added.added_offsets = offsets_of<FreshOffset>();
  expect_same_values(own, added);
}

TEST(Added, NamesThatAreTakenOrCannotBeTypedAreRefused) {
  for (const char* name : {"owen", "rcs", "", "a,b", "a:b", "a=b", "Owen", "a b"}) {
    EXPECT_THROW(add_sequence(SequenceInfo{name, "", ""}, points_of<OwenSequence>()), Error)
        << name;
    Preset preset;
    preset.spec.name = name;
    EXPECT_THROW(add_preset(preset), Error) << name;
  }
  for (const char* name : {"fresh", "none", "", "a,b"}) {
    EXPECT_THROW(add_perturbation(PerturbationInfo{name, "", ""}, offsets_of<FreshOffset>()), Error)
        << name;
  }
  EXPECT_EQ(sequence_infos().size(), std::size_t(Sequences::size));
  EXPECT_EQ(perturbation_infos().size(), std::size_t(Perturbations::size));
}

// What is added stays for as long as the program runs: in processes of their own.
void expect_in_a_process(void (*check)()) {
  EXPECT_EXIT(
      {
        check();
        std::exit(testing::Test::HasFailure() ? 1 : 0);
      },
      testing::ExitedWithCode(0), "");
}

TEST(AddedDeathTest, SequencesAndOffsetsAreFoundByTheirNames) {
  expect_in_a_process([] {
    add_sequence(SequenceInfo{"mine", "", ""}, points_of<OwenSequence>());
    add_perturbation(PerturbationInfo{"my-offset", "", ""}, offsets_of<FreshOffset>());
    EXPECT_EQ(sequence_infos().back().name, "mine");
    EXPECT_EQ(perturbation_infos().back().name, "my-offset");
    expect_same_values(state_of("owen", 5, plan), state_of("mine", 5, plan));
    expect_same_values(state_of("cpt:offset=fresh,weight=0.5", 5, plan),
                       state_of("cpt:offset=my-offset,weight=0.5", 5, plan));
    EXPECT_THROW(add_sequence(SequenceInfo{"mine", "", ""}, points_of<OwenSequence>()), Error);
    EXPECT_THROW(
        add_perturbation(PerturbationInfo{"my-offset", "", ""}, offsets_of<FreshOffset>()), Error);
  });
}

TEST(AddedDeathTest, AsManyAreAddedAsAnIdTellsApart) {
  expect_in_a_process([] {
    std::list<std::string> names;  // which live as long as the process
    for (std::size_t i = perturbation_infos().size(); i < 256; ++i) {
      names.push_back("offset-" + std::to_string(i));
      add_perturbation(PerturbationInfo{names.back(), "", ""}, offsets_of<FreshOffset>());
    }
    EXPECT_THROW(add_perturbation(PerturbationInfo{"one-more", "", ""}, offsets_of<FreshOffset>()),
                 Error);
    EXPECT_EQ(perturbation_infos().size(), 256u);
    expect_same_values(state_of("cpt:offset=fresh,weight=0.5", 5, plan),
                       state_of("cpt:weight=0.5,offset=" + names.back(), 5, plan));
  });
}

}  // namespace test_added
}  // namespace lockstep
