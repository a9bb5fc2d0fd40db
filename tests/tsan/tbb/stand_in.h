// The part of oneTBB's interface that the project uses, on plain threads, for the thread sanitizer
// alone: Debian's oneTBB is not instrumented, so that the sanitizer would take every hand-over of
// work for a race, and suppressions by TBB's names would hide the races of the work itself. Here
// all is instrumented and nothing needs to be suppressed.
//
// Threads are started for each loop, and numbers are dealt out by relaxed atomics: nothing but a
// loop's begin and end orders what its parts do, as with TBB.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <thread>
#include <utility>
#include <vector>

namespace tbb {
namespace stand_in {

// Threads that run at a time have places of their own. Only their begins and ends take the lock.
inline constexpr std::size_t most_threads = 256;

struct Places {
  std::mutex mutex;
  std::array<bool, most_threads> taken{};

  std::size_t take() {
    const std::lock_guard lock(mutex);
    const auto free = std::find(taken.begin(), taken.end(), false);
    if (free == taken.end()) throw std::bad_alloc();
    *free = true;
    return std::size_t(free - taken.begin());
  }
  void give_back(std::size_t place) {
    const std::lock_guard lock(mutex);
    taken[place] = false;
  }
};
inline Places places;

struct Place {
  std::size_t index = places.take();
  ~Place() { places.give_back(index); }
};

inline std::size_t this_place() {
  thread_local const Place place;
  return place.index;
}

inline std::atomic<std::size_t> global_limit = 0;  // 0: none
inline thread_local std::size_t arena_limit = 0;

// Two at least, where nothing is said: races need them.
inline std::size_t threads_for(std::size_t tasks) {
  std::size_t most = std::max(2u, std::thread::hardware_concurrency());
  if (arena_limit > 0) most = arena_limit;
  if (global_limit > 0) most = std::min<std::size_t>(most, global_limit);
  return std::min(most, tasks);
}

// Calls task(0) to task(count - 1), each on any thread. Passes on the first exception.
template <class Task>
void run(std::size_t count, const Task& task) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::once_flag failed;
  const auto work = [&] {
    try {
      for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) task(i);
    } catch (...) {
      next.store(count, std::memory_order_relaxed);
      std::call_once(failed, [&] { failure = std::current_exception(); });
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < threads_for(count); ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace stand_in

template <class Value>
class blocked_range {
 public:
  blocked_range(Value begin, Value end, std::size_t grain = 1)
      : begin_(begin), end_(end), grain_(grain) {}
  Value begin() const { return begin_; }
  Value end() const { return end_; }
  std::size_t size() const { return std::size_t(end_ - begin_); }
  std::size_t grainsize() const { return grain_; }

 private:
  Value begin_, end_;
  std::size_t grain_;
};

template <class Value>
class blocked_range2d {
 public:
  blocked_range2d(blocked_range<Value> rows, blocked_range<Value> columns)
      : rows_(rows), columns_(columns) {}
  blocked_range2d(Value row_begin, Value row_end, std::size_t row_grain, Value column_begin,
                  Value column_end, std::size_t column_grain)
      : rows_(row_begin, row_end, row_grain), columns_(column_begin, column_end, column_grain) {}
  const blocked_range<Value>& rows() const { return rows_; }
  const blocked_range<Value>& cols() const { return columns_; }

 private:
  blocked_range<Value> rows_, columns_;
};

namespace stand_in {

inline constexpr std::size_t most_parts = 64;

template <class Value>
std::size_t part_size(const blocked_range<Value>& range) {
  return std::max(range.grainsize(), (range.size() + most_parts - 1) / most_parts);
}
template <class Value>
std::size_t part_count(const blocked_range<Value>& range) {
  return (range.size() + part_size(range) - 1) / part_size(range);
}
template <class Value>
blocked_range<Value> part(const blocked_range<Value>& range, std::size_t index) {
  const std::size_t first = index * part_size(range);
  const std::size_t end = std::min(first + part_size(range), range.size());
  return {Value(range.begin() + Value(first)), Value(range.begin() + Value(end)),
          range.grainsize()};
}

}  // namespace stand_in

struct simple_partitioner {};

template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body) {
  stand_in::run(stand_in::part_count(range),
                [&](std::size_t i) { body(stand_in::part(range, i)); });
}

template <class Value, class Body>
void parallel_for(const blocked_range2d<Value>& range, const Body& body, simple_partitioner = {}) {
  const std::size_t columns = range.cols().size();
  stand_in::run(range.rows().size() * columns, [&](std::size_t i) {
    const Value row = range.rows().begin() + Value(i / columns);
    const Value column = range.cols().begin() + Value(i % columns);
    body(blocked_range2d<Value>({row, row + 1}, {column, column + 1}));
  });
}

template <class Value, class Body>
void parallel_for(Value first, Value end, const Body& body) {
  if (!(first < end)) return;
  stand_in::run(std::size_t(end - first), [&](std::size_t i) { body(Value(first + Value(i))); });
}

template <class Range, class Value, class Body, class Join>
Value parallel_deterministic_reduce(const Range& range, const Value& identity, const Body& body,
                                    const Join& join) {
  std::vector<Value> parts(stand_in::part_count(range), identity);
  stand_in::run(parts.size(),
                [&](std::size_t i) { parts[i] = body(stand_in::part(range, i), identity); });
  Value all = identity;
  for (const Value& value : parts) all = join(all, value);
  return all;
}

template <class... Tasks>
void parallel_invoke(const Tasks&... tasks) {
  stand_in::run(sizeof...(tasks), [&](std::size_t wanted) {
    std::size_t i = 0;
    ((i++ == wanted ? tasks() : void()), ...);
  });
}

class global_control {
 public:
  enum parameter { max_allowed_parallelism };
  global_control(parameter, std::size_t limit) : earlier_(stand_in::global_limit.exchange(limit)) {}
  ~global_control() { stand_in::global_limit = earlier_; }
  global_control(const global_control&) = delete;
  global_control& operator=(const global_control&) = delete;

