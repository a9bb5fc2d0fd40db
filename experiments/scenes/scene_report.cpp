#include "experiments/scenes/scene_report.h"

#include "core/environment_map.h"
#include "core/texture_image.h"

#include <tbb/parallel_for.h>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <limits>
#include <set>
#include <tuple>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

void count(const Shape& shape, ShapeCounts& counts) {
  const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
  counts.meshes += mesh != nullptr;
  counts.spheres += std::holds_alternative<Sphere>(shape.geometry);
  counts.disks += std::holds_alternative<Disk>(shape.geometry);
  if (!mesh) return;
  counts.triangles += mesh->triangles.size();
  counts.vertices += mesh->positions.size();
}

void add(ShapeCounts& sum, const ShapeCounts& c) {
  sum.meshes += c.meshes;
  sum.spheres += c.spheres;
  sum.disks += c.disks;
  sum.triangles += c.triangles;
  sum.vertices += c.vertices;
}

std::size_t memory_bytes(const Shape& shape) {
  const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
  if (!mesh) return 0;
  return mesh->positions.size() * sizeof(glm::vec3) + mesh->normals.size() * sizeof(glm::vec3) +
         mesh->uvs.size() * sizeof(glm::vec2) + mesh->triangles.size() * sizeof(glm::uvec3);
}

void report_geometry(const SceneDescription& scene, SceneReport& report) {
  report.bounds = bounds_of(scene);
  for (const Shape& shape : scene.shapes) {
    count(shape, report.own);
    report.geometry_bytes += memory_bytes(shape);
  }
  std::vector<ShapeCounts> counts(scene.objects.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    for (const Shape& shape : scene.objects[i].shapes) {
      count(shape, counts[i]);
      report.geometry_bytes += memory_bytes(shape);
    }
    add(report.objects, counts[i]);
  }
  for (const Instance& instance : scene.instances) {
    add(report.placed, counts[std::size_t(instance.object)]);
  }
  report.object_count = scene.objects.size();
  report.instance_count = scene.instances.size();
}

template <class... Input>
bool any_textured(const Input&... inputs) {
  return (... || (inputs.texture >= 0));
}

bool textured(const DiffuseMaterial& m) { return any_textured(m.reflectance, m.sigma); }
bool textured(const DiffuseTransmissionMaterial& m) {
  return any_textured(m.reflectance, m.transmittance);
}
bool textured(const ConductorMaterial& m) {
  return any_textured(m.eta, m.k, m.alpha_scale, m.specular);
}
bool textured(const CoatedMaterial& m) {
  return any_textured(m.diffuse, m.specular, m.alpha_scale);
}
bool textured(const DielectricMaterial& m) {
  return any_textured(m.alpha_scale, m.reflectance, m.transmittance);
}
bool textured(const PrincipledMaterial& m) {
  return any_textured(m.base_color, m.metallic, m.alpha, m.specular, m.transmission, m.coat,
                      m.coat_alpha);
}
bool textured(const MeasuredMaterial&) { return false; }
bool textured(const MixMaterial& m) { return any_textured(m.amount); }

std::vector<MaterialCounts> count_materials(const std::vector<Material>& materials) {
  // In the order of MaterialModel.
  std::array<MaterialCounts, std::variant_size_v<MaterialModel>> models{{{"diffuse"},
                                                                         {"diffuse transmission"},
                                                                         {"conductor"},
                                                                         {"coated diffuse"},
                                                                         {"dielectric"},
                                                                         {"principled"},
                                                                         {"measured"},
                                                                         {"mix"}}};
  for (const Material& material : materials) {
    MaterialCounts& c = models[material.model.index()];
    ++c.count;
    c.textured += std::visit([](const auto& m) { return textured(m); }, material.model);
    c.opacity += material.opacity != FloatInput(1.0f);
    c.normal_map += material.normal_map >= 0;
    c.bump += material.bump.has_value();
  }
  std::vector<MaterialCounts> present;
  std::copy_if(models.begin(), models.end(), std::back_inserter(present),
               [](const MaterialCounts& c) { return c.count > 0; });
  return present;
}

std::vector<TextureCount> count_textures(const std::vector<Texture>& textures) {
  // In the order of Texture.
  std::array<TextureCount, std::variant_size_v<Texture>> kinds{
      {{"image"}, {"checkerboard"}, {"product"}, {"mix"}}};
  for (const Texture& texture : textures) ++kinds[texture.index()].count;
  std::vector<TextureCount> present;
  std::copy_if(kinds.begin(), kinds.end(), std::back_inserter(present),
               [](const TextureCount& c) { return c.count > 0; });
  return present;
}

