// The live view against a small receiver that reads the protocol of the viewer tev.
#include "core/error.h"
#include "experiments/output/tev_display.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace lockstep::test_tev_display {
namespace {

using namespace std::chrono_literals;

// A socket that listens at a free port of this machine.
class Listener {
 public:
  Listener() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const plain = reinterpret_cast<sockaddr*>(&address);
    if (bind(socket_, plain, size) != 0 || listen(socket_, 1) != 0 ||
        getsockname(socket_, plain, &size) != 0) {
      throw std::runtime_error("no port to listen at");
    }
    port_ = ntohs(address.sin_port);
  }
  ~Listener() { ::close(socket_); }
  TevAddress address() const { return {"127.0.0.1", std::to_string(port_)}; }
  int accept() const { return ::accept(socket_, nullptr, nullptr); }

 private:
  int socket_;
  int port_ = 0;
};

// Reads `size` bytes, fewer where the connection ends.
std::string read_bytes(int socket, std::size_t size) {
  std::string bytes(size, '\0');
  std::size_t have = 0;
  while (have < size) {
    const ssize_t got = recv(socket, bytes.data() + have, size - have, 0);
    if (got <= 0) break;
    have += std::size_t(got);
  }
  bytes.resize(have);
  return bytes;
}

// Takes fields off the front of a message; throws where it is too short.
struct Fields {
  std::string_view rest;

  std::string_view take(std::size_t size) {
    if (rest.size() < size) throw std::runtime_error("the message ends early");
    const std::string_view taken = rest.substr(0, size);
    rest.remove_prefix(size);
    return taken;
  }
  template <typename T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string text() {
    const std::string_view taken = take(std::min(rest.find('\0'), rest.size() - 1) + 1);
    return std::string(taken.substr(0, taken.size() - 1));
  }
};

// The messages, and the image that a viewer would show.
struct Received {
  std::vector<int> kinds;
  std::string name;
  Image image;
};

void expect_channels(Fields& fields) {
  EXPECT_EQ(fields.number<std::int32_t>(), 3);
  for (const char* channel : {"R", "G", "B"}) EXPECT_EQ(fields.text(), channel);
}

void read_create(Fields fields, Received& received) {
  EXPECT_LE(fields.number<std::uint8_t>(), 1);
  received.name = fields.text();
  const auto width = fields.number<std::int32_t>(), height = fields.number<std::int32_t>();
  expect_channels(fields);
  EXPECT_TRUE(fields.rest.empty());
  received.image = Image(width, height);
}

void read_update(Fields fields, Received& received) {
  EXPECT_LE(fields.number<std::uint8_t>(), 1);
  EXPECT_EQ(fields.text(), received.name);
  expect_channels(fields);
  std::int32_t box[4];  // x, y, width, height
  for (std::int32_t& side : box) side = fields.number<std::int32_t>();
  std::int64_t offsets[3], strides[3];
  for (std::int64_t& offset : offsets) offset = fields.number<std::int64_t>();
  for (std::int64_t& stride : strides) stride = fields.number<std::int64_t>();
  const std::size_t pixels = std::size_t(box[2]) * std::size_t(box[3]);
  std::vector<float> data(fields.rest.size() / sizeof(float));
  std::memcpy(data.data(), fields.rest.data(), data.size() * sizeof(float));
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const int x = box[0] + int(i) % box[2], y = box[1] + int(i) / box[2];
      received.image.at(x, y)[c] = data.at(std::size_t(offsets[c]) + i * std::size_t(strides[c]));
    }
  }
}

// All that one connection brings.
Received receive(const Listener& listener) {
  Received received;
  const int socket = listener.accept();
  while (true) {
    const std::string head = read_bytes(socket, 4);
    if (head.size() < 4) break;
    const std::uint32_t length = Fields{head}.number<std::uint32_t>();
    const std::string body = read_bytes(socket, length - 4);
    EXPECT_EQ(body.size(), length - 4);
    Fields fields{body};
    received.kinds.push_back(fields.number<std::uint8_t>());
    if (received.kinds.back() == 4) read_create(fields, received);
    if (received.kinds.back() == 6) read_update(fields, received);
  }
  close(socket);
  return received;
}

