// Saved films: a render that goes on from one is the render that was not stopped.
#include "core/error.h"
#include "tests/t_cornell.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace lockstep::test_checkpoint {
namespace {

class Resume : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    file_ = std::filesystem::temp_directory_path() /
            ("lockstep-test-" + std::string(info->name()) + "-" + std::to_string(getpid()));
    std::filesystem::remove(file_);
  }
  void TearDown() override { std::filesystem::remove(file_); }

  RenderSettings resuming(int spp) const {
    RenderSettings s = small_render(spp);
    s.resume_file = file_;
    return s;
  }
  // The error with which a render from the file fails; empty where it does not.
  std::string refusal(const Scene& scene, const char* sampler, const RenderSettings& s) {
    try {
      render(scene, parse_sampler(sampler), s);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }

  std::string file_;
};

TEST_F(Resume, TwoHalvesAreOneRender) {
  const Scene scene = small_cornell();
  for (const char* sampler : {"owen", "random", "cpt", "rcs:pilot=2", "rcs:pilot=2,combine=weight",
                              "rcs:weight=0.3,offset=fresh"}) {
    std::filesystem::remove(file_);
    const SamplerSpec spec = parse_sampler(sampler);
    const RenderResult half = render(scene, spec, resuming(4));
    EXPECT_TRUE(same_bytes(half.image, render(scene, spec, small_render(4)).image)) << sampler;
    RenderSettings rest = resuming(8);
    rest.width = 4;  // neither width nor threads are part of the image
    rest.threads = 1;
    const RenderResult whole = render(scene, spec, rest);
    EXPECT_TRUE(same_bytes(whole.image, render(scene, spec, small_render(8)).image)) << sampler;
    EXPECT_EQ(whole.stats.spp, 8);
    EXPECT_EQ(whole.stats.paths, 3500u * 8u) << "what both runs traced";
    EXPECT_GT(whole.stats.cpu_seconds, half.stats.cpu_seconds);
  }
}

TEST_F(Resume, AFinishedRenderIsNotDoneAgain) {
  const Scene scene = small_cornell();
  const Image image = render(scene, parse_sampler("owen"), resuming(4)).image;
  const RenderResult again = render(scene, parse_sampler("owen"), resuming(4));
  EXPECT_TRUE(same_bytes(again.image, image));
  EXPECT_EQ(again.stats.paths, 3500u * 4u);
  EXPECT_EQ(again.stats.spp, 4);
}

TEST_F(Resume, OtherSettingsAreRefused) {
  const Scene scene = small_cornell();
  render(scene, parse_sampler("rcs:pilot=2"), resuming(4));
  EXPECT_EQ(refusal(scene, "rcs:pilot=2", resuming(4)), "");
  RenderSettings s = resuming(8);
  s.seed = 99;
  EXPECT_NE(refusal(scene, "rcs:pilot=2", s).find("other settings"), std::string::npos);
  s = resuming(8);
  s.depth = 3;
  EXPECT_NE(refusal(scene, "rcs:pilot=2", s).find("other settings"), std::string::npos);
  s = resuming(8);
  s.roulette_depth = 7;
  EXPECT_NE(refusal(scene, "rcs:pilot=2", s).find("other settings"), std::string::npos);
  for (const char* sampler : {"owen", "rcs:pilot=1", "rcs:pilot=2,c=5"}) {
    EXPECT_NE(refusal(scene, sampler, resuming(8)).find("other settings"), std::string::npos);
  }
  const Scene wider = build(resized(builtin::make_cornell(), 71, 50));
  EXPECT_NE(refusal(wider, "rcs:pilot=2", resuming(8)).find("other settings"), std::string::npos);
  SceneDescription brighter = resized(builtin::make_cornell(), 70, 50);  // the name stays
  for (Shape& shape : brighter.shapes) {
    if (shape.emission) shape.emission->radiance.value *= 2.0f;
  }
  EXPECT_NE(refusal(build(brighter), "rcs:pilot=2", resuming(8)).find("another scene"),
            std::string::npos);
  const Scene other = build(resized(builtin::make_furnace(), 70, 50));
  EXPECT_NE(refusal(other, "rcs:pilot=2", resuming(8)).find(file_), std::string::npos);
}

TEST_F(Resume, DamagedFilesAreRefused) {
  const Scene scene = small_cornell();
  render(scene, parse_sampler("owen"), resuming(4));
  const auto size = std::filesystem::file_size(file_);
  for (const auto cut : {size - 1, size / 2, std::uintmax_t(60), std::uintmax_t(20),
                         std::uintmax_t(3), std::uintmax_t(0)}) {
    std::filesystem::resize_file(file_, cut);
    const std::string error = refusal(scene, "owen", resuming(8));
    EXPECT_NE(error.find(file_), std::string::npos) << cut;
    EXPECT_NE(error.find("remove it"), std::string::npos) << cut;
  }
  std::ofstream(file_) << "some other file that happens to lie here";
  EXPECT_NE(refusal(scene, "owen", resuming(8)).find("not a saved film"), std::string::npos);
}

TEST_F(Resume, ACancelledRenderLeavesNoHalfPassBehind) {
  const Scene scene = small_cornell();
  const SamplerSpec owen = parse_sampler("owen");
  render(scene, owen, resuming(2));
  int calls = 0;
  EXPECT_THROW(render(scene, owen, resuming(8), [&](double) { return ++calls < 9; }), Cancelled);
  const Image image = render(scene, owen, resuming(8)).image;
  EXPECT_TRUE(same_bytes(image, render(scene, owen, small_render(8)).image));
}

TEST_F(Resume, AFileThatCannotBeWrittenIsAnError) {
  RenderSettings s = small_render(1);
  s.resume_file = file_ + "/no/such/folder/film";
  EXPECT_NE(refusal(small_cornell(), "owen", s).find("cannot write"), std::string::npos);
}

}  // namespace
}  // namespace lockstep::test_checkpoint
