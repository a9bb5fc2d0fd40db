// Images cut short: one line that names the file, whatever the format, never a picture that is
// partly made up.
#include "core/image.h"
#include "core/texture_image.h"
#include "tests/t_images.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <memory>

namespace lockstep::test_damaged_images {
namespace {

class DamagedImages : public TestWithImages {
 protected:
  // Detail everywhere, so that no part of the file is padding.
  std::string bytes_of(const std::string& extension) const {
    const std::string name = path("whole." + extension);
    write_image(name, image_of(120, 90, [](int x, int y) {
                  const float a = float(x * 37 % 101 + y * 53 % 89) / 190.0f;
                  return glm::vec3(a, 1.0f - a, 0.5f + 0.4f * std::sin(float(x * y)));
                }));
    std::ifstream in(name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void expect_error(const std::string& file) const {
    for (const auto& message : {message_of([&] { read_image(path(file)); }),
                                message_of([&] { read_texture_image(texture_of(path(file))); })}) {
      expect_one_line_with(message, file + ": ");
    }
  }
};

TEST_F(DamagedImages, CutShortGiveOneLine) {
  for (const std::string extension : {"png", "jpg", "exr", "hdr", "tga"}) {
    const std::string whole = bytes_of(extension);
    EXPECT_NO_THROW(read_texture_image(texture_of(path("whole." + extension))));
    for (const size_t percent : {10u, 50u, 95u}) {
      const std::string name = "cut" + std::to_string(percent) + "." + extension;
      write(name, whole.substr(0, whole.size() * percent / 100));
      SCOPED_TRACE(name);
      expect_error(name);
    }
  }
}

TEST_F(DamagedImages, InSceneFilesGiveOneLine) {
  for (const std::string extension : {"png", "jpg"}) {
    const std::string whole = bytes_of(extension);
    for (const size_t percent : {10u, 50u, 95u, 100u}) {
      ImageTexture texture = texture_of("inside." + extension);
      const size_t size = whole.size() * percent / 100;
      texture.encoded = std::make_shared<std::vector<unsigned char>>(
          whole.begin(), whole.begin() + ptrdiff_t(size));
      const std::string message = error_of([&] { read_texture_image(texture); });
      if (percent == 100) {
        EXPECT_EQ(message, "") << extension;
      } else {
        expect_one_line_with(message, "inside." + extension + ": ");
      }
    }
  }
}

// What cameras and editors leave in JPEGs does no harm: bytes behind the end, or between markers.
TEST_F(DamagedImages, ExtraBytesInJpegsAreNoDamage) {
  const std::string whole = bytes_of("jpg");
  write("behind.jpg", whole + std::string(100, 'x'));
  EXPECT_NO_THROW(read_image(path("behind.jpg")));
  const size_t tables = whole.find("\xff\xdb");
  ASSERT_NE(tables, whole.npos);
  write("between.jpg", whole.substr(0, tables) + std::string(7, 'x') + whole.substr(tables));
  EXPECT_NO_THROW(read_image(path("between.jpg")));
}

}  // namespace
}  // namespace lockstep::test_damaged_images
