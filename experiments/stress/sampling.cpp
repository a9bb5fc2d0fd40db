// Random numbers, weights, pilots, sums and image sizes at their ends.
#include "core/bsdf.h"
#include "core/bsdf/dielectric.h"
#include "core/bsdf/diffuse_transmission.h"
#include "core/bsdf/metal.h"
#include "core/bsdf/oren_nayar.h"
#include "core/bsdf/principled.h"
#include "core/hash.h"
#include "core/light.h"
#include "core/scene.h"
#include "experiments/stress/parts.h"
#include "packets/pass.h"
#include "packets/paths.h"
#include "samplers/make_state.h"
#include "samplers/weight_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace lockstep::stress {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kCorners[] = {0.0f, 0x1p-32f, 0x1p-24f, 0.25f, 0.5f, 0.75f, one_minus_epsilon};

// How many checks failed; right where none did.
StressFinding failures(std::uint64_t count) { return {.got = double(count)}; }

StressCase computation(std::string name, std::string extreme, std::string argument,
                       std::function<StressFinding(const StressSetting&)> run,
                       bool every_width = false, bool every_sampler = false) {
  return {std::move(name), "sampling", std::move(extreme), std::move(argument),
          StressComputation{std::move(run), every_width, every_sampler}};
}

// Values of samplers ----------------------------------------------------------------------------

// A batch of one tile's pixels at samples [first, first + 4), and what the sampler makes of it.
struct Drawn {
  std::vector<float> u, v;
};

Drawn draw(const SamplerState& state, int width, std::uint32_t first, int pair) {
  constexpr int pixels = 61, samples = 4, count = pixels * samples;
  std::vector<std::uint32_t> pixel(count + 16, 0), sample(count + 16, first);
  for (int i = 0; i < count; ++i) {
    pixel[std::size_t(i)] = std::uint32_t(i / samples % 16 + i / samples / 16 * state.width);
    sample[std::size_t(i)] = first + std::uint32_t(i % samples);
  }
  Drawn d{std::vector<float>(count + 16), std::vector<float>(count + 16)};
  const SampleBatch batch{pixel.data(), sample.data(), count, first, samples};
  find_kernel(choose_isa(), width).fill_pair(state, batch, pair, d.u.data(), d.v.data());
  d.u.resize(count);
  d.v.resize(count);
  return d;
}

std::uint64_t count_outside_unit(const std::vector<float>& values) {
  return std::uint64_t(std::count_if(values.begin(), values.end(), [](float x) {
    return !(x >= 0.0f && x <= one_minus_epsilon);
  }));
}

// Values outside [0, 1 - 2^-24], or that differ from those of width 1.
std::uint64_t count_bad(const SamplerState& state, int width, std::uint32_t first, int pair) {
  const Drawn d = draw(state, width, first, pair), one = draw(state, 1, first, pair);
  std::uint64_t bad = count_outside_unit(d.u) + count_outside_unit(d.v);
  for (std::size_t i = 0; i < d.u.size(); ++i) bad += d.u[i] != one.u[i] || d.v[i] != one.v[i];
  return bad;
}

StressFinding large_indices(const StressSetting& s) {
  std::uint64_t bad = 0;
  const SamplerState state = make_state(s.sampler, 7, {16, 16, 64});
  for (const std::uint32_t first : {0u, 0x00fffffeu, 0x7ffffffeu, 0xfffffffcu}) {
    for (const int pair : {0, 1, 3, 777, max_pairs - 1}) {
      bad += count_bad(state, s.width, first, pair);
    }
  }
  return failures(bad);
}

