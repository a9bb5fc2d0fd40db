#include "core/mitsuba/textured.h"

#include <set>
#include <vector>

namespace lockstep::mitsuba {
namespace {

template <class... Inputs>
bool any(const Inputs&... inputs) {
  return (... || (inputs.texture >= 0));
}

bool has_texture(const DiffuseMaterial& m) { return any(m.reflectance, m.sigma); }
bool has_texture(const DiffuseTransmissionMaterial& m) {
  return any(m.reflectance, m.transmittance);
}
bool has_texture(const ConductorMaterial& m) { return any(m.eta, m.k, m.alpha_scale, m.specular); }
bool has_texture(const CoatedMaterial& m) { return any(m.diffuse, m.specular, m.alpha_scale); }
bool has_texture(const DielectricMaterial& m) {
  return any(m.alpha_scale, m.reflectance, m.transmittance);
}
bool has_texture(const PrincipledMaterial& m) {
  return any(m.base_color, m.metallic, m.alpha, m.specular, m.transmission, m.coat, m.coat_alpha);
}
bool has_texture(const MeasuredMaterial&) { return false; }
bool has_texture(const MixMaterial& m) { return any(m.amount); }

}  // namespace

bool is_textured(const SceneDescription& scene, int index) {
  std::set<int> seen;
  std::vector<int> left{index};
  while (!left.empty()) {
    const int next = left.back();
    left.pop_back();
    if (!seen.insert(next).second) continue;
    const Material& m = scene.materials[size_t(next)];
    if (m.normal_map >= 0 || m.opacity.texture >= 0 || (m.bump && m.bump->texture >= 0)) {
      return true;
    }
    if (std::visit([](const auto& model) { return has_texture(model); }, m.model)) return true;
    if (const auto* mix = std::get_if<MixMaterial>(&m.model)) {
      left.insert(left.end(), {mix->first, mix->second});
    }
  }
  return false;
}

}  // namespace lockstep::mitsuba
