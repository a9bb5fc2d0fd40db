#include "core/location.h"
#include "experiments/scenes/camera_override.h"
#include "experiments/scenes/scene_report.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lockstep {
namespace {

// 1234567 as 1,234,567.
std::string grouped(std::size_t count) {
  std::string text = std::to_string(count);
  for (auto at = std::ptrdiff_t(text.size()) - 3; at > 0; at -= 3) {
    text.insert(text.begin() + at, ',');
  }
  return text;
}

std::string counted(std::size_t count, const std::string& what) {
  const bool plural = count != 1 && !what.ends_with("vertices");
  const bool es = what.ends_with("sh");
  return fmt::format("{} {}{}", grouped(count), what, plural ? es ? "es" : "s" : "");
}

std::string bytes_text(std::size_t bytes) {
  double value = double(bytes);
  if (value < 1000.0) return fmt::format("{} B", bytes);
  for (const char* unit : {"kB", "MB", "GB"}) {
    value /= 1000.0;
    if (value < 999.5) return fmt::format("{:.{}f} {}", value, value < 9.95 ? 1 : 0, unit);
  }
  return fmt::format("{:.0f} TB", value / 1000.0);
}

std::string number(float value) { return fmt::format("{:.5g}", value + 0.0f); }

// Five digits of the largest component: roundings leave dust in the others.
std::string vector_text(glm::vec3 v) {
  const float largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 1e-4f && largest < 1e7f)) {
    return fmt::format("{} {} {}", number(v.x), number(v.y), number(v.z));
  }
  const float grid = std::pow(10.0f, std::floor(std::log10(largest)) - 4.0f);
  const auto on_grid = [&](float x) { return number(grid * std::round(x / grid)); };
  return fmt::format("{} {} {}", on_grid(v.x), on_grid(v.y), on_grid(v.z));
}

std::string pair_text(glm::vec2 v) {
  return v.x == v.y ? number(v.x) : fmt::format("{} x {}", number(v.x), number(v.y));
}

std::string line(std::string_view label, const std::string& text) {
  return fmt::format("  {:<22}{}\n", label, text);
}

// A count in a column of its own, then what it is made of.
std::string count_line(std::string_view label, std::size_t count, const std::string& text) {
  const std::string row = fmt::format("  {:<20}{:>12}  {}", label, grouped(count), text);
  return row.substr(0, row.find_last_not_of(' ') + 1) + '\n';
}

std::string joined(std::initializer_list<std::pair<std::size_t, const char*>> parts) {
  std::string text;
  for (const auto& [count, what] : parts) {
    if (count > 0) text += (text.empty() ? "" : ", ") + counted(count, what);
  }
  return text;
}

std::string kinds(const ShapeCounts& c) {
  return joined({{c.meshes, "mesh"}, {c.spheres, "sphere"}, {c.disks, "disk"}});
}

std::string bounds_text(const Bounds& b) {
  if (b.empty()) return "none";
  return fmt::format("({}) to ({}), size {}", vector_text(b.lo), vector_text(b.hi),
                     vector_text(b.hi - b.lo));
}

std::string geometry_text(const SceneReport& r) {
  std::string text = "\nGeometry\n";
  text += count_line("shapes", r.own.shapes(), kinds(r.own));
  text += count_line("triangles", r.own.triangles, counted(r.own.vertices, "vertices"));
  if (r.object_count + r.instance_count > 0) {
    text += count_line(
        "objects", r.object_count,
        fmt::format("{}; {}", kinds(r.objects),
                    joined({{r.objects.triangles, "triangle"}, {r.objects.vertices, "vertices"}})));
    text += count_line("instances", r.instance_count,
                       joined({{r.placed.triangles, "triangle"},
                               {r.placed.spheres, "sphere"},
                               {r.placed.disks, "disk"}}));
    text += count_line("triangles in all", r.own.triangles + r.placed.triangles,
                       "with those of instances");
  }
  text += line("bounds", bounds_text(r.bounds));
  return text + line("memory", bytes_text(r.geometry_bytes) + " as read");
}

std::string materials_text(const std::vector<MaterialCounts>& materials) {
  if (materials.empty()) return "";
  const auto cell = [](int count) { return count > 0 ? grouped(std::size_t(count)) : "-"; };
  std::string text = fmt::format("\n{:<22}{:>12}{:>10}{:>9}{:>8}{:>6}\n", "Materials", "count",
                                 "textured", "opacity", "normal", "bump");
  for (const MaterialCounts& m : materials) {
    text += fmt::format("  {:<20}{:>12}{:>10}{:>9}{:>8}{:>6}\n", m.model, cell(m.count),
                        cell(m.textured), cell(m.opacity), cell(m.normal_map), cell(m.bump));
  }
  return text;
}

std::string image_line(const ImageReport& image) {
  if (!image.error.empty()) return fmt::format("  {:<38}{}\n", "not read", printable(image.error));
  return fmt::format("  {:>6} x {:<6} {:<12}{:>8}  {}\n", image.width, image.height, image.stored,
                     bytes_text(image.memory_bytes), printable(image.file));
}

std::string textures_text(const SceneReport& r) {
  if (r.textures.empty()) return "";
  std::string text = "\nTextures\n";
  for (const TextureCount& t : r.textures) text += count_line(t.kind, std::size_t(t.count), "");
  if (r.images.empty()) return text;
  std::size_t bytes = 0;
  for (const ImageReport& image : r.images) bytes += image.memory_bytes;
  text += fmt::format("\nImages: {}, {} in memory, read in {:.2f} s\n", r.images.size(),
                      bytes_text(bytes), r.image_seconds);
  for (const ImageReport& image : r.images) text += image_line(image);
  return text;
}

