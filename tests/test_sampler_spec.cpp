// The one-line text form of samplers: what it says, what it refuses, and in which words.
#include "core/error.h"
#include "samplers/perturbations.h"
#include "samplers/presets.h"
#include "samplers/sequences.h"

#include <gtest/gtest.h>

#include <set>

namespace lockstep::test_sampler_spec {
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

// Every field but the name.
void expect_same(const SamplerSpec& a, const SamplerSpec& b, std::string_view text) {
  EXPECT_EQ(a.share, b.share) << text;
  EXPECT_EQ(a.pairs, b.pairs) << text;
  EXPECT_EQ(a.interleave, b.interleave) << text;
  EXPECT_EQ(a.sequence, b.sequence) << text;
  EXPECT_EQ(a.perturbation, b.perturbation) << text;
  EXPECT_EQ(a.mix, b.mix) << text;
  EXPECT_EQ(a.weight_source, b.weight_source) << text;
  EXPECT_EQ(a.weight, b.weight) << text;
  EXPECT_EQ(a.c, b.c) << text;
  EXPECT_EQ(a.t, b.t) << text;
  EXPECT_EQ(a.filter, b.filter) << text;
  EXPECT_EQ(a.pilot, b.pilot) << text;
  EXPECT_EQ(a.combine, b.combine) << text;
}

// Presets ---------------------------------------------------------------------------------------

TEST(SamplerSpec, EverySequenceIsAPresetOfPixelsThatShareNothing) {
  for (const SequenceInfo& info : Sequences::infos()) {
    const SamplerSpec s = parse_sampler(info.name);
    EXPECT_EQ(name(s.sequence), info.name);
    EXPECT_EQ(s.share, Share::Pixel);
    EXPECT_FALSE(s.shared());
    EXPECT_EQ(name(s.perturbation), "none");
    EXPECT_EQ(s.weight_source, WeightSource::Constant);
  }
}

TEST(SamplerSpec, PresetsAreWhatTheirPapersSay) {
  const SamplerSpec cpt = parse_sampler("cpt");
  EXPECT_EQ(cpt.share, Share::Image);
  EXPECT_EQ(name(cpt.sequence), "owen");
  EXPECT_EQ(name(cpt.perturbation), "none");
  EXPECT_EQ(cpt.weight_source, WeightSource::Constant);

  const SamplerSpec rcs = parse_sampler("rcs");
  EXPECT_EQ(rcs.share, Share::Image);
  EXPECT_EQ(name(rcs.perturbation), "constant");  // keeps u_k stratified
  EXPECT_EQ(rcs.mix, Mix::Add);
  EXPECT_EQ(rcs.weight_source, WeightSource::Map);
  EXPECT_EQ(rcs.combine, Combine::Add);

  const SamplerSpec bluenoise = parse_sampler("bluenoise");
  EXPECT_EQ(bluenoise.share, Share::Image);
  EXPECT_EQ(name(bluenoise.perturbation), "bluenoise");
  EXPECT_EQ(bluenoise.mix, Mix::Add);
  EXPECT_EQ(bluenoise.weight_source, WeightSource::Constant);
  EXPECT_EQ(bluenoise.weight, 1.0f);

  const SamplerSpec strata = parse_sampler("strata");
  EXPECT_EQ(strata.share, Share::Image);
  EXPECT_EQ(strata.mix, Mix::Xor);
  EXPECT_EQ(strata.weight_source, WeightSource::Cells);
  EXPECT_EQ(strata.pairs, 3);
}

TEST(SamplerSpec, NamesAreThoseOfPresetsAndEachIsThereOnce) {
  const std::vector<std::string> names = sampler_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  EXPECT_EQ(names.size(), std::size_t(Sequences::size) + 4);
  for (const std::string& name : names) {
    EXPECT_EQ(parse_sampler(name).name, name);
    EXPECT_EQ(to_string(parse_sampler(name)), name);
    EXPECT_EQ(find_preset(name).spec.name, name);
  }
}

TEST(SamplerSpec, SequencesAndOffsetsAreFoundByName) {
  for (const SequenceInfo& info : Sequences::infos()) {
    EXPECT_EQ(name(sequence_named(info.name)), info.name);
  }
  for (const PerturbationInfo& info : Perturbations::infos()) {
    EXPECT_EQ(name(perturbation_named(info.name)), info.name);
  }
  EXPECT_EQ(perturbation_named("none"), PerturbationId{});
  EXPECT_EQ(sequence_named("random"), SequenceId{});
  EXPECT_THROW(sequence_named("none"), UsageError);
  EXPECT_THROW(perturbation_named("owen"), UsageError);
}

// Options ---------------------------------------------------------------------------------------

TEST(SamplerSpec, EveryOptionIsSet) {
  SamplerSpec expected;
  expected.name = "rcs";
  expected.share = Share::Tile;
  expected.pairs = 5;
  expected.interleave = 2;
  expected.sequence = sequence_named("random");
  expected.perturbation = perturbation_named("fresh");
  expected.mix = Mix::Xor;
  expected.weight_source = WeightSource::Map;
  expected.c = 2.5f;
  expected.t = 0.125f;
  expected.filter = WeightFilter::Median;
  expected.pilot = 7;
  expected.combine = Combine::Weight;
  expect_same(
      parse_sampler("rcs:sequence=random,share=tile,pairs=5,interleave=2,offset=fresh,"
                    "mix=xor,weight=map,c=2.5,t=0.125,filter=median,pilot=7,combine=weight"),
      expected, "all options");
}

TEST(SamplerSpec, EveryChoiceIsSet) {
  for (const SequenceInfo& i : Sequences::infos()) {
    const auto text = "rcs:sequence=" + std::string(i.name);
    EXPECT_EQ(name(parse_sampler(text).sequence), i.name);
  }
  for (const PerturbationInfo& i : Perturbations::infos()) {
    const auto text = "rcs:weight=1,offset=" + std::string(i.name);
    EXPECT_EQ(name(parse_sampler(text).perturbation), i.name);
  }
  EXPECT_EQ(parse_sampler("owen:share=pixel").share, Share::Pixel);
  EXPECT_EQ(parse_sampler("owen:share=tile").share, Share::Tile);
  EXPECT_EQ(parse_sampler("owen:share=image").share, Share::Image);
  EXPECT_EQ(parse_sampler("strata:mix=add").mix, Mix::Add);
  EXPECT_EQ(parse_sampler("strata:pairs=0").pairs, 0);
  for (const int n : {1, 2, 4}) {
    EXPECT_EQ(parse_sampler("cpt:interleave=" + std::to_string(n)).interleave, n);
  }
  EXPECT_EQ(parse_sampler("rcs:filter=none").filter, WeightFilter::None);
  EXPECT_EQ(parse_sampler("rcs:filter=gaussian").filter, WeightFilter::Gaussian);
  EXPECT_EQ(parse_sampler("rcs:combine=add").combine, Combine::Add);
  EXPECT_EQ(parse_sampler("rcs:pilot=0").pilot, 0);
  EXPECT_EQ(parse_sampler("rcs:weight=auto").weight_source, WeightSource::Auto);
  EXPECT_EQ(parse_sampler("rcs:weight=cells").weight_source, WeightSource::Cells);
  EXPECT_EQ(parse_sampler("strata:weight=map").weight_source, WeightSource::Map);
  const SamplerSpec constant = parse_sampler("cpt:offset=fresh,weight=0.3");
  EXPECT_EQ(constant.weight_source, WeightSource::Constant);
  EXPECT_EQ(constant.weight, 0.3f);
}

TEST(SamplerSpec, OptionsMayComeInAnyOrderAndTheLastOneCounts) {
  EXPECT_EQ(parse_sampler("cpt:weight=map,offset=fresh").weight_source, WeightSource::Map);
  EXPECT_EQ(parse_sampler("owen:offset=fresh,weight=auto,pilot=2,share=tile").pilot, 2);
  EXPECT_EQ(parse_sampler("rcs:c=1,c=2").c, 2.0f);
  EXPECT_EQ(parse_sampler("rcs:weight=1.5,weight=0.5").weight, 0.5f);
}

// Text ------------------------------------------------------------------------------------------

TEST(SamplerSpec, CanonicalTextNamesOnlyWhatDiffersFromThePreset) {
  EXPECT_EQ(to_string(parse_sampler("rcs:c=4,t=0.02,filter=gaussian,offset=constant")), "rcs");
  EXPECT_EQ(to_string(parse_sampler("strata:share=image,mix=xor,weight=cells,pairs=3")), "strata");
  EXPECT_EQ(to_string(parse_sampler("rcs:t=0.05,c=8")), "rcs:c=8,t=0.05");
  EXPECT_EQ(to_string(parse_sampler("rcs:weight=0.25")), "rcs:weight=0.25");
  EXPECT_EQ(to_string(parse_sampler("rcs:combine=weight,pilot=4,filter=none,mix=xor,offset=fresh,"
                                    "interleave=4,pairs=2,share=tile,sequence=random")),
            "rcs:sequence=random,share=tile,pairs=2,interleave=4,offset=fresh,mix=xor,filter=none,"
            "pilot=4,combine=weight");
}

TEST(SamplerSpec, TextSurvivesARoundTrip) {
  std::vector<std::string> texts = sampler_names();
  for (const char* text :
       {"rcs:c=8,t=0.05", "rcs:weight=0.1", "rcs:weight=0", "rcs:c=3.3333333", "rcs:c=inf",
        "cpt:sequence=random", "cpt:offset=constant,weight=0.7", "strata:pairs=65536",
        "owen:share=image,offset=bluenoise,weight=1e-7", "zsobol:share=tile,interleave=4",
        "rcs:weight=auto,pilot=9,combine=weight", "bluenoise:weight=cells,mix=xor",
        "rcs:sequence=random,offset=fresh,c=0,t=0,filter=median,pilot=4,combine=weight"}) {
    texts.push_back(text);
  }
  for (const SequenceInfo& i : Sequences::infos()) {
    for (const PerturbationInfo& p : Perturbations::infos()) {
      texts.push_back("cpt:mix=xor,sequence=" + std::string(i.name) +
                      ",offset=" + std::string(p.name));
    }
  }
  for (const std::string& text : texts) {
    const SamplerSpec spec = parse_sampler(text);
    const std::string canonical = to_string(spec);
    EXPECT_EQ(to_string(parse_sampler(canonical)), canonical);
    expect_same(parse_sampler(canonical), spec, text);
  }
}

// Refusals --------------------------------------------------------------------------------------

TEST(SamplerSpec, UnknownNamesAreRefusedWithTheChoices) {
  EXPECT_REFUSED("niederreiter", "unknown sampler 'niederreiter'; choose from random, stratified,");
  EXPECT_REFUSED("niederreiter", "cpt, rcs, bluenoise, strata");
  EXPECT_REFUSED("", "unknown sampler ''");
  EXPECT_REFUSED("RCS", "unknown sampler 'RCS'");
  EXPECT_REFUSED("rcs ", "unknown sampler 'rcs '");
  EXPECT_REFUSED("rcs:d=1",
                 "unknown sampler option 'd'; choose from sequence share pairs interleave offset "
                 "mix weight c t filter pilot combine");
}

TEST(SamplerSpec, UnknownValuesAreRefusedWithTheChoices) {
  EXPECT_REFUSED("rcs:sequence=faure", "sequence=faure is unknown; choose from random, stratified");
  EXPECT_REFUSED("rcs:share=row", "share=row is unknown; choose from pixel, tile, image");
  EXPECT_REFUSED("rcs:offset=old",
                 "offset=old is unknown; choose from none, fresh, constant, bluenoise, morton");
  EXPECT_REFUSED("rcs:mix=or", "mix=or is unknown; choose from add, xor");
  EXPECT_REFUSED("rcs:filter=box", "filter=box is unknown; choose from none, gaussian, median");
  EXPECT_REFUSED("rcs:combine=max", "combine=max is unknown; choose from add, weight");
  EXPECT_REFUSED("rcs:filter=", "filter= is unknown");
  for (const char* value : {"0", "3", "8", "5"}) {
    const std::string text = value;
    EXPECT_REFUSED("cpt:interleave=" + text, "interleave=" + text + " must be 1, 2 or 4");
  }
}

TEST(SamplerSpec, NumbersAreRefusedOutsideTheirRange) {
  for (const char* value : {"", "x", "-1", "nan", "1e99", "2x", " 2", "0x"}) {
    const std::string text = value;
    for (const char* key : {"c", "t", "weight"}) {
      const std::string item = std::string(key) + "=" + text;
      EXPECT_REFUSED("rcs:" + item, item + " needs a number of at least 0");
    }
    for (const char* key : {"pilot", "pairs", "interleave"}) {
      const std::string item = std::string(key) + "=" + text;
      EXPECT_REFUSED("rcs:" + item, item + " needs");
    }
  }
  EXPECT_REFUSED("rcs:pilot=2.5", "pilot=2.5 needs a whole number");
  EXPECT_REFUSED("rcs:pairs=1e9", "pairs=1e9 needs a whole number");
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

TEST(SamplerSpec, OptionsWithoutEffectAreRefused) {
  for (const char* option : {"pairs=2", "interleave=2", "offset=fresh", "mix=xor", "weight=0.5",
                             "weight=map", "c=1", "t=1", "filter=none", "pilot=1", "combine=add"}) {
    for (const char* sampler : {"random", "owen", "zsobol", "rcs:share=pixel"}) {
      const std::string begin = std::string(sampler) + (sampler[3] == ':' ? "," : ":");
      EXPECT_REFUSED(
          begin + option,
          std::string(option) + " has no effect without a shared sequence; set share=image");
    }
  }
  EXPECT_REFUSED("cpt:c=4", "c=4 has no effect without a map; set weight=map");
  EXPECT_REFUSED("rcs:c=4,weight=0.5", "c=4 has no effect without a map");
  EXPECT_REFUSED("rcs:weight=auto,t=0.1", "t=0.1 has no effect without a map");
  EXPECT_REFUSED("bluenoise:pilot=4",
                 "pilot=4 has no effect without a pilot; set weight=map or weight=auto");
  EXPECT_REFUSED("strata:combine=add", "combine=add has no effect without a pilot");
  EXPECT_EQ(refusal("rcs:weight=auto,pilot=4"), "");
}

TEST(SamplerSpec, AWeightWithoutAnOffsetIsRefused) {
  EXPECT_REFUSED("rcs:offset=none", "a weight map needs an offset to weigh; set offset=");
  EXPECT_REFUSED("cpt:weight=map", "a weight map needs an offset to weigh");
  EXPECT_REFUSED("cpt:weight=auto", "a weight map needs an offset to weigh");
  EXPECT_REFUSED("cpt:weight=0.5", "a weight needs an offset to weigh");
  EXPECT_REFUSED("cpt:weight=cells", "a weight needs an offset to weigh");
  EXPECT_REFUSED("owen:share=tile,weight=0.5", "a weight needs an offset to weigh");
}

// What it says of itself ------------------------------------------------------------------------

TEST(SamplerSpec, OnlyAPilotCombinedByWeightIsBiased) {
  for (const std::string& name : sampler_names()) EXPECT_TRUE(parse_sampler(name).unbiased());
  EXPECT_TRUE(parse_sampler("rcs:weight=0.5").unbiased());
  EXPECT_TRUE(parse_sampler("rcs:weight=auto").unbiased());
  EXPECT_FALSE(parse_sampler("rcs:combine=weight").unbiased());
  EXPECT_FALSE(parse_sampler("rcs:weight=auto,combine=weight").unbiased());
}

TEST(SamplerSpec, OnlyMapsAndAutomaticWeightsHaveAPilot) {
  for (const std::string& name : sampler_names()) {
    EXPECT_EQ(parse_sampler(name).has_pilot(), name == "rcs") << name;
  }
  EXPECT_TRUE(parse_sampler("strata:weight=auto").has_pilot());
  EXPECT_FALSE(parse_sampler("rcs:weight=cells").has_pilot());
}

TEST(SamplerSpec, ThoseWhosePointsDependOnTheirNumberArePlanned) {
  for (const std::string& name : sampler_names()) {
    const bool planned = name == "stratified" || name == "zsobol" || name == "strata";
    EXPECT_EQ(is_planned(parse_sampler(name)), planned) << name;
  }
  EXPECT_TRUE(is_planned(parse_sampler("rcs:sequence=zsobol")));
  EXPECT_TRUE(is_planned(parse_sampler("rcs:weight=cells")));
  EXPECT_FALSE(is_planned(parse_sampler("strata:weight=0.25")));
}

TEST(SamplerSpec, HelpNamesEveryPresetAndOption) {
  const std::string help = sampler_help();
  std::vector<std::string> words = sampler_names();
  for (const char* word :
       {"sequence", "share", "pairs", "interleave", "offset", "mix", "weight", "c", "t", "filter",
        "pilot", "combine", "none|gaussian|median", "add|weight", "add|xor", "pixel|tile|image",
        "none|fresh|constant|bluenoise|morton", "map|auto|cells|0..1", "1|2|4"}) {
    words.push_back(word);
  }
  for (const std::string& word : words) {
    EXPECT_NE(help.find("  " + word), std::string::npos) << word;
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
}  // namespace lockstep::test_sampler_spec
