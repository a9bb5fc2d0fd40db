#include "tests/fuzz/digest.h"

#include "core/expand_shapes.h"
#include "core/flatten.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

namespace lockstep::fuzz {
namespace {

bool is_finite(float v) { return std::isfinite(v); }
template <int N>
bool is_finite(const glm::vec<N, float>& v) {
  for (int i = 0; i < N; ++i) {
    if (!std::isfinite(v[i])) return false;
  }
  return true;
}
bool is_finite(const glm::mat4& m) {
  return is_finite(m[0]) && is_finite(m[1]) && is_finite(m[2]) && is_finite(m[3]);
}

template <class T>
bool all_finite(const std::vector<T>& values) {
  return std::all_of(values.begin(), values.end(), [](const T& v) { return is_finite(v); });
}

bool is_index(int i, std::size_t count) { return i >= 0 && std::size_t(i) < count; }

void check_mesh(const TriangleMesh& mesh) {
  const std::size_t count = mesh.positions.size();
  require(mesh.normals.empty() || mesh.normals.size() == count, "normals do not match positions");
  require(mesh.uvs.empty() || mesh.uvs.size() == count, "uvs do not match positions");
  require(all_finite(mesh.positions), "a position is not finite");
  require(all_finite(mesh.normals), "a normal is not finite");
  require(all_finite(mesh.uvs), "a texture coordinate is not finite");
  for (const glm::uvec3 t : mesh.triangles) {
    require(t.x < count && t.y < count && t.z < count, "a triangle's vertex does not exist");
  }
}

void check_shape(const SceneDescription& scene, const Shape& shape) {
  require(is_index(shape.material, scene.materials.size()), "a shape's material does not exist");
  if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) check_mesh(*mesh);
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
    require(is_finite(sphere->center), "a sphere's centre is not finite");
    require(is_finite(sphere->radius) && sphere->radius > 0.0f, "a sphere has no radius");
  }
  if (const auto* disk = std::get_if<Disk>(&shape.geometry)) {
    require(is_finite(disk->center) && is_finite(disk->normal), "a disk is not finite");
    require(is_finite(disk->radius) && disk->radius > 0.0f, "a disk has no radius");
  }
  if (shape.emission) {
    require(is_finite(shape.emission->radiance.value), "a radiance is not finite");
    require(shape.emission->radiance.texture < int(scene.textures.size()),
            "an emission's texture does not exist");
  }
}

void check_lights(const SceneDescription& scene) {
  for (const LightSource& light : scene.lights) {
    if (const auto* point = std::get_if<PointLight>(&light)) {
      require(is_finite(point->position) && is_finite(point->intensity), "a point light");
    } else if (const auto* spot = std::get_if<SpotLight>(&light)) {
      require(is_finite(spot->position) && is_finite(spot->intensity), "a spot light");
      require(is_finite(spot->direction), "a spot light's direction");
      require(std::abs(spot->cos_inner) <= 1.0f && std::abs(spot->cos_outer) <= 1.0f,
              "a spot light's cone");
    } else if (const auto* distant = std::get_if<DistantLight>(&light)) {
      require(is_finite(distant->direction) && is_finite(distant->irradiance), "a distant light");
    }
  }
  if (!scene.environment) return;
  require(is_finite(scene.environment->radiance), "the environment's radiance is not finite");
  for (int i = 0; i < 3; ++i) {
    require(is_finite(scene.environment->to_world[i]), "the environment's frame is not finite");
  }
}

void check_camera(const CameraDescription& camera, const FilmDescription& film) {
  require(is_finite(camera.camera_to_world), "the camera's frame is not finite");
  require(camera.fov_degrees > 0.0f && camera.fov_degrees < 180.0f, "the field of view");
  require(is_finite(camera.extent) && camera.extent > 0.0f, "the extent of the view");
  require(is_finite(camera.shift), "the camera's shift is not finite");
  require(is_finite(camera.lens_radius) && is_finite(camera.focal_distance), "the lens");
  constexpr double most_pixels = 1 << 30;
  require(film.width > 0 && film.height > 0 && double(film.width) * film.height <= most_pixels,
          "the number of pixels");
  require(is_finite(film.filter.radius) && film.filter.radius.x > 0.0f &&
              film.filter.radius.y > 0.0f && is_finite(film.filter.sigma),
          "the pixel filter");
}