StressFinding odd_weights(const StressSetting& s) {
  std::uint64_t bad = 0;
  SamplerState state = make_state(parse_sampler("rcs"), 7, {16, 16, 64});
  const float weights[] = {0.0f, 1e-45f, 1e-38f, 1e-7f, one_minus_epsilon, 1.0f,
                           1.5f, 1e30f,  -1.0f,  kNan,  kInfinity,         -kInfinity};
  std::vector<float> map(256);
  for (std::size_t i = 0; i < map.size(); ++i) map[i] = weights[i % std::size(weights)];
  state.weights = map.data();
  for (const Mix mix : {Mix::Add, Mix::Xor}) {
    state.mix = mix;
    for (const int pair : {0, 1, 3}) bad += count_bad(state, s.width, 0, pair);
  }
  return failures(bad);
}

// Maps and models -------------------------------------------------------------------------------

bool is_good(float x) { return is_finite(x) && x >= 0.0f; }
bool is_unit(const Vec3<float>& w) { return std::abs(length(w) - 1.0f) < 1e-5f; }

StressFinding maps_of_the_square(const StressSetting&) {
  std::uint64_t bad = 0;
  for (const float x : kCorners) {
    for (const float y : kCorners) {
      const Vec2<float> u(x, y), disk = concentric_disk(u), triangle = uniform_triangle(u);
      bad += !(disk.x * disk.x + disk.y * disk.y <= 1.00001f);
      bad += !(triangle.x >= 0.0f && triangle.y >= 0.0f && triangle.x + triangle.y <= 1.0f);
      const Vec3<float> hemisphere = cosine_hemisphere(u);
      bad += !is_unit(hemisphere) || hemisphere.z < 0.0f;
      bad += !is_unit(uniform_sphere(u));
      for (const float cone : {1e-30f, 1e-14f, 1e-7f, 0.5f, 2.0f}) {
        const Vec3<float> w = uniform_cone(u, cone);
        bad += !is_unit(w) || !(1.0f - w.z <= cone + 0x1p-23f) || !is_good(uniform_cone_pdf(cone));
      }
    }
  }
  return failures(bad);
}

// f cos and densities finite and not negative, and unit directions, from grazing to face on.
template <class Bsdf>
std::uint64_t count_bad_samples(const Bsdf& bsdf) {
  std::uint64_t bad = 0;
  for (const float cos_o : {1e-6f, 1e-4f, 0.01f, 0.5f, 1.0f}) {
    const Vec3<float> wo(std::sqrt(1.0f - cos_o * cos_o), 0.0f, cos_o);
    for (const float lobe : kCorners) {
      for (const float x : kCorners) {
        for (const float y : kCorners) {
          const auto s = sample(bsdf, wo, lobe, Vec2<float>(x, y));
          bad += !is_good(s.pdf);
          if (!(s.pdf > 0.0f)) continue;
          bad += !is_unit(s.wi) || !is_good(s.weight.x) || !is_good(s.weight.y);
          const auto v = eval(bsdf, wo, s.wi);
          bad += !is_good(v.pdf) || !is_good(v.f_cos.x);
        }
      }
    }
  }
  return bad;
}

StressFinding models_at_corners(const StressSetting&) {
  const Vec3<float> white(1.0f), black(0.0f);
  std::uint64_t bad = count_bad_samples(DiffuseBsdf<float>{white}) +
                      count_bad_samples(oren_nayar<float>(white, 90.0f)) +
                      count_bad_samples(DiffuseTransmissionBsdf<float>{white, white});
  for (const float alpha : {0.0f, 1e-3f, 0.1f, 1.0f}) {
    const Ggx<float> ggx{Vec2<float>(alpha)}, rough{Vec2<float>(std::max(alpha, smoothest_alpha))};
    bad += count_bad_samples(MetalBsdf<float>{{black, white, ggx}, white, 0.0f});
    bad += count_bad_samples(MetalBsdf<float>{{white * 1e6f, white * 1e6f, ggx}, white, 0.0f});
    for (const float eta : {1.0f, 1.000001f, 1.5f, 100.0f}) {
      const float inside = inner_reflectance(eta);
      bad +=
          count_bad_samples(CoatedBsdf<float>{white, white, rough, eta, 1.0f, inside, 0.0f, 0.0f});
      for (const bool thin : {false, true}) {
        bad += count_bad_samples(DielectricBsdf<float>{white, white, ggx, eta, thin});
      }
      for (const int lobes : {0, 1, 2, 4, 7}) {
        PrincipledBsdf<float> p{white,
                                lobes & 1 ? 1.0f : 0.0f,
                                alpha,
                                eta,
                                1.0f,
                                lobes & 2 ? 1.0f : 0.0f,
                                lobes & 4 ? 1.0f : 0.0f,
                                alpha,
                                false};
        bad += count_bad_samples(p);
      }
    }
  }
  return failures(bad);
}

