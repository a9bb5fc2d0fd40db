#include "experiments/report/report_images.h"

#include "core/error.h"
#include "core/half.h"
#include "experiments/metrics/flip.h"
#include "experiments/metrics/metrics.h"

#include <fmt/format.h>
#include <zlib.h>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace lockstep {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kMostAveraged = 16;  // pixels a side

std::string base64(std::string bytes) {
  using namespace boost::archive::iterators;
  using Digits = base64_from_binary<transform_width<const char*, 6, 8>>;
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  bytes.append(padding, '\0');
  std::string text(Digits(bytes.data()), Digits(bytes.data() + bytes.size()));
  return text.replace(text.size() - padding, padding, padding, '=');
}

std::string zipped(const std::vector<std::uint8_t>& bytes) {
  uLongf size = compressBound(uLong(bytes.size()));
  std::string stream(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(stream.data()), &size, bytes.data(), uLong(bytes.size()),
                6) != Z_OK) {
    throw std::bad_alloc();  // the only way in which it fails where there is room for its output
  }
  stream.resize(size);
  return base64(std::move(stream));
}

std::uint16_t zigzag(std::uint16_t difference) {
  return std::uint16_t(difference << 1 ^ (difference & 0x8000u ? 0xffffu : 0u));
}

// One render's encoded images.
struct EncodedRun {
  Json entry;
  std::string elements;
};

// Elements of one page: ids are given out in turn.
struct Elements {
  int count = 0;
  std::string add(std::string& html, const std::string& base64) {
    const std::string id = fmt::format("image-{}", count++);
    html += fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, base64);
    return id;
  }
};

EncodedRun encode(const SceneComparison& scene, const Image& reference, const fs::path& directory,
                  const RunImages& files, int factor, Elements& elements) {
  EncodedRun run;
  const Image image = read_image((directory / files.exr).string());
  if (image.width != scene.reference.image.width || image.height != scene.reference.image.height) {
    throw Error(files.exr + ": has another size than the reference");
  }
  run.entry = {{"sampler", files.sampler}, {"spp", files.spp}};
  const auto add = [&](const std::string& text) { return elements.add(run.elements, text); };
  run.entry["radiance"] =
      add(encoded_radiance(averaged_down(image, factor), scene.exposure, &reference));
  const Image flip = flip_ldr_map(scene.reference.image, image);
  run.entry["flip"] = add(encoded_map(averaged_down(flip, factor)));
  run.entry["weights"] = nullptr;
  if (!files.weights_png.empty()) {
    const fs::path exr = fs::path(directory / files.weights_png).replace_extension(".exr");
    Image weights = read_image(exr.string());
    Image map(weights.width, weights.height, 1);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
      map.pixels[i] = weights.pixels[i * std::size_t(weights.channels)];
    }
    run.entry["weights"] = add(encoded_map(averaged_down(map, factor)));
  }
  return run;
}

// Median CPU time of a sampler's renders at a sample count.
double seconds_of(const Json& scene, const RunImages& files) {
  for (const Json& rung : scene["samplers"][std::size_t(files.sampler)]["rungs"]) {
    if (rung["spp"] == files.spp) return rung["cpu_seconds"]["median"];
  }
  return 0.0;
}

// The longest CPU time that was measured for every sampler.
std::optional<double> longest_budget(const Json& scene) {
  std::optional<double> longest;
  for (const Json& budget : scene["equal_time"]["budgets"]) {
    const Json& samplers = budget["samplers"];
    const bool all = std::all_of(samplers.begin(), samplers.end(), [](const Json& entry) {
      return entry.contains(metrics()[0].name);
    });
    if (!all) continue;
    const double seconds = budget["cpu_seconds"];
    longest = std::max(longest.value_or(seconds), seconds);
  }
  return longest;
}

// Renders in the order in which they are worth room, and how many of them are the first set.
struct Order {
  std::vector<RunImages> runs;
  std::size_t first_set = 0;
};

Order order_of(const SceneComparison& scene, const Json& summary) {
  const std::optional<double> budget = longest_budget(summary);
  // Distance from the budget in factors; without one, from the largest sample count.
  const auto distance = [&](const RunImages& run) {
    const double seconds = seconds_of(summary, run);
    return budget && seconds > 0.0 ? std::fabs(std::log(seconds / *budget)) : -double(run.spp);
  };
  Order order{scene.images, 0};
  std::stable_sort(order.runs.begin(), order.runs.end(),
                   [](const RunImages& a, const RunImages& b) { return a.spp > b.spp; });
  for (std::size_t s = 0; s < summary["samplers"].size(); ++s) {
    auto best = order.runs.end();
    for (auto run = order.runs.begin(); run != order.runs.end(); ++run) {
      if (run->sampler != int(s)) continue;
      if (best == order.runs.end() || distance(*run) < distance(*best)) best = run;
    }
    if (best == order.runs.end()) continue;
    std::rotate(order.runs.begin() + std::ptrdiff_t(order.first_set), best, best + 1);
    ++order.first_set;
  }
  return order;
}

