// Crashes, in processes of their own: the message that they leave, and how the process ends.
#include "core/error.h"
#include "experiments/output/activity.h"
#include "experiments/output/crash_handler.h"
#include "tests/t_scenes.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <new>
#include <thread>

namespace lockstep::test_crash {
namespace {

// Renders with two threads, and calls `watch` with the corner of each tile that has samples.
void render_watched(const std::function<void(int, int)>& watch) {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  catch_crashes();
  const Scene scene = build(resized(builtin::make_cornell(), 40, 40));
  RenderSettings settings;
  settings.seed = 7;
  settings.spp = 4;
  settings.threads = 2;
  settings.lanes = LaneLayout{4, 4, 1};
  settings.scene_name = "a-box";
  settings.command = "lockstep render a-box --seed 7";
  settings.watch = [&](int x, int y, const Image&) { watch(x, y); };
  render(scene, parse_sampler("strata"), settings);
}

// Renders and does `crash` once the tile at (16, 16) has samples.
void render_until(const std::function<void()>& crash) {
  render_watched([&](int x, int y) {
    if (x == 16 && y == 16) crash();
  });
}

constexpr const char* place =
    "render   scene a-box, sampler strata, seed 7\n"
    "  where    pixels .16, 16. to .31, 31., samples 0 to 3, bounce [0-9]+\n"
    "  again    lockstep render a-box --seed 7\n";

class CrashDeathTest : public testing::Test {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "the sanitizer reports crashes itself";
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
    GTEST_SKIP() << "the sanitizer reports crashes itself";
#endif
#endif
  }
  CrashDeathTest() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(CrashDeathTest, EverySignalNamesPlaceAndCommand) {
  for (const auto& [signal, name] : {std::pair{SIGSEGV, "SIGSEGV"},
                                     {SIGBUS, "SIGBUS"},
                                     {SIGFPE, "SIGFPE"},
                                     {SIGILL, "SIGILL"},
                                     {SIGABRT, "SIGABRT"}}) {
    EXPECT_EXIT(render_until([s = signal] { raise(s); }), testing::KilledBySignal(signal),
                std::string("^lockstep: crashed: ") + name + ".*; this is a defect.*" + place)
        << name;
  }
}

TEST_F(CrashDeathTest, AFaultHasItsAddress) {
  const auto fault = [] { *reinterpret_cast<volatile int*>(std::uintptr_t(0x1230)) = 1; };
  EXPECT_EXIT(render_until(fault), testing::KilledBySignal(SIGSEGV),
              "address 0x1230.*" + std::string(place));
}

TEST_F(CrashDeathTest, AnExceptionThatNobodyCatchesIsToldByItsText) {
  const auto throws = [] { std::thread([] { throw Error("nobody expects this"); }).join(); };
  EXPECT_EXIT(render_until(throws), testing::KilledBySignal(SIGABRT),
              "crashed: SIGABRT.*error    nobody expects this\n");
}

// A call for each level, without end for a 0, and none of them can be left out.
int deep(volatile int* p) {
  volatile int frame[256] = {};
  frame[0] = *p;
  if (*p != 0) return 0;
  return deep(frame) + frame[*p];
}

TEST_F(CrashDeathTest, AStackThatOverflowsStillGivesTheMessage) {
  const auto overflow = [] {
    catch_crashes();
    const Activity reading("reading a scene of scenes of scenes");
    volatile int zero = 0;
    std::exit(deep(&zero));
  };
  EXPECT_EXIT(overflow(), testing::KilledBySignal(SIGSEGV),
              "crashed: SIGSEGV.*during   reading a scene of scenes of scenes\n  again    ");
}

TEST_F(CrashDeathTest, AStackThatOverflowsOnAThreadThatRendersNamesThePlace) {
  const auto overflow = [] {
    const auto main_thread = std::this_thread::get_id();
    render_watched([main_thread](int, int) {
      volatile int zero = 0;
      if (std::this_thread::get_id() != main_thread) std::exit(deep(&zero));
      std::this_thread::sleep_for(std::chrono::milliseconds(50));  // tiles are left for the other
    });
  };
  EXPECT_EXIT(overflow(), testing::KilledBySignal(SIGSEGV),
              "crashed: SIGSEGV.*\n  render   scene a-box, .*\n  where    pixels .*\n  again    ");
}

TEST(OutOfMemory, SaysWhatWasBeingDone) {
  try {
    const Activity outer("the whole");
    const Activity inner("reading the scene large.pbrt");
    throw std::bad_alloc();
  } catch (const std::bad_alloc&) {
    EXPECT_EQ(out_of_memory_text().find("not enough memory for reading the scene large.pbrt: "), 0u)
        << out_of_memory_text();
    EXPECT_EQ(out_of_memory_text().find('\n'), std::string::npos);
  }
  const Activity next("rendering");
  EXPECT_STREQ(current_activity(), "rendering");
  EXPECT_EQ(out_of_memory_text().find("not enough memory for rendering: "), 0u);
}

}  // namespace
}  // namespace lockstep::test_crash
