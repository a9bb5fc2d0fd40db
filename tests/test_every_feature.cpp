// A scene with every feature at once: the same bytes for every width, thread count, lane layout and
// way through Embree.
#include "packets/kernel.h"
#include "tests/t_images.h"
#include "tests/t_measured.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace lockstep::test_every_feature {
namespace {

using builtin::add_material;
using builtin::add_rectangle;
using builtin::add_sphere;

class EveryFeature : public TestWithImages {
 protected:
  static glm::vec3 waves(int x, int y) {
    return {0.5f + 0.5f * std::sin(float(x)), 0.5f + 0.4f * std::cos(float(x + 2 * y)),
            0.3f + 0.2f * std::sin(float(3 * y))};
  }

  struct Textures {
    int image, fine, checks, product, blend, normals;
  };
  Textures add_textures(SceneDescription& d) const {
    ImageTexture image = texture_of(exr("waves", 9, 7, waves), TextureFilter::Bilinear);
    image.wrap_u = TextureWrap::Mirror;
    image.uv.u_row = {1.7f, 0.3f};
    Textures t{};
    t.image = add_texture(d, image);
    image.filter = TextureFilter::Trilinear;
    image.uv.u_row *= 15.0f;
    image.uv.v_row *= 12.0f;
    t.fine = add_texture(d, image);
    CheckerboardTexture checks;
    checks.even = textured(t.image);
    checks.odd = glm::vec3(0.2f, 0.7f, 0.5f);
    checks.uv.u_row = {5.0f, 0.0f};
    checks.uv.v_row = {0.0f, 3.0f};
    t.checks = add_texture(d, checks);
    t.product = add_texture(d, ProductTexture{textured(t.fine), glm::vec3(0.9f, 0.8f, 0.7f)});
    t.blend = add_texture(d, MixTexture{textured(t.checks), textured(t.product), 0.3f});
    t.normals = add_texture(d, texture_of(exr("normals", 5, 5, [](int x, int y) {
                              return 0.5f + 0.5f * glm::normalize(glm::vec3(x - 2, 2 - y, 4));
                            })));
    return t;
  }

  static std::vector<Material> diffuse_materials(const Textures& t) {
    Material bumpy = DiffuseMaterial{textured(t.checks)};
    bumpy.bump = textured_number(t.fine, 0.02f);
    Material mapped = DiffuseMaterial{textured(t.blend)};
    mapped.normal_map = t.normals;
    mapped.normal_scale = 0.8f;
    Material rough = DiffuseMaterial{textured(t.product), textured_number(t.image, 40.0f)};
    Material one_sided = DiffuseMaterial{glm::vec3(0.7f)};
    one_sided.two_sided = false;
    Material lace = DiffuseMaterial{textured(t.image)};
    lace.opacity = textured_number(t.blend);
    Material cut = DiffuseTransmissionMaterial{textured(t.checks, glm::vec3(0.5f)),
                                               textured(t.image, glm::vec3(0.5f))};
    cut.opacity = textured_number(t.image);
    cut.opacity_cutoff = 0.4f;
    return {bumpy,
            mapped,
            rough,
            one_sided,
            lace,
            cut,
            DiffuseTransmissionMaterial{glm::vec3(0.3f), glm::vec3(0.6f)}};
  }

  static std::vector<Material> glossy_materials(const Textures& t) {
    DielectricMaterial glass, frosted, sheet;
    glass.absorption = {0.5f, 0.1f, 1.0f};
    frosted.alpha = {0.1f, 0.4f};
    frosted.alpha_scale = textured_number(t.image);
    frosted.eta = 1.33f;
    frosted.absorption = {0.0f, 0.3f, 0.2f};
    sheet.thin = true;
    sheet.transmittance = textured(t.blend);
    ConductorMaterial brushed, mirror;
    brushed.alpha = {0.05f, 0.3f};
    brushed.specular = textured(t.checks);
    mirror.alpha = glm::vec2(0.0f);
    CoatedMaterial coated;
    coated.diffuse = textured(t.blend);
    coated.alpha_scale = textured_number(t.image);
    PrincipledMaterial plastic, clear;
    plastic.base_color = textured(t.image);
    plastic.metallic = textured_number(t.checks);
    plastic.alpha = textured_number(t.image, 0.5f);
    plastic.coat = 0.5f;
    clear.transmission = textured_number(t.checks, 0.9f);
    clear.alpha = 0.05f;
    Material dented = brushed;
    dented.normal_map = t.normals;
    return {glass, frosted, sheet, dented, mirror, coated, plastic, clear, MeasuredMaterial{1}};
  }

  // A black table, and one with a highlight.
  static void add_tables(SceneDescription& d) {
    const auto glossy = [](glm::vec3 wo, glm::vec3 wi) {
      const float h = glm::normalize(wo + wi).z;
      return glm::vec3(0.1f, 0.2f, 0.1f) + 0.4f * std::pow(h, 40.0f);
    };
    const auto black = [](glm::vec3, glm::vec3) { return glm::vec3(0.0f); };
    d.measured = {make_measured_table(cells_of(black), "black"),
                  make_measured_table(cells_of(glossy), "glossy")};
  }

