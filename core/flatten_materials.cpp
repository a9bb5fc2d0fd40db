#include "core/boundary_albedo.h"
#include "core/error.h"
#include "core/flatten.h"
#include "core/fresnel.h"
#include "core/microfacet.h"

#include <fmt/format.h>

#include <algorithm>

namespace lockstep {
namespace {

// A row under construction: what is appended is constant, or bound to a texture.
class Row {
 public:
  explicit Row(MaterialKind model) : kind(model) {}

  Row& add(const ColorInput& input) {
    if (input.texture >= 0) bindings.push_back(binding_of(input, column()));
    return add(input.value.x).add(input.value.y).add(input.value.z);
  }
  Row& add(const FloatInput& input) {
    if (input.texture >= 0) bindings.push_back(binding_of(input, column()));
    return add(input.value);
  }
  // Roughness along x and y, both times `scale`.
  Row& add(glm::vec2 alpha, const FloatInput& scale) {
    if (scale.texture >= 0) {
      TextureBinding b = binding_of(scale, column());
      b.columns = 2;
      b.scale = scale.value * glm::vec3(alpha, 0.0f);
      bindings.push_back(b);
    }
    return add(alpha.x * scale.value).add(alpha.y * scale.value);
  }
  Row& add(float value) {
    parameters.push_back(value);
    return *this;
  }
  Row& add(glm::vec3 v) { return add(v.x).add(v.y).add(v.z); }

  MaterialKind kind;
  std::vector<float> parameters;
  std::vector<TextureBinding> bindings;

 private:
  int column() const { return int(parameters.size()); }
};

Row row(const DiffuseMaterial& m) {
  if (m.sigma == FloatInput(0.0f)) return Row(MaterialKind::Diffuse).add(m.reflectance);
  return Row(MaterialKind::RoughDiffuse).add(m.reflectance).add(m.sigma);
}
Row row(const DiffuseTransmissionMaterial& m) {
  return Row(MaterialKind::DiffuseTransmission).add(m.reflectance).add(m.transmittance);
}
Row row(const ConductorMaterial& m) {
  return Row(MaterialKind::Conductor)
      .add(m.eta)
      .add(m.k)
      .add(m.alpha, m.alpha_scale)
      .add(m.specular);
}
Row row(const CoatedMaterial& m) {
  Row r = Row(MaterialKind::Coated).add(m.diffuse).add(m.specular);
  FloatInput alpha = m.alpha_scale;
  alpha.value *= m.alpha;
  return r.add(alpha)
      .add(m.eta)
      .add(m.layered ? 1.0f : 0.0f)
      .add(inner_reflectance(m.eta, m.thickness))
      .add(m.thickness)
      .add(float(m.reflections));
}
Row row(const DielectricMaterial& m) {
  return Row(MaterialKind::Dielectric)
      .add(m.reflectance)
      .add(m.transmittance)
      .add(m.alpha, m.alpha_scale)
      .add(m.eta)
      .add(m.thin ? 1.0f : 0.0f)
      .add(m.thin ? glm::vec3(0.0f) : m.absorption);
}
Row row(const PrincipledMaterial& m) {
  return Row(MaterialKind::Principled)
      .add(m.base_color)
      .add(m.metallic)
      .add(m.alpha)
      .add(m.eta)
      .add(m.specular)
      .add(m.transmission)
      .add(m.coat)
      .add(m.coat_alpha);
}
Row row(const MeasuredMaterial& m) { return Row(MaterialKind::Measured).add(float(m.table)); }
Row row(const MixMaterial& m) {
  return Row(MaterialKind::Mix).add(float(m.first)).add(float(m.second)).add(m.amount);
}

std::int32_t append_binding(FlatScene& flat, const TextureBinding& binding) {
  flat.texture_bindings.push_back(binding);
  return std::int32_t(flat.texture_bindings.size()) - 1;
}

bool is_anisotropic(const MaterialModel& model) {
  const auto differ = [](glm::vec2 alpha) { return alpha.x != alpha.y; };
  if (const auto* c = std::get_if<ConductorMaterial>(&model)) return differ(c->alpha);
  if (const auto* d = std::get_if<DielectricMaterial>(&model)) return differ(d->alpha);
  return false;
}

// What hits on the material need, and `r` its row.
FeatureMask features_of(const Material& m, const Row& r) {
  const auto when = [](bool needed, Feature f) { return needed ? bit(f) : 0u; };
  const auto* glass = std::get_if<DielectricMaterial>(&m.model);
  const bool absorbs = glass && !glass->thin && glass->absorption != glm::vec3(0.0f);
  return bit(material_feature(r.kind)) | when(!r.bindings.empty(), Feature::Textures) |
         when(m.normal_map >= 0 || (m.bump && m.bump->texture >= 0), Feature::SurfaceMaps) |
         when(is_anisotropic(m.model), Feature::Tangents) |
         when(m.opacity != FloatInput(1.0f), Feature::Opacity) |
         when(!m.two_sided, Feature::OneSided) | when(absorbs, Feature::Absorption);
}

bool is_bound(const Row& r, int column) {
  return std::any_of(r.bindings.begin(), r.bindings.end(),
                     [&](const TextureBinding& b) { return b.column == column; });
}

// True for what has facets, unless it is a mirror or clear glass all over.
bool has_rough_facets(const Row& r) {
  const auto rough = [&](std::size_t column) {
    return r.parameters[column] >= smoothest_alpha || is_bound(r, int(column));
  };
  switch (r.kind) {
    case MaterialKind::Conductor:
    case MaterialKind::Dielectric:
      return rough(6) || r.parameters[7] >= smoothest_alpha;
    case MaterialKind::Coated:
      return rough(6);
    case MaterialKind::Principled:
      return rough(4);
    default:
      return false;
  }
}

// The index of refraction whose boundary table kernels look up for hits on the material.
std::optional<float> boundary_index(const Row& r) {
  const std::vector<float>& p = r.parameters;
  if (r.kind == MaterialKind::Coated) return p[7];
  if (r.kind == MaterialKind::Dielectric && has_rough_facets(r) && p[9] == 0.0f) return p[8];
  if (r.kind == MaterialKind::Principled && (p[7] > 0.0f || is_bound(r, 7))) return p[5];
  return std::nullopt;
}

// Prepares what puts back what facets lose. `r` is as long as rows are.
void compensate(Row& r, FlatScene& flat) {
  const std::optional<float> index = boundary_index(r);
  if (!index) return;
  r.parameters[boundary_column] = float(boundary_table_for(*index, flat.boundary_etas));
}

void append_maps(const Material& material, const Row& r, FlatScene& flat) {
  const auto first = std::int32_t(flat.texture_bindings.size());
  for (const TextureBinding& b : r.bindings) append_binding(flat, b);
  std::int32_t normal = -1, bump = -1;
  if (material.normal_map >= 0) {
    TextureBinding b = binding_of(ColorInput(glm::vec3(1.0f), material.normal_map), 0);
    b.scale.x = material.normal_scale;
    normal = append_binding(flat, b);
  }
  if (material.bump && material.bump->texture >= 0) {
    bump = append_binding(flat, binding_of(*material.bump, 0));
  }
  flat.material_maps.insert(flat.material_maps.end(),
                            {first, std::int32_t(r.bindings.size()), normal, bump});
}

void append_material(const Material& material, bool compensated, FlatScene& flat) {
  Row r = std::visit([](const auto& m) { return row(m); }, material.model);
  append_maps(material, r, flat);
  r.parameters.resize(material_stride, 0.0f);
  if (compensated) compensate(r, flat);
  flat.material_features.push_back(
      features_of(material, r) |
      (compensated && has_rough_facets(r) ? bit(Feature::Compensation) : 0u));
  flat.material_kinds.push_back(std::int32_t(r.kind));
  flat.material_parameters.insert(flat.material_parameters.end(), r.parameters.begin(),
                                  r.parameters.end());
  flat.opacities.push_back(
      {material.opacity.value, binding_of(material.opacity, 0), material.opacity_cutoff});
}

void append_measured(const SceneDescription& description, FlatScene& flat) {
  for (const Material& material : description.materials) {
    const auto* m = std::get_if<MeasuredMaterial>(&material.model);
    if (m && (m->table < 0 || std::size_t(m->table) >= description.measured.size())) {
      throw Error(
          fmt::format("a material refers to measured table {}, which does not exist", m->table));
    }
  }
  if (description.measured.size() > most_measured_tables) {
    throw Error(fmt::format("{} tables of measured reflectance; at most {} fit",
                            description.measured.size(), most_measured_tables));
  }
  flat.measured.reserve(description.measured.size() * measured_floats);
  for (const MeasuredTable& table : description.measured) {
    flat.measured.insert(flat.measured.end(), table.values.begin(), table.values.end());
  }
}

// Finds mixes that contain themselves, which kernels would follow for ever, by their depth.
class MixCheck {
 public:
  explicit MixCheck(const std::vector<Material>& materials)
      : materials_(materials), checked_(materials.size(), false) {}