Image gradient(int width, int height) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = 0.25f * float(i);
  return image;
}

TEST(TevDisplay, ShowsWhatItWasGiven) {
  const Listener listener;
  Received received;
  std::thread viewer([&] { received = receive(listener); });
  Image expected(70, 50);
  {
    TevDisplay display(listener.address(), "out/image.exr", 70, 50);
    for (const auto& [x, y] : {std::pair{0, 0}, {16, 16}, {50, 20}, {3, 34}}) {
      const Image tile = gradient(16, 16);
      display.update(x, y, tile);
      for (int row = 0; row < 16; ++row) {
        std::copy_n(tile.at(0, row), 3 * 16, expected.at(x, y + row));
      }
    }
  }
  viewer.join();
  EXPECT_EQ(received.name, "out/image.exr");
  ASSERT_GE(received.kinds.size(), 2u);
  EXPECT_EQ(received.kinds[0], 4);  // CreateImage, then UpdateImageV3
  for (std::size_t i = 1; i < received.kinds.size(); ++i) EXPECT_EQ(received.kinds[i], 6);
  EXPECT_EQ(received.image.pixels, expected.pixels);
}

TEST(TevDisplay, SendsWhileTheImageForms) {
  const Listener listener;
  TevDisplay display(listener.address(), "a", 8, 8);
  const int socket = listener.accept();
  const std::string create = tev_create_image("a", 8, 8);
  EXPECT_EQ(read_bytes(socket, create.size()), create);
  const Image image = gradient(8, 8);
  display.update(0, 0, image);
  const std::string update = tev_update_image("a", 0, 8, 8, image.pixels.data());
  EXPECT_EQ(read_bytes(socket, update.size()), update);  // without the display being closed
  close(socket);
}

TEST(TevDisplay, WarnsOnceWhereNobodyListens) {
  TevAddress address;
  {
    const Listener gone;
    address = gone.address();
  }
  testing::internal::CaptureStderr();
  {
    TevDisplay display(address, "a", 64, 64);
    for (int i = 0; i < 10; ++i) display.update(0, 0, gradient(64, 64));
  }
  const std::string output = testing::internal::GetCapturedStderr();
  EXPECT_EQ(output.find("lockstep: warning: --display 127.0.0.1:"), 0u) << output;
  EXPECT_EQ(output.find('\n'), output.size() - 1) << output;
}

TEST(TevDisplay, GivesUpOnAViewerThatGoesAwayOrTakesNothing) {
  for (const bool goes : {true, false}) {
    const Listener listener;
    testing::internal::CaptureStderr();
    int socket = -1;
    const auto start = std::chrono::steady_clock::now();
    {
      // More than buffers of sockets hold.
      TevDisplay display(listener.address(), "a", 4096, 1024, 200ms);
      socket = listener.accept();
      if (goes) close(socket);
      display.update(0, 0, gradient(4096, 1024));
      if (goes) std::this_thread::sleep_for(600ms);
      display.update(0, 0, gradient(4096, 1024));
    }
    // Seconds where it should be 0.2: a hang is what fails.
    EXPECT_LT(std::chrono::steady_clock::now() - start, 30s);
    if (!goes) close(socket);
    const std::string output = testing::internal::GetCapturedStderr();
    EXPECT_EQ(output.find("lockstep: warning: --display 127.0.0.1:"), 0u) << output;
    EXPECT_EQ(output.find('\n'), output.size() - 1) << output;
  }
}

TEST(TevDisplay, ReadsAddresses) {
  EXPECT_EQ(parse_tev_address("localhost:1234").host, "localhost");
  EXPECT_EQ(parse_tev_address("localhost:1234").port, "1234");
  EXPECT_EQ(parse_tev_address("render7").port, "14158");
  EXPECT_EQ(parse_tev_address("[::1]:99").host, "::1");
  EXPECT_EQ(parse_tev_address("[::1]").port, "14158");
  for (const char* wrong : {"", ":14158", "host:", "host:0", "host:65536", "host:12x", "host:-1"}) {
    EXPECT_THROW(parse_tev_address(wrong), UsageError) << wrong;
  }
}

}  // namespace
}  // namespace lockstep::test_tev_display
