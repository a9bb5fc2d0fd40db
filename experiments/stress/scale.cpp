// Size, place and shape: what coordinates in float make of a scene.
#include "experiments/stress/parts.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace lockstep::stress {
namespace {

using builtin::add_material;
using builtin::add_rectangle;

constexpr float kRadiance = 5.0f;
constexpr float kBoxEmission = 0.7f, kBoxAlbedo = 0.6f;
constexpr const char* kFurnace = "closed furnace: L (1 + a + ... + a^depth), whatever its shape";

SceneDescription floor_under_lamp() {
  SceneDescription scene = lit_floor();
  add_lamp(scene, 0.5f, 0.5f, 1.0f, glm::vec3(kRadiance));
  return scene;
}
const double kUnderLamp =
    double(kRadiance) * double(floor_albedo) * rectangle_form_factor(0.5, 0.5, 1.0);

std::vector<StressCase> scaled() {
  std::vector<StressCase> cases;
  for (const float scale : {1e-6f, 1e-3f, 1e3f, 1e6f}) {
    cases.push_back({fmt::format("scaled-{:.0e}-lamp", scale), "scale",
                     fmt::format("all lengths times {:.0e}", scale), kFormFactor,
                     StressScene{.make =
                                     [scale](const std::string&) {
                                       SceneDescription scene = floor_under_lamp();
                                       transform(scene, scale, glm::vec3(0.0f));
                                       return scene;
                                     },
                                 .expected = kUnderLamp,
                                 .rounding = 1e-3}});
  }
  for (const float scale : {1e-6f, 1e6f}) {
    cases.push_back({fmt::format("scaled-{:.0e}-box", scale), "scale",
                     fmt::format("all lengths times {:.0e}, three bounces", scale), kFurnace,
                     StressScene{.make =
                                     [scale](const std::string&) {
                                       SceneDescription scene =
                                           closed_box(kBoxEmission, kBoxAlbedo);
                                       transform(scene, scale, glm::vec3(0.0f));
                                       return scene;
                                     },
                                 .expected = partial_sum(0.7, 0.6, 3),
                                 .depth = 3}});
  }
  return cases;
}

// The box's diagonal is 5.4.
std::vector<StressCase> moved() {
  std::vector<StressCase> cases;
  for (const float sizes : {1e3f, 1e5f, 1e7f}) {
    const glm::vec3 move = sizes * 5.4f * glm::normalize(glm::vec3(1.0f, -0.7f, 0.4f));
    cases.push_back({fmt::format("moved-{:.0e}-box", sizes), "scale",
                     fmt::format("a box {:.0e} times its size from the origin", sizes), kFurnace,
                     StressScene{.make =
                                     [move](const std::string&) {
                                       SceneDescription scene =
                                           closed_box(kBoxEmission, kBoxAlbedo);
                                       transform(scene, 1.0f, move);
                                       return scene;
                                     },
                                 .expected = partial_sum(0.7, 0.6, 3),
                                 .rounding = 2e-3,
                                 .depth = 3}});
    const glm::vec3 far = sizes * 11.3f * glm::normalize(glm::vec3(1.0f, -0.7f, 0.4f));
    cases.push_back({fmt::format("moved-{:.0e}-lamp", sizes), "scale",
                     fmt::format("a lamp {:.0e} times the scene's size from the origin", sizes),
                     kFormFactor,
                     StressScene{.make =
                                     [far](const std::string&) {
                                       SceneDescription scene = floor_under_lamp();
                                       transform(scene, 1.0f, far);
                                       return scene;
                                     },
                                 .expected = kUnderLamp,
                                 .rounding = 1e-2}});
  }
  const auto tilted = [](const std::string&) {
    SceneDescription scene = floor_under_lamp();
    turn(scene, glm::mat3(glm::rotate(glm::mat4(1.0f), 0.7f, glm::vec3(0.6f, 0.0f, 0.8f))));
    transform(scene, 1.0f, 1e4f * glm::normalize(glm::vec3(1.0f, -0.7f, 0.4f)));
    return scene;
  };
  cases.push_back({"moved-1e+03-tilted-lamp", "scale",
                   "a tilted lamp a thousand times the scene's size from the origin", kFormFactor,
                   StressScene{.make = tilted, .expected = kUnderLamp, .rounding = 1e-2}});
  return cases;
}

// Two plates face each other; what escapes at their edges is as small as the gap.
StressCase gap(float height) {
  const auto make = [height](const std::string&) {
    SceneDescription scene;
    scene.name = "gap";
    const int wall = grey(scene, 0.5f);
    const Emission light{glm::vec3(1.0f)};
    add_rectangle(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, wall, light);
    add_rectangle(scene, {0, height, 0}, {1, 0, 0}, {0, 0, 1}, wall, light);
    const glm::vec3 eye(0, 0.5f * height, 0);
    scene.camera.camera_to_world = builtin::look_at(eye, eye + glm::vec3(1, -1, 0.3f));
    scene.camera.fov_degrees = 20.0f;
    scene.film.width = scene.film.height = 16;
    return scene;
  };
  return {fmt::format("gap-{:.0e}", height), "scale",
          fmt::format("camera between plates {:.0e} of their size apart", height),
          "the gap is a closed furnace but for a share as small as the gap",
          StressScene{
              .make = make, .expected = partial_sum(1.0, 0.5, 30), .rounding = 5e-3, .depth = 30}};
}

// A floor whose vertex normals lean by `degrees` towards +x, seen from above.
SceneDescription leaning_floor(float degrees) {
  SceneDescription scene;
  scene.name = "leaning normals";
  add_rectangle(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, grey(scene, floor_albedo));
  const float angle = degrees * float(pi_double) / 180.0f;
  auto& mesh = std::get<TriangleMesh>(scene.shapes[0].geometry);
  mesh.normals.assign(mesh.positions.size(), {std::sin(angle), std::cos(angle), 0.0f});
  look_straight(scene, {1.0f, 1.0f, 0.001f}, {0, 0, 0}, 0.5f);
  return scene;
}

glm::vec3 from_horizon(float degrees) {
  const float a = degrees * float(pi_double) / 180.0f;
  return {-std::cos(a), -std::sin(a), 0.0f};  // in which light from +x travels
}

std::vector<StressCase> terminator() {
  const auto under_sky = [](const std::string&) {
    SceneDescription scene = leaning_floor(60.0f);
    scene.environment = glm::vec3(1.0f);
    return scene;
  };
  const auto in_sun = [](float degrees) {
    return [degrees](const std::string&) {
      SceneDescription scene = leaning_floor(60.0f);
      scene.lights = {DistantLight{from_horizon(degrees), glm::vec3(1.0f)}};
      return scene;
    };
  };
  // Shading normal at 30 degrees above +x: light from 5 degrees is 25 degrees off it.
  const double lit = double(floor_albedo) / pi_double * std::cos(25.0 * pi_double / 180.0);
  return {
      {"terminator-sky", "scale", "shading normals 60 degrees off the face, under a sky",
       "both horizons cut the cosine lobe: a (1 + cos 60) / 2",
       StressScene{.make = under_sky, .expected = double(floor_albedo) * 0.75, .spp = 64}},
      {"terminator-grazing-sun", "scale", "sun 5 degrees above the face, normals 60 degrees off it",
       "a / pi times the cosine with the shading normal",
       StressScene{.make = in_sun(5.0f), .expected = lit, .rounding = 1e-3}},
      {"terminator-sun-below", "scale", "sun 5 degrees below the face, above the shading horizon",
       "a face lets no light through: 0",
       StressScene{.make = in_sun(-5.0f), .expected = 0.0, .rounding = 0.0}},
  };
}

// Floors in one plane, one on the other, under a sky of radiance 1.
SceneDescription coincident_floors(const std::vector<float>& albedos) {
  SceneDescription scene;
  scene.name = "coincident floors";
  for (const float a : albedos) {
    add_rectangle(scene, {0, 0, 0}, {0.3f, 0.2f, 1}, {1, -0.1f, 0}, grey(scene, a));
  }
  scene.environment = glm::vec3(1.0f);
  look_straight(scene, {1, 2, 0.5f}, {0, 0, 0}, 0.5f);
  return scene;
}

// Share of pixels that are none of these values, but for rounding.
double share_of_others(const Image& image, std::initializer_list<double> values) {
  int others = 0;
  for (const float x : image.pixels) {
    bool known = false;
    for (const double v : values) known = known || std::abs(double(x) - v) < 1e-4;
    others += !known;
  }
  return double(others) / double(image.pixels.size());
}

std::vector<StressCase> coincident() {
  const auto lamp_in_floor = [](const std::string&) {
    SceneDescription scene = lit_floor(1.0f);
    add_rectangle(scene, {1.5f, 0, 0}, {0, 0, 1}, {0.5f, 0, 0}, black(scene),
                  Emission{glm::vec3(kRadiance)});
    return scene;
  };
  return {
      {"coincident-same", "scale", "three floors of one material in one place",
       "under a sky of radiance 1 a floor shows its albedo; floors below it get nothing",
       StressScene{.make =
                       [](const std::string&) {
                         return coincident_floors({0.5f, 0.5f, 0.5f});
                       },
                   .expected = 0.5,
                   .depth = 4}},
      {"coincident-different", "scale", "a black and a white floor in one place",
       "every sample sees either of them, so no pixel lies outside [0, 1], at any width the same",
       StressScene{.make =
                       [](const std::string&) {
                         return coincident_floors({0.0f, 1.0f});
                       },
                   .expected = 0.0,
                   .rounding = 0.0,
                   .spp = 1,
                   .depth = 4,
                   .measure =
                       [](const Image& i) {
                         return share_of_others(i, {0.0, 1.0});
                       },
                   .samplers = {"random", "owen", "cpt", "strata"}}},
      {"coplanar-lamp", "scale", "a lamp in the floor's own plane, facing up",
       "it is seen edge-on from the floor: 0",
       StressScene{.make = lamp_in_floor, .expected = 0.0, .rounding = 0.0, .depth = 2}},
  };
}

// A floor of 200 needles 1e-4 wide and 100 long: the camera sees a square that crosses 10 of them.
SceneDescription needle_floor() {
  SceneDescription scene;
  scene.name = "needles";
  TriangleMesh mesh;
  for (int i = -50; i < 50; ++i) {
    const float x = 1e-4f * float(i);
    add_quad(mesh, {x, 0, -50}, {x, 0, 50}, {x + 1e-4f, 0, 50}, {x + 1e-4f, 0, -50});
  }
  builtin::add_mesh(scene, mesh, grey(scene, floor_albedo));
  look_straight(scene, {0.3f, 2, 0.2f}, {0, 0, 0}, 1e-3f);
  return scene;
}

// Faces without area among the others: repeated corners, corners in a line, a lamp that has shrunk
// to a point.
SceneDescription degenerate_floor() {
  SceneDescription scene = lit_floor();
  auto& mesh = std::get<TriangleMesh>(scene.shapes[0].geometry);
  const auto n = std::uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {1e-4f, 0, 0}, {2e-4f, 0, 0}});
  mesh.triangles.insert(mesh.triangles.end(),
                        {{n, n, n}, {n, n, n + 1}, {n, n + 1, n + 2}, {0, 0, 2}});
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0f));
  TriangleMesh point;
  point.positions = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
  point.triangles = {{0, 1, 2}};
  builtin::add_mesh(scene, point, black(scene));
  scene.shapes.back().emission = Emission{glm::vec3(1e6f)};
  return scene;
}

