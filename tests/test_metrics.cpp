// Metrics against values worked out by hand.
#include "core/error.h"
#include "experiments/metrics/metrics.h"
#include "experiments/metrics/squared_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lockstep::test_metrics {
namespace {

Image constant(int width, int height, float value) {
  Image image(width, height, 3);
  for (float& v : image.pixels) v = value;
  return image;
}

TEST(Metrics, RmseIsTheRootOfTheMeanSquare) {
  const Image reference = constant(2, 1, 1.0f);
  Image test = reference;
  test.at(0, 0)[0] = 4.0f;  // one of six values is off by 3: sqrt(9 / 6)
  EXPECT_NEAR(rmse(reference, test), std::sqrt(1.5), 1e-12);
}

TEST(Metrics, RelmseDividesByTheReference) {
  Image reference = constant(2, 1, 0.0f);
  for (int c = 0; c < 3; ++c) reference.at(1, 0)[c] = 2.0f;
  Image test = reference;
  test.at(0, 0)[1] = 0.1f;  // 0.01 / (0 + 0.01) = 1
  test.at(1, 0)[2] = 4.0f;  // 4 / (4 + 0.01)
  EXPECT_NEAR(relmse(reference, test), (1.0 + 4.0 / 4.01) / 6.0, 1e-7);
}

TEST(Metrics, TrimmingLeavesOutOnePixelInAThousand) {
  const Image reference = constant(50, 40, 0.0f);  // 2000 pixels: two are left out
  Image test = constant(50, 40, 0.1f);             // relMSE 1 everywhere
  test.at(3, 3)[0] = 100.0f;
  test.at(7, 9)[1] = 50.0f;
  EXPECT_NEAR(relmse_trimmed(reference, test), 1.0, 1e-6);
  EXPECT_GT(relmse(reference, test), 10.0);
}

TEST(Metrics, TrimmingASmallImageLeavesOutNothing) {
  const Image reference = constant(3, 3, 0.5f);
  Image test = reference;
  test.at(0, 0)[0] = 9.0f;
  EXPECT_DOUBLE_EQ(relmse_trimmed(reference, test), relmse(reference, test));
}

TEST(Metrics, EqualImagesHaveNoError) {
  const Image image = constant(4, 4, 0.3f);
  const std::vector<double> values = evaluate_metrics(image, image);
  ASSERT_EQ(values.size(), metrics().size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(values[i], metrics()[i].lower_is_better ? 0.0 : 1.0) << metrics()[i].name;
  }
}

TEST(Metrics, TableHasTheKeysThatScriptsReadInOrder) {
  const std::vector<std::string_view> keys = {
      "rmse",     "relmse", "relmse_trimmed", "yee_pixels", "yee_share",    "flip_ldr",
      "flip_hdr", "mse",    "smape",          "ssim",       "low_pass_rmse"};
  ASSERT_EQ(metrics().size(), keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) EXPECT_EQ(metrics()[i].name, keys[i]);
}

TEST(Metrics, MapsHoldWhatValuesSum) {
  const Image reference = constant(20, 10, 0.3f);
  Image test = reference;
  for (int c = 0; c < 3; ++c) test.at(12, 4)[c] = 5.0f;
  const Evaluation evaluation = evaluate(reference, test);
  const auto value = [&](std::string_view name) {
    for (std::size_t i = 0; i < metrics().size(); ++i) {
      if (metrics()[i].name == name) return evaluation.values[i];
    }
    return -1.0;
  };
  EXPECT_EQ(value("flip_ldr"), mean_of_map(evaluation.flip_ldr));
  EXPECT_EQ(value("flip_hdr"), mean_of_map(evaluation.flip_hdr.map));
  EXPECT_NEAR(value("yee_share"), mean_of_map(evaluation.yee_failing), 1e-12);
  EXPECT_EQ(value("yee_pixels"), 200.0 * value("yee_share"));
  EXPECT_GT(value("flip_ldr"), 0.0);
  EXPECT_GT(value("yee_pixels"), 0.0);
  EXPECT_LT(value("ssim"), 1.0);
}

TEST(Metrics, APreparedReferenceChangesNothing) {
  const Image reference = constant(40, 30, 0.3f);
  const PreparedReference prepared = prepare_reference(reference);
  for (const float brightest : {0.2f, 0.4f, 7.0f}) {
    Image test = reference;
    for (int c = 0; c < 3; ++c) test.at(12, 4)[c] = brightest;
    EXPECT_EQ(evaluate(prepared, test).values, evaluate_metrics(reference, test));
  }
}

TEST(Metrics, OtherThanThreeChannelsAreRefused) {
  const Image weights(4, 2, 1);
  try {
    evaluate_metrics(weights, weights, "a.exr", "b.exr");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("a.exr: 1 channels"), std::string::npos);
  }
}

TEST(Metrics, DifferentSizesAreNamed) {
  try {
    evaluate_metrics(constant(4, 2, 0.0f), constant(3, 2, 0.0f), "a.exr", "b.exr");
    FAIL() << "no error";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("a.exr is 4x2"), std::string::npos) << message;
    EXPECT_NE(message.find("b.exr is 3x2"), std::string::npos) << message;
  }
}

TEST(Metrics, ValuesThatAreNotFiniteAreLocated) {
  Image test = constant(4, 2, 0.0f);
  test.at(3, 1)[2] = std::numeric_limits<float>::quiet_NaN();
  try {
    evaluate_metrics(constant(4, 2, 0.0f), test, "a.exr", "b.exr");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("b.exr: pixel (3, 1)"), std::string::npos);
  }
}

TEST(Metrics, NamesThatAreTakenOrNoColumnAreNotAdded) {
  const std::size_t count = metrics().size();
  for (const char* name : {"rmse", "yee_share", "", "a,b", "A", "a b", "a\"b"}) {
    EXPECT_THROW(add_metric({name, "", ""}, rmse), Error) << name;
  }
  EXPECT_EQ(metrics().size(), count);
}

}  // namespace
}  // namespace lockstep::test_metrics
