// Images as `lockstep metrics` reads them: those that are accepted are whole, and of a small one
// every metric is a number.
#include "core/image.h"
#include "experiments/metrics/metrics.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/own_errors.h"
#include "tests/fuzz/playground.h"

#include <cmath>
#include <string>
#include <string_view>

namespace lockstep::fuzz {
namespace {

void check_image(const std::string& path) {
  const Image image = read_image(path);
  require(image.width > 0 && image.height > 0 && image.channels == 3, "an image without pixels");
  require(image.pixels.size() == std::size_t(image.width) * std::size_t(image.height) * 3,
          "pixels are lost");
  constexpr int small = 32;  // metrics take their time
  if (image.width > small || image.height > small) return;
  Image half = image;
  for (float& v : half.pixels) v *= 0.5f;
  for (const double value : evaluate_metrics(image, half)) {
    require(!std::isnan(value), "a metric of finite images is not a number");
  }
}

// OpenImageIO chooses its reader by the name.
std::string name_for(std::string_view bytes) {
  if (bytes.starts_with("#?")) return "input.hdr";
  if (bytes.starts_with("PF") || bytes.starts_with("Pf")) return "input.pfm";
  if (bytes.starts_with("v/1")) return "input.exr";
  return "input.png";
}

}  // namespace
}  // namespace lockstep::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lockstep;
  static const fuzz::Playground playground;
  const std::string name = fuzz::name_for({reinterpret_cast<const char*>(data), size});
  const std::string path = playground.write(name, data, size);
  fuzz::expect_own_errors("image", [&] { fuzz::check_image(path); });
  fuzz::expect_own_errors("image's settings", [&] { read_metadata(path); });
  return 0;
}
