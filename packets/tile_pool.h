// The work of one pass, for several parties (threads of this process, other processes) that take
// parts of it, render them from empty sums, and deliver these. Tiles are 16x16 pixels, and sums are
// made by blocks of samples (film.h), so the film has the same bits whoever renders what.
#pragma once

#include "packets/film.h"
#include "packets/pass.h"

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace lockstep {

// All members may be called from any thread.
class TilePool {
 public:
  // The pass adds `samples`, which whole_blocks() allows, to the film. `changed` is called with the
  // tile's pixels after sums were added to the film, by one thread at a time.
  TilePool(Film& film, std::uint32_t samples, int parties,
           std::function<void(const TileArea&)> changed);

  // The next part: of what is left a share that shrinks, but no fewer tiles than `least` where
  // there are as many. Empty where all is handed out; some of it may come back.
  std::optional<TileWork> take(int least);

  // The film's sums to begin with, in the order of sums_of(); empty where they are zero.
  std::vector<double> start(const TileWork& work);

  // For work that somebody took and will not deliver.
  void give_back(const TileWork& work);

  // Work that was rendered, by tiles and rows, as sums_of() gives it. What has been delivered
  // before is left out. Returns how many sums it wants where `sums` has another number, else 0.
  std::size_t deliver(const TileWork& work, const std::vector<double>& sums,
                      const PassTotals& totals);

  // Waits until work can be taken or all is delivered, but no longer than this.
  void wait(double seconds);

  bool done() const;
  double share_done() const;  // of the pass
  PassTotals totals() const;  // of all that was delivered

 private:
  bool is_added(int tile, std::uint32_t first_sample) const;
  void add_block(int tile, std::uint32_t first_sample, const double* sums);
  std::uint32_t block_end(std::uint32_t sample) const;

  Film& film_;
  const std::uint32_t begin_, end_;  // samples of the pass
  const int tiles_, parties_;
  const std::function<void(const TileArea&)> changed_;
  mutable std::mutex mutex_;
  std::condition_variable change_;
  TileWork next_;  // not handed out yet: tiles of this block, then the blocks after it
  std::deque<TileWork> returned_;
  std::vector<std::uint32_t> added_;  // by tile: up to which sample
  std::map<std::pair<int, std::uint32_t>, std::vector<double>> early_;  // blocks before their turn
  std::int64_t delivered_ = 0, all_ = 0;                                // pairs of tile and block
  PassTotals totals_;
};

// The film's sums of the work's tiles: tile after tile, rows of its pixels, four values for each.
std::vector<double> sums_of(const Film& film, const TileWork& work);

// Sets them; all to 0 where `sums` is empty.
void set_sums(Film& film, const TileWork& work, const std::vector<double>& sums);

// How many there are.
std::size_t sum_count(const Film& film, const TileWork& work);

}  // namespace lockstep
