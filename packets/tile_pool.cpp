#include "packets/tile_pool.h"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace lockstep {
namespace {

constexpr int most_tiles = 256;  // handed out at once: 2 MB of sums

// Calls f(row of sums in the film, its length, where it begins among the work's sums).
template <class F>
std::size_t for_each_row(const Film& film, int first, int tiles, F f) {
  std::size_t at = 0;
  for (int tile = first; tile < first + tiles; ++tile) {
    const TileArea area = tile_area(film, tile);
    const auto count = 4 * std::size_t(area.x1 - area.x0);
    for (int y = area.y0; y < area.y1; ++y, at += count) {
      f(4 * (std::size_t(y) * std::size_t(film.width) + std::size_t(area.x0)), count, at);
    }
  }
  return at;
}

}  // namespace

std::size_t sum_count(const Film& film, const TileWork& work) {
  return for_each_row(film, work.first, work.tiles, [](std::size_t, std::size_t, std::size_t) {});
}

std::vector<double> sums_of(const Film& film, const TileWork& work) {
  std::vector<double> sums(sum_count(film, work));
  for_each_row(film, work.first, work.tiles, [&](std::size_t row, std::size_t n, std::size_t at) {
    std::copy_n(film.sums.begin() + std::ptrdiff_t(row), n, sums.begin() + std::ptrdiff_t(at));
  });
  return sums;
}

void set_sums(Film& film, const TileWork& work, const std::vector<double>& sums) {
  for_each_row(film, work.first, work.tiles, [&](std::size_t row, std::size_t n, std::size_t at) {
    double* to = film.sums.data() + row;
    if (sums.empty()) {
      std::fill_n(to, n, 0.0);
    } else {
      std::copy_n(sums.data() + at, n, to);
    }
  });
}

TilePool::TilePool(Film& film, std::uint32_t samples, int parties,
                   std::function<void(const TileArea&)> changed)
    : film_(film),
      begin_(film.samples),
      end_(film.samples + samples),
      tiles_(tile_count(film)),
      parties_(parties),
      changed_(std::move(changed)),
      added_(std::size_t(tiles_), film.samples) {
  next_ = {0, tiles_, begin_, block_end(begin_) - begin_};
  for (std::uint32_t s = begin_; s < end_; s = block_end(s)) all_ += tiles_;
  if (end_ > film_block) film_.earlier.resize(film_.sums.size());
}

std::uint32_t TilePool::block_end(std::uint32_t sample) const {
  return std::min(end_, (sample / film_block + 1) * film_block);
}

std::optional<TileWork> TilePool::take(int least) {
  const std::lock_guard lock(mutex_);
  if (!returned_.empty()) {
    const TileWork work = returned_.front();
    returned_.pop_front();
    return work;
  }
  if (next_.samples == 0) return {};
  std::int64_t left = next_.tiles;
  for (std::uint32_t s = block_end(next_.first_sample); s < end_; s = block_end(s)) left += tiles_;
  const std::int64_t share = std::max<std::int64_t>(left / (2 * parties_), least);
  TileWork work = next_;
  work.tiles = int(std::min<std::int64_t>({share, next_.tiles, most_tiles}));
  next_.first += work.tiles;
  next_.tiles -= work.tiles;
  if (next_.tiles == 0) {
    const std::uint32_t first = next_.first_sample + next_.samples;
    next_ = {0, tiles_, first, first < end_ ? block_end(first) - first : 0};
  }
  return work;
}

std::vector<double> TilePool::start(const TileWork& work) {
  const std::lock_guard lock(mutex_);
  if (work.first_sample % film_block == 0) return {};
  return sums_of(film_, work);
}

void TilePool::give_back(const TileWork& work) {
  const std::lock_guard lock(mutex_);
  returned_.push_back(work);
  change_.notify_all();
}

bool TilePool::is_added(int tile, std::uint32_t first_sample) const {
  return added_[std::size_t(tile)] > first_sample || early_.contains({tile, first_sample});
}

// Only the first block of a pass begins within a block of the film: its sums go on from the film's.
void TilePool::add_block(int tile, std::uint32_t first_sample, const double* sums) {
  const TileArea area = tile_area(film_, tile);
  if (first_sample > 0 && first_sample % film_block == 0) {
    begin_block(film_, area.x0, area.y0, area.x1, area.y1);
  }
  for_each_row(film_, tile, 1, [&](std::size_t row, std::size_t n, std::size_t at) {
    std::memcpy(film_.sums.data() + row, sums + at, n * sizeof *sums);
  });
  added_[std::size_t(tile)] = block_end(first_sample);
  if (changed_) changed_(area);
}

std::size_t TilePool::deliver(const TileWork& work, const std::vector<double>& sums,
                              const PassTotals& totals) {
  const std::lock_guard lock(mutex_);
  const std::size_t count = sum_count(film_, work);
  if (sums.size() != count) return count;
  bool is_new = false;
  std::size_t at = 0;
  for (int tile = work.first; tile < work.first + work.tiles; ++tile) {
    const std::size_t size = sum_count(film_, {tile, 1, 0, 0});
    if (!is_added(tile, work.first_sample)) {
      is_new = true;
      ++delivered_;
      early_[{tile, work.first_sample}].assign(sums.begin() + std::ptrdiff_t(at),
                                               sums.begin() + std::ptrdiff_t(at + size));
    }
    at += size;
    // In the order of the samples, as far as they are there.
    const std::uint32_t& added = added_[std::size_t(tile)];
    for (auto place = early_.find({tile, added}); place != early_.end();
         place = early_.find({tile, added})) {
      add_block(tile, place->first.second, place->second.data());
      early_.erase(place);
    }
  }
  if (is_new) add(totals_, totals);
  change_.notify_all();
  return 0;
}

void TilePool::wait(double seconds) {
  std::unique_lock lock(mutex_);
  if (delivered_ == all_ || !returned_.empty()) return;
  change_.wait_for(lock, std::chrono::duration<double>(seconds));
}

bool TilePool::done() const {
  const std::lock_guard lock(mutex_);
  return delivered_ == all_;
}

double TilePool::share_done() const {
  const std::lock_guard lock(mutex_);
  return double(delivered_) / double(all_);
}

PassTotals TilePool::totals() const {
  const std::lock_guard lock(mutex_);
  return totals_;
}

}  // namespace lockstep
