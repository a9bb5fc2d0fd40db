#include "core/pbrt/surfaces.h"

#include "core/pbrt/materials.h"
#include "core/pbrt/media.h"
#include "core/pbrt/textures.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>
#include <variant>

namespace lockstep::pbrt {

namespace {

constexpr int invisible = -1;

int declared_material(Library& library, const MaterialReference& reference) {
  if (reference.name.empty()) return reference.declared;
  const int* found = library.named_materials.find(reference.name, reference.order);
  if (found == nullptr) {
    fail(reference.where, "NamedMaterial \"" + reference.name + "\" has not been defined");
  }
  return *found;
}

// Whether a medium inside could be seen.
bool passes_light(const Material& material) {
  return std::holds_alternative<DielectricMaterial>(material.model) ||
         std::holds_alternative<MixMaterial>(material.model);
}

// `material` with what absorbs inside of its dielectrics. `copies`: of the parts of mixes, which
// may have parts in common.
Material with_absorption(Library& library, Material material, glm::vec3 absorption,
                         std::map<int, int>& copies) {
  if (auto* glass = std::get_if<DielectricMaterial>(&material.model)) {
    glass->absorption = absorption;
  } else if (auto* mix = std::get_if<MixMaterial>(&material.model)) {
    for (int* part : {&mix->first, &mix->second}) {
      const Material& original = library.scene_materials[static_cast<size_t>(*part)];
      if (!passes_light(original)) continue;
      const auto [known, added] = copies.try_emplace(*part, 0);
      if (added) {
        Material copy = original;
        copy = with_absorption(library, std::move(copy), absorption, copies);
        known->second = add_material(library, std::move(copy));
      }
      *part = known->second;
    }
  }
  return material;
}

// Finds or makes the scene's material for each surface.
class Surfaces {
 public:
  explicit Surfaces(State& state) : library_(state.library), surfaces_(state.surfaces) {}

  // `emits`: the shape must stay even if nothing but its light is visible.
  int material(int surface, bool emits) {
    const Surface& s = surfaces_[static_cast<size_t>(surface)];
    MaterialDeclaration& declaration =
        library_.materials[static_cast<size_t>(declared_material(library_, s.material))];
    const std::optional<Material>& made = made_material(library_, declaration);
    const glm::vec3 absorption = get_absorption(s, made);
    if (!made) return interface(s, absorption, emits);
    const FloatInput opacity = get_opacity(s);
    if (absorption == glm::vec3(0.0f) && opacity == FloatInput(1.0f)) {
      if (declaration.scene_index < 0) declaration.scene_index = add_material(library_, *made);
      return declaration.scene_index;
    }
    const Key key{&declaration, absorption.x,  absorption.y,
                  absorption.z, opacity.value, opacity.texture};
    const auto [known, added] = variants_.try_emplace(key, 0);
    if (added) known->second = variant(*made, absorption, opacity);
    return known->second;
  }

 private:
  using Key = std::tuple<const MaterialDeclaration*, float, float, float, float, int>;

  int variant(const Material& made, glm::vec3 absorption, const FloatInput& opacity) {
    Material copy = made;
    std::map<int, int> copies;
    if (absorption != glm::vec3(0.0f)) copy = with_absorption(library_, copy, absorption, copies);
    multiply_opacity(library_, copy, opacity);
    return add_material(library_, std::move(copy));
  }

  // Of what light passes through; zero for other materials.
  glm::vec3 get_absorption(const Surface& s, const std::optional<Material>& made) {
    if (s.medium.empty() || (made && !passes_light(*made))) return glm::vec3(0.0f);
    return medium_absorption(library_, s.medium, s.order, s.where);
  }

  FloatInput get_opacity(const Surface& s) {
    if (s.alpha_texture.empty()) return s.alpha;
    return float_texture(library_, s.alpha_texture, s.order, s.where);
  }

  int interface(const Surface& s, glm::vec3 absorption, bool emits) {
    if (absorption != glm::vec3(0.0f)) {
      library_.warnings.add(
          s.where, "media inside of interface materials are not supported; they are left out");
    }
    if (!emits) return invisible;
    library_.warnings.add(s.where, "lights with an interface material are black to other light");
    if (black_ < 0) black_ = add_material(library_, DiffuseMaterial{glm::vec3(0.0f)});
    return black_;
  }

  Library& library_;
  const std::vector<Surface>& surfaces_;
  std::map<Key, int> variants_;
  int black_ = -1;
};

void settle_shapes(Surfaces& surfaces, std::vector<Shape>& shapes) {
  for (Shape& shape : shapes) {
    shape.material = surfaces.material(shape.material, shape.emission.has_value());
  }
  std::erase_if(shapes, [](const Shape& shape) { return shape.material == invisible; });
}

void settle_instances(State& state, Surfaces& surfaces) {
  for (const InstanceReference& instance : state.instances) {
    ObjectDeclaration* object = state.objects.find(instance.name, instance.order);
    if (object == nullptr) {
      fail(instance.where, "the object \"" + instance.name + "\" has not been defined");
    }
    if (object->scene_index < 0) {
      settle_shapes(surfaces, object->shapes);
      if (object->shapes.empty()) continue;
      object->scene_index = static_cast<int>(state.scene.objects.size());
      state.scene.objects.push_back({std::move(object->shapes)});
    }
    state.scene.instances.push_back({object->scene_index, instance.to_world});
  }
}

}  // namespace

void settle_surfaces(State& state) {
  for (const MaterialReference& m : state.unknown_materials) declared_material(state.library, m);
  Surfaces surfaces(state);
  settle_shapes(surfaces, state.scene.shapes);
  settle_instances(state, surfaces);
  state.scene.textures = std::move(state.library.scene_textures);
  state.scene.measured = std::move(state.library.scene_measured);
  state.scene.materials = std::move(state.library.scene_materials);
}

}  // namespace lockstep::pbrt
