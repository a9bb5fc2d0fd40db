// The one-line text form of samplers: what it says, what it refuses, and in which words.
#include "core/error.h"
#include "samplers/sampler_spec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lockstep {
namespace {

// The message with which `text` is refused; empty where it is accepted.
std::string refusal(std::string_view text) {
  try {
    parse_sampler(text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

#define EXPECT_REFUSED(text, part)                                                         \
  EXPECT_NE(refusal(text).find(part), std::string::npos) << text << ": " << refusal(text); \
  EXPECT_EQ(refusal(text).find('\n'), std::string::npos)

TEST(SamplerSpec, PresetsAreWhatTheirPapersSay) {
  const SamplerSpec random = parse_sampler("random");
  EXPECT_FALSE(random.shared);
  EXPECT_EQ(random.sequence, Sequence::Random);
  EXPECT_EQ(random.perturbation, Perturbation::None);

  const SamplerSpec owen = parse_sampler("owen");
  EXPECT_FALSE(owen.shared);
  EXPECT_EQ(owen.sequence, Sequence::Owen);

  const SamplerSpec cpt = parse_sampler("cpt");
  EXPECT_TRUE(cpt.shared);
  EXPECT_EQ(cpt.perturbation, Perturbation::None);
  EXPECT_EQ(cpt.weight_source, WeightSource::Constant);

  const SamplerSpec rcs = parse_sampler("rcs");
  EXPECT_TRUE(rcs.shared);
  EXPECT_EQ(rcs.perturbation, Perturbation::Constant);  // keeps u_k stratified
  EXPECT_EQ(rcs.weight_source, WeightSource::Map);
  EXPECT_EQ(rcs.combine, Combine::Add);
}

TEST(SamplerSpec, EveryOptionIsSet) {
  const SamplerSpec s = parse_sampler(
      "rcs:sequence=random,offset=constant,weight=map,c=2.5,t=0.125,filter=median,pilot=7,"
      "combine=weight");
  EXPECT_EQ(s.name, "rcs");
  EXPECT_TRUE(s.shared);
  EXPECT_EQ(s.sequence, Sequence::Random);
  EXPECT_EQ(s.perturbation, Perturbation::Constant);
  EXPECT_EQ(s.weight_source, WeightSource::Map);
  EXPECT_EQ(s.c, 2.5f);
  EXPECT_EQ(s.t, 0.125f);
  EXPECT_EQ(s.filter, WeightFilter::Median);
  EXPECT_EQ(s.pilot, 7);
  EXPECT_EQ(s.combine, Combine::Weight);

  EXPECT_EQ(parse_sampler("rcs:sequence=owen").sequence, Sequence::Owen);
  EXPECT_EQ(parse_sampler("rcs:offset=fresh").perturbation, Perturbation::Fresh);
  EXPECT_EQ(parse_sampler("rcs:offset=none,weight=1").perturbation, Perturbation::None);
  EXPECT_EQ(parse_sampler("rcs:filter=none").filter, WeightFilter::None);
  EXPECT_EQ(parse_sampler("rcs:filter=gaussian").filter, WeightFilter::Gaussian);
  EXPECT_EQ(parse_sampler("rcs:combine=add").combine, Combine::Add);
  EXPECT_EQ(parse_sampler("rcs:pilot=0").pilot, 0);
  const SamplerSpec constant = parse_sampler("cpt:offset=fresh,weight=0.3");
  EXPECT_EQ(constant.weight_source, WeightSource::Constant);
  EXPECT_EQ(constant.weight, 0.3f);
  EXPECT_EQ(parse_sampler("cpt:offset=fresh,weight=map").weight_source, WeightSource::Map);
}

TEST(SamplerSpec, OptionsMayComeInAnyOrderAndTheLastOneCounts) {
  EXPECT_EQ(parse_sampler("cpt:weight=map,offset=fresh").weight_source, WeightSource::Map);
  EXPECT_EQ(parse_sampler("rcs:c=1,c=2").c, 2.0f);
  EXPECT_EQ(parse_sampler("rcs:weight=1.5,weight=0.5").weight, 0.5f);
}

TEST(SamplerSpec, CanonicalTextNamesOnlyWhatDiffersFromThePreset) {
  for (const char* name : {"random", "owen", "cpt", "rcs"}) {
    EXPECT_EQ(to_string(parse_sampler(name)), name);
  }
  EXPECT_EQ(to_string(parse_sampler("rcs:c=4,t=0.02,filter=gaussian,offset=constant")), "rcs");
  EXPECT_EQ(to_string(parse_sampler("rcs:t=0.05,c=8")), "rcs:c=8,t=0.05");
  EXPECT_EQ(to_string(parse_sampler("rcs:weight=0.25")), "rcs:weight=0.25");
  EXPECT_EQ(to_string(parse_sampler("rcs:combine=weight,pilot=4,filter=none,offset=fresh,"
                                    "sequence=random")),
            "rcs:sequence=random,offset=fresh,filter=none,pilot=4,combine=weight");
}

TEST(SamplerSpec, TextSurvivesARoundTrip) {
  for (const char* text :
       {"random", "owen", "cpt", "rcs", "rcs:c=8,t=0.05", "rcs:weight=0.1", "rcs:weight=0",
        "rcs:c=3.3333333", "rcs:c=inf", "cpt:sequence=random", "cpt:offset=constant,weight=0.7",
        "rcs:sequence=random,offset=fresh,c=0,t=0,filter=median,pilot=4,combine=weight"}) {
    const SamplerSpec spec = parse_sampler(text);
    const std::string canonical = to_string(spec);
    const SamplerSpec again = parse_sampler(canonical);
    EXPECT_EQ(to_string(again), canonical);
    EXPECT_EQ(again.c, spec.c) << text;
    EXPECT_EQ(again.t, spec.t) << text;
    EXPECT_EQ(again.weight, spec.weight) << text;
    EXPECT_EQ(again.sequence, spec.sequence) << text;
    EXPECT_EQ(again.perturbation, spec.perturbation) << text;
    EXPECT_EQ(again.weight_source, spec.weight_source) << text;
    EXPECT_EQ(again.filter, spec.filter) << text;
    EXPECT_EQ(again.pilot, spec.pilot) << text;
    EXPECT_EQ(again.combine, spec.combine) << text;
  }
}

TEST(SamplerSpec, UnknownNamesAreRefusedWithTheChoices) {
  EXPECT_REFUSED("sobol", "unknown sampler 'sobol'; choose from random, owen, cpt, rcs");
  EXPECT_REFUSED("", "unknown sampler ''");
  EXPECT_REFUSED("RCS", "unknown sampler 'RCS'");
  EXPECT_REFUSED("rcs ", "unknown sampler 'rcs '");
  EXPECT_REFUSED("rcs:d=1",
                 "unknown sampler option 'd'; choose from sequence offset weight c t "
                 "filter pilot combine");
}

TEST(SamplerSpec, UnknownValuesAreRefusedWithTheChoices) {
  EXPECT_REFUSED("rcs:sequence=halton", "sequence=halton is unknown; choose from random, owen");
  EXPECT_REFUSED("rcs:offset=old", "offset=old is unknown; choose from none, fresh, constant");
  EXPECT_REFUSED("rcs:filter=box", "filter=box is unknown; choose from none, gaussian, median");
  EXPECT_REFUSED("rcs:combine=max", "combine=max is unknown; choose from add, weight");
  EXPECT_REFUSED("rcs:filter=", "filter= is unknown");
}

TEST(SamplerSpec, NumbersAreRefusedOutsideTheirRange) {
  for (const char* value : {"", "x", "-1", "nan", "1e99", "2x", " 2", "0x"}) {
    const std::string text = value;
    EXPECT_REFUSED("rcs:c=" + text, "c=" + text + " needs a number of at least 0");
    EXPECT_REFUSED("rcs:t=" + text, "t=" + text + " needs a number of at least 0");
    EXPECT_REFUSED("rcs:weight=" + text, "weight=" + text + " needs a number of at least 0");
    EXPECT_REFUSED("rcs:pilot=" + text, "pilot=" + text + " needs");
  }
  EXPECT_REFUSED("rcs:pilot=2.5", "pilot=2.5 needs a whole number");
  EXPECT_REFUSED("rcs:pilot=1e9", "pilot=1e9 needs a whole number");
  EXPECT_REFUSED("rcs:weight=1.5", "weight lies in [0, 1]; 1 is already independent");
  EXPECT_REFUSED("rcs:weight=inf", "weight lies in [0, 1]");
  EXPECT_EQ(refusal("rcs:weight=1"), "");
  EXPECT_EQ(refusal("rcs:weight=0"), "");
}

TEST(SamplerSpec, OptionsNeedTheirForm) {
  EXPECT_REFUSED("rcs:", "'' needs the form key=value");
  EXPECT_REFUSED("rcs:c", "'c' needs the form key=value");
  EXPECT_REFUSED("rcs:c=1,", "'' needs the form key=value");
  EXPECT_REFUSED("rcs:c=1,,t=2", "'' needs the form key=value");
  EXPECT_REFUSED("rcs:=1", "unknown sampler option ''");
}

TEST(SamplerSpec, SamplersWithoutASharedSequenceHaveNoOptions) {
  for (const char* option : {"sequence=owen", "offset=fresh", "weight=0.5", "weight=map", "c=1",
                             "t=1", "filter=none", "pilot=1", "combine=add"}) {
    const std::string key = std::string(option).substr(0, std::string(option).find('='));
    EXPECT_REFUSED("random:" + std::string(option), "sampler random has no option " + key);
    EXPECT_REFUSED("owen:" + std::string(option), "sampler owen has no option " + key);
  }
}

TEST(SamplerSpec, AMapWithoutAnOffsetIsRefused) {
  EXPECT_REFUSED("rcs:offset=none", "a weight map needs an offset to weigh; set offset=");
  EXPECT_REFUSED("cpt:weight=map", "a weight map needs an offset to weigh");
  EXPECT_REFUSED("cpt:weight=0.5", "a weight needs an offset to weigh");
  EXPECT_REFUSED("cpt:c=4", "c=4 has no effect without a map");
  EXPECT_REFUSED("rcs:c=4,weight=0.5", "c=4 has no effect without a map");
}

TEST(SamplerSpec, OnlyAMapWithWeightedCombinationIsBiased) {
  EXPECT_TRUE(parse_sampler("random").unbiased());
  EXPECT_TRUE(parse_sampler("rcs").unbiased());
  EXPECT_TRUE(parse_sampler("rcs:weight=0.5").unbiased());
  EXPECT_FALSE(parse_sampler("rcs:combine=weight").unbiased());
}

TEST(SamplerSpec, HelpNamesEveryPresetAndOption) {
  const std::string help = sampler_help();
  for (const char* word : {"random", "owen", "cpt", "rcs", "sequence", "offset", "weight", "c", "t",
                           "filter", "pilot", "combine", "none|gaussian|median", "add|weight"}) {
    EXPECT_NE(help.find(word), std::string::npos) << word;
  }
}

TEST(SamplerSpec, ListsAreSplitWhereASamplerBegins) {
  using List = std::vector<std::string>;
  EXPECT_EQ(split_sampler_list("random"), List{"random"});
  EXPECT_EQ(split_sampler_list("random,owen"), (List{"random", "owen"}));
  EXPECT_EQ(split_sampler_list("random,rcs:c=4,t=0.02,owen"),
            (List{"random", "rcs:c=4,t=0.02", "owen"}));
  EXPECT_EQ(split_sampler_list("rcs:c=4,t=0.02,rcs:c=8,pilot=2,cpt"),
            (List{"rcs:c=4,t=0.02", "rcs:c=8,pilot=2", "cpt"}));
  EXPECT_EQ(split_sampler_list(""), List{});
  EXPECT_EQ(split_sampler_list("c=4,owen"), (List{"c=4", "owen"}));  // refused when parsed
  EXPECT_EQ(split_sampler_list("random,,owen"), (List{"random", "", "owen"}));
}

}  // namespace
}  // namespace lockstep
