// Loop subdivision on half-edges. Half-edge 3f + e leads from corner e of face f to the next
// corner.
#include "core/mesh.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <string>

namespace lockstep {

namespace {

constexpr std::int32_t none = -1;

struct Topology {
  std::vector<std::int32_t> opposite;   // per half-edge: its twin in the neighbouring face, or none
  std::vector<std::int32_t> edge;       // per half-edge: the number of its undirected edge
  std::vector<std::int32_t> first_out;  // per vertex: an outgoing half-edge; on a boundary the one
                                        // from which turning anticlockwise meets every face
  int edge_count = 0;
};

// The neighbours of a vertex, anticlockwise seen from the side that the winding faces.
struct OneRing {
  std::vector<glm::vec3> points;
  bool boundary = false;
};

std::int32_t next_in_face(std::int32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
std::int32_t previous_in_face(std::int32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

unsigned origin(const TriangleMesh& mesh, std::int32_t h) { return mesh.triangles[h / 3][h % 3]; }
unsigned target(const TriangleMesh& mesh, std::int32_t h) { return origin(mesh, next_in_face(h)); }

void connect_twins(const TriangleMesh& mesh, Topology& topology) {
  struct Side {
    std::uint64_t key;
    std::int32_t half_edge;
  };
  const auto count = static_cast<std::int32_t>(3 * mesh.triangles.size());
  std::vector<Side> sides(count);
  for (std::int32_t h = 0; h < count; ++h) {
    const auto [low, high] = std::minmax({origin(mesh, h), target(mesh, h)});
    sides[h] = {(std::uint64_t{low} << 32) | high, h};
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.key != b.key ? a.key < b.key : a.half_edge < b.half_edge;
  });

  topology.opposite.assign(count, none);
  topology.edge.resize(count);
  for (std::int32_t i = 0; i < count; ++topology.edge_count) {
    std::int32_t end = i;
    while (end < count && sides[end].key == sides[i].key) {
      topology.edge[sides[end++].half_edge] = topology.edge_count;
    }
    const std::int32_t a = sides[i].half_edge;
    const std::string name =
        std::to_string(origin(mesh, a)) + "-" + std::to_string(target(mesh, a));
    if (end - i > 2) throw std::invalid_argument("edge " + name + " has more than two faces");
    if (end - i == 2) {
      const std::int32_t b = sides[i + 1].half_edge;
      if (origin(mesh, a) == origin(mesh, b)) {
        throw std::invalid_argument("the faces beside edge " + name + " wind in opposite ways");
      }
      topology.opposite[a] = b;
      topology.opposite[b] = a;
    }
    i = end;
  }
}

Topology connect(const TriangleMesh& mesh) {
  Topology topology;
  connect_twins(mesh, topology);
  topology.first_out.assign(mesh.positions.size(), none);
  for (std::int32_t h = 0; h < static_cast<std::int32_t>(topology.opposite.size()); ++h) {
    std::int32_t& first = topology.first_out[origin(mesh, h)];
    if (first == none || topology.opposite[h] == none) first = h;
  }
  return topology;
}

// Fills `ring`, whose memory is reused from call to call.
void walk_ring(const TriangleMesh& mesh, const Topology& topology, std::int32_t first,
               OneRing& ring) {
  ring.points.clear();
  ring.boundary = false;
  for (std::int32_t h = first;;) {
    ring.points.push_back(mesh.positions[target(mesh, h)]);
    const std::int32_t into = previous_in_face(h);
    h = topology.opposite[into];
    if (h == first) return;
    if (h == none) {
      ring.points.push_back(mesh.positions[origin(mesh, into)]);
      ring.boundary = true;
      return;
    }
  }
}

// (1 - n w) center + w * sum of the n points of the ring.
glm::vec3 ring_average(glm::vec3 center, const OneRing& ring, float weight) {
  glm::vec3 sum(0.0f);
  for (const glm::vec3& p : ring.points) sum += p;
  return (1.0f - static_cast<float>(ring.points.size()) * weight) * center + weight * sum;
}

glm::vec3 boundary_average(glm::vec3 center, const OneRing& ring, float weight) {
  return (1.0f - 2.0f * weight) * center + weight * (ring.points.front() + ring.points.back());
}

// Warren's weights, simpler than Loop's own and as smooth.
float vertex_weight(size_t valence) {
  return valence == 3 ? 3.0f / 16.0f : 3.0f / (8.0f * static_cast<float>(valence));
}

glm::vec3 refined_position(glm::vec3 center, const OneRing& ring) {
  if (ring.boundary) return boundary_average(center, ring, 1.0f / 8.0f);
  return ring_average(center, ring, vertex_weight(ring.points.size()));
}

glm::vec3 limit_position(glm::vec3 center, const OneRing& ring) {
  if (ring.boundary) return boundary_average(center, ring, 1.0f / 6.0f);
  const size_t valence = ring.points.size();
  return ring_average(
      center, ring, 1.0f / (static_cast<float>(valence) + 3.0f / (8.0f * vertex_weight(valence))));
}

// Hoppe et al. 1994, the tangent into the surface at a vertex of the boundary.
glm::vec3 inward_tangent(glm::vec3 center, const std::vector<glm::vec3>& ring) {
  const size_t last = ring.size() - 1;
  if (last == 1) return ring[0] + ring[1] - 2.0f * center;
  if (last == 2) return ring[1] - center;
  if (last == 3) return 2.0f * (ring[1] + ring[2] - center) - ring[0] - ring[3];
  const float theta = std::numbers::pi_v<float> / static_cast<float>(last);
  glm::vec3 tangent = -std::sin(theta) * (ring[0] + ring[last]);
  for (size_t k = 1; k < last; ++k) {
    tangent += (2.0f - 2.0f * std::cos(theta)) * std::sin(static_cast<float>(k) * theta) * ring[k];
  }
  return tangent;
}

glm::vec3 limit_normal(glm::vec3 center, const OneRing& ring) {
  glm::vec3 n(0.0f);
  if (ring.boundary) {
    n = glm::cross(inward_tangent(center, ring.points), ring.points.back() - ring.points.front());
  } else {
    glm::vec3 s(0.0f), t(0.0f);
    const float turn = 2.0f * std::numbers::pi_v<float> / static_cast<float>(ring.points.size());
    for (size_t j = 0; j < ring.points.size(); ++j) {
      // Relative to the vertex: the weights sum to zero, and so do their rounding errors.
      const glm::vec3 spoke = ring.points[j] - center;
      s += std::cos(turn * static_cast<float>(j)) * spoke;
      t += std::sin(turn * static_cast<float>(j)) * spoke;
    }
    n = glm::cross(s, t);
  }
  const float length = glm::length(n);
  return length > 0.0f ? n / length : glm::vec3(0.0f, 0.0f, 1.0f);
}

glm::vec3 edge_point(const TriangleMesh& mesh, const Topology& topology, std::int32_t h) {
  const glm::vec3 ends = mesh.positions[origin(mesh, h)] + mesh.positions[target(mesh, h)];
  const std::int32_t twin = topology.opposite[h];
  if (twin == none) return 0.5f * ends;
  const glm::vec3 tips = mesh.positions[origin(mesh, previous_in_face(h))] +
                         mesh.positions[origin(mesh, previous_in_face(twin))];
  return 0.375f * ends + 0.125f * tips;
}

TriangleMesh refine(const TriangleMesh& mesh) {
  const Topology topology = connect(mesh);
  const size_t vertex_count = mesh.positions.size();
  TriangleMesh fine;
  fine.positions = mesh.positions;
  fine.positions.resize(vertex_count + topology.edge_count);

  OneRing ring;
  for (size_t v = 0; v < vertex_count; ++v) {
    if (topology.first_out[v] == none) continue;
    walk_ring(mesh, topology, topology.first_out[v], ring);
    fine.positions[v] = refined_position(mesh.positions[v], ring);
  }
  for (std::int32_t h = 0; h < static_cast<std::int32_t>(topology.edge.size()); ++h) {
    if (topology.opposite[h] < h) {  // once per edge, of two twins at the later one
      fine.positions[vertex_count + topology.edge[h]] = edge_point(mesh, topology, h);
    }
  }

  fine.triangles.reserve(4 * mesh.triangles.size());
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    const glm::uvec3 corner = mesh.triangles[f];
    const auto first_edge = static_cast<unsigned>(vertex_count);
    const unsigned a = first_edge + topology.edge[3 * f];
    const unsigned b = first_edge + topology.edge[3 * f + 1];
    const unsigned c = first_edge + topology.edge[3 * f + 2];
    fine.triangles.insert(fine.triangles.end(),
                          {{corner.x, a, c}, {a, corner.y, b}, {c, b, corner.z}, {a, b, c}});
  }
  return fine;
}

TriangleMesh to_limit(const TriangleMesh& mesh) {
  const Topology topology = connect(mesh);
  TriangleMesh limit;
  limit.positions = mesh.positions;
  limit.normals.assign(mesh.positions.size(), glm::vec3(0.0f, 0.0f, 1.0f));
  limit.triangles = mesh.triangles;
  OneRing ring;
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    if (topology.first_out[v] == none) continue;
    walk_ring(mesh, topology, topology.first_out[v], ring);
    limit.positions[v] = limit_position(mesh.positions[v], ring);
    limit.normals[v] = limit_normal(mesh.positions[v], ring);
  }
  return limit;
}

}  // namespace

TriangleMesh subdivide_loop(const TriangleMesh& control, int levels) {
  TriangleMesh mesh;
  mesh.positions = control.positions;
  for (const glm::uvec3& t : control.triangles) {
    // A face that names a vertex twice has no area; its neighbours join without it.
    if (t.x != t.y && t.y != t.z && t.z != t.x) mesh.triangles.push_back(t);
  }
  for (int level = 0; level < levels; ++level) mesh = refine(mesh);
  return to_limit(mesh);
}

}  // namespace lockstep