// Adds renders while they fit; false where one of the first set does not.
bool add_runs(const Comparison& comparison, const std::vector<Order>& orders, bool first_sets,
              int factor, std::size_t max_bytes, Elements& elements, ReportImages& page) {
  const fs::path directory = comparison.settings.directory;
  for (std::size_t s = 0; s < orders.size(); ++s) {
    const SceneComparison& scene = comparison.scenes[s];
    const Order& order = orders[s];
    const Image reference = averaged_down(scene.reference.image, factor);
    Json& index = page.index[s];
    const std::size_t begin = first_sets ? 0 : order.first_set;
    const std::size_t end = first_sets ? order.first_set : order.runs.size();
    for (std::size_t i = begin; i < end; ++i) {
      try {
        const EncodedRun run = encode(scene, reference, directory, order.runs[i], factor, elements);
        if (page.elements.size() + run.elements.size() > max_bytes) return false;
        page.elements += run.elements;
        index["runs"].push_back(run.entry);
        index["left_out"] = index["left_out"].get<int>() - 1;
      } catch (const Error&) {
        // The file is gone or damaged: the page says that it has one image less.
      }
    }
  }
  return true;
}

// References and first sets; false where they do not fit.
bool add_first(const Comparison& comparison, const std::vector<Order>& orders, int factor,
               std::size_t max_bytes, Elements& elements, ReportImages& page) {
  for (std::size_t s = 0; s < orders.size(); ++s) {
    const SceneComparison& scene = comparison.scenes[s];
    const Image reference = averaged_down(scene.reference.image, factor);
    const std::string id =
        elements.add(page.elements, encoded_radiance(reference, scene.exposure, nullptr));
    page.index.push_back({{"size", {reference.width, reference.height}},
                          {"factor", factor},
                          {"reference", id},
                          {"runs", Json::array()},
                          {"left_out", int(orders[s].runs.size())}});
    if (page.elements.size() > max_bytes) return false;
  }
  return add_runs(comparison, orders, true, factor, max_bytes, elements, page);
}

}  // namespace

std::string encoded_radiance(const Image& image, float exposure, const Image* prediction) {
  const std::size_t count = image.pixels.size();
  const auto half = [exposure](float value) { return half_from_float(value * exposure); };
  std::vector<std::uint8_t> planes(2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint16_t predicted = 0;
    if (prediction)
      predicted = half(prediction->pixels[i]);
    else if (i >= 3)
      predicted = half(image.pixels[i - 3]);
    const std::uint16_t code = zigzag(std::uint16_t(half(image.pixels[i]) - predicted));
    planes[i] = std::uint8_t(code);
    planes[count + i] = std::uint8_t(code >> 8);
  }
  return zipped(planes);
}

std::string encoded_map(const Image& map) {
  std::vector<std::uint8_t> bytes(map.pixels.size());
  std::uint8_t before = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto code = std::uint8_t(255.0f * std::clamp(map.pixels[i], 0.0f, 1.0f) + 0.5f);
    bytes[i] = std::uint8_t(code - before);
    before = code;
  }
  return zipped(bytes);
}

Image averaged_down(const Image& image, int factor) {
  if (factor == 1) return image;
  Image small((image.width + factor - 1) / factor, (image.height + factor - 1) / factor,
              image.channels);
  for (int y = 0; y < small.height; ++y) {
    const int bottom = std::min(image.height, (y + 1) * factor);
    for (int x = 0; x < small.width; ++x) {
      const int right = std::min(image.width, (x + 1) * factor);
      for (int c = 0; c < image.channels; ++c) {
        double sum = 0.0;
        for (int v = y * factor; v < bottom; ++v) {
          for (int u = x * factor; u < right; ++u) sum += image.at(u, v)[c];
        }
        small.at(x, y)[c] = float(sum / ((bottom - y * factor) * (right - x * factor)));
      }
    }
  }
  return small;
}

ReportImages report_images(const Comparison& comparison, const Json& summary,
                           std::size_t max_bytes) {
  std::vector<Order> orders;
  for (std::size_t s = 0; s < comparison.scenes.size(); ++s) {
    orders.push_back(order_of(comparison.scenes[s], summary["scenes"][s]));
  }
  for (int factor = 1; factor <= kMostAveraged; ++factor) {
    ReportImages page{Json::array(), ""};
    Elements elements;
    if (!add_first(comparison, orders, factor, max_bytes, elements, page)) continue;
    add_runs(comparison, orders, false, factor, max_bytes, elements, page);
    return page;
  }
  return {Json::array(), ""};
}

}  // namespace lockstep