  // Of the materials before: glass with metal, and that with diffuse ones.
  static void add_mixes(SceneDescription& d, const Textures& t) {
    const int n = int(d.materials.size());
    add_material(d, MixMaterial{n - 9, n - 6, textured_number(t.fine)});
    add_material(d, MixMaterial{n, 0, 0.4f});
  }

  static void add_objects(SceneDescription& d) {
    const TriangleMesh ball = builtin::icosphere(2);
    for (int i = 0; i < int(d.materials.size()); ++i) {
      const glm::vec3 at(float(i % 6) - 2.5f, 0.55f + float(i / 6), 0.4f * float(i % 3));
      if (i % 3 == 0) {
        TriangleMesh mesh = ball;
        if (i % 2) builtin::displace(mesh, [](glm::vec3 p) { return 1.0f + 0.1f * p.x; });
        builtin::place(mesh, at, glm::vec3(0.45f), 10.0f * float(i));
        builtin::add_mesh(d, std::move(mesh), i);
      } else if (i % 3 == 1) {
        add_sphere(d, at, 0.45f, i);
      } else {
        add_rectangle(d, at, {0.4f, 0, 0.2f}, {0, 0.4f, 0}, i);
        set_uvs(d, d.shapes.size() - 1);
      }
    }
  }

  // A glass ball and a lattice, squeezed and mirrored.
  static void add_instances(SceneDescription& d) {
    ObjectDescription object;
    object.shapes = {d.shapes[4], d.shapes[7]};
    d.objects.push_back(std::move(object));
    for (const float side : {1.0f, -1.0f}) {
      const glm::vec3 at(1.3f * side, 0.1f * side, 2.0f);
      d.instances.push_back(
          {0, glm::scale(glm::translate(glm::mat4(1.0f), at), {side, 0.5f, 0.8f})});
    }
  }

  static void add_lights(SceneDescription& d, const Textures& t) {
    const int black = add_material(d, DiffuseMaterial{glm::vec3(0.0f)});
    add_rectangle(d, {-1, 5, 0}, {1, 0, 0}, {0, 0, 1}, black, Emission{glm::vec3(4.0f)});
    add_rectangle(d, {2, 5, 0}, {1, 0, 0}, {0, 0, 1}, black,
                  Emission{textured(t.blend, glm::vec3(6.0f)), true});
    add_sphere(d, {-3, 3, 1}, 0.3f, black, Emission{glm::vec3(8.0f, 6.0f, 4.0f)});
    add_sphere(d, {3, 3, 1}, 0.3f, black, Emission{textured(t.image, glm::vec3(9.0f))});
    TriangleMesh triangle;
    triangle.positions = {{-1, 4, 2}, {1, 4, 2}, {0, 4, 3}};
    triangle.triangles = {{0, 1, 2}};
    builtin::add_mesh(d, triangle, black);
    d.shapes.back().emission = Emission{glm::vec3(5.0f)};
    d.shapes.push_back(Shape{Disk{{-2, 4, 3}, {0, -1, 0}, 0.4f}, black, Emission{glm::vec3(5.0f)}});
    SpotLight spot{{0, 4, 4}, glm::normalize(glm::vec3(0, -1, -1)), glm::vec3(20.0f), 0.95f, 0.8f};
    d.lights = {PointLight{{0.2f, 3.5f, 1.5f}, glm::vec3(3.0f)}, spot,
                DistantLight{glm::normalize(glm::vec3(1, -2, -1)), glm::vec3(0.7f)}};
  }

  SceneDescription description(bool map_and_lens) const {
    SceneDescription d;
    d.name = "every feature";
    const Textures t = add_textures(d);
    for (const Material& m : diffuse_materials(t)) add_material(d, m);
    for (const Material& m : glossy_materials(t)) add_material(d, m);
    add_tables(d);
    add_mixes(d, t);
    add_objects(d);
    add_instances(d);
    add_rectangle(d, {0, 0, 0}, {0, 0, 6}, {6, 0, 0}, 0);
    set_uvs(d, d.shapes.size() - 1);
    add_lights(d, t);
    d.environment = glm::vec3(0.3f, 0.4f, 0.5f);
    d.film.filter.kind = PixelFilter::Kind::Mitchell;
    d.film.filter.radius = glm::vec2(1.5f);
    look_straight(d, {0, 3, 8}, {0, 1.2f, 0}, 4.5f, 23, 17);
    d.compensate_microfacets = map_and_lens;
    if (map_and_lens) {
      d.camera.projection = CameraDescription::Projection::Perspective;
      d.camera.fov_degrees = 33.0f;
      d.camera.lens_radius = 0.1f;
      d.camera.focal_distance = 7.0f;
      d.environment->mapping = Environment::Mapping::LatLong;
      d.environment->file = exr("sky", 16, 8, waves);
    }
    return d;
  }