// One light of each kind over a floor.
SceneDescription all_lights() {
  SceneDescription scene = lit_floor();
  add_lamp(scene, 0.5f, 0.5f, 1.0f, glm::vec3(1.0f));
  const int lamp = black(scene);
  builtin::add_sphere(scene, {1, 1, 0}, 0.3f, lamp, Emission{glm::vec3(1.0f)});
  TriangleMesh triangle;
  triangle.positions = {{2, 1, 0}, {3, 1, 0}, {2, 1, 1}};
  triangle.triangles = {{0, 1, 2}};
  builtin::add_mesh(scene, triangle, lamp);
  scene.shapes.back().emission = Emission{glm::vec3(1.0f)};
  scene.lights = {PointLight{{0, 2, 0}},
                  SpotLight{.position = {0, 2, 1}, .direction = {0, -1, 0}, .cos_outer = 0.9f},
                  DistantLight{{0, -1, 0}}};
  scene.environment = glm::vec3(1.0f);
  return scene;
}

// From points of the floor, of the lights themselves and their rims.
StressFinding lights_at_corners(const StressSetting&) {
  const Scene scene(all_lights(), embree_isa(choose_isa()));
  const SceneData& data = scene.data();
  const Frame<float> frame = frame_around(Vec3<float>(0.0f, 1.0f, 0.0f));
  std::uint64_t bad = 0;
  for (const Vec3<float>& p :
       {Vec3<float>(0.0f), Vec3<float>(0.5f, 1.0f, 0.5f), Vec3<float>(1.0f, 1.3f, 0.0f),
        Vec3<float>(1.0f, 1.0f, 0.0f), Vec3<float>(0.0f, 2.0f, 0.0f), Vec3<float>(1e6f)}) {
    for (const float choice : kCorners) {
      for (const float y : kCorners) {
        const LightChoice<float> chosen = choose_light(data.lights, Vec2<float>(choice, y));
        bad += chosen.index < 0 || chosen.index >= data.lights.count;
        bad += !(chosen.u.x >= 0.0f && chosen.u.x < 1.0f);
      }
      for (std::int32_t i = 0; i < data.lights.count; ++i) {
        for (const float y : kCorners) {
          const auto s = sample_light<float>(data, i, p, frame, Vec2<float>(choice, y));
          bad += !is_good(s.pdf);
          if (!(s.pdf > 0.0f)) continue;
          bad += !is_unit(s.wi) || !is_good(s.radiance.x) || !(s.distance >= 0.0f);
        }
      }
    }
  }
  return failures(bad);
}

// Pilots ----------------------------------------------------------------------------------------

Image flat_pilot(float value) {
  Image pilot(16, 16);
  std::fill(pilot.pixels.begin(), pilot.pixels.end(), value);
  return pilot;
}

Image with_one_pixel(float value) {
  Image pilot = flat_pilot(0.5f);
  std::fill_n(pilot.at(7, 9), 3, value);
  return pilot;
}

// Weights outside [0, 1] or, where `only` holds a value, different from it.
std::uint64_t count_bad_weights(const Image& weights, float only = -1.0f) {
  return std::uint64_t(std::count_if(weights.pixels.begin(), weights.pixels.end(), [&](float w) {
    return !(w >= 0.0f && w <= 1.0f) || (only >= 0.0f && w != only);
  }));
}

