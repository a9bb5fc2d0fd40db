// Triangle meshes, and the few operations on them that readers and built-in scenes need.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace lockstep {

struct TriangleMesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  // one per position, unit length; empty: flat shading
  std::vector<glm::vec2> uvs;      // one per position; empty: none
  std::vector<glm::uvec3> triangles;
};

// Appends both triangles of the quad p00, p10, p11, p01 (in this order around it) to `mesh`,
// with four vertices of its own and the normal of cross(p10 - p00, p01 - p00).
void add_quad(TriangleMesh& mesh, glm::vec3 p00, glm::vec3 p10, glm::vec3 p11, glm::vec3 p01);

// Moves positions by `transform` and normals by its inverse transpose; a transform that mirrors
// also turns the winding round, so that geometric normals keep to the same side.
void apply_transform(TriangleMesh& mesh, const glm::mat4& transform);

// Sets smooth normals: the mean of the adjacent faces' normals, weighted by the angle at the
// vertex. Vertices without a proper face get the z axis.
void set_smooth_normals(TriangleMesh& mesh);

// A sphere as a mesh with smooth normals: for spheres that a transform has made ellipsoids.
TriangleMesh tessellated_sphere(float radius, int segments);

// Loop subdivision of a control mesh, `levels` times, then every vertex moved to its limit position
// with the limit surface's normal (Loop 1987; limit masks: Hoppe et al. 1994). Boundaries follow
// the cubic B-spline rules. Throws std::invalid_argument where an edge has more than two faces.
TriangleMesh subdivide_loop(const TriangleMesh& control, int levels);

}  // namespace lockstep
