// The report page and the figures, from a comparison made up by hand; the page in a browser is
// tested in tests/report.
#include "core/half.h"
#include "experiments/compare/summary.h"
#include "experiments/metrics/metrics.h"
#include "experiments/output/command_line.h"
#include "experiments/report/figures.h"
#include "experiments/report/report.h"

#include <gtest/gtest.h>

#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

namespace lockstep::test_report {
namespace {

namespace fs = std::filesystem;

struct TemporaryFolder {
  fs::path path = fs::temp_directory_path() / ("lockstep-report-" + std::to_string(::getpid()));
  TemporaryFolder() { fs::create_directories(path); }
  ~TemporaryFolder() { fs::remove_all(path); }
};

std::string text_of(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// Noise around a gradient; RGB.
Image noisy_image(int width, int height, float noise, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(1.0f - noise, 1.0f + noise);
  Image image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = (0.1f + float(i) / float(image.pixels.size())) * uniform(random);
  }
  return image;
}

// Two samplers, two sample counts, two seeds; the first seed's renders are files in the folder.
Comparison made_comparison(const fs::path& folder, int width, int height) {
  Comparison comparison;
  comparison.settings.samplers = {parse_sampler("random"), parse_sampler("rcs")};
  comparison.settings.rungs = {4, 16};
  comparison.settings.seeds = 2;
  comparison.settings.directory = folder.string();
  SceneComparison scene;
  scene.scene = scene.label = "made </script><b>up</b>";
  scene.width = width;
  scene.height = height;
  scene.depth = 3;
  scene.exposure = 0.5f;
  scene.reference.image = noisy_image(width, height, 0.0f, 1);
  for (int s = 0; s < 2; ++s) {
    for (int spp : {4, 16}) {
      for (std::uint32_t seed = 0; seed < 2; ++seed) {
        Measurement run;
        run.sampler = s;
        run.seed = seed;
        run.spp = spp;
        run.cpu_seconds = run.wall_seconds = spp * (1.0 + 0.1 * s);
        run.errors.assign(metrics().size(), 1.0 / (spp + s));
        scene.runs.push_back(run);
      }
      const std::string stem = "image-" + std::to_string(s) + "-" + std::to_string(spp);
      RunImages images{s, spp, stem + ".exr", stem + ".png", s == 1 ? stem + "-weights.png" : ""};
      write_image((folder / images.exr).string(),
                  noisy_image(width, height, 1.0f / float(spp), unsigned(s)));
      Image weights(width, height, 1);
      std::fill(weights.pixels.begin(), weights.pixels.end(), 0.25f);
      if (s == 1) write_image((folder / (stem + "-weights.exr")).string(), weights);
      scene.images.push_back(images);
    }
    scene.spectra.push_back({s, 16, 2, {{{0.125, 4.0}, {0.375, 1.0}}, 2.0}});
  }
  comparison.scenes.push_back(scene);
  return comparison;
}

std::vector<std::uint8_t> unzipped(const std::string& base64, std::size_t size) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> stream, bytes(size);
  unsigned bits = 0;
  int count = 0;
  for (char c : base64.substr(0, base64.find('='))) {
    bits = bits << 6 | unsigned(digits.find(c));
    count += 6;
    if (count >= 8) stream.push_back(std::uint8_t(bits >> (count -= 8)));
  }
  uLongf length = uLongf(size);
  EXPECT_EQ(uncompress(bytes.data(), &length, stream.data(), uLong(stream.size())), Z_OK);
  EXPECT_EQ(length, size);
  return bytes;
}

// The half floats that encoded_radiance() was given.
std::vector<std::uint16_t> decoded(const std::string& base64, std::size_t count,
                                   const std::vector<std::uint16_t>* prediction) {
  const std::vector<std::uint8_t> planes = unzipped(base64, 2 * count);
  std::vector<std::uint16_t> halves(count);
  for (std::size_t i = 0; i < count; ++i) {
    const int code = planes[i] | planes[count + i] << 8;
    const int difference = code & 1 ? -(code + 1) / 2 : code / 2;
    halves[i] = std::uint16_t((prediction ? (*prediction)[i]
                               : i >= 3   ? halves[i - 3]
                                          : 0) +
                              difference);
  }
  return halves;
}

std::vector<std::uint16_t> halves_of(const Image& image, float exposure) {
  std::vector<std::uint16_t> halves;
  for (float value : image.pixels) halves.push_back(half_from_float(value * exposure));
  return halves;
}

TEST(ReportImages, KeepEveryHalfFloat) {
  Image reference = noisy_image(13, 7, 0.5f, 1), image = noisy_image(13, 7, 1.5f, 2);
  reference.pixels[0] = 0.0f;
  reference.pixels[1] = -3.0f;
  image.pixels[0] = 1e9f;  // becomes the largest half
  image.pixels[2] = 1e-7f;
  const std::size_t count = image.pixels.size();
  const auto first = decoded(encoded_radiance(reference, 0.7f, nullptr), count, nullptr);
  EXPECT_EQ(first, halves_of(reference, 0.7f));
  EXPECT_EQ(decoded(encoded_radiance(image, 0.7f, &reference), count, &first),
            halves_of(image, 0.7f));
}

TEST(ReportImages, MapsAreBytesOfTheirDifferences) {
  Image map(3, 1, 1);
  map.pixels = {1.0f, 0.2f, 0.4f};
  EXPECT_EQ(unzipped(encoded_map(map), 3), (std::vector<std::uint8_t>{255, 52, 51}));
}

TEST(ReportImages, AveragingDownKeepsTheMean) {
  Image image(3, 2, 1);
  image.pixels = {1, 2, 5, 3, 6, 9};
  const Image small = averaged_down(image, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.pixels, (std::vector<float>{3.0f, 7.0f}));
}

TEST(ReportImages, HoldsAllRendersWhereThereIsRoom) {
  const TemporaryFolder folder;
  const Comparison comparison = made_comparison(folder.path, 24, 16);
  const ReportImages images = report_images(comparison, summarize(comparison), 1'000'000);
  const auto& scene = images.index[0];
  EXPECT_EQ(scene["factor"], 1);
  EXPECT_EQ(scene["left_out"], 0);
  ASSERT_EQ(scene["runs"].size(), 4u);
  EXPECT_EQ(scene["runs"][0]["spp"], 16) << "those at the longest common time come first";
  EXPECT_TRUE(scene["runs"][0]["weights"].is_null());
  EXPECT_TRUE(scene["runs"][1]["weights"].is_string());
  for (const auto& run : scene["runs"]) {
    for (const char* image : {"radiance", "flip"}) {
      const std::string element = "id=\"" + run[image].get<std::string>() + "\"";
      EXPECT_NE(images.elements.find(element), std::string::npos) << element;
    }
  }
}

TEST(ReportImages, StayWithinTheirRoom) {
  const TemporaryFolder folder;
  const Comparison comparison = made_comparison(folder.path, 96, 64);
  const auto summary = summarize(comparison);
  const std::size_t all = report_images(comparison, summary, 100'000'000).elements.size();
  const ReportImages fewer = report_images(comparison, summary, 3 * all / 4);
  EXPECT_EQ(fewer.index[0]["factor"], 1);
  EXPECT_EQ(fewer.index[0]["runs"].size() + fewer.index[0]["left_out"].get<std::size_t>(), 4u);
  EXPECT_GE(fewer.index[0]["runs"].size(), 2u) << "one for each sampler";
  EXPECT_LE(fewer.elements.size(), 3 * all / 4);
  const ReportImages smaller = report_images(comparison, summary, all / 4);
  EXPECT_GT(smaller.index[0]["factor"], 1);
  EXPECT_LE(smaller.elements.size(), all / 4);
}

TEST(ReportImages, LoseOnlyWhatCannotBeRead) {
  const TemporaryFolder folder;
  const Comparison comparison = made_comparison(folder.path, 24, 16);
  fs::remove(folder.path / "image-0-4.exr");
  fs::resize_file(folder.path / "image-1-4.exr", 100);
  const ReportImages images = report_images(comparison, summarize(comparison), 1'000'000);
  EXPECT_EQ(images.index[0]["runs"].size(), 2u);
  EXPECT_EQ(images.index[0]["left_out"], 2);
}

TEST(Report, IsOnePageThatNeedsNothingElse) {
  const TemporaryFolder folder;
  const Comparison comparison = made_comparison(folder.path, 24, 16);
  const auto summary = summarize(comparison);
  const std::string html = report_html(summary, report_images(comparison, summary, 1'000'000));
  for (const char* mark :
       {"{{CSS}}", "{{D3}}", "{{DATA}}", "{{IMAGES}}", "{{JS}}", "<script src", "<link", "<img"}) {
    EXPECT_EQ(html.find(mark), std::string::npos) << mark;
  }
  EXPECT_EQ(html.find("made </script>"), std::string::npos) << "data must not end its element";
  EXPECT_NE(html.find("made \\u003c/script>"), std::string::npos);
}

// The room that the page may take, from what an image takes: noise with a relative error of a half
// hardly compresses.
TEST(Report, TenSamplersOf512By512FitInto30Megabytes) {
  const Image reference = noisy_image(512, 512, 0.0f, 1), image = noisy_image(512, 512, 0.5f, 2);
  const std::size_t one = encoded_radiance(image, 1.0f, &reference).size();
  Image noise(512, 512, 1);
  for (std::size_t i = 0; i < noise.pixels.size(); ++i) {
    noise.pixels[i] = std::clamp(image.pixels[3 * i], 0.0f, 1.0f);
  }
  EXPECT_LT(11 * (one + encoded_map(noise).size()), kReportImageBytes);
}

TEST(CommandLine, IsQuotedForAShell) {
  EXPECT_EQ(shell_line({"lockstep", "rcs:c=4,t=0.02", "a b", "it's", "", "$(x)"}),
            "lockstep rcs:c=4,t=0.02 'a b' 'it'\\''s' '' '$(x)'");
  EXPECT_NE(own_command_line().find("test_experiments"), std::string::npos);
}

TEST(Figures, HaveScriptsDataAndPdf) {
  const TemporaryFolder folder;
  const Comparison comparison = made_comparison(folder.path, 24, 16);
  const std::string said = write_figures(summarize(comparison), folder.path.string());
  const fs::path figures = folder.path / "figures";
  const std::string label = "made___script__b_up__b_";
  const std::string data = text_of(figures / (label + "-errors.dat"));
  EXPECT_TRUE(data.starts_with("# spp cpu_seconds rmse rmse_p5 rmse_p95 relmse ")) << data;
  EXPECT_NE(data.find("\n16 17.6 0.0588235294 0.0588235294 0.0588235294"), std::string::npos)
      << data;
  const std::string script = text_of(figures / (label + "-error-time.gp"));
  EXPECT_NE(script.find("title 'random'"), std::string::npos);
  EXPECT_NE(script.find("set output '" + label + "-error-time-flip_ldr.'.format"),
            std::string::npos);
  if (said.find("not installed") != std::string::npos) GTEST_SKIP() << "no gnuplot here";
  for (const char* figure : {"-error-time-flip_ldr.pdf", "-error-spp-rmse.pdf", "-spectrum.pdf"}) {
    EXPECT_TRUE(text_of(figures / (label + figure)).starts_with("%PDF")) << figure << ": " << said;
  }
}

}  // namespace
}  // namespace lockstep::test_report
