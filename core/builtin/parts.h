// What the built-in scenes are put together from. World: right-handed, y up, metres.
#pragma once

#include "core/scene_description.h"

#include <glm/vec3.hpp>

#include <functional>
#include <optional>

namespace lockstep::builtin {

// Camera at `eye` that sees `target` in the middle of its image.
glm::mat4 look_at(glm::vec3 eye, glm::vec3 target);

// Appends a material; returns its index.
int add_material(SceneDescription& scene, const Material& material);

void add_mesh(SceneDescription& scene, TriangleMesh mesh, int material);

void add_sphere(SceneDescription& scene, glm::vec3 center, float radius, int material,
                std::optional<Emission> emission = {});

// The rectangle center +- a +- b, facing along cross(a, b).
void add_rectangle(SceneDescription& scene, glm::vec3 center, glm::vec3 a, glm::vec3 b,
                   int material, std::optional<Emission> emission = {});

// A box on the ground: its base's centre, its size, turned by `degrees` about the vertical.
void add_box(SceneDescription& scene, glm::vec3 base, glm::vec3 size, float degrees, int material);

// Unit sphere of 20 * 4^levels nearly equal triangles, facing outwards; no normals.
TriangleMesh icosphere(int levels);

// Grid of n x n squares over [-half, half]^2 in x and z, at height(x, z), facing up, smooth
// normals.
TriangleMesh terrain(int n, float half, const std::function<float(float, float)>& height);

// Moves vertex p of a star-shaped mesh around the origin to p * radius(p), with smooth normals.
void displace(TriangleMesh& mesh, const std::function<float(glm::vec3)>& radius);

// Scales, turns about the vertical and moves a mesh.
void place(TriangleMesh& mesh, glm::vec3 position, glm::vec3 scale, float degrees);

}  // namespace lockstep::builtin