struct TextureCheck {
  const SceneDescription& scene;

  void operator()(const ColorInput& input) const {
    require(is_finite(input.value), "a colour is not finite");
    require(input.texture < int(scene.textures.size()), "a colour's texture does not exist");
  }
  void operator()(const FloatInput& input) const {
    require(is_finite(input.value) && is_finite(input.power), "a number is not finite");
    require(input.texture < int(scene.textures.size()), "a number's texture does not exist");
    require(input.channel < 4, "a texture's channel does not exist");
  }
  void operator()(const UvTransform& uv) const {
    require(is_finite(uv.u_row) && is_finite(uv.v_row) && is_finite(uv.offset),
            "a transform of texture coordinates is not finite");
  }
  void operator()(const ImageTexture& t) const { (*this)(t.uv); }
  void operator()(const CheckerboardTexture& t) const {
    (*this)(t.even), (*this)(t.odd), (*this)(t.uv);
  }
  void operator()(const ProductTexture& t) const { (*this)(t.a), (*this)(t.b); }
  void operator()(const MixTexture& t) const { (*this)(t.a), (*this)(t.b), (*this)(t.amount); }
};

// Models that a kernel gets rows of; what they hold is checked there.
void check_materials(const SceneDescription& scene) {
  const TextureCheck check{scene};
  for (const Texture& texture : scene.textures) std::visit(check, texture);
  for (const Material& material : scene.materials) {
    check(material.opacity);
    if (material.bump) check(*material.bump);
    require(material.normal_map < int(scene.textures.size()), "a normal map does not exist");
  }
}

// Of large scenes the time to flatten them is not the reader's.
bool is_small(const SceneDescription& scene) {
  constexpr std::size_t tessellated = 2048, largest = 20'000;
  std::size_t sum = scene.instances.size();
  const auto add = [&](const std::vector<Shape>& shapes) {
    for (const Shape& shape : shapes) {
      const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
      sum += mesh ? mesh->positions.size() + mesh->triangles.size() : tessellated;
    }
  };
  add(scene.shapes);
  for (const ObjectDescription& object : scene.objects) add(object.shapes);
  return sum <= largest;
}

void check_flat(const SceneDescription& scene) {
  const FlatScene flat = flatten(scene);
  require(all_finite(flat.positions), "a flat position is not finite");
  require(all_finite(flat.normals), "a flat normal is not finite");
  require(all_finite(flat.spheres), "a flat sphere is not finite");
  require(all_finite(flat.material_parameters), "a material's parameter is not finite");
  require(all_finite(flat.light_cdf), "a light's probability is not finite");
  for (const TextureBinding& b : flat.texture_bindings) {
    require(b.texture < int(scene.textures.size()), "a material's texture does not exist");
    require(is_finite(b.scale) && is_finite(b.power), "a texture's factor is not finite");
  }
  require(all_finite(flat.instance_rows), "an instance's row is not finite");
  for (const FlatInstance& i : flat.instances) {
    require(is_index(i.object, flat.objects.size()), "a flat instance's object does not exist");
  }
  for (const FlatObject& o : flat.objects) {
    require(std::size_t(o.first_geometry) + o.geometry_count <= flat.geometries.size(),
            "a flat object's geometry does not exist");
  }
  const auto vertices = std::int32_t(flat.positions.size() / 3);
  for (const std::int32_t i : flat.triangles) {
    require(i >= 0 && i < vertices, "a flat triangle's vertex does not exist");
  }
}

}  // namespace

void check_usable(SceneDescription scene) {
  for (const Shape& shape : scene.shapes) check_shape(scene, shape);
  for (const ObjectDescription& object : scene.objects) {
    for (const Shape& shape : object.shapes) check_shape(scene, shape);
  }
  for (const Instance& instance : scene.instances) {
    require(is_index(instance.object, scene.objects.size()), "an instance's object does not exist");
    require(is_finite(instance.to_world), "an instance's transform is not finite");
  }
  check_materials(scene);
  check_lights(scene);
  check_camera(scene.camera, scene.film);
  if (!is_small(scene)) return;
  expand_shapes(scene);
  check_flat(scene);
}

}  // namespace lockstep::fuzz