StressFinding weights_of_pilot(const Image& pilot, float only) {
  std::uint64_t bad = 0;
  for (const WeightFilter filter :
       {WeightFilter::None, WeightFilter::Gaussian, WeightFilter::Median}) {
    bad += count_bad_weights(make_weights(pilot, {4.0f, 0.02f, filter}), only);
  }
  const Image variance = variance_of_neighbours(pilot);
  bad += count_bad_weights(make_auto_weights(pilot, variance, 1.0), only);
  return failures(bad);
}

std::vector<StressCase> pilots() {
  const auto of = [](const char* name, const char* extreme, const char* argument, Image pilot,
                     float only) {
    return computation(name, extreme, argument,
                       [=](const StressSetting&) { return weights_of_pilot(pilot, only); });
  };
  const auto by_settings = [](const char* name, const char* extreme, const char* argument, float c,
                              float t, float only) {
    return computation(name, extreme, argument, [=](const StressSetting&) {
      Image pilot(16, 16);
      for (std::size_t i = 0; i < pilot.pixels.size(); ++i) pilot.pixels[i] = float(i % 7);
      return failures(count_bad_weights(make_weights(pilot, {c, t, WeightFilter::None}), only));
    });
  };
  constexpr const char* kRange = "every weight lies in [0, 1]";
  return {
      of("pilot-black", "a black pilot", "no difference: weight 0", flat_pilot(0.0f), 0.0f),
      of("pilot-constant", "a constant pilot", "no difference: weight 0", flat_pilot(0.25f), 0.0f),
      of("pilot-hot-pixel", "a pilot with one pixel of 1e30", kRange, with_one_pixel(1e30f), -1.0f),
      of("pilot-nan", "a pilot with one pixel of NaN", kRange, with_one_pixel(kNan), -1.0f),
      of("pilot-infinite", "a pilot with one pixel of infinity", kRange, with_one_pixel(kInfinity),
         -1.0f),
      by_settings("weights-c-0", "c = 0", "weight 0", 0.0f, 0.02f, 0.0f),
      by_settings("weights-c-1e30", "c = 1e30", "every difference gives weight 1", 1e30f, 0.02f,
                  1.0f),
      by_settings("weights-t-0", "t = 0", kRange, 4.0f, 0.0f, -1.0f),
      by_settings("weights-t-infinite", "t = infinity", "no difference reaches it: weight 0", 4.0f,
                  kInfinity, 0.0f),
  };
}

// Renders with weights at their ends. Every pixel of the box has the same expectation.
StressCase rendered_with(const char* name, const char* extreme, const char* sampler,
                         SceneDescription (*make)(), double expected) {
  return {name, "sampling", extreme, "weights change the error, never the mean",
          StressScene{.make = [make](const std::string&) { return make(); },
                      .expected = expected,
                      .spp = 64,
                      .depth = 2,
                      .samplers = {sampler}}};
}

SceneDescription grey_box() { return closed_box(0.7f, 0.6f); }
SceneDescription dark_box() {
  SceneDescription scene = closed_box(0.7f, 0.6f);
  for (Shape& shape : scene.shapes) shape.emission.reset();
  return scene;
}

std::vector<StressCase> renders_with_weights() {
  const double box = partial_sum(0.7, 0.6, 2);
  return {
      rendered_with("render-rcs-c-0", "rcs with c = 0", "rcs:c=0", grey_box, box),
      rendered_with("render-rcs-c-1e30", "rcs with c = 1e30", "rcs:c=1e30", grey_box, box),
      rendered_with("render-rcs-t-0", "rcs with t = 0", "rcs:t=0", grey_box, box),
      rendered_with("render-rcs-t-infinite", "rcs with t = infinity", "rcs:t=inf", grey_box, box),
      rendered_with("render-rcs-all-pilot", "rcs with all samples in the pilot", "rcs:pilot=64",
                    grey_box, box),
      rendered_with("render-rcs-w-1e-7", "w = 1e-7 everywhere", "rcs:weight=1e-7", grey_box, box),
      rendered_with("render-rcs-black-pilot", "rcs with a black pilot", "rcs", dark_box, 0.0),
      rendered_with("render-rcs-auto-black", "automatic weights of a black pilot",
                    "rcs:weight=auto", dark_box, 0.0),
  };
}

