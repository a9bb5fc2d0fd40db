#include "experiments/output/tev_display.h"

#include "core/error.h"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <memory>
#include <utility>

namespace lockstep {
namespace {

static_assert(std::endian::native == std::endian::little, "the protocol is little-endian");

constexpr int kBlockRows = 32;  // sent together
constexpr auto kInterval = std::chrono::milliseconds(250);
constexpr auto kGlance = std::chrono::milliseconds(50);  // between looks at the clock

enum class Kind : std::uint8_t { CreateImage = 4, UpdateImageV3 = 6 };

// Appends fields to a message whose length is set at the end.
class Message {
 public:
  explicit Message(Kind kind) : bytes_(4, '\0') { add(std::uint8_t(kind)); }

  template <typename T>
  Message& add(T value) {
    return add(&value, 1);
  }
  template <typename T>
  Message& add(const T* values, std::size_t count) {
    bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(T));
    return *this;
  }
  Message& add(std::string_view text) {
    bytes_.append(text);
    bytes_.push_back('\0');
    return *this;
  }

  std::string finish() {
    const auto length = std::uint32_t(bytes_.size());
    std::memcpy(bytes_.data(), &length, sizeof length);
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

constexpr std::uint8_t kStayInBackground = 0;  // do not take the focus
constexpr std::int32_t kChannels = 3;

void add_channels(Message& message) {
  message.add(kChannels);
  for (const char* channel : {"R", "G", "B"}) message.add(std::string_view(channel));
}

}  // namespace

TevAddress parse_tev_address(std::string_view text) {
  TevAddress address;
  std::string_view host = text, port;
  const std::size_t colon = text.rfind(':');
  if (colon != std::string_view::npos && text.find(']', colon) == std::string_view::npos) {
    host = text.substr(0, colon);
    port = text.substr(colon + 1);
    int number = 0;
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
    if (error != std::errc() || end != port.data() + port.size() || number < 1 || number > 65535) {
      throw UsageError(
          fmt::format("--display: '{}' is no port; use HOST:PORT, as localhost:14158", port));
    }
    address.port = port;
  }
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  if (host.empty()) {
    throw UsageError(
        fmt::format("--display: '{}' names no host; use HOST:PORT, as localhost:14158", text));
  }
  address.host = host;
  return address;
}

std::string tev_create_image(std::string_view name, int width, int height) {
  Message message(Kind::CreateImage);
  message.add(kStayInBackground).add(name).add(std::int32_t(width)).add(std::int32_t(height));
  add_channels(message);
  return message.finish();
}

std::string tev_update_image(std::string_view name, int y, int width, int rows, const float* rgb) {
  const std::int32_t rectangle[] = {0, y, width, rows};
  const std::int64_t offsets[] = {0, 1, 2}, strides[] = {3, 3, 3};  // in floats
  Message message(Kind::UpdateImageV3);
  message.add(kStayInBackground).add(name);
  add_channels(message);
  message.add(rectangle, 4).add(offsets, 3).add(strides, 3);
  message.add(rgb, std::size_t(3) * std::size_t(width) * std::size_t(rows));
  return message.finish();
}

TevDisplay::TevDisplay(const TevAddress& address, std::string name, int width, int height,
                       std::chrono::milliseconds patience)
    : address_(address),
      name_(std::move(name)),
      patience_(patience),
      image_(width, height),
      changed_(std::size_t((height + kBlockRows - 1) / kBlockRows)),
      thread_([this] { run(); }) {}

TevDisplay::~TevDisplay() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    end_ = Clock::now() + patience_;
  }
  wake_.notify_all();
  thread_.join();
  if (socket_ >= 0) close(socket_);
}

void TevDisplay::update(int x, int y, const Image& part) {
  const std::lock_guard lock(mutex_);
  for (int row = 0; row < part.height; ++row) {
    std::copy_n(part.at(0, row), 3 * part.width, image_.at(x, y + row));
    changed_[std::size_t((y + row) / kBlockRows)] = 1;
  }
}

// Waits until the socket takes bytes. False when it does not for too long.
bool TevDisplay::wait_for(int socket) const {
  const Clock::time_point longest = Clock::now() + patience_;
  while (Clock::now() < std::min(longest, end_.load())) {
    pollfd wanted{socket, POLLOUT, 0};
    const int ready = poll(&wanted, 1, int(kGlance.count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
  errno = ETIMEDOUT;
  return false;
}

// A connected socket that never blocks, or -1 with errno set.
int TevDisplay::connected(const addrinfo& address) const {
  const int socket = ::socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC,
                              address.ai_protocol);
  if (socket < 0) return -1;
  if (::connect(socket, address.ai_addr, address.ai_addrlen) == 0) return socket;
  int error = errno;
  if (error == EINPROGRESS) {
    socklen_t size = sizeof error;
    error = wait_for(socket) ? 0 : errno;
    if (error == 0) getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
  }
  if (error == 0) return socket;
  close(socket);
  errno = error;
  return -1;
}

bool TevDisplay::connect() {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(address_.host.c_str(), address_.port.c_str(), &hints, &found);
  if (error != 0) {
    failure_ = gai_strerror(error);
    return false;
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  for (const addrinfo* at = found; at && socket_ < 0; at = at->ai_next) socket_ = connected(*at);
  if (socket_ < 0) failure_ = std::strerror(errno);
  return socket_ >= 0;
}

bool TevDisplay::send(std::string_view message) {
  while (!message.empty()) {
    const ssize_t sent = ::send(socket_, message.data(), message.size(), MSG_NOSIGNAL);
    if (sent > 0) message.remove_prefix(std::size_t(sent));
    if (sent < 0 && errno == EINTR) continue;
    const bool full = sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
    if ((sent < 0 && !full) || (!message.empty() && !wait_for(socket_))) {
      failure_ = std::strerror(errno);
      return false;
    }
  }
  return true;
}

bool TevDisplay::send_changes() {
  std::vector<float> rows;
  for (std::size_t block = 0; block < changed_.size(); ++block) {
    const int y = int(block) * kBlockRows, height = std::min(kBlockRows, image_.height - y);
    {
      const std::lock_guard lock(mutex_);
      if (!std::exchange(changed_[block], 0)) continue;
      const float* first = image_.at(0, y);
      rows.assign(first, first + std::size_t(3 * image_.width) * std::size_t(height));
    }
    if (!send(tev_update_image(name_, y, image_.width, height, rows.data()))) return false;
  }
  return true;
}

void TevDisplay::run() {
  bool good = connect() && send(tev_create_image(name_, image_.width, image_.height));
  for (bool last = false; good && !last;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, kInterval, [this] { return closing_; });
      last = closing_;
    }
    good = send_changes();
  }
  if (!good) {
    fmt::print(stderr, "lockstep: warning: --display {}:{}: {}; nothing more is shown there\n",
               address_.host, address_.port, failure_);
  }
}

}  // namespace lockstep