  // What a render of these bytes must repeat.
  struct Rendered {
    Image image;
    RayCounts rays;
  };
  static Rendered run(const Scene& scene, const SamplerSpec& sampler, const RenderSettings& s) {
    RenderResult r = render(scene, sampler, s);
    EXPECT_EQ(r.stats.nonfinite, 0u);
    return {std::move(r.image), r.stats.rays};
  }
  static void expect_same(const Rendered& a, const Rendered& b, const std::string& what) {
    EXPECT_TRUE(same_bytes(a.image, b.image)) << what;
    EXPECT_EQ(a.rays.bounce, b.rays.bounce) << what;
    EXPECT_EQ(a.rays.shadow, b.rays.shadow) << what;
  }

  static RenderSettings settings(Isa isa) {
    RenderSettings s = settings_of({.spp = 5, .depth = 8}, 5);
    s.roulette_depth = 3;
    s.isa = isa;
    s.width = 1;
    return s;
  }

  // With all the sets of features that exclude each other.
  template <class F>
  void for_each_scene(F f) const {
    for (const Isa isa : available_isas()) {
      for (const bool map_and_lens : {false, true}) {
        const Scene scene = build(description(map_and_lens), isa);
        for (const char* sampler : {"owen", "strata", "rcs"}) {
          f(scene, parse_sampler(sampler), settings(isa),
            std::string(name(isa)) + ' ' + sampler + (map_and_lens ? " map" : " constant"));
        }
      }
    }
  }
};

TEST_F(EveryFeature, IsInTheScene) {
  using enum Feature;
  const FeatureMask map = build(description(true)).features();
  const FeatureMask constant = build(description(false)).features();
  EXPECT_EQ(feature_names(all_features & ~map),
            feature_names(feature_set(Environment, Orthographic)));
  EXPECT_EQ(feature_names(all_features & ~constant),
            feature_names(feature_set(EnvironmentMap, Lens, Compensation)));
}

TEST_F(EveryFeature, GivesTheSameBytesForEveryWidthLayoutAndThreadCount) {
  for_each_scene([](const Scene& scene, const SamplerSpec& sampler, RenderSettings s,
                    const std::string& what) {
    const Rendered expected = run(scene, sampler, s);
    EXPECT_GT(mean_of(expected.image), 0.05) << "black images say little";
    int n = 0;
    for (const int width : {1, 4, 8, 16}) {
      for (const char* layout : {"4x4x1", "1x1x16", "8x2x1", "2x2x4"}) {
        s.width = width;
        s.threads = 1 + n++ % 3;
        s.lanes = parse_lane_layout(layout);
        expect_same(run(scene, sampler, s), expected,
                    what + " width " + std::to_string(width) + " lanes " + layout);
      }
    }
    s.specialized = false;
    expect_same(run(scene, sampler, s), expected, what + " general");
  });
}

TEST_F(EveryFeature, GivesTheSameBytesForEveryTraversalMode) {
  for_each_scene([](const Scene& scene, const SamplerSpec& sampler, RenderSettings s,
                    const std::string& what) {
    s.width = 0;
    s.traversal = traversal_mode(0);
    const Rendered expected = run(scene, sampler, s);
    for (int mode = 1; mode < traversal_modes; ++mode) {
      s.traversal = traversal_mode(mode);
      expect_same(run(scene, sampler, s), expected, what + ' ' + to_string(*s.traversal));
    }
  });
}

// Materials that specialised kernels know, with the new features around them taken away one by one:
// each scene runs on the smallest kernel that has it, and as on the general one.
TEST_F(EveryFeature, TakenAwayOneByOneGivesTheBytesOfTheGeneralKernel) {
  SceneDescription d = description(false);
  const auto compare = [&](const char* what) {
    const Scene scene = build(d);
    RenderSettings s = settings(choose_isa());
    s.width = 0;
    const Rendered special = run(scene, parse_sampler("owen"), s);
    s.specialized = false;
    expect_same(special, run(scene, parse_sampler("owen"), s), what);
    return find_kernel(choose_isa(), 0, scene.features()).features;
  };
  EXPECT_EQ(compare("all"), all_features);
  d.lights.clear();
  d.environment.reset();
  d.camera.projection = CameraDescription::Projection::Perspective;
  d.camera.fov_degrees = 33.0f;
  d.instances.clear();
  d.objects.clear();
  std::erase_if(d.shapes,
                [](const Shape& s) { return std::holds_alternative<Sphere>(s.geometry); });
  std::erase_if(d.shapes, [](const Shape& s) {
    return s.emission && (s.emission->two_sided || s.emission->radiance.value.x == 5.0f);
  });
  d.film.filter.kind = PixelFilter::Kind::Gaussian;
  EXPECT_EQ(compare("quad light"), all_features);
  for (Material& m : d.materials) {
    const MaterialModel model = m.model;
    m = std::holds_alternative<ConductorMaterial>(model) ? Material(ConductorMaterial{})
        : std::holds_alternative<CoatedMaterial>(model)  ? Material(CoatedMaterial{})
                                                         : Material(DiffuseMaterial{});
  }
  EXPECT_NE(compare("plain materials"), all_features);
}

}  // namespace
}  // namespace lockstep::test_every_feature
