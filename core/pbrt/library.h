// What a scene file declares for use elsewhere: textures, materials and media. They are made into
// the scene's own only where a shape needs them, when the whole file has been read.
#pragma once

#include "core/material.h"
#include "core/measured_table.h"
#include "core/pbrt/names.h"
#include "core/pbrt/parameters.h"
#include "core/pbrt/version.h"

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lockstep::pbrt {

enum class Progress { Untouched, Begun, Done };  // Begun: met again, it refers to itself

struct TextureDeclaration {
  std::string name, type;
  ParameterSet set;
  int order = 0;
  Progress progress = Progress::Untouched;
  ColorInput value{};  // once done; the three channels of a float texture's are equal
};

struct MaterialDeclaration {
  std::string type;
  ParameterSet set;
  int order = 0;
  Progress progress = Progress::Untouched;
  std::optional<Material> material{};  // once done; nothing: an interface
  int scene_index = -1;                // once used as it is
};

struct MediumDeclaration {
  std::string type;
  ParameterSet set;
};

struct Library {
  std::string main_file;
  Version version = Version::v4;
  Warnings warnings;
  int order = 0;    // of the directive that is being carried out
  int nesting = 0;  // of what is being made

  NameTable<TextureDeclaration> color_textures, float_textures;
  NameTable<MediumDeclaration> media;
  std::deque<MaterialDeclaration> materials;
  NameTable<int> named_materials;  // indices of `materials`

  std::vector<Texture> scene_textures;
  std::vector<MeasuredTable> scene_measured;
  std::map<std::string, int> measured_files;  // what has been read: indices of scene_measured
  std::vector<Material> scene_materials;
};

// Appends to the scene's lists and returns the index.
int add_texture(Library& library, Texture texture);
int add_material(Library& library, Material material);

// The file `name` of the scene: beside the file that mentions it, or beside the main file.
std::string resolve(const Library& library, const std::string& mentioned_in,
                    const std::string& name);

// Held while a texture or material is made. Fails where it refers to itself or where references
// nest too deep.
class Making {
 public:
  // `what` names it in messages.
  Making(Library& library, Progress& progress, const std::string& what, const Location& where);
  Making(const Making&) = delete;
  Making& operator=(const Making&) = delete;
  ~Making() { --library_.nesting; }

 private:
  Library& library_;
};

}  // namespace lockstep::pbrt