 private:
  std::size_t earlier_;
};

class task_arena {
 public:
  explicit task_arena(int threads) : threads_(std::size_t(threads)) {}
  template <class Task>
  void execute(const Task& task) {
    struct Restore {
      std::size_t earlier;
      ~Restore() { stand_in::arena_limit = earlier; }
    } const restore{std::exchange(stand_in::arena_limit, threads_)};
    task();
  }

 private:
  std::size_t threads_;
};

// A value for each place, made when its thread first asks.
template <class Value>
class enumerable_thread_specific {
 public:
  template <class... Arguments>
  explicit enumerable_thread_specific(const Arguments&... arguments)
      : make_([=] { return std::make_unique<Value>(arguments...); }) {}

  Value& local() {
    std::unique_ptr<Value>& mine = values_[stand_in::this_place()];
    if (!mine) mine = make_();
    return *mine;
  }

  class iterator {
   public:
    iterator(std::unique_ptr<Value>* at, std::unique_ptr<Value>* end) : at_(at), end_(end) {
      skip();
    }
    Value& operator*() const { return **at_; }
    iterator& operator++() {
      ++at_;
      skip();
      return *this;
    }
    bool operator!=(const iterator& other) const { return at_ != other.at_; }

   private:
    void skip() {
      while (at_ != end_ && !*at_) ++at_;
    }
    std::unique_ptr<Value>*at_, *end_;
  };
  iterator begin() { return {values_.data(), values_.data() + values_.size()}; }
  iterator end() { return {values_.data() + values_.size(), values_.data() + values_.size()}; }

 private:
  std::function<std::unique_ptr<Value>()> make_;
  std::array<std::unique_ptr<Value>, stand_in::most_threads> values_;
};

}  // namespace tbb
