// Traversal modes decide how fast rays are traced, never what they hit: every mode gives the image
// of single rays, to the bit, and so does choosing among them by measurement.
#include "core/error.h"
#include "packets/pass.h"
#include "tests/t_scenes.h"

#include <gtest/gtest.h>

namespace lockstep::test_traversal {
namespace {

constexpr TraversalMode single_rays{Packets::Single, false};

// All modes but single rays with the flag, which are single rays.
std::vector<TraversalMode> distinct_modes() {
  std::vector<TraversalMode> modes;
  for (int i = 0; i < traversal_modes; ++i) {
    if (traversal_mode(i) != TraversalMode{Packets::Single, true})
      modes.push_back(traversal_mode(i));
  }
  return modes;
}

std::string mode_name(std::optional<TraversalMode> mode) {
  return mode ? to_string(*mode) : "auto";
}

// No multiples of a packet: the last one of a queue is partly empty.
SceneDescription small(const char* name) { return resized(read_scene(name), 37, 23); }

// Two sheets that overlap in one tilted plane, in different colours, and a box on both, whose base
// lies in that plane too, under a sky.
SceneDescription sheets_on_each_other() {
  SceneDescription d;
  d.name = "sheets";
  d.film.width = 48, d.film.height = 32;
  d.environment = glm::vec3(1.0f);
  const int red = builtin::add_material(d, DiffuseMaterial{glm::vec3(0.8f, 0.1f, 0.1f)});
  const int blue = builtin::add_material(d, DiffuseMaterial{glm::vec3(0.1f, 0.1f, 0.8f)});
  const int white = builtin::add_material(d, DiffuseMaterial{glm::vec3(0.7f, 0.7f, 0.7f)});
  builtin::add_rectangle(d, {0, 0, 0}, {0, 0, 2}, {2, 0, 0}, red);
  builtin::add_rectangle(d, {0.3f, 0, 0.2f}, {0, 0, 1.7f}, {2, 0, 0}, blue);
  builtin::add_box(d, {0.4f, 0, 0.3f}, {0.7f, 0.9f, 0.6f}, 20, white);
  glm::mat4 tilt(1.0f);
  tilt[0] = glm::vec4(0.96f, 0.28f, 0.0f, 0.0f), tilt[1] = glm::vec4(-0.28f, 0.96f, 0.0f, 0.0f);
  for (Shape& shape : d.shapes) apply_transform(std::get<TriangleMesh>(shape.geometry), tilt);
  d.camera.camera_to_world = builtin::look_at({1, 3, 5}, {0.2f, 0.1f, 0.1f});
  d.camera.fov_degrees = 40.0f;
  return d;
}

RenderSettings settings_of(Isa isa, int spp) {
  RenderSettings s;
  s.seed = 5;
  s.spp = spp;
  s.depth = 3;
  s.threads = 2;
  s.isa = isa;
  return s;
}

void expect_same_in_every_mode(const SceneDescription& description, int spp) {
  for (const Isa isa : available_isas()) {
    const Scene scene = build(description, isa);
    RenderSettings s = settings_of(isa, spp);
    for (const char* sampler : {"owen", "cpt", "rcs:weight=0.125"}) {
      const SamplerSpec spec = parse_sampler(sampler);
      s.traversal = single_rays;
      const RenderResult expected = render(scene, spec, s);
      std::vector<std::optional<TraversalMode>> modes{std::nullopt};
      for (const TraversalMode mode : distinct_modes()) modes.emplace_back(mode);
      for (const auto& mode : modes) {
        s.traversal = mode;
        const RenderResult result = render(scene, spec, s);
        EXPECT_TRUE(same_bytes(result.image, expected.image))
            << description.name << ' ' << name(isa) << ' ' << sampler << ' ' << mode_name(mode);
        EXPECT_EQ(result.stats.rays.bounce, expected.stats.rays.bounce);
        EXPECT_EQ(result.stats.rays.shadow, expected.stats.rays.shadow);
      }
    }
  }
}

TEST(TraversalModes, GiveOneImageOfCornell) { expect_same_in_every_mode(small("cornell"), 9); }
TEST(TraversalModes, GiveOneImageOfReef) { expect_same_in_every_mode(small("reef"), 3); }
TEST(TraversalModes, GiveOneImageOfMeadow) { expect_same_in_every_mode(small("meadow"), 3); }
TEST(TraversalModes, GiveOneImageOfSpheres) { expect_same_in_every_mode(small("spheres"), 9); }
TEST(TraversalModes, GiveOneImageOfSheetsOnEachOther) {
  expect_same_in_every_mode(sheets_on_each_other(), 9);
}

TEST(TraversalModes, GiveOneImageWithFastIntersection) {
  for (SceneDescription description : {small("cornell"), small("reef"), sheets_on_each_other()}) {
    description.robust_intersection = false;
    expect_same_in_every_mode(description, 3);
  }
}

// An image of scene data that no Scene holds.
Image image_of(const SceneData& data, Isa isa, TraversalMode mode) {
  Workers workers(TraversalPolicy(mode, 0), LayoutPolicy(LaneLayout{}));
  const SamplerState sampler;
  Pass pass;
  pass.kernel = &find_kernel(isa, 0), pass.scene = &data, pass.sampler = &sampler;
  pass.workers = &workers;
  pass.path.depth = 1;
  Film film(data.camera.width, data.camera.height);
  PassTotals totals;
  EXPECT_TRUE(run_pass(pass, film, totals, [](double) { return true; }));
  return mean(film);
}

// Guards the test of the sheets: without the list of what overlaps, modes do differ there.
TEST(TraversalModes, WouldDisagreeOnSheetsOnEachOther) {
  int differing = 0;
  for (const Isa isa : available_isas()) {
    const Scene scene = build(sheets_on_each_other(), isa);
    ASSERT_TRUE(scene.data().coincident);
    SceneData unaware = scene.data();
    unaware.coincident = nullptr;
    const Image expected = image_of(scene.data(), isa, single_rays);
    EXPECT_TRUE(same_bytes(image_of(unaware, isa, single_rays), expected));
    for (const TraversalMode mode : distinct_modes()) {
      EXPECT_TRUE(same_bytes(image_of(scene.data(), isa, mode), expected)) << to_string(mode);
      differing += !same_bytes(image_of(unaware, isa, mode), expected);
    }
  }
  EXPECT_GT(differing, 0);
}

// The measuring policy really tries them all: on small images it had no time to.
TEST(TraversalModes, AreAllTriedByThePolicy) {
  const Scene scene = build(resized(builtin::make_cornell(), 128, 128));
  RenderSettings s = settings_of(choose_isa(), 32);
  s.threads = 1;
  const SamplerSpec owen = parse_sampler("owen");
  const RenderResult measured = render(scene, owen, s);
  for (const TraversalMode mode : distinct_modes()) {
    std::uint64_t rays = 0;
    for (const auto& kind : measured.stats.traced) rays += kind[index(mode)];
    EXPECT_GT(rays, 0u) << to_string(mode);
  }
  s.traversal = single_rays;
  EXPECT_TRUE(same_bytes(measured.image, render(scene, owen, s).image));
}

// Names ----------------------------------------------------------------------------------------

TEST(TraversalNames, AreReadBack) {
  for (const TraversalMode mode : distinct_modes()) {
    EXPECT_EQ(parse_traversal(to_string(mode)), mode) << to_string(mode);
    EXPECT_EQ(traversal_mode(index(mode)), mode);
  }
  EXPECT_EQ(parse_traversal("auto"), std::nullopt);
  EXPECT_EQ(parse_traversal("packet16-coherent"), (TraversalMode{Packets::Sixteen, true}));
}

TEST(TraversalNames, OthersAreRefused) {
  for (const char* text :
       {"", "packet", "packet2", "Packet8", "packet8-", "packet8-coherent-coherent", "-coherent",
        "auto-coherent", "single-coherent", "packet8 ", "stream"}) {
    EXPECT_THROW(parse_traversal(text), UsageError) << text;
  }
}

}  // namespace
}  // namespace lockstep::test_traversal