std::vector<StressCase> faces() {
  const auto sky = [](SceneDescription scene) {
    scene.environment = glm::vec3(1.0f);
    return scene;
  };
  return {
      {"needles", "scale", "triangles of aspect 1e6", "a floor under a sky shows its albedo",
       StressScene{.make = [sky](const std::string&) { return sky(needle_floor()); },
                   .expected = double(floor_albedo),
                   .depth = 2}},
      {"degenerate-faces", "scale",
       "faces without area, vertex normals of length 0, a lamp without area",
       "what has no area is not there: the floor shows its albedo",
       StressScene{.make = [sky](const std::string&) { return sky(degenerate_floor()); },
                   .expected = double(floor_albedo),
                   .depth = 2}},
  };
}

// A wall in z = 0 of 16 x 16 squares, cut along their diagonals, that emits towards the camera; one
// square is one pixel, all of whose samples are taken at one point: its middle, on the diagonal, or
// where four squares meet.
SceneDescription wall_of_squares(bool at_corners) {
  SceneDescription scene;
  scene.name = "wall of squares";
  TriangleMesh mesh;
  constexpr int n = 18;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) mesh.positions.push_back({float(i - n / 2), float(j - n / 2), 0});
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  builtin::add_mesh(scene, mesh, black(scene));
  scene.shapes[0].emission = Emission{glm::vec3(1.0f)};
  const float shift = at_corners ? 0.5f : 0.0f;
  look_straight(scene, {shift, shift, 3}, {shift, shift, 0}, 16.0f);
  scene.film.filter.radius = glm::vec2(0.0f);
  return scene;
}

