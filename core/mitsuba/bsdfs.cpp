#include "core/mitsuba/bsdfs.h"

#include "core/mitsuba/colors.h"
#include "core/mitsuba/textures.h"
#include "core/mitsuba/values.h"

#include <algorithm>
#include <numeric>
#include <string_view>

namespace lockstep::mitsuba {
namespace {

void warn(const BsdfCall& call, const std::string& what) {
  call.state.warnings.add(call.set.where(), what);
}

// The model inside; a diffuse grey where there is none.
std::optional<Material> nested(const BsdfCall& call, bool two_sided) {
  const std::vector<const Property*> inside = call.set.objects("bsdf");
  if (inside.empty()) {
    warn(call, call.set.shown() + " has no model inside; a diffuse grey is used");
    Material grey;
    grey.two_sided = two_sided;
    return grey;
  }
  if (inside.size() > 1) {
    warn(call, call.set.shown() + ": of several models inside the first is used");
  }
  return make_material(call.state, inside.front()->element, two_sided);
}

std::optional<Material> two_sided(const BsdfCall& call) { return nested(call, true); }

std::optional<Material> none(const BsdfCall&) { return std::nullopt; }

// A share; constants are kept in [0, 1].
FloatInput get_share(const BsdfCall& call, const char* name) {
  FloatInput share = get_number(call.state, call.set, name, 0.5f);
  if (share.texture < 0) share.value = std::clamp(share.value, 0.0f, 1.0f);
  return share;
}

// A share of what is there already.
void thin_out(const BsdfCall& call, Material& m, const FloatInput& opacity) {
  if (m.opacity == FloatInput(1.0f)) {
    m.opacity = opacity;
  } else if (opacity.texture < 0) {
    m.opacity.value *= opacity.value;
  } else {
    warn(call, "masks inside masks are not supported; the inner one is used");
  }
}

std::optional<Material> mask(const BsdfCall& call) {
  std::optional<Material> m = nested(call, call.two_sided);
  const FloatInput opacity = get_share(call, "opacity");
  if (m) thin_out(call, *m, opacity);
  return m;
}

std::optional<Material> bump_map(const BsdfCall& call) {
  std::optional<Material> m = nested(call, call.two_sided);
  const float scale = call.set.get_float("scale", 1.0f);
  for (const Property* texture : call.set.objects("texture")) {
    const TextureInput input = read_texture(call.state, texture->element);
    if (!m || input.color.texture < 0) continue;
    const glm::vec3 factor = input.color.value;
    m->bump = FloatInput(scale * (factor.x + factor.y + factor.z) / 3.0f);
    m->bump->texture = input.color.texture;
    m->bump->channel = input.channel;
  }
  call.set.ignore({"flip_invalid_normals", "use_shadowing_function"});
  return m;
}

std::optional<Material> normal_map(const BsdfCall& call) {
  std::optional<Material> m = nested(call, call.two_sided);
  for (const Property* texture : call.set.objects("texture")) {
    const TextureInput input = read_texture(call.state, texture->element);
    if (m) m->normal_map = input.color.texture;
  }
  call.set.ignore({"flip_invalid_normals", "use_shadowing_function"});
  return m;
}

// Exact, but for light that the coat reflects back inside, over a diffuse model alone.
std::optional<Material> coating(const BsdfCall& call) {
  std::optional<Material> m = nested(call, call.two_sided);
  const bool rough = call.set.type() == "roughcoating";
  CoatedMaterial coated;
  coated.eta = relative_index(call, "bk7");
  coated.specular = get_reflectance(call.state, call.set, "specular_reflectance", 1.0f);
  coated.alpha = 0.0f;
  if (rough) {
    const Roughness roughness = get_roughness(call, 0.1f);
    coated.alpha = roughness.alpha.x;
    coated.alpha_scale = roughness.scale;
  }
  call.set.ignore({"thickness"});
  if (call.set.find("sigma_a") != nullptr) warn(call, "absorption in coatings is not supported");
  if (!m) return m;
  const auto* base = std::get_if<DiffuseMaterial>(&m->model);
  if (base != nullptr && coated.eta > 1.0f) {
    coated.diffuse = base->reflectance;
    m->model = coated;
  } else if (auto* principled = std::get_if<PrincipledMaterial>(&m->model)) {
    principled->coat = 1.0f;
    principled->coat_alpha = coated.alpha;
  } else {
    warn(call, "coatings are supported over diffuse models only; this one is left out");
  }
  return m;
}

// A share `amount` of `second`; nothing to see counts as a hole.
std::optional<Material> mix(const BsdfCall& call, const Element& first, const Element& second,
                            const FloatInput& amount) {
  const std::optional<int> a = material_index(call.state, first, call.two_sided);
  const std::optional<int> b = material_index(call.state, second, call.two_sided);
  if (!a && !b) return std::nullopt;
  if (!a || !b) {
    Material seen = call.state.scene.materials[size_t(a ? *a : *b)];
    if (!a) {
      thin_out(call, seen, amount);
    } else if (amount.texture < 0) {
      thin_out(call, seen, 1.0f - amount.value);
    } else {
      warn(call, "holes where a texture is bright are not supported; the surface is closed");
    }
    return seen;
  }
  const std::vector<Material>& materials = call.state.scene.materials;
  Material m(MixMaterial{*a, *b, amount});
  m.two_sided = materials[size_t(*a)].two_sided || materials[size_t(*b)].two_sided;
  return m;
}

std::optional<Material> blend(const BsdfCall& call) {
  const std::vector<const Property*> inside = call.set.objects("bsdf");
  if (inside.size() != 2) fail(call.set.where(), call.set.shown() + " needs two models inside");
  const FloatInput weight = get_share(call, "weight");
  return mix(call, inside[0]->element, inside[1]->element, weight);
}

std::vector<double> mixture_weights(const BsdfCall& call, std::size_t count) {
  std::vector<double> weights = numbers_of(call.set.element(), call.set.get_string("weights", ""));
  const bool proper = std::all_of(weights.begin(), weights.end(), [](double w) { return w >= 0; });
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (weights.size() != count || !proper || !(sum > 0.0)) {
    fail(call.set.where(), call.set.shown() + " needs a weight of 0 or more for each of its " +
                               std::to_string(count) + " models");
  }
  return weights;
}

// Two at a time: the first model of those that are left against the others. What the weights lack
// to 1 is absorbed.
std::optional<Material> mixture(const BsdfCall& call) {
  const std::vector<const Property*> inside = call.set.objects("bsdf");
  const std::vector<double> weights = mixture_weights(call, inside.size());
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  double left = std::max(0.0, 1.0 - sum);
  std::optional<int> others;
  if (left > 1e-6) others = add_material(call.state, DiffuseMaterial{glm::vec3(0.0f), 0.0f});
  for (std::size_t i = inside.size(); i-- > 0;) {
    const std::optional<int> one = material_index(call.state, inside[i]->element, call.two_sided);
    if (!one || weights[i] == 0.0) {
      if (!one) warn(call, "\"null\" inside a mixture is not supported; it is left out");
      continue;
    }
    left += weights[i];
    if (!others) {
      others = one;
      continue;
    }
    Material m(MixMaterial{*one, *others, float(1.0 - weights[i] / left)});
    m.two_sided = call.two_sided;
    others = add_material(call.state, m);
  }
  if (!others) return std::nullopt;
  return call.state.scene.materials[size_t(*others)];
}

struct Model {
  std::string_view name;
  Material (*make)(const BsdfCall&);
};

// To support another model that stands alone, write its function and add it here.
constexpr Model models[] = {
    {"diffuse", make_diffuse},
    {"lambertian", make_diffuse},
    {"roughdiffuse", make_rough_diffuse},
    {"difftrans", make_diffuse_transmitter},
    {"dielectric", make_dielectric},
    {"thindielectric", make_thin_dielectric},
    {"roughdielectric", make_rough_dielectric},
    {"conductor", make_conductor},
    {"roughconductor", make_rough_conductor},
    {"plastic", make_plastic},
    {"roughplastic", make_rough_plastic},
    {"pplastic", make_rough_plastic},
    {"phong", make_phong},
    {"ward", make_ward},
    {"principled", make_principled},
    {"principledthin", make_principled},
};

struct Adapter {
  std::string_view name;
  std::optional<Material> (*make)(const BsdfCall&);
};

// Models around others.
constexpr Adapter adapters[] = {
    {"twosided", two_sided},   {"mask", mask},
    {"bumpmap", bump_map},     {"bump", bump_map},
    {"normalmap", normal_map}, {"coating", coating},
    {"roughcoating", coating}, {"blendbsdf", blend},
    {"mixturebsdf", mixture},  {"null", none},
};

}  // namespace

int add_material(State& state, Material material) {
  state.scene.materials.push_back(std::move(material));
  return int(state.scene.materials.size()) - 1;
}

std::optional<Material> make_material(State& state, const Element& element, bool is_two_sided) {
  const Nesting nesting(state, element);
  const Properties set = state.properties(element);
  const BsdfCall call{state, set, is_two_sided};
  for (const Adapter& adapter : adapters) {
    if (adapter.name != set.type()) continue;
    std::optional<Material> material = adapter.make(call);
    set.warn_unused(state.warnings);
    return material;
  }
  for (const Model& model : models) {
    if (model.name != set.type()) continue;
    if (set.type() == "principledthin") warn(call, "principledthin is rendered as principled");
    Material material = model.make(call);
    set.warn_unused(state.warnings);
    return material;
  }
  warn(call, "<bsdf type=\"" + element.attribute("type") +
                 "\"> is not supported; a diffuse grey is used");
  Material grey;
  grey.two_sided = is_two_sided;
  return grey;
}

std::optional<int> material_index(State& state, const Element& element, bool is_two_sided) {
  const auto key = std::make_pair(element.node, is_two_sided);
  if (const auto known = state.materials.find(key); known != state.materials.end()) {
    return known->second;
  }
  std::optional<Material> material = make_material(state, element, is_two_sided);
  std::optional<int> index;
  if (material) index = add_material(state, std::move(*material));
  state.materials[key] = index;
  return index;
}

}  // namespace lockstep::mitsuba
