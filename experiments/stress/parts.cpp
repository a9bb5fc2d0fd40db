#include "experiments/stress/parts.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <filesystem>

namespace lockstep::stress {

using builtin::add_material;
using builtin::add_rectangle;
using builtin::add_sphere;

int black(SceneDescription& scene) { return grey(scene, 0.0f); }

int grey(SceneDescription& scene, float albedo) {
  return add_material(scene, DiffuseMaterial{glm::vec3(albedo)});
}

void look_straight(SceneDescription& scene, glm::vec3 eye, glm::vec3 target, float extent,
                   int width, int height) {
  scene.camera = {};
  scene.camera.camera_to_world = builtin::look_at(eye, target);
  scene.camera.projection = CameraDescription::Projection::Orthographic;
  scene.camera.extent = extent;
  scene.film.width = width;
  scene.film.height = height;
}

SceneDescription lit_floor(float half_size) {
  SceneDescription scene;
  scene.name = "floor";
  add_rectangle(scene, {0, 0, 0}, {0, 0, half_size}, {half_size, 0, 0}, grey(scene, floor_albedo));
  look_straight(scene, {3, 2, 1}, {0, 0, 0}, 1e-3f);
  return scene;
}

void add_lamp(SceneDescription& scene, float a, float b, float h, glm::vec3 radiance) {
  add_rectangle(scene, {0, h, 0}, {a, 0, 0}, {0, 0, b}, black(scene), Emission{radiance});
}

double rectangle_form_factor(double a, double b, double h) {
  const double x = a / h, y = b / h, sx = std::sqrt(1 + x * x), sy = std::sqrt(1 + y * y);
  return 4.0 / (2.0 * pi_double) * (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy));
}

SceneDescription closed_box(float emission, float albedo) {
  SceneDescription scene;
  scene.name = "closed box";
  const int wall = grey(scene, albedo);
  const Emission light{glm::vec3(emission)};
  const glm::vec3 x(1, 0, 0), y(0, 1.5f, 0), z(0, 0, 2);
  add_rectangle(scene, -x, y, z, wall, light);
  add_rectangle(scene, x, z, y, wall, light);
  add_rectangle(scene, -y, z, x, wall, light);
  add_rectangle(scene, y, x, z, wall, light);
  add_rectangle(scene, -z, x, y, wall, light);
  add_rectangle(scene, z, y, x, wall, light);
  scene.camera.camera_to_world = builtin::look_at({0.2f, -0.3f, 0.1f}, {1, 1, 1});
  scene.camera.fov_degrees = 100.0f;
  scene.film.width = scene.film.height = 16;
  return scene;
}

SceneDescription closed_sphere(float emission, float albedo) {
  SceneDescription scene;
  scene.name = "closed sphere";
  add_sphere(scene, {1, 2, 3}, 2.5f, grey(scene, albedo), Emission{glm::vec3(emission)});
  std::get<Sphere>(scene.shapes[0].geometry).emits_inwards = true;
  scene.camera.camera_to_world = builtin::look_at({1.3f, 1.6f, 2.8f}, {5, 4, 1});
  scene.camera.fov_degrees = 60.0f;
  scene.film.width = scene.film.height = 16;
  return scene;
}

double partial_sum(double emission, double albedo, int depth) {
  double sum = 0.0;
  for (int i = depth; i >= 0; --i) sum = sum * albedo + emission;
  return sum;
}

void turn(SceneDescription& scene, const glm::mat3& rotation) {
  for (Shape& shape : scene.shapes) {
    if (auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
      for (glm::vec3& p : mesh->positions) p = rotation * p;
    } else if (auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
      sphere->center = rotation * sphere->center;
    }
  }
  scene.camera.camera_to_world = glm::mat4(rotation) * scene.camera.camera_to_world;
}

void transform(SceneDescription& scene, float scale, glm::vec3 move) {
  for (Shape& shape : scene.shapes) {
    if (auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
      for (glm::vec3& p : mesh->positions) p = p * scale + move;
    } else if (auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
      sphere->center = sphere->center * scale + move;
      sphere->radius *= scale;
    }
  }
  glm::vec4& eye = scene.camera.camera_to_world[3];
  eye = glm::vec4(glm::vec3(eye) * scale + move, 1.0f);
  scene.camera.extent *= scale;
}

std::string write_exr(const std::string& folder, const std::string& name, int width, int height,
                      const std::function<glm::vec3(int x, int y)>& color) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec3 c = color(x, y);
      for (int k = 0; k < 3; ++k) image.at(x, y)[k] = c[k];
    }
  }
  const std::string path = (std::filesystem::path(folder) / (name + ".exr")).string();
  write_image(path, image);
  return path;
}

void set_uvs(Shape& rectangle) {
  std::get<TriangleMesh>(rectangle.geometry).uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
}

}  // namespace lockstep::stress