std::string emitters_text(const EmitterCounts& e) {
  return joined({{e.counts.triangles, "triangle"},
                 {e.counts.spheres, "sphere"},
                 {e.counts.disks, "disk"}}) +
         (e.two_sided > 0 ? fmt::format("; {} two-sided", e.two_sided) : "") +
         (e.textured > 0 ? fmt::format("; {} textured", e.textured) : "");
}

std::string environment_text(const EnvironmentReport& e) {
  const glm::vec3 radiance = e.environment.radiance;
  if (e.environment.mapping == Environment::Mapping::Constant) {
    return "constant, radiance " + vector_text(radiance);
  }
  const char* mapping = e.environment.mapping == Environment::Mapping::LatLong
                            ? "latitude-longitude"
                            : "equal-area octahedral";
  if (!e.image.error.empty())
    return fmt::format("{}, not read: {}", mapping, printable(e.image.error));
  return fmt::format("{}, {} x {}, {}, {}, mean radiance {}\n{:36}{}", mapping, e.image.width,
                     e.image.height, e.image.stored, bytes_text(e.image.memory_bytes),
                     vector_text(e.mean_radiance), "", printable(e.image.file));
}

std::string lights_text(const SceneReport& r) {
  std::string text;
  const auto add = [&](const char* kind, std::size_t count, const std::string& note) {
    if (count > 0) text += count_line(kind, count, note);
  };
  add("emitting shapes", r.emitters.counts.shapes(), emitters_text(r.emitters));
  add("point", std::size_t(r.lights.point), "");
  add("spot", std::size_t(r.lights.spot), "");
  add("distant", std::size_t(r.lights.distant), "");
  if (r.environment) add("environment", 1, environment_text(*r.environment));
  return "\nLights\n" + (text.empty() ? "  none\n" : text);
}

std::string projection_text(const CameraDescription& camera, const FilmDescription& film) {
  const float longer = float(std::max(film.width, film.height));
  const float ratio = longer / float(std::min(film.width, film.height));
  const bool perspective = camera.projection == CameraDescription::Projection::Perspective;
  const float half = std::tan(0.5f * glm::radians(camera.fov_degrees));
  const float wide =
      perspective ? 2.0f * glm::degrees(std::atan(ratio * half)) : ratio * camera.extent;
  std::string text = perspective
                         ? fmt::format("perspective, fov {} degrees", number(camera.fov_degrees))
                         : fmt::format("orthographic, extent {}", number(camera.extent));
  if (ratio > 1.0f) text += fmt::format(" (longer side: {})", number(wide));
  return text;
}

std::string camera_text(const CameraDescription& camera, const FilmDescription& film) {
  const glm::mat4& m = camera.camera_to_world;
  const bool left_handed = glm::determinant(glm::mat3(m)) > 0.0f;
  std::string text = "\nCamera\n" + line("projection", projection_text(camera, film));
  text += line("position", vector_text(glm::vec3(m[3])));
  text += line("direction", vector_text(glm::normalize(glm::vec3(m[2]))));
  text += line("up", vector_text(glm::normalize(glm::vec3(m[1]))));
  text += line("coordinates", left_handed ? "left-handed" : "right-handed");
  const bool lens = camera.lens_radius > 0.0f;
  text += line("lens", lens ? fmt::format("radius {}, sharp at {}", number(camera.lens_radius),
                                          number(camera.focal_distance))
                            : "pinhole");
  if (camera.shift != glm::vec2(0.0f)) {
    text += line("shift", fmt::format("{} right, {} up, in shorter sides", number(camera.shift.x),
                                      number(camera.shift.y)));
  }
  return text + line("as --camera", to_string(override_of(camera)));
}

std::string film_text(const FilmDescription& film, const RenderDefaults& defaults) {
  const PixelFilter& filter = film.filter;
  std::string kind = "box";
  if (filter.kind == PixelFilter::Kind::Triangle) kind = "triangle";
  if (filter.kind == PixelFilter::Kind::Gaussian) kind = "Gaussian, sigma " + number(filter.sigma);
  if (filter.kind == PixelFilter::Kind::Mitchell) {
    kind = fmt::format("Mitchell, B {}, C {}", number(filter.b), number(filter.c));
  }
  if (filter.kind == PixelFilter::Kind::Lanczos) kind = "Lanczos, tau " + number(filter.tau);
  return "\nFilm\n" + line("resolution", fmt::format("{} x {}", film.width, film.height)) +
         line("filter", fmt::format("{}, radius {} px", kind, pair_text(filter.radius))) +
         line("samples per pixel", std::to_string(defaults.spp)) +
         line("depth", std::to_string(defaults.depth));
}

}  // namespace

std::string report_text(const SceneReport& r) {
  std::string text = fmt::format("{}\n{}, read in {:.2f} s\n", printable(r.scene),
                                 format_name(r.format), r.read_seconds);
  text += geometry_text(r) + materials_text(r.materials) + textures_text(r) + lights_text(r) +
          camera_text(r.camera, r.film) + film_text(r.film, r.defaults);
  if (r.warnings.empty()) return text;
  text += fmt::format("\nWarnings: {}\n", r.warnings.size());
  for (const std::string& warning : r.warnings) text += "  " + printable(warning) + '\n';
  return text;
}

}  // namespace lockstep
