#include "core/pbrt/materials.h"

#include "core/pbrt/material_types.h"
#include "core/pbrt/textures.h"

#include <string_view>
#include <utility>

namespace lockstep::pbrt {

namespace {

MadeMaterial interface(const Inputs&) { return std::nullopt; }

struct MaterialType {
  std::string_view name;
  MadeMaterial (*make)(const Inputs&);
};

// To support another material, write its function and add it here.
constexpr MaterialType material_types[] = {
    {"diffuse", diffuse},
    {"coateddiffuse", coated_diffuse},
    {"conductor", conductor},
    {"coatedconductor", coated_conductor},
    {"dielectric", dielectric},
    {"thindielectric", thin_dielectric},
    {"diffusetransmission", diffuse_transmission},
    {"mix", mixed},
    {"matte", matte},
    {"plastic", plastic},
    {"metal", metal},
    {"shinymetal", shiny_metal},
    {"glass", glass},
    {"mirror", mirror},
    {"uber", uber},
    {"substrate", substrate},
    {"translucent", translucent},
    {"disney", disney},
    {"subsurface", subsurface},
    {"kdsubsurface", subsurface},
    {"hair", hair},
    {"measured", measured},
    {"fourier", fourier},
    {"interface", interface},
    {"none", interface},
    {"", interface},
};

void set_relief(const Inputs& in, Material& material) {
  for (const char* name : {"displacement", "bumpmap"}) {
    const auto height = in.find_number(name);
    if (height && height->texture >= 0) material.bump = *height;
  }
  const Parameter* file = in.set().find("normalmap", {"string"});
  if (file == nullptr || (file->strings.size() == 1 && file->strings[0].empty())) return;
  ImageTexture image = named_image(in.library(), in.set(), *file);
  image.encoding = TextureEncoding::Linear;
  material.normal_map = add_texture(in.library(), std::move(image));
}

MadeMaterial make_material(const std::string& type, const Inputs& in) {
  in.set().ignore({"type"});
  for (const MaterialType& known : material_types) {
    if (known.name != type) continue;
    MadeMaterial material = known.make(in);
    if (!material) return std::nullopt;
    set_relief(in, *material);
    in.set().warn_unused(in.library().warnings);
    return material;
  }
  in.library().warnings.add(in.set().where(),
                            "Material \"" + type + "\" is not supported; a diffuse grey is used");
  return DiffuseMaterial{};
}

}  // namespace

const std::optional<Material>& made_material(Library& library, MaterialDeclaration& declaration) {
  if (declaration.progress != Progress::Done) {
    const Making making(library, declaration.progress, declaration.set.owner(),
                        declaration.set.where());
    declaration.material =
        make_material(declaration.type, Inputs(declaration.set, declaration.order, library));
    declaration.progress = Progress::Done;
  }
  return declaration.material;
}

void multiply_opacity(Library& library, Material& material, const FloatInput& opacity) {
  material.opacity = multiply(library, material.opacity, opacity);
}

}  // namespace lockstep::pbrt