// What the command line must not take.
StressFinding refused_sampler(const char* text) {
  StressFinding finding{.expected = 1.0};
  try {
    parse_sampler(text);
  } catch (const std::exception& error) {
    finding.got = 1.0;
    finding.refusal = error.what();
  }
  return finding;
}

std::vector<StressCase> refusals() {
  const auto of = [](const char* name, const char* extreme, const char* text) {
    return computation(name, extreme, "refused in one line",
                       [text](const StressSetting&) { return refused_sampler(text); });
  };
  return {of("weight-above-1", "w = 1.5 on the command line", "rcs:weight=1.5"),
          of("weight-nan", "w = NaN on the command line", "rcs:weight=nan"),
          of("c-negative", "c = -1 on the command line", "rcs:c=-1")};
}

// Sums ------------------------------------------------------------------------------------------

// The mean of 2^26 samples of one pixel, through what ends the paths of a render; `value` gives
// that of path i of a wave, and `first` replaces the first of all.
template <class F>
double mean_of_samples(F value, float first) {
  constexpr int waves = (1 << 26) / wave_paths;
  Film film(1, 1);
  SceneData scene;
  scene.features = 0;
  TileJob job;
  job.scene = &scene;
  job.film = film.view();
  const auto paths = std::make_unique<PathTable>();
  paths->count = wave_paths;
  TileCounts counts;
  for (int wave = 0; wave < waves; ++wave) {
    for (int i = 0; i < wave_paths; ++i) {
      const float x = wave == 0 && i == 0 ? first : value(i);
      for (int c = 0; c < 3; ++c) paths->radiance[4 * i + c] = x;
      paths->radiance[4 * i + 3] = 1.0f;
      paths->pixel[i] = 0;
      paths->sample[i] = std::uint32_t(wave * wave_paths + i);
    }
    end_paths<all_features>(job, *paths, counts);
  }
  return film.sums[0] / film.sums[3];
}

std::vector<StressCase> sums() {
  constexpr double n = 0x1p26;
  constexpr float third = 1.0f / 3.0f, large = 1e8f, small = 1e-8f;
  const double mixed = 0.5 * (double(large) + double(small));
  const auto close_to = [](double expected, double got, double relative) {
    return StressFinding{.expected = expected, .got = got, .tolerance = relative * expected};
  };
  return {
      computation("sum-of-2^26", "67 million samples of 1/3",
                  "every partial sum has at most 50 bits: exact in double",
                  [=](const StressSetting&) {
                    return close_to(double(third),
                                    mean_of_samples([=](int) { return third; }, third), 0.0);
                  }),
      computation("sum-of-2^26-mixed", "67 million samples of 1e8 and 1e-8 in turn",
                  "the exact mean, to 2^26 roundings of double",
                  [=](const StressSetting&) {
                    return close_to(
                        mixed, mean_of_samples([=](int i) { return i % 2 ? small : large; }, large),
                        0x1p26 * 0x1p-53);
                  }),
      computation("firefly-is-kept", "one sample of 1e30 among 67 million of 1",
                  "no sample is clamped: (1e30 + n - 1) / n",
                  [=](const StressSetting&) {
                    return close_to((double(1e30f) + n - 1.0) / n,
                                    mean_of_samples([](int) { return 1.0f; }, 1e30f), 1e-12);
                  }),
      computation("sum-without-nonfinite", "samples of NaN and infinity among those of 2",
                  "they are left out and counted: the mean of the others",
                  [=](const StressSetting&) {
                    return close_to(2.0,
                                    mean_of_samples(
                                        [](int i) {
                                          return i % 5 == 1 ? kNan : i % 5 == 2 ? kInfinity : 2.0f;
                                        },
                                        -kInfinity),
                                    0.0);
                  }),
  };
}

