#include "experiments/distributed/shared_tiles.h"

#include "core/cpu_clock.h"
#include "experiments/output/activity.h"
#include "experiments/output/machine.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <map>
#include <new>
#include <thread>
#include <type_traits>
#include <utility>

namespace lockstep {
namespace {

using JsonMessage = nlohmann::json;

struct PassHeader {
  std::uint64_t pass = 0;
  std::uint64_t is_pilot = 0;  // weights follow
};
struct WorkHeader {
  std::uint64_t pass = 0;
  TileWork work;  // sums to begin with follow, or nothing
};
struct TilesHeader {
  std::uint64_t pass = 0;
  TileWork work;
  PassTotals totals;  // sums follow
};

// All ranks run the same program on the same kind of machine: values go as they are.
template <class Header, class T>
std::vector<char> pack(const Header& header, const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<Header>);
  std::vector<char> bytes(sizeof header + values.size() * sizeof(T));
  std::memcpy(bytes.data(), &header, sizeof header);
  if (!values.empty()) {
    std::memcpy(bytes.data() + sizeof header, values.data(), values.size() * sizeof(T));
  }
  return bytes;
}

template <class Header, class T>
std::pair<Header, std::vector<T>> unpack(const std::vector<char>& bytes) {
  std::pair<Header, std::vector<T>> result;
  if (bytes.size() < sizeof(Header)) return result;
  std::memcpy(&result.first, bytes.data(), sizeof(Header));
  result.second.resize((bytes.size() - sizeof(Header)) / sizeof(T));
  if (!result.second.empty()) {
    std::memcpy(result.second.data(), bytes.data() + sizeof(Header),
                result.second.size() * sizeof(T));
  }
  return result;
}

// Rank 0's side of one render. What ranks know lasts from pass to pass.
struct Sharing {
  Desk& desk;
  const JsonMessage render;
  const int threads;
  std::uint64_t pass = 0;  // of all renders: none is taken for another's
  SharedPass shared = {};
  TilePool* pool = nullptr;
  std::map<int, bool> joined = {};          // ranks that know the render
  std::map<int, std::uint64_t> knows = {};  // the pass that a rank knows
  std::map<int, TileWork> given = {};

  std::vector<Outgoing> next(const Helper& helper) {
    if (!std::exchange(joined[helper.rank], true)) {
      return {{MessageKind::Render, bytes_of(render.dump())}};
    }
    const std::optional<TileWork> work = pool->take(threads);
    if (!work) return {};
    given[helper.rank] = *work;
    std::vector<Outgoing> messages;
    if (std::exchange(knows[helper.rank], pass) != pass) {
      const PassHeader header{pass, shared.is_pilot};
      messages.push_back({MessageKind::Pass, pack(header, shared.weights)});
    }
    messages.push_back({MessageKind::Work, pack(WorkHeader{pass, *work}, pool->start(*work))});
    return messages;
  }

  void result(const Helper& helper, const Message& message) {
    const auto [header, sums] = unpack<TilesHeader, double>(message.bytes);
    if (header.pass != pass) return;
    pool->deliver(header.work, sums, header.totals);
    given.erase(helper.rank);
  }

  void give_back(const Helper& helper) {
    const auto place = given.find(helper.rank);
    if (place == given.end()) return;
    pool->give_back(place->second);
    given.erase(place);
  }
};

}  // namespace

TileSharing share_tiles(Desk& desk, const JsonMessage& render, int threads) {
  static std::atomic<std::uint64_t> passes = 0;
  auto sharing = std::make_shared<Sharing>(Sharing{desk, render, threads});
  TileSharing result;
  result.parties = desk.ranks();
  result.begin = [sharing](const SharedPass& shared, TilePool& pool) {
    sharing->pass = ++passes;
    sharing->shared = shared;
    sharing->pool = &pool;
    sharing->given.clear();
    Handout handout;
    handout.next = [sharing](const Helper& helper) { return sharing->next(helper); };
    handout.result = [sharing](const Helper& h, const Message& m) { sharing->result(h, m); };
    handout.idle = handout.lost = [sharing](const Helper& helper) { sharing->give_back(helper); };
    sharing->desk.serve(std::move(handout));
  };
  result.end = [sharing] { sharing->desk.rest(); };
  return result;
}

namespace {

std::atomic<double> last_sign = 0.0;

void tell(MessageKind kind, std::vector<char> bytes = {}) {
  last_sign = wall_seconds();
  send(0, int(kind), std::move(bytes));
}

std::string host_name() {
  char name[256] = {};
  gethostname(name, sizeof name - 1);
  return name;
}

// What a rank other than 0 is doing.
struct Work {
  const Skills& skills;
  std::unique_ptr<TileRenderer> renderer = {};
  bool goes_on = true;

  void render(const Message& message) {
    const auto [header, start] = unpack<WorkHeader, double>(message.bytes);
    TilesHeader tiles{header.pass, header.work, {}};
    const std::vector<double> sums = renderer->render(header.work, start, tiles.totals);
    tell(MessageKind::Tiles, pack(tiles, sums));
    tell(MessageKind::Idle);
  }

  // Where it is asked to stop, the rest goes to others.
  void measure(const Message& message) {
    renderer.reset();
    try {
      skills.unit(JsonMessage::parse(text_of(message)));
    } catch (const Cancelled&) {
    }
  }

  void handle(const Message& message) {
    switch (MessageKind(message.kind)) {
      case MessageKind::Render:
        renderer.reset();
        renderer = skills.join(JsonMessage::parse(text_of(message)));
        tell(MessageKind::Idle);
        break;
      case MessageKind::Pass: {
        auto [header, weights] = unpack<PassHeader, float>(message.bytes);
        if (renderer) renderer->begin({header.is_pilot != 0, std::move(weights)});
        break;
      }
      case MessageKind::Work:
        if (renderer) render(message);
        break;
      case MessageKind::Unit:
        measure(message);
        tell(MessageKind::Idle);
        break;
      case MessageKind::Stop:
        goes_on = false;
        break;
      default:
        break;
    }
  }
};

// Tells rank 0 where it does not.
template <class F>
bool succeeds(F f) {
  try {
    f();
    return true;
  } catch (const std::bad_alloc&) {
    tell(MessageKind::Failed, bytes_of(out_of_memory_text()));
  } catch (const std::exception& error) {
    tell(MessageKind::Failed, bytes_of(error.what()));
  }
  return false;
}

}  // namespace

void say_alive() {
  if (wall_seconds() - last_sign > 1.0) tell(MessageKind::Alive);
}

void send_record(const std::string& line) { tell(MessageKind::Record, bytes_of(line)); }

void help(const Skills& skills) {
  const JsonMessage hello = {{"cpu", cpu_name()}, {"host", host_name()}};
  tell(MessageKind::Hello,
       bytes_of(hello.dump(-1, ' ', false, JsonMessage::error_handler_t::replace)));
  const bool is_ready = succeeds([&] {
    if (skills.prepare) skills.prepare();
  });
  if (is_ready) tell(MessageKind::Idle);
  Work work{skills};
  while (work.goes_on) {
    const std::optional<Message> message = receive();
    if (message) {
      succeeds([&] { work.handle(*message); });
    } else {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }
  tell(MessageKind::Bye);
}

}  // namespace lockstep