  void check(int material, int depth = 0) {
    if (material < 0 || std::size_t(material) >= materials_.size()) {
      throw Error(
          fmt::format("a mixed material refers to material {}, which does not exist", material));
    }
    const auto* mix = std::get_if<MixMaterial>(&materials_[std::size_t(material)].model);
    if (!mix || checked_[std::size_t(material)]) return;
    if (depth > 64) throw Error("mixed materials contain themselves or are nested too deeply");
    check(mix->first, depth + 1);
    check(mix->second, depth + 1);
    checked_[std::size_t(material)] = true;
  }

 private:
  const std::vector<Material>& materials_;
  std::vector<bool> checked_;
};

}  // namespace

TextureBinding binding_of(const ColorInput& input, int column) {
  TextureBinding b;
  b.texture = input.texture;
  b.column = column;
  b.scale = input.value;
  return b;
}

TextureBinding binding_of(const FloatInput& input, int column) {
  TextureBinding b;
  b.texture = input.texture;
  b.column = column;
  b.columns = 1;
  b.is_color = false;
  b.channel = input.channel;
  b.power = input.power;
  b.scale = glm::vec3(input.value);
  return b;
}

void flatten_materials(const SceneDescription& description, FlatScene& flat) {
  MixCheck mixes(description.materials);
  for (std::size_t i = 0; i < description.materials.size(); ++i) mixes.check(int(i));
  for (const Material& m : description.materials) {
    append_material(m, description.compensate_microfacets, flat);
  }
  append_measured(description, flat);
}

}  // namespace lockstep
