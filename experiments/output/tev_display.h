// A view of a render as it forms, in the image viewer tev, through its network protocol: messages
// of a little-endian 32-bit length (its own four bytes included), a byte for the kind, and fields.
#pragma once

#include "core/image.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

struct addrinfo;

namespace lockstep {

// HOST:PORT; the port is tev's 14158 where it is left out. IPv6 addresses stand in brackets.
struct TevAddress {
  std::string host;
  std::string port = "14158";
};

// Throws UsageError.
TevAddress parse_tev_address(std::string_view text);

// The messages that Lockstep sends. Names may not hold zero bytes.
// Makes an image of channels R, G and B, or replaces the one of that name.
std::string tev_create_image(std::string_view name, int width, int height);
// Replaces `rows` rows of an image from row y on; `rgb` holds 3 * width * rows values.
std::string tev_update_image(std::string_view name, int y, int width, int rows, const float* rgb);

// Shows an image in the viewer. A thread of its own sends, a few times a second, the rows that
// have changed: update() only copies. A viewer that is not there, goes away or takes nothing for
// `patience` is one warning on stderr, and from then on nothing is sent.
class TevDisplay {
 public:
  TevDisplay(const TevAddress& address, std::string name, int width, int height,
             std::chrono::milliseconds patience = std::chrono::seconds(5));
  // Sends what has changed, within `patience`.
  ~TevDisplay();
  TevDisplay(const TevDisplay&) = delete;
  TevDisplay& operator=(const TevDisplay&) = delete;

  // Puts a linear RGB image's pixels at (x, y); it must lie inside. From any thread.
  void update(int x, int y, const Image& part);

 private:
  using Clock = std::chrono::steady_clock;

  void run();
  bool connect();
  int connected(const addrinfo& address) const;
  bool wait_for(int socket) const;
  bool send(std::string_view message);
  bool send_changes();

  TevAddress address_;
  std::string name_;
  std::chrono::milliseconds patience_;
  int socket_ = -1;
  std::string failure_;  // why nothing is sent any more

  std::mutex mutex_;  // of what follows
  std::condition_variable wake_;
  Image image_;
  std::vector<std::uint8_t> changed_;  // by block of rows
  bool closing_ = false;
  std::atomic<Clock::time_point> end_ = Clock::time_point::max();  // no sending after it

  std::thread thread_;
};

}  // namespace lockstep
