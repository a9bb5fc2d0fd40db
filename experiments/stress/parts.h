// What the battery's scenes are put together from, and closed forms that several of them share.
// World: y up unless said otherwise.
#pragma once

#include "core/builtin/parts.h"
#include "core/image.h"
#include "core/scene_description.h"
#include "experiments/stress/stress.h"

#include <functional>
#include <string>
#include <vector>

namespace lockstep::stress {

inline constexpr double pi_double = 3.14159265358979323846;
inline constexpr float floor_albedo = 0.6f;
inline constexpr const char* kFormFactor = "form factor of the lamp, Howell's B-3";

// The families' lists.
std::vector<StressCase> scale_cases();
std::vector<StressCase> light_cases();
std::vector<StressCase> material_cases();
std::vector<StressCase> sampling_cases();
std::vector<StressCase> stiff_cases();

int black(SceneDescription& scene);
int grey(SceneDescription& scene, float albedo);

// An orthographic camera at `eye` that sees a square of side `extent` around `target`.
void look_straight(SceneDescription& scene, glm::vec3 eye, glm::vec3 target, float extent,
                   int width = 16, int height = 16);

// A floor in y = 0 of this half size, of which the camera sees a point near the origin from the
// side.
SceneDescription lit_floor(float half_size = 4.0f);

// A black lamp of half sizes a and b at height h over the origin, facing down.
void add_lamp(SceneDescription& scene, float a, float b, float h, glm::vec3 radiance);

// Form factor from a point to a parallel rectangle of half sizes a and b, centred h above it: four
// times that of the quarter with a corner above the point (Howell, catalogue of configuration
// factors, B-3).
double rectangle_form_factor(double a, double b, double h);

// A closed box, half sizes 1, 1.5 and 2, whose walls emit inwards; seen from within.
SceneDescription closed_box(float emission, float albedo);

// A closed sphere that emits inwards; seen from within.
SceneDescription closed_sphere(float emission, float albedo);

// Everywhere in a closed body of emission L and albedo a the radiance is L (1 + a + a^2 + ...),
// with one term more than interactions are lit.
double partial_sum(double emission, double albedo, int depth);

// Turned about the origin.
void turn(SceneDescription& scene, const glm::mat3& rotation);

// All positions and lengths times `scale`, then moved.
void transform(SceneDescription& scene, float scale, glm::vec3 move);

// Writes a float image of that function of column and row, row 0 at the top; returns its path.
std::string write_exr(const std::string& folder, const std::string& name, int width, int height,
                      const std::function<glm::vec3(int x, int y)>& color);

// Texture coordinates for the mesh of a rectangle's shape: (0, 0) to (1, 1), u along its first
// edge.
void set_uvs(Shape& rectangle);

}  // namespace lockstep::stress
