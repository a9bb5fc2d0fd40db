// What an image may not depend on: threads, packet width, the order of tiles, and where a render
// was stopped and continued. And that a saved film which is not what was saved is refused.
#include "tests/t_files.h"
#include "tests/t_scenes.h"

#include <fmt/format.h>

#include <random>

namespace lockstep::test_determinism {
namespace {

constexpr const char* every_kind_of_sampler[] = {
    "random", "stratified", "zsobol",      "bluenoise",
    "cpt",    "strata",     "rcs:pilot=2", "rcs:pilot=2,combine=weight"};

// Glass, metal, textures, an environment and lights between them; 50 x 37 pixels are 4 x 3 tiles,
// the last of them cut.
std::vector<Scene> small_scenes() {
  std::vector<Scene> scenes;
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (scene.name == "cornell" || scene.name == "reef") {
      scenes.push_back(build(resized(scene.make(), 50, 37)));
    }
  }
  return scenes;
}

// The n-th of all ways to render that must not matter.
RenderSettings way(int n) {
  RenderSettings s;
  s.seed = 5, s.spp = 4, s.depth = 3, s.roulette_depth = 2;
  const int threads[] = {1, 2, 7}, widths[] = {1, 4, 8, 16};
  const TileOrder orders[] = {TileOrder::Forward, TileOrder::Backward, TileOrder::Scattered};
  s.threads = threads[n % 3];
  s.width = widths[n % 4];
  s.tile_order = orders[(n + n / 3) % 3];
  return s;
}

std::string to_string(const RenderSettings& s) {
  return fmt::format("{} threads, width {}, order {}", s.threads, s.width, int(s.tile_order));
}

TEST(Determinism, AnyThreadsWidthAndTileOrderGiveTheSameBytes) {
  for (const Scene& scene : small_scenes()) {
    for (const char* sampler : every_kind_of_sampler) {
      const SamplerSpec spec = parse_sampler(sampler);
      const Image expected = render(scene, spec, way(0)).image;
      for (int n = 1; n < 12; ++n) {
        EXPECT_TRUE(same_bytes(render(scene, spec, way(n)).image, expected))
            << sampler << ", " << to_string(way(n));
      }
    }
  }
}

// The upper left corners of the tiles, as they are done.
std::vector<std::pair<int, int>> tiles_of(TileOrder order) {
  const Scene scene = build(resized(builtin::make_cornell(), 50, 37));
  std::vector<std::pair<int, int>> tiles;
  RenderSettings s = way(0);
  s.spp = 1, s.tile_order = order;
  s.watch = [&](int x, int y, const Image&) { tiles.emplace_back(x, y); };
  render(scene, parse_sampler("random"), s);
  return tiles;
}

TEST(Determinism, TileOrdersDiffer) {
  auto forward = tiles_of(TileOrder::Forward), backward = tiles_of(TileOrder::Backward),
       scattered = tiles_of(TileOrder::Scattered);
  ASSERT_EQ(forward.size(), 12u);
  EXPECT_NE(forward, backward);
  EXPECT_NE(forward, scattered);
  EXPECT_NE(backward, scattered);
  for (auto* tiles : {&forward, &backward, &scattered}) std::sort(tiles->begin(), tiles->end());
  EXPECT_EQ(forward, backward);
  EXPECT_EQ(forward, scattered);
}

class StoppedRenders : public TestWithFiles {};

TEST_F(StoppedRenders, GoOnToTheSameBytes) {
  for (const Scene& scene : small_scenes()) {
    for (const char* sampler : every_kind_of_sampler) {
      const SamplerSpec spec = parse_sampler(sampler);
      const Image expected = render(scene, spec, way(0)).image;
      std::filesystem::remove(path("film"));
      // Every run may do some tiles more than the one before, in another way, and is then cut off:
      // at some time one gets through.
      for (int n = 1, tiles = 5; n < 40; ++n, tiles += 6) {
        RenderSettings s = way(n);
        s.resume_file = path("film");
        int done = 0;
        try {
          const Image image = render(scene, spec, s, [&](double) { return ++done < tiles; }).image;
          EXPECT_GT(n, 2) << "was not stopped at all";
          EXPECT_TRUE(same_bytes(image, expected)) << sampler << ", run " << n;
          break;
        } catch (const Cancelled&) {
          ASSERT_LT(n, 39) << sampler << ": never ends";
        }
      }
    }
  }
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// 500 damages of one bit each, wherever they fall: none may go unnoticed.
TEST_F(StoppedRenders, AFilmWithOneWrongBitIsRefused) {
  const Scene scene = build(resized(builtin::make_cornell(), 20, 12));
  const SamplerSpec spec = parse_sampler("rcs:pilot=2");
  RenderSettings s = way(0);
  s.resume_file = path("film");
  render(scene, spec, s);
  const std::string whole = bytes_of(path("film"));
  const auto refusal = [&] { return message_of([&] { render(scene, spec, s); }); };
  EXPECT_EQ(refusal(), "");
  std::mt19937 random(7);
  int checksums = 0;
  for (int i = 0; i < 500; ++i) {
    std::string damaged = whole;
    const std::size_t at = random() % damaged.size();
    damaged[at] = char(damaged[at] ^ (1 << random() % 8));
    write("film", damaged);
    const std::string message = refusal();
    expect_one_line_with(message, "film: ");
    expect_one_line_with(message, "remove it to start anew");
    checksums += message.find("damaged") != message.npos;
  }
  EXPECT_GT(checksums, 400) << "most bits are values";
}

}  // namespace
}  // namespace lockstep::test_determinism