std::string short_name(const std::string& file, const std::string& scene) {
  const fs::path relative = fs::path(file).lexically_normal().lexically_relative(
      fs::path(scene).lexically_normal().parent_path());
  const std::string text = relative.string();
  return text.empty() || text.starts_with("..") ? file : text;
}

std::string stored_as(TexelFormat format, bool decoded, TextureEncoding encoding) {
  switch (format) {
    case TexelFormat::Byte:
      if (!decoded) return "8-bit linear";
      return encoding == TextureEncoding::Gamma ? "8-bit gamma" : "8-bit sRGB";
    case TexelFormat::Short:
      return "16-bit";
    case TexelFormat::Half:
      return "half";
    case TexelFormat::Float:
      break;
  }
  return "float";
}

void read_image_of(const ImageTexture& texture, ImageReport& report) {
  try {
    const TextureImage image = read_texture_image(texture);
    report.stored = stored_as(image.format, !image.decode.empty(), texture.encoding);
    report.width = image.width();
    report.height = image.height();
    report.memory_bytes = image.memory_bytes();
  } catch (const std::exception& error) {
    report.error = error.what();
  }
}

// One for each image that is kept: textures that differ in their lookup alone share it.
std::vector<ImageReport> report_images(const SceneDescription& scene, const std::string& path) {
  std::set<std::tuple<std::string, const void*, TextureEncoding, float>> known;
  std::vector<const ImageTexture*> images;
  for (const Texture& texture : scene.textures) {
    const auto* image = std::get_if<ImageTexture>(&texture);
    if (!image) continue;
    const float gamma = image->encoding == TextureEncoding::Gamma ? image->gamma : 0.0f;
    if (known.emplace(image->file, image->encoded.get(), image->encoding, gamma).second) {
      images.push_back(image);
    }
  }
  std::vector<ImageReport> reports(images.size());
  tbb::parallel_for(std::size_t(0), images.size(), [&](std::size_t i) {
    const bool on_disk = !images[i]->encoded;
    reports[i].file = on_disk ? short_name(images[i]->file, path) : images[i]->file;
    read_image_of(*images[i], reports[i]);
  });
  return reports;
}

EmitterCounts count_emitters(const std::vector<Shape>& shapes) {
  EmitterCounts emitters;
  for (const Shape& shape : shapes) {
    if (!shape.emission) continue;
    count(shape, emitters.counts);
    emitters.two_sided += shape.emission->two_sided;
    emitters.textured += shape.emission->radiance.texture >= 0;
  }
  return emitters;
}

LightCounts count_lights(const std::vector<LightSource>& lights) {
  LightCounts counts;
  for (const LightSource& light : lights) {
    counts.point += std::holds_alternative<PointLight>(light);
    counts.spot += std::holds_alternative<SpotLight>(light);
    counts.distant += std::holds_alternative<DistantLight>(light);
  }
  return counts;
}

EnvironmentReport report_environment(const Environment& environment, const std::string& path) {
  EnvironmentReport report{environment, {}, environment.radiance};
  if (environment.mapping == Environment::Mapping::Constant) return report;
  report.image.file = short_name(environment.file, path);
  try {
    const EnvironmentMap map(environment);
    const TexelData texels = map.view().texels;
    report.image.width = texels.width;
    report.image.height = texels.height;
    report.image.stored = stored_as(texels.format, texels.decode, TextureEncoding::ByFormat);
    report.image.memory_bytes = map.memory_bytes();
    report.mean_radiance = map.mean_radiance();
  } catch (const std::exception& error) {
    report.image.error = error.what();
  }
  return report;
}

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

SceneReport report_scene(const std::string& path) {
  SceneReport report;
  report.scene = path;
  report.format = scene_format(path);
  const Clock::time_point start = Clock::now();
  const SceneDescription scene = read_scene(path);
  report.read_seconds = seconds_since(start);

  report_geometry(scene, report);
  report.materials = count_materials(scene.materials);
  report.textures = count_textures(scene.textures);
  report.emitters = count_emitters(scene.shapes);
  report.lights = count_lights(scene.lights);
  report.camera = scene.camera;
  report.film = scene.film;
  report.defaults = scene.defaults;
  report.warnings = scene.warnings;

  const Clock::time_point images_start = Clock::now();
  report.images = report_images(scene, path);
  if (scene.environment) report.environment = report_environment(*scene.environment, path);
  report.image_seconds = seconds_since(images_start);
  return report;
}

}  // namespace lockstep
