// The functions behind the types of materials, as materials.cpp lists them.
#pragma once

#include "core/pbrt/inputs.h"

#include <optional>

namespace lockstep::pbrt {

using MadeMaterial = std::optional<Material>;  // nothing: an interface

// v4 (materials_v4.cpp); conductor and metal share their indices, both have mix.
MadeMaterial diffuse(const Inputs&);
MadeMaterial coated_diffuse(const Inputs&);
MadeMaterial conductor(const Inputs&);
MadeMaterial coated_conductor(const Inputs&);
MadeMaterial dielectric(const Inputs&);
MadeMaterial thin_dielectric(const Inputs&);
MadeMaterial diffuse_transmission(const Inputs&);
MadeMaterial mixed(const Inputs&);

// v2 and v3 (materials_v3.cpp)
MadeMaterial matte(const Inputs&);
MadeMaterial plastic(const Inputs&);
MadeMaterial metal(const Inputs&);
MadeMaterial shiny_metal(const Inputs&);
MadeMaterial glass(const Inputs&);
MadeMaterial mirror(const Inputs&);
MadeMaterial uber(const Inputs&);
MadeMaterial substrate(const Inputs&);
MadeMaterial translucent(const Inputs&);
MadeMaterial disney(const Inputs&);

// v2 and v4 (measured.cpp)
MadeMaterial measured(const Inputs&);

// Stand-ins for what the scene description cannot say (material_stand_ins.cpp)
MadeMaterial subsurface(const Inputs&);
MadeMaterial hair(const Inputs&);
MadeMaterial fourier(const Inputs&);

// Without parameters both versions have copper.
struct MetalIndex {
  ColorInput eta, k, specular{};
};
MetalIndex metal_index(const Inputs& in, const char* eta_name, const char* k_name);

// The metal whose reflectance at normal incidence is `reflectance`, with eta = 1.
MetalIndex metal_of_reflectance(const ColorInput& reflectance);

// "eta" or "index" of a dielectric.
float dielectric_index(const Inputs& in, const char* name, float fallback);

// `base` and `over` added up, where no share of light comes from both: `over` makes up `share`.
Material sum(const Inputs& in, Material base, Material over, float share);

}  // namespace lockstep::pbrt
