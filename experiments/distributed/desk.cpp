#include "experiments/distributed/desk.h"

#include "core/cpu_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace lockstep {
namespace {

constexpr auto kNap = std::chrono::microseconds(500);
constexpr double kSilenceFactor = 10.0;

std::string name_of(const Helper& helper) {
  return fmt::format("rank {} ({})", helper.rank, helper.host);
}

void say(const std::string& text) { fmt::print(stderr, "lockstep: warning: {}\n", text); }

}  // namespace

std::vector<char> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

std::string text_of(const Message& message) { return {message.bytes.begin(), message.bytes.end()}; }

Desk::Desk(const Ranks& ranks, double timeout)
    : ranks_(ranks), timeout_(timeout), peers_(std::size_t(ranks.count)) {
  const double now = wall_seconds();
  for (int rank = 0; rank < ranks.count; ++rank) {
    peers_[std::size_t(rank)].helper.rank = rank;
    peers_[std::size_t(rank)].last_sign = now;
  }
  if (ranks_.count > 1) thread_ = std::thread([this] { run(); });
}

Desk::~Desk() { close(); }

void Desk::close() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void Desk::serve(Handout handout) {
  const std::lock_guard lock(mutex_);
  handout_ = std::move(handout);
}

void Desk::rest() { serve({}); }

void Desk::expect_silence(double seconds) {
  const std::lock_guard lock(mutex_);
  silence_ = std::max(silence_, seconds);
}

double Desk::limit() const { return std::max(timeout_, kSilenceFactor * silence_); }

void Desk::run() {
  while (!stop_) {
    bool heard = false;
    while (const std::optional<Message> message = receive()) {
      const std::lock_guard lock(mutex_);
      handle(*message);
      heard = true;
    }
    {
      const std::lock_guard lock(mutex_);
      hand_out();
      look_for_lost();
    }
    if (!heard) std::this_thread::sleep_for(kNap);
  }
}

void Desk::handle(const Message& message) {
  Peer& peer = peers_[std::size_t(message.from)];
  const bool was_lost = peer.state == State::Lost;
  if (was_lost) say(name_of(peer.helper) + " answers again");
  if (was_lost) peer.state = State::Busy;
  peer.last_sign = wall_seconds();
  switch (MessageKind(message.kind)) {
    case MessageKind::Hello: {
      const auto hello = nlohmann::json::parse(text_of(message), nullptr, false);
      if (hello.is_object()) {
        peer.helper.cpu = hello.value("cpu", peer.helper.cpu);
        peer.helper.host = hello.value("host", peer.helper.host);
      }
      break;
    }
    case MessageKind::Idle:
      peer.state = State::Idle;
      if (handout_.idle) handout_.idle(peer.helper);
      break;
    case MessageKind::Tiles:
    case MessageKind::Record:
      if (handout_.result) handout_.result(peer.helper, message);
      break;
    case MessageKind::Failed:
      peer.state = State::Failed;
      say(fmt::format("{} stops, the others go on: {}", name_of(peer.helper), text_of(message)));
      if (handout_.lost) handout_.lost(peer.helper);
      break;
    case MessageKind::Bye:
      peer.state = State::Gone;
      break;
    default:
      break;
  }
}

void Desk::hand_out() {
  if (!handout_.next) return;
  for (Peer& peer : peers_) {
    if (peer.state != State::Idle) continue;
    std::vector<Outgoing> messages = handout_.next(peer.helper);
    if (messages.empty()) continue;
    peer.state = State::Busy;
    peer.last_sign = wall_seconds();
    for (Outgoing& message : messages) {
      send(peer.helper.rank, int(message.kind), std::move(message.bytes));
    }
  }
}

void Desk::look_for_lost() {
  const double now = wall_seconds();
  for (Peer& peer : peers_) {
    if (peer.state != State::Busy || now - peer.last_sign < limit()) continue;
    peer.state = State::Lost;
    say(fmt::format("{} has sent nothing for {:.0f} s: others get its work", name_of(peer.helper),
                    now - peer.last_sign));
    if (handout_.lost) handout_.lost(peer.helper);
  }
}

std::string Desk::dismiss() {
  rest();
  for (int rank = 1; rank < ranks_.count; ++rank) send(rank, int(MessageKind::Stop), {});
  const double start = wall_seconds();
  std::string silent;
  do {
    std::this_thread::sleep_for(kNap);
    const std::lock_guard lock(mutex_);
    silent.clear();
    bool waits = false;
    for (int rank = 1; rank < ranks_.count; ++rank) {
      const Peer& peer = peers_[std::size_t(rank)];
      if (peer.state == State::Gone) continue;
      silent += (silent.empty() ? "" : ", ") + name_of(peer.helper);
      waits |= peer.state != State::Lost;
    }
    if (!waits) break;
  } while (wall_seconds() - start < limit());
  close();
  return silent;
}

}  // namespace lockstep
