// Renders that several parties share: the image is that of one process, whoever renders what, in
// whatever order it comes, once or twice.
#include "packets/shared_render.h"
#include "tests/t_cornell.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace lockstep::test_shared_render {
namespace {

// Helpers in threads of this process that take work by turns; the first one is clumsy.
class Helpers {
 public:
  Helpers(const Scene& scene, const SamplerSpec& sampler, const RenderSettings& settings, int count)
      : sharing_{count + 1, [this](const SharedPass& pass, TilePool& pool) { begin(pass, pool); },
                 [this] { end(); }} {
    for (int i = 0; i < count; ++i) {
      renderers_.push_back(
          std::make_unique<TileRenderer>(scene, sampler, settings, [](double) { return true; }));
    }
  }
  const TileSharing& sharing() const { return sharing_; }
  int delivered() const { return delivered_; }

 private:
  void begin(const SharedPass& pass, TilePool& pool) {
    for (std::size_t i = 0; i < renderers_.size(); ++i) {
      renderers_[i]->begin(pass);
      threads_.emplace_back([this, i, &pool] { work(*renderers_[i], pool, i == 0); });
    }
  }

  // Takes two parts at once and delivers the later one first; gives some back, delivers some twice.
  void work(TileRenderer& renderer, TilePool& pool, bool clumsy) {
    for (int n = 0; !pool.done(); ++n) {
      const std::optional<TileWork> first = pool.take(3), second = pool.take(1);
      for (const auto& work : {second, first}) {
        if (!work) continue;
        if (clumsy && n % 3 == 1) {
          pool.give_back(*work);
          continue;
        }
        PassTotals totals;
        const std::vector<double> sums = renderer.render(*work, pool.start(*work), totals);
        EXPECT_EQ(pool.deliver(*work, sums, totals), 0u);
        if (clumsy) pool.deliver(*work, sums, totals);
        ++delivered_;
      }
      if (!first) pool.wait(0.001);
    }
  }

  void end() {
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

  TileSharing sharing_;
  std::vector<std::unique_ptr<TileRenderer>> renderers_;
  std::vector<std::thread> threads_;
  std::atomic<int> delivered_ = 0;
};

TEST(SharedRender, IsTheRenderOfOneProcess) {
  const Scene scene = small_cornell();
  for (const char* sampler : {"owen", "zsobol", "random", "rcs:pilot=70",
                              "rcs:pilot=5,combine=weight", "rcs:weight=auto,pilot=10"}) {
    const SamplerSpec spec = parse_sampler(sampler);
    RenderSettings s = small_render(200, 2);
    s.threads = 1;
    Helpers helpers(scene, spec, s, 2);
    const RenderResult alone = render(scene, spec, s);
    const RenderResult shared = render(scene, spec, s, {}, helpers.sharing());
    EXPECT_TRUE(same_bytes(alone.image, shared.image)) << sampler;
    EXPECT_EQ(alone.stats.paths, shared.stats.paths) << "each tile counts once, " << sampler;
    EXPECT_GT(helpers.delivered(), 0) << sampler;
  }
}

TEST(SharedRender, ALaterPartOfABlockGoesOnFromTheFirst) {
  const Scene scene = small_cornell();
  const SamplerSpec spec = parse_sampler("random");
  const RenderSettings s = small_render(1, 2);
  Film film(70, 50);
  film.samples = 10;
  std::fill(film.sums.begin(), film.sums.end(), 3.0);
  TilePool pool(film, 20, 1, {});
  while (const std::optional<TileWork> work = pool.take(4)) {
    EXPECT_EQ(pool.start(*work), std::vector<double>(sum_count(film, *work), 3.0));
    EXPECT_EQ(work->first_sample, 10u);
    EXPECT_EQ(work->samples, 20u);
    EXPECT_EQ(pool.deliver(*work, {1.0}, {}), sum_count(film, *work)) << "too few sums";
    EXPECT_EQ(pool.deliver(*work, std::vector<double>(sum_count(film, *work), 5.0), {}), 0u);
  }
  EXPECT_TRUE(pool.done());
  EXPECT_EQ(film.sums, std::vector<double>(film.sums.size(), 5.0));
  EXPECT_TRUE(film.earlier.empty());
}

TEST(SharedRender, BlocksAreAddedInTheirOrder) {
  Film film(16, 16);
  TilePool pool(film, 3 * film_block, 1, {});
  std::vector<TileWork> all;
  while (const std::optional<TileWork> work = pool.take(1)) all.push_back(*work);
  ASSERT_EQ(all.size(), 3u);
  // 1e16 + 1 is 1e16: only one order of these gives 1.
  const double sums[] = {1e16, -1e16, 1.0};
  for (const std::size_t block : {2u, 0u, 1u}) {
    pool.deliver(all[block], std::vector<double>(film.sums.size(), sums[block]), {});
  }
  ASSERT_TRUE(pool.done());
  EXPECT_EQ(film.earlier[0] + film.sums[0], 1.0);
}

}  // namespace
}  // namespace lockstep::test_shared_render