// Seen from within a ball of 5120 triangles, black inside, in a bright sky.
SceneDescription dark_ball() {
  SceneDescription scene;
  scene.name = "dark ball";
  builtin::add_mesh(scene, builtin::icosphere(4), black(scene));
  scene.environment = glm::vec3(1e6f);
  scene.camera.camera_to_world = builtin::look_at({0, 0, 0}, {1, 0, 0});
  scene.camera.fov_degrees = 160.0f;
  scene.film.width = scene.film.height = 32;
  return scene;
}

// A white square seen exactly from its own plane, in a white sky.
SceneDescription edge_on() {
  SceneDescription scene;
  scene.name = "edge on";
  add_rectangle(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, grey(scene, 1.0f));
  scene.environment = glm::vec3(1.0f);
  look_straight(scene, {3, 0, 0}, {0, 0, 0}, 2.0f);
  scene.film.filter.radius = glm::vec2(0.0f);
  scene.film.height = 17;  // the middle row lies in the plane
  return scene;
}

std::vector<StressCase> edges() {
  const auto wall = [](bool at_corners) {
    return StressScene{
        .make = [at_corners](const std::string&) { return wall_of_squares(at_corners); },
        .rounding = 0.0};
  };
  return {
      {"rays-through-edges", "scale", "rays exactly through the edges of a mesh",
       "a mesh without holes shows its emission in every sample", wall(false)},
      {"rays-through-vertices", "scale", "rays exactly through the vertices of a mesh",
       "a mesh without holes shows its emission in every sample", wall(true)},
      {"watertight-ball", "scale", "a black ball of 5120 faces in a sky of 1e6, seen from within",
       "no ray slips between faces: exactly 0",
       StressScene{.make = [](const std::string&) { return dark_ball(); },
                   .expected = 0.0,
                   .rounding = 0.0}},
      {"rays-parallel-to-face", "scale", "a face seen from its own plane",
       "white in a white sky is invisible from everywhere",
       StressScene{.make = [](const std::string&) { return edge_on(); }, .depth = 2}},
  };
}

void append(std::vector<StressCase>& to, std::vector<StressCase> from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

std::vector<StressCase> scale_cases() {
  std::vector<StressCase> cases = scaled();
  append(cases, moved());
  append(cases, {gap(1e-3f), gap(1e-5f)});
  append(cases, terminator());
  append(cases, coincident());
  append(cases, faces());
  append(cases, edges());
  return cases;
}

}  // namespace lockstep::stress
