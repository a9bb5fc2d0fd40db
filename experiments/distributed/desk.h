// Rank 0's side of a run on several ranks: it hands out work to those that have none, takes what
// they send, and notices who does not answer. The rest of rank 0 works as other ranks do, on a
// thread of its own.
#pragma once

#include "experiments/distributed/ranks.h"

#include <nlohmann/json.hpp>

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace lockstep {

enum class MessageKind : int {
  // To rank 0
  Hello,   // JSON: cpu, host
  Idle,    // wants work
  Alive,   // still at it
  Tiles,   // rendered: see shared_tiles.cpp
  Record,  // text: a line of a journal
  Failed,  // text: what happened; this rank does no more
  Bye,     // the answer to Stop
  // From rank 0
  Render,  // JSON: the render that tiles follow of
  Pass,    // the pass that tiles follow of
  Work,    // tiles to render
  Unit,    // JSON: something else to do
  Stop,
};

struct Outgoing {
  MessageKind kind{};
  std::vector<char> bytes;
};

struct Helper {
  int rank = 0;
  std::string cpu = "unknown CPU", host = "unknown host";
};

// What is handed out, and to whom. All are called by one thread at a time.
struct Handout {
  // What a rank gets that has nothing to do; empty where there is nothing now.
  std::function<std::vector<Outgoing>(const Helper&)> next;
  std::function<void(const Helper&, const Message&)> result;  // Tiles, Record
  std::function<void(const Helper&)> idle;  // it has done what it was given, or will not
  std::function<void(const Helper&)> lost;  // it does not answer: what it was given is for others
};

class Desk {
 public:
  // A rank that has work and sends nothing for so many seconds counts as lost; it is welcome again
  // when it does.
  Desk(const Ranks& ranks, double timeout);
  ~Desk();
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;

  void serve(Handout handout);
  void rest();  // hands out nothing more; no function of it is called once it returns

  // Some work begins with so many seconds during which ranks send nothing: ten times that is
  // waited.
  void expect_silence(double seconds);

  int ranks() const { return ranks_.count; }

  // Lets all ranks go and sends nothing any more. Returns those that do not answer, in words; empty
  // where all did.
  std::string dismiss();

 private:
  enum class State { Unknown, Idle, Busy, Lost, Failed, Gone };
  struct Peer {
    Helper helper;
    State state = State::Unknown;
    double last_sign = 0.0;
  };
  void run();
  void close();
  void handle(const Message& message);
  void hand_out();
  void look_for_lost();
  double limit() const;

  const Ranks ranks_;
  const double timeout_;
  double silence_ = 0.0;
  std::mutex mutex_;
  Handout handout_;
  std::vector<Peer> peers_;  // by rank; that of rank 0 is not used
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

std::vector<char> bytes_of(const std::string& text);
std::string text_of(const Message& message);

}  // namespace lockstep
