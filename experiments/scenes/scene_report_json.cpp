#include "experiments/scenes/camera_override.h"
#include "experiments/scenes/scene_report.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace lockstep {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(glm::vec3 v) { return {v.x, v.y, v.z}; }

Json counts_json(const ShapeCounts& c) {
  return {{"meshes", c.meshes},
          {"spheres", c.spheres},
          {"disks", c.disks},
          {"triangles", c.triangles},
          {"vertices", c.vertices}};
}

Json geometry_json(const SceneReport& r) {
  Json bounds;
  if (!r.bounds.empty()) bounds = {vector_json(r.bounds.lo), vector_json(r.bounds.hi)};
  return {{"shapes", counts_json(r.own)},          {"objects", r.object_count},
          {"in_objects", counts_json(r.objects)},  {"instances", r.instance_count},
          {"in_instances", counts_json(r.placed)}, {"bounds", bounds},
          {"memory_bytes", r.geometry_bytes}};
}

Json materials_json(const std::vector<MaterialCounts>& materials) {
  Json list = Json::array();
  for (const MaterialCounts& m : materials) {
    list.push_back({{"model", m.model},
                    {"count", m.count},
                    {"textured", m.textured},
                    {"opacity", m.opacity},
                    {"normal_map", m.normal_map},
                    {"bump", m.bump}});
  }
  return list;
}

Json image_json(const ImageReport& image) {
  if (!image.error.empty()) return {{"file", image.file}, {"error", image.error}};
  return {{"file", image.file},
          {"resolution", {image.width, image.height}},
          {"stored", image.stored},
          {"memory_bytes", image.memory_bytes}};
}

Json environment_json(const EnvironmentReport& e) {
  constexpr const char* mappings[] = {"constant", "latitude-longitude", "equal-area octahedral"};
  Json json{{"mapping", mappings[int(e.environment.mapping)]},
            {"radiance", vector_json(e.environment.radiance)}};
  if (e.environment.mapping == Environment::Mapping::Constant) return json;
  json["image"] = image_json(e.image);
  if (e.image.error.empty()) json["mean_radiance"] = vector_json(e.mean_radiance);
  return json;
}

Json lights_json(const SceneReport& r) {
  Json emitters = counts_json(r.emitters.counts);
  emitters["two_sided"] = r.emitters.two_sided;
  emitters["textured"] = r.emitters.textured;
  return {{"emitting_shapes", emitters},
          {"point", r.lights.point},
          {"spot", r.lights.spot},
          {"distant", r.lights.distant},
          {"environment", r.environment ? environment_json(*r.environment) : Json()}};
}

Json camera_json(const CameraDescription& camera) {
  const glm::mat4& m = camera.camera_to_world;
  const bool perspective = camera.projection == CameraDescription::Projection::Perspective;
  Json json{{"projection", perspective ? "perspective" : "orthographic"},
            {"position", vector_json(glm::vec3(m[3]))},
            {"right", vector_json(glm::normalize(glm::vec3(m[0])))},
            {"up", vector_json(glm::normalize(glm::vec3(m[1])))},
            {"direction", vector_json(glm::normalize(glm::vec3(m[2])))},
            {"left_handed", glm::determinant(glm::mat3(m)) > 0.0f}};
  if (perspective) json["fov_degrees"] = camera.fov_degrees;
  if (!perspective) json["extent"] = camera.extent;
  json["shift"] = {camera.shift.x, camera.shift.y};
  json["lens_radius"] = camera.lens_radius;
  json["focal_distance"] = camera.focal_distance;
  json["override"] = to_string(override_of(camera));
  return json;
}

Json film_json(const FilmDescription& film) {
  constexpr const char* kinds[] = {"box", "triangle", "gaussian", "mitchell", "lanczos"};
  const PixelFilter& filter = film.filter;
  Json filter_json{{"kind", kinds[int(filter.kind)]},
                   {"radius", {filter.radius.x, filter.radius.y}}};
  if (filter.kind == PixelFilter::Kind::Gaussian) filter_json["sigma"] = filter.sigma;
  if (filter.kind == PixelFilter::Kind::Mitchell) {
    filter_json["b"] = filter.b;
    filter_json["c"] = filter.c;
  }
  if (filter.kind == PixelFilter::Kind::Lanczos) filter_json["tau"] = filter.tau;
  return {{"resolution", {film.width, film.height}}, {"filter", filter_json}};
}

}  // namespace

nlohmann::ordered_json report_json(const SceneReport& r) {
  Json textures = Json::object();
  for (const TextureCount& t : r.textures) textures[std::string(t.kind)] = t.count;
  Json images = Json::array();
  for (const ImageReport& image : r.images) images.push_back(image_json(image));
  return {{"scene", r.scene},
          {"format", format_name(r.format)},
          {"read_seconds", r.read_seconds},
          {"image_seconds", r.image_seconds},
          {"geometry", geometry_json(r)},
          {"materials", materials_json(r.materials)},
          {"textures", textures},
          {"images", images},
          {"lights", lights_json(r)},
          {"camera", camera_json(r.camera)},
          {"film", film_json(r.film)},
          {"spp", r.defaults.spp},
          {"depth", r.defaults.depth},
          {"warnings", r.warnings}};
}

}  // namespace lockstep
