// Image files: what is written comes back, and what fails leaves nothing behind.
#include "core/error.h"
#include "core/image.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace lockstep::test_image_io {
namespace {

namespace fs = std::filesystem;

// Gives each test an empty directory of its own.
class ImageFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    directory_ = fs::temp_directory_path() /
                 ("lockstep-" + std::string(test->name()) + "-" + std::to_string(getpid()));
    fs::create_directories(directory_);
  }
  void TearDown() override { fs::remove_all(directory_); }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  size_t file_count() const {
    return size_t(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
  }
  void cut_in_half(const std::string& name) const {
    fs::resize_file(path(name), fs::file_size(path(name)) / 2);
  }

  fs::path directory_;
};

Image random_image(int width, int height, int channels, float scale = 1.0f) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<float> uniform(0.0f, scale);
  Image image(width, height, channels);
  for (float& v : image.pixels) v = uniform(generator);
  return image;
}

// The message of the Error that `action` throws; empty if it throws none.
template <typename Action>
std::string error_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expect_one_line_naming(const std::string& message, const std::string& file) {
  EXPECT_NE(message.find(file), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

template <typename T>
std::string bytes_of(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

struct RawChannel {
  std::string name;
  int32_t type = 2;  // 0: whole numbers, 1: half floats, 2: floats
  std::string row;
};

// An uncompressed EXR file of one row of `width` pixels, put together byte by byte; its data window
// begins at (-1, 7).
std::string raw_exr(int width, const std::vector<RawChannel>& channels) {
  const auto attribute = [](const char* name, const char* type, const std::string& value) {
    return name + std::string(1, '\0') + type + std::string(1, '\0') +
           bytes_of(int32_t(value.size())) + value;
  };
  std::string list, row;
  for (const RawChannel& c : channels) {
    list += c.name + '\0' + bytes_of(c.type) + bytes_of(int32_t(0)) + bytes_of(int32_t(1)) +
            bytes_of(int32_t(1));
    row += c.row;
  }
  const std::string window = bytes_of(int32_t(-1)) + bytes_of(int32_t(7)) +
                             bytes_of(int32_t(width - 2)) + bytes_of(int32_t(7));
  std::string file = bytes_of(int32_t(20000630)) + bytes_of(int32_t(2)) +
                     attribute("channels", "chlist", list + '\0') +
                     attribute("compression", "compression", bytes_of('\0')) +
                     attribute("dataWindow", "box2i", window) +
                     attribute("displayWindow", "box2i", window) +
                     attribute("lineOrder", "lineOrder", bytes_of('\0')) +
                     attribute("lockstep:sampler", "string", "owen") +
                     attribute("pixelAspectRatio", "float", bytes_of(1.0f)) +
                     attribute("screenWindowCenter", "v2f", bytes_of(0.0f) + bytes_of(0.0f)) +
                     attribute("screenWindowWidth", "float", bytes_of(1.0f)) + '\0';
  file += bytes_of(uint64_t(file.size() + 8));
  return file + bytes_of(int32_t(7)) + bytes_of(int32_t(row.size())) + row;
}

TEST_F(ImageFiles, ExrKeepsEveryBit) {
  Image image = random_image(37, 19, 3, 1e4f);
  image.pixels[0] = std::numeric_limits<float>::quiet_NaN();
  image.pixels[1] = -std::numeric_limits<float>::infinity();
  image.pixels[2] = 1e-42f;
  write_image(path("a.exr"), image);
  const Image back = read_image(path("a.exr"));
  ASSERT_EQ(back.width, 37);
  ASSERT_EQ(back.height, 19);
  ASSERT_EQ(back.pixels.size(), image.pixels.size());
  EXPECT_EQ(std::memcmp(back.pixels.data(), image.pixels.data(), sizeof(float) * 37 * 19 * 3), 0);
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(ImageFiles, HeaderKeepsSettings) {
  const Metadata settings{{"sampler", "rcs:c=4,t=0.02"}, {"seed", "18446744073709551615"}};
  write_image(path("a.exr"), random_image(4, 4, 3), settings);
  EXPECT_EQ(read_metadata(path("a.exr")), settings);
  write_image(path("a.png"), random_image(4, 4, 3), {{"sampler", "owen"}});
  EXPECT_EQ(read_metadata(path("a.png")), (Metadata{{"sampler", "owen"}}));
}

TEST_F(ImageFiles, SameImageGivesSameFile) {
  const Image image = random_image(8, 8, 3);
  write_image(path("a.exr"), image, {{"seed", "1"}});
  sleep(1);  // a time stamp in the header would differ now
  write_image(path("b.exr"), image, {{"seed", "1"}});
  const auto bytes = [&](const char* name) {
    std::ifstream file(path(name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_TRUE(bytes("a.exr") == bytes("b.exr"));
}

TEST_F(ImageFiles, PngKeepsAll256Values) {
  // Every 8-bit code, decoded by the sRGB curve in double precision.
  Image image(16, 16);
  for (int code = 0; code < 256; ++code) {
    const double v = code / 255.0;
    const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    for (int c = 0; c < 3; ++c) image.at(code % 16, code / 16)[c] = float(linear);
  }
  write_image(path("a.png"), image);
  const Image back = read_image(path("a.png"));
  ASSERT_EQ(back.pixels.size(), image.pixels.size());
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    EXPECT_NEAR(back.pixels[i], image.pixels[i], 2e-6f) << "code " << i / 3;
  }
}

TEST_F(ImageFiles, PngClampsWhatItCannotHold) {
  Image image(4, 1);
  const float values[] = {-1.0f, 7.0f, std::numeric_limits<float>::quiet_NaN(), 0.5f};
  for (int x = 0; x < 4; ++x) image.at(x, 0)[0] = values[x];
  write_image(path("a.png"), image);
  const Image back = read_image(path("a.png"));
  EXPECT_EQ(back.at(0, 0)[0], 0.0f);
  EXPECT_EQ(back.at(1, 0)[0], 1.0f);
  EXPECT_EQ(back.at(2, 0)[0], 0.0f);
  EXPECT_NEAR(back.at(3, 0)[0], 0.5f, 0.005f);
}

TEST_F(ImageFiles, RadianceFileIsNearlyExact) {
  Image image(32, 32);
  for (float& v : image.pixels) v = 123.4f;
  write_image(path("a.hdr"), image);
  EXPECT_NEAR(read_image(path("a.hdr")).at(3, 9)[2], 123.4f, 1.0f);
}

TEST_F(ImageFiles, JpegIsReadAsLinear) {
  Image image(32, 32);
  for (float& v : image.pixels) v = 0.2f;
  write_image(path("a.jpg"), image);
  EXPECT_NEAR(read_image(path("a.jpg")).at(16, 16)[1], 0.2f, 0.01f);
}

TEST_F(ImageFiles, OneChannelComesBackGrey) {
  const Image weights = random_image(9, 5, 1);
  write_image(path("w.exr"), weights);
  const Image back = read_image(path("w.exr"));
  ASSERT_EQ(back.channels, 3);
  for (int x = 0; x < 9; ++x) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(back.at(x, 4)[c], weights.at(x, 4)[0]);
  }
}

TEST_F(ImageFiles, ExrOfOtherProgramsIsRead) {
  const auto half = [](uint16_t a, uint16_t b) { return bytes_of(a) + bytes_of(b); };
  const auto full = [](float a, float b) { return bytes_of(a) + bytes_of(b); };
  const auto read = [&](const std::vector<RawChannel>& channels) {
    // The content says that this is EXR, not the name.
    std::ofstream(path("raw.png"), std::ios::binary) << raw_exr(2, channels);
    const Image image = read_image(path("raw.png"));
    EXPECT_EQ(image.width, 2);
    EXPECT_EQ(image.height, 1);
    return image.pixels;
  };
  using Pixels = std::vector<float>;
  EXPECT_EQ(read({{"A", 1, half(0, 0)},
                  {"B", 1, half(0x3c00, 0xc000)},
                  {"G", 0, bytes_of(uint32_t(0)) + bytes_of(UINT32_MAX)},
                  {"R", 2, full(0.1f, 1e30f)}}),
            (Pixels{0.1f, 0.0f, 1.0f, 1e30f, 1.0f, -2.0f}));
  EXPECT_EQ(read_metadata(path("raw.png")), (Metadata{{"sampler", "owen"}}));
  EXPECT_EQ(read({{"A", 2, full(9, 9)}, {"Y", 2, full(3, 4)}}), (Pixels{3, 3, 3, 4, 4, 4}));
  EXPECT_EQ(read({{"view.A", 2, full(9, 9)},
                  {"view.B", 2, full(1, 2)},
                  {"view.G", 2, full(3, 4)},
                  {"view.R", 2, full(5, 6)},
                  {"wide.R", 2, full(7, 8)}}),
            (Pixels{5, 3, 1, 6, 4, 2}));
}

TEST_F(ImageFiles, AlphaIsDroppedAndColourKept) {
  Image image(2, 1, 4);
  image.pixels = {0.5f, 0.25f, 1.0f, 0.0f, 0.5f, 0.25f, 1.0f, 1.0f};
  write_image(path("a.exr"), image);
  const Image back = read_image(path("a.exr"));
  ASSERT_EQ(back.channels, 3);
  EXPECT_EQ(back.pixels, (std::vector<float>{0.5f, 0.25f, 1.0f, 0.5f, 0.25f, 1.0f}));
}

TEST_F(ImageFiles, WritingReplacesAFile) {
  write_image(path("a.exr"), Image(2, 2));
  write_image(path("a.exr"), Image(3, 3));
  EXPECT_EQ(read_image(path("a.exr")).width, 3);
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(ImageFiles, UnreadableFilesAreErrors) {
  const auto read = [&](const std::string& name) {
    return error_of([&] { read_image(path(name)); });
  };
  expect_one_line_naming(read("missing.exr"), "missing.exr");
  expect_one_line_naming(error_of([&] { read_metadata(path("missing.exr")); }), "missing.exr");

  std::ofstream(path("text.png")) << "not an image at all\n";
  expect_one_line_naming(read("text.png"), "text.png");
  std::ofstream(path("empty.exr")).close();
  expect_one_line_naming(read("empty.exr"), "empty.exr");
  fs::create_directory(path("folder.exr"));
  expect_one_line_naming(read("folder.exr"), "folder.exr");

#ifdef __SANITIZE_ADDRESS__
  const __lsan::ScopedDisabler ignore_leaks;  // libpng's long jump skips OpenImageIO's destructors
#endif
  for (const std::string name : {"half.exr", "half.png"}) {
    write_image(path(name), random_image(64, 64, 3));
    cut_in_half(name);
    expect_one_line_naming(read(name), name);
  }
}

TEST_F(ImageFiles, VastDamagedHeaderIsAnError) {
  std::ofstream(path("vast.exr"), std::ios::binary) << raw_exr(1 << 29, {{"Y", 2, "few"}});
  expect_one_line_naming(error_of([&] { read_image(path("vast.exr")); }), "vast.exr");
  // Room for it may be promised, so that reading it would take long.
  std::ofstream(path("vast.pfm")) << "PF\n32768 32768\n-1.0\n";
  EXPECT_NE(error_of([&] { read_image(path("vast.pfm")); }).find("32768 pixels is too large"),
            std::string::npos);
}

TEST_F(ImageFiles, AttributesLargerThanTheirFileAreErrors) {
  write_image(path("a.exr"), random_image(4, 4, 3), {{"key", "value"}});
  std::ostringstream text;
  text << std::ifstream(path("a.exr"), std::ios::binary).rdbuf();
  std::string bytes = text.str();
  const std::string type("string\0", 7);
  ASSERT_NE(bytes.find(type), bytes.npos);
  bytes.replace(bytes.find(type) + type.size(), 4, "\xff\xff\xff\x3f");  // 1 GiB
  std::ofstream(path("b.exr"), std::ios::binary) << bytes;
  for (const std::string& message : {error_of([&] { read_image(path("b.exr")); }),
                                     error_of([&] { read_metadata(path("b.exr")); })}) {
    EXPECT_NE(message.find("claims to be larger than the file"), message.npos) << message;
  }
}

// The module of other formats is looked for beside the program: a copy of this one elsewhere has
// none, and must still do all that it does with EXR files.
TEST_F(ImageFiles, OnlyOtherFormatsNeedTheModule) {
  const fs::path self = fs::read_symlink("/proc/self/exe");
  if (fs::exists(self.parent_path() / "lockstep_image_formats.so")) {
    fs::copy_file(self, path("copy"));
    const std::string run =
        path("copy") + " --gtest_filter=ImageFiles.OnlyOtherFormatsNeedTheModule";
    EXPECT_EQ(std::system(run.c_str()), 0);
    return;
  }
  write_image(path("a.exr"), random_image(4, 4, 3), {{"seed", "1"}});
  EXPECT_EQ(read_image(path("a.exr")).width, 4);
  EXPECT_EQ(read_metadata(path("a.exr")), (Metadata{{"seed", "1"}}));
  std::ofstream(path("b.png")) << "any";
  for (const std::string& message : {error_of([&] { write_image(path("b.png"), Image(4, 4)); }),
                                     error_of([&] { read_image(path("b.png")); }),
                                     error_of([&] { can_write_image("b.png"); })}) {
    expect_one_line_naming(message, "b.png");
    EXPECT_NE(message.find("lockstep_image_formats.so"), std::string::npos) << message;
  }
  std::stringstream loaded;
  loaded << std::ifstream("/proc/self/maps").rdbuf();
  EXPECT_NE(loaded.str().find("libOpenEXR"), std::string::npos);
  EXPECT_EQ(loaded.str().find("libOpenImageIO"), std::string::npos);
}

TEST_F(ImageFiles, UnwritablePlacesAreErrorsAndLeaveNothing) {
  const Image image = random_image(8, 8, 3);
  const auto write = [&](const std::string& name) {
    return error_of([&] { write_image(path(name), image); });
  };
  expect_one_line_naming(write("no/such/a.exr"), "a.exr");
  expect_one_line_naming(write("a.unknown"), "a.unknown");
  expect_one_line_naming(write("extensionless"), "extensionless");
  expect_one_line_naming(error_of([&] { write_image(path("a.exr"), Image(0, 0)); }), "a.exr");
  EXPECT_EQ(file_count(), 0u);

  // A directory in the file's place: the rename fails after the data was written.
  fs::create_directories(path("a.exr/inside"));
  expect_one_line_naming(write("a.exr"), "a.exr");
  EXPECT_EQ(file_count(), 1u);
}

// A limit on file sizes stands in for a full disk.
TEST_F(ImageFiles, FullDiskIsAnErrorAndLeavesNothing) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{2000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string exr = error_of([&] { write_image(path("a.exr"), random_image(64, 64, 3)); });
  const std::string png = error_of([&] { write_image(path("a.png"), random_image(64, 64, 3)); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  expect_one_line_naming(exr, "a.exr");
  expect_one_line_naming(png, "a.png");
  EXPECT_EQ(file_count(), 0u);
}

}  // namespace
}  // namespace lockstep::test_image_io