// The last 64 samples that have a number, through the renderer.
StressFinding last_samples(const StressSetting& s) {
  const Scene scene(grey_box(), embree_isa(choose_isa()));
  const SamplerState state = make_state(s.sampler, 3, {16, 16, 64});
  Film film(16, 16);
  film.samples = 0xffffffc0u;
  Workers workers(TraversalPolicy({}, default_width(choose_isa())), LayoutPolicy({}));
  Pass pass;
  pass.kernel = &find_kernel(choose_isa(), s.width, scene.features());
  pass.scene = &scene.data(), pass.sampler = &state, pass.workers = &workers;
  pass.path = {2, 1000};
  pass.samples = 64;
  PassTotals totals;
  run_pass(pass, film, totals, [](double) { return true; });
  double sum = 0.0;
  const Image image = mean(film);
  for (const float x : image.pixels) sum += double(x) / double(image.pixels.size());
  // One seed of a shared sequence of 64 points: far above the error that all five have.
  return {.expected = partial_sum(0.7, 0.6, 2), .got = sum, .tolerance = 0.15};
}

// Image sizes -----------------------------------------------------------------------------------

StressCase image_of_size(int width, int height, const char* extreme) {
  return {fmt::format("image-{}x{}", width, height), "sampling", extreme,
          "closed furnace: L (1 + a + a^2)",
          StressScene{.make =
                          [=](const std::string&) {
                            SceneDescription scene = closed_box(0.7f, 0.2f);
                            scene.film.width = width;
                            scene.film.height = height;
                            return scene;
                          },
                      .expected = partial_sum(0.7, double(0.2f), 2),
                      .spp = width * height > 4096 ? 4 : 64,
                      .depth = 2}};
}

}  // namespace

std::vector<StressCase> sampling_cases() {
  std::vector<StressCase> cases{
      computation("sampler-indices", "samples 0 to 2^32 - 1, pairs 0 to 4095",
                  "values in [0, 1 - 2^-24], the same bits at every width", large_indices, true,
                  true),
      computation("sampler-weights",
                  "w = 0, denormal, 1e-7, 1 - 2^-24, 1, larger, negative, NaN, infinite",
                  "values in [0, 1 - 2^-24], the same bits at every width", odd_weights, true),
      computation("render-last-samples", "samples 2^32 - 64 to 2^32 - 1, rendered",
                  "closed furnace: L (1 + a + a^2), to within what 64 samples err", last_samples,
                  true, true),
      computation("u-at-corners-maps", "u = 0, 2^-32, ..., 1 - 2^-24 to disks, spheres, cones",
                  "points inside, directions of length 1", maps_of_the_square),
      computation("u-at-corners-models", "u = 0, 2^-32, ..., 1 - 2^-24 to all reflection models",
                  "finite weights and densities that are not negative, directions of length 1",
                  models_at_corners),
      computation("u-at-corners-lights", "u = 0, 2^-32, ..., 1 - 2^-24 to all lights",
                  "lights that exist, finite densities, directions of length 1", lights_at_corners),
  };
  for (auto&& group : {pilots(), renders_with_weights(), refusals(), sums()}) {
    cases.insert(cases.end(), group.begin(), group.end());
  }
  cases.push_back(image_of_size(1, 1, "an image of one pixel"));
  cases.push_back(image_of_size(16384, 1, "an image of 16384 x 1 pixels"));
  cases.push_back(image_of_size(13, 7, "an image that packets and tiles do not divide"));
  cases.push_back(image_of_size(17, 33, "an image one pixel wider than tiles"));
  return cases;
}

}  // namespace lockstep::stress
