// The scenes without fine geometry: cornell, spheres, furnace.
#include "core/builtin/parts.h"
#include "core/builtin/scenes.h"

#include <glm/trigonometric.hpp>

#include <cmath>

namespace lockstep::builtin {

// A room of 2 m, open towards the camera, whose front edges lie just outside the image.
SceneDescription make_cornell() {
  SceneDescription scene;
  scene.name = "cornell";
  const int white = add_material(scene, DiffuseMaterial{glm::vec3(0.73f, 0.71f, 0.67f)});
  const int red = add_material(scene, DiffuseMaterial{glm::vec3(0.60f, 0.07f, 0.05f)});
  const int green = add_material(scene, DiffuseMaterial{glm::vec3(0.11f, 0.42f, 0.10f)});
  const int lamp = add_material(scene, DiffuseMaterial{glm::vec3(0.0f)});

  const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  add_rectangle(scene, {0, 0, 0}, z, x, white);   // floor
  add_rectangle(scene, {0, 2, 0}, x, z, white);   // ceiling
  add_rectangle(scene, {0, 1, -1}, x, y, white);  // back
  add_rectangle(scene, {-1, 1, 0}, y, z, red);
  add_rectangle(scene, {1, 1, 0}, z, y, green);
  add_rectangle(scene, {0, 1.995f, 0}, 0.25f * x, 0.22f * z, lamp,
                Emission{glm::vec3(27.0f, 21.0f, 14.0f)});

  add_box(scene, {-0.34f, 0, -0.28f}, {0.58f, 1.18f, 0.58f}, 18.0f, white);
  add_box(scene, {0.36f, 0, 0.34f}, {0.56f, 0.56f, 0.56f}, -16.0f, white);

  const float distance = 2.6f;  // from the room's front
  scene.camera.camera_to_world = look_at({0, 1, 1 + distance}, {0, 1, 0});
  scene.camera.fov_degrees = glm::degrees(2.0f * std::atan(0.99f / distance));
  scene.film.width = scene.film.height = 512;
  scene.defaults = {64, 5};
  return scene;
}

// Metal of five roughnesses, each seen in lights of four sizes and equal power: the small lights
// want to be sampled, the polished metals want their own lobe followed (after Veach 1997,
// fig. 9.2).
SceneDescription make_spheres() {
  SceneDescription scene;
  scene.name = "spheres";
  scene.environment = glm::vec3(0.10f, 0.12f, 0.15f);
  const int floor = add_material(scene, DiffuseMaterial{glm::vec3(0.32f, 0.33f, 0.35f)});
  const int wall = add_material(scene, DiffuseMaterial{glm::vec3(0.42f, 0.38f, 0.33f)});
  const int lamp = add_material(scene, DiffuseMaterial{glm::vec3(0.0f)});
  add_rectangle(scene, {0, 0, 0}, {0, 0, 14}, {14, 0, 0}, floor);
  add_rectangle(scene, {0, 6, -4}, {14, 0, 0}, {0, 8, 0}, wall);

  const float roughness[] = {0.01f, 0.04f, 0.1f, 0.22f, 0.45f};
  for (int i = 0; i < 5; ++i) {
    ConductorMaterial metal;
    if (i % 2 == 1) {  // aluminium between the copper
      metal.eta = glm::vec3(1.66f, 0.88f, 0.52f);
      metal.k = glm::vec3(9.2f, 6.3f, 4.8f);
    }
    metal.alpha = glm::vec2(roughness[i]);
    add_sphere(scene, {2.1f * float(i - 2), 0.95f, 0}, 0.95f, add_material(scene, metal));
  }

  const float radii[] = {0.06f, 0.18f, 0.4f, 0.8f};
  const glm::vec3 tints[] = {
      {1, 0.75f, 0.5f}, {1, 0.92f, 0.75f}, {0.8f, 0.95f, 1}, {0.6f, 0.8f, 1}};
  for (int i = 0; i < 4; ++i) {
    const float radiance = 3.2f / (radii[i] * radii[i]);
    add_sphere(scene, {2.6f * (float(i) - 1.5f), 4.1f, -1.2f}, radii[i], lamp,
               Emission{radiance * tints[i]});
  }

  scene.camera.camera_to_world = look_at({0, 3.4f, 11.5f}, {0, 2.0f, 0});
  scene.camera.fov_degrees = 32.0f;
  scene.film.width = 684;
  scene.film.height = 385;
  scene.defaults = {64, 4};
  return scene;
}

// Albedo 1 under radiance 1: a convex surface sends light on without loss, so every pixel is 1.
SceneDescription make_furnace() {
  SceneDescription scene;
  scene.name = "furnace";
  const int white = add_material(scene, DiffuseMaterial{glm::vec3(1.0f)});
  add_sphere(scene, glm::vec3(0.0f), 1.0f, white);
  scene.environment = glm::vec3(1.0f);
  scene.camera.camera_to_world = look_at({0, 0, 4}, {0, 0, 0});
  scene.camera.fov_degrees = 36.0f;
  scene.film.width = scene.film.height = 64;
  scene.defaults = {16, 2};
  return scene;
}

}  // namespace lockstep::builtin
