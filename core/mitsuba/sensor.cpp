#include "core/mitsuba/sensor.h"

#include "core/mitsuba/values.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace lockstep::mitsuba {
namespace {

// What of the whole image is rendered, in pixels.
struct Film {
  int width = 768, height = 576;
  glm::ivec2 crop_offset{0}, crop_size{0};
};

Film read_film(State& state, const Properties& set) {
  Film film;
  film.width = set.get_int("width", film.width);
  film.height = set.get_int("height", film.height);
  constexpr int largest = 65536;
  if (film.width < 1 || film.height < 1 || film.width > largest || film.height > largest) {
    fail(set.where(), "<film> needs a width and height between 1 and " + std::to_string(largest));
  }
  film.crop_offset = {set.get_int("crop_offset_x", 0), set.get_int("crop_offset_y", 0)};
  film.crop_size = {set.get_int("crop_width", film.width), set.get_int("crop_height", film.height)};
  const glm::ivec2 offset = film.crop_offset, size = film.crop_size;
  if (offset.x < 0 || offset.y < 0 || size.x < 1 || size.y < 1 || offset.x > film.width - size.x ||
      offset.y > film.height - size.y) {
    fail(set.where(), "the crop window of <film> lies outside the image");
  }
  // How the image is written is the command line's concern.
  for (const char* tag : {"string", "boolean"}) set.objects(tag);
  set.ignore({"gamma", "exposure", "key", "burn"});
  set.objects("rfilter");
  set.warn_unused(state.warnings);
  return film;
}

PixelFilter read_filter(State& state, const Properties* film) {
  // Mitsuba's own: lowered to zero at four standard deviations.
  const auto gaussian = [](float sigma) {
    return PixelFilter{PixelFilter::Kind::Gaussian, glm::vec2(4.0f * sigma), sigma};
  };
  const auto mitchell = [](float b, float c) {
    PixelFilter filter{PixelFilter::Kind::Mitchell, glm::vec2(2.0f)};
    filter.b = b, filter.c = c;
    return filter;
  };
  const std::vector<const Property*> filters =
      film != nullptr ? film->objects("rfilter") : std::vector<const Property*>{};
  if (filters.empty()) return gaussian(0.5f);
  const Properties set = state.properties(filters.front()->element);
  PixelFilter filter = gaussian(0.5f);
  if (set.type() == "box") {
    const float radius = set.get_float("radius", 0.5f);
    filter = {PixelFilter::Kind::Box, glm::vec2(radius), 0.5f};
  } else if (set.type() == "tent") {
    const float radius = set.get_float("radius", 1.0f);
    filter = {PixelFilter::Kind::Triangle, glm::vec2(radius), 0.5f};
  } else if (set.type() == "gaussian") {
    filter = gaussian(set.get_float("stddev", 0.5f));
  } else if (set.type() == "mitchell") {
    filter = mitchell(set.get_float("B", 1.0f / 3.0f), set.get_float("C", 1.0f / 3.0f));
  } else if (set.type() == "catmullrom") {
    filter = mitchell(0.0f, 0.5f);
  } else if (set.type() == "lanczos") {
    filter = {PixelFilter::Kind::Lanczos, glm::vec2(float(set.get_int("lobes", 3)))};
    filter.tau = filter.radius.x;
  } else {
    state.warnings.add(
        set.where(), "<rfilter type=\"" + set.type() + "\"> is not supported; a Gaussian is used");
    for (const char* tag : {"float", "integer"}) set.objects(tag);
  }
  if (!(std::abs(filter.b) <= 2.0f && std::abs(filter.c) <= 2.0f)) {
    fail(set.where(), set.shown() + " needs B and C between -2 and 2");
  }
  if (!(filter.radius.x > 0.0f && filter.radius.x <= 64.0f)) {
    fail(set.where(), set.shown() + " needs a radius between 0 and 64 pixels");
  }
  set.warn_unused(state.warnings);
  return filter;
}

// Half the image's width at distance 1, of the whole image.
double half_width(const Properties& set, const Film& film) {
  const double aspect = double(film.width) / film.height;
  double degrees = 0.0;
  std::string axis = "diagonal";
  if (set.has("fov")) {
    degrees = double(set.get_float("fov", 0.0f));
    axis = plain(set.get_string("fov_axis", "x"));
  } else {
    // Of a lens in front of 35 mm film.
    std::string text = set.get_string("focal_length", "50mm");
    if (text.ends_with("mm")) text.resize(text.size() - 2);
    const std::vector<double> focal_length = numbers_of(set.element(), text);
    if (focal_length.size() != 1 || !(focal_length[0] > 0.0)) {
      fail(set.where(), set.shown() + " needs a focal length such as 50mm");
    }
    degrees = glm::degrees(2.0 * std::atan(std::hypot(36.0, 24.0) / (2.0 * focal_length[0])));
  }
  if (!(degrees > 0.0 && degrees < 180.0)) {
    fail(set.where(), set.shown() + " needs a fov between 0 and 180 degrees");
  }
  const double half = std::tan(0.5 * glm::radians(degrees));
  if (axis == "smaller") axis = aspect > 1.0 ? "y" : "x";
  if (axis == "larger") axis = aspect > 1.0 ? "x" : "y";
  if (axis == "x") return half;
  if (axis == "y") return half * aspect;
  if (axis == "diagonal") return half / std::sqrt(1.0 + 1.0 / (aspect * aspect));
  fail(set.where(), "fov_axis is x, y, diagonal, smaller or larger, not \"" + axis + "\"");
}

// From Mitsuba's frame, whose +x is on the left.
glm::mat4 camera_to_world(const glm::dmat4& m) {
  return glm::mat4(glm::vec4(glm::normalize(glm::vec3(-m[0])), 0.0f),
                   glm::vec4(glm::normalize(glm::vec3(m[1])), 0.0f),
                   glm::vec4(glm::normalize(glm::vec3(m[2])), 0.0f),
                   glm::vec4(glm::vec3(m[3]), 1.0f));
}

// Where the middle of the crop window, moved by the principal point, lies in the whole image, and
// the window's size.
void set_window(const Properties& set, const Film& film, double half, CameraDescription& camera) {
  const double pixel = 2.0 * half / film.width;
  const double shorter = std::min(film.crop_size.x, film.crop_size.y);
  const bool perspective = camera.projection == CameraDescription::Projection::Perspective;
  camera.fov_degrees = float(glm::degrees(2.0 * std::atan(0.5 * pixel * shorter)));
  if (!perspective) camera.extent = float(pixel * shorter);
  const double x = film.crop_offset.x + 0.5 * film.crop_size.x - 0.5 * film.width +
                   double(set.get_float("principal_point_offset_x", 0.0f)) * film.width;
  const double y = film.crop_offset.y + 0.5 * film.crop_size.y - 0.5 * film.height +
                   double(set.get_float("principal_point_offset_y", 0.0f)) * film.height;
  camera.shift = {float(x / shorter), float(0.0 - y / shorter)};
}

CameraDescription read_camera(State& state, const Properties& set, const Film& film) {
  const bool thin_lens = set.type() == "thinlens";
  const bool orthographic = set.type() == "orthographic";
  if (!thin_lens && !orthographic && set.type() != "perspective") {
    state.warnings.add(set.where(), "<sensor type=\"" + set.element().attribute("type") +
                                        "\"> is not supported; a perspective camera is used");
  }
  const glm::dmat4 m = set.get_transform("to_world", state.warnings);
  CameraDescription camera;
  camera.camera_to_world = camera_to_world(m);
  if (orthographic) {
    camera.projection = CameraDescription::Projection::Orthographic;
    set_window(set, film, glm::length(glm::dvec3(m[0])), camera);
  } else {
    set_window(set, film, half_width(set, film), camera);
  }
  const float focal_distance = set.get_float("focus_distance", camera.focal_distance);
  const float aperture = set.get_float("aperture_radius", 0.0f);
  if (thin_lens && !(aperture >= 0.0f && focal_distance > 0.0f)) {
    fail(set.where(), set.shown() + " needs an aperture_radius and a focus_distance above 0");
  }
  if (thin_lens) {
    camera.lens_radius = aperture;
    camera.focal_distance = focal_distance;
  }
  set.ignore({"near_clip", "far_clip", "shutter_open", "shutter_close", "srf"});
  return camera;
}

void read_sampler(State& state, const Properties& sensor) {
  int samples = 4;
  for (const Property* p : sensor.objects("sampler")) {
    // The command line chooses the sampler; only the file's sample count matters.
    const Properties set = state.properties(p->element);
    samples = set.get_int("sample_count", samples);
    if (samples < 1) fail(set.where(), "<sampler> needs a sample_count above 0");
  }
  state.scene.defaults.spp = samples;
}

}  // namespace

void read_sensor(State& state, const Element& element) {
  const Properties set = state.properties(element);
  const std::vector<const Property*> films = set.objects("film");
  Film film;
  film.crop_size = {film.width, film.height};
  PixelFilter filter = read_filter(state, nullptr);
  if (!films.empty()) {
    const Properties film_set = state.properties(films.front()->element);
    film = read_film(state, film_set);
    filter = read_filter(state, &film_set);
  }
  state.scene.film = {film.crop_size.x, film.crop_size.y, filter};
  state.scene.camera = read_camera(state, set, film);
  read_sampler(state, set);
  if (!set.objects("medium").empty()) {
    state.warnings.add(set.where(), "participating media are not supported; they are left out");
  }
  set.warn_unused(state.warnings);
}

}  // namespace lockstep::mitsuba
