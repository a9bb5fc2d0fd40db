#include "core/mtl.h"

#include "core/location.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

// The statements of one newmtl, before they are a model.
struct Statements {
  ColorInput diffuse{glm::vec3(0.8f)}, specular{glm::vec3(0.0f)}, emission{glm::vec3(0.0f)};
  FloatInput opacity{1.0f};
  std::optional<FloatInput> roughness, metallic, bump;
  int normal_map = -1;
  float exponent = 0.0f, eta = 1.5f;
  int illum = 2;
};

ObjMaterial to_material(const Statements& s) {
  ObjMaterial result;
  Material& m = result.material;
  const bool transparent = s.illum == 4 || s.illum == 6 || s.illum == 7 || s.illum == 9;
  const bool mirror = s.illum == 3 || s.illum == 5 || s.illum == 8;
  const bool is_black = s.diffuse.texture < 0 && s.diffuse.value == glm::vec3(0.0f);
  const bool shines = s.specular.texture >= 0 || s.specular.value != glm::vec3(0.0f);
  const float alpha = std::sqrt(2.0f / (s.exponent + 2.0f));
  if (transparent) {
    DielectricMaterial glass;
    glass.eta = s.eta;
    m.model = glass;
  } else if (mirror && is_black && shines) {
    ConductorMaterial metal;
    metal.eta = glm::vec3(0.0f);  // with k = 1: all is reflected
    metal.k = glm::vec3(1.0f);
    metal.alpha = glm::vec2(s.exponent > 0.0f && s.exponent < 1000.0f ? alpha : 0.0f);
    metal.specular = s.specular;
    m.model = metal;
  } else if (s.roughness || s.metallic) {
    PrincipledMaterial principled;
    principled.base_color = s.diffuse;
    principled.metallic = s.metallic.value_or(FloatInput(0.0f));
    principled.alpha = s.roughness.value_or(FloatInput(0.5f));
    principled.alpha.value *= principled.alpha.value;
    principled.alpha.power = 2.0f;
    principled.eta = s.eta;
    m.model = principled;
  } else if (shines && s.exponent > 0.0f) {
    CoatedMaterial coated;
    coated.diffuse = s.diffuse;
    coated.specular = s.specular;
    coated.alpha = alpha;
    coated.eta = s.eta;
    coated.layered = false;
    m.model = coated;
  } else {
    m.model = DiffuseMaterial{s.diffuse, 0.0f};
  }
  if (!transparent) m.opacity = s.opacity;
  m.bump = s.bump;
  m.normal_map = s.normal_map;
  if (s.emission.texture >= 0 || s.emission.value != glm::vec3(0.0f)) {
    result.emission = Emission{s.emission, false};
  }
  return result;
}

// A map's file and the options before it.
struct Map {
  std::string file;
  glm::vec2 offset{0.0f}, scale{1.0f};
  float bump = 1.0f;
  bool clamp = false;
};

class Reader {
 public:
  Reader(std::string path, SceneDescription& scene) : path_(std::move(path)), scene_(scene) {}

  void read(ObjMaterials& materials) {
    std::ifstream file(path_);
    std::string line;
    std::string name;
    while (std::getline(file, line)) {
      ++line_;
      if (!line.empty() && line.back() == '\r') line.pop_back();
      words_.clear();
      std::istringstream stream(line);
      for (std::string word; stream >> word && word.front() != '#';) words_.push_back(word);
      if (words_.empty()) continue;
      if (words_[0] == "newmtl") {
        if (line_of_name_ > 0) materials[name] = to_material(s_);
        s_ = {};
        name = rest_of(line);
        line_of_name_ = line_;
      } else if (line_of_name_ > 0) {
        statement(words_[0]);
      }
    }
    if (line_of_name_ > 0) materials[name] = to_material(s_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { lockstep::fail({path_, line_}, what); }

  void warn(const std::string& what) {
    const std::string line = path_ + ":" + std::to_string(line_) + ": " + printable(what);
    scene_.warnings.push_back(line);
  }

  static std::string rest_of(const std::string& line) {
    const size_t key = line.find("newmtl");
    const size_t first = line.find_first_not_of(" \t", key + 6);
    if (first == std::string::npos) return "";
    return line.substr(first, line.find_last_not_of(" \t") + 1 - first);
  }

  std::optional<float> to_number(const std::string& text) const {
    float value = 0.0f;
    const char* first = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* end = text.data() + text.size();
    const auto [rest, status] = std::from_chars(first, end, value);
    if (status != std::errc() || rest != end || !std::isfinite(value)) return std::nullopt;
    return value;
  }

  float number(size_t i) const {
    const std::optional<float> value = i < words_.size() ? to_number(words_[i]) : std::nullopt;
    if (!value) fail(words_[0] + " needs a number");
    return *value;
  }

  glm::vec3 color(float most) {
    if (words_.size() > 1 && (words_[1] == "spectral" || words_[1] == "xyz")) {
      warn(words_[0] + " " + words_[1] + " is not supported; a grey is used");
      return glm::vec3(0.5f);
    }
    const float r = number(1);
    const glm::vec3 given = words_.size() > 3 ? glm::vec3(r, number(2), number(3)) : glm::vec3(r);
    return glm::clamp(given, 0.0f, most);
  }

  // Options start with a dash and take one number or word, but for -o, -s and -t (up to three
  // numbers) and -mm (two). The file's name is the rest and may hold blanks.
  Map map() const {
    Map m;
    size_t i = 1;
    while (i + 1 < words_.size() && words_[i].size() > 1 && words_[i][0] == '-') {
      const std::string& option = words_[i++];
      const bool vector = option == "-o" || option == "-s" || option == "-t";
      std::vector<float> values;
      const size_t most = vector ? 3 : option == "-mm" ? 2 : 1;
      while (values.size() < most && i + 1 < words_.size()) {
        const std::optional<float> value = to_number(words_[i]);
        if (!value) break;
        values.push_back(*value);
        ++i;
      }
      if (values.empty()) m.clamp = m.clamp || (option == "-clamp" && words_[i] == "on");
      if (values.empty() && i + 1 < words_.size()) ++i;  // an option with a word
      if (option == "-bm" && !values.empty()) m.bump = values[0];
      if (!vector || values.empty()) continue;
      glm::vec2& target = option == "-s" ? m.scale : m.offset;
      target = {values[0], values.size() > 1 ? values[1] : target.y};
    }
    for (; i < words_.size(); ++i) m.file += (m.file.empty() ? "" : " ") + words_[i];
    if (m.file.empty()) fail(words_[0] + " needs the name of an image");
    std::replace(m.file.begin(), m.file.end(), '\\', '/');
    return m;
  }

  int texture(const Map& m, TextureEncoding encoding) {
    ImageTexture image;
    image.file = (fs::path(path_).parent_path() / m.file).string();
    image.encoding = encoding;
    image.wrap_u = image.wrap_v = m.clamp ? TextureWrap::Clamp : TextureWrap::Repeat;
    image.where = path_ + ":" + std::to_string(line_);
    // scale * uv + offset with v upwards, in coordinates that have v downwards
    image.uv.u_row = {m.scale.x, 0.0f};
    image.uv.v_row = {0.0f, m.scale.y};
    image.uv.offset = {m.offset.x, 1.0f - m.scale.y - m.offset.y};
    scene_.textures.emplace_back(std::move(image));
    return int(scene_.textures.size()) - 1;
  }

  ColorInput color_map() { return {glm::vec3(1.0f), texture(map(), TextureEncoding::ByFormat)}; }

  FloatInput float_map() {
    FloatInput input(1.0f);
    input.texture = texture(map(), TextureEncoding::Linear);
    return input;
  }

  void statement(const std::string& key) {
    constexpr float any = 1e30f;
    if (key == "Kd") {
      if (s_.diffuse.texture < 0) s_.diffuse = color(1.0f);
    } else if (key == "Ks") {
      if (s_.specular.texture < 0) s_.specular = color(1.0f);
    } else if (key == "Ke") {
      if (s_.emission.texture < 0) s_.emission = color(any);
    } else if (key == "map_Kd") {
      s_.diffuse = color_map();
    } else if (key == "map_Ks") {
      s_.specular = color_map();
    } else if (key == "map_Ke") {
      s_.emission = color_map();
    } else if (key == "Ns") {
      s_.exponent = std::clamp(number(1), 0.0f, 1e6f);
    } else if (key == "Ni") {
      if (number(1) > 1.0f) s_.eta = std::min(number(1), 10.0f);
    } else if (key == "illum") {
      s_.illum = int(std::clamp(number(1), 0.0f, 10.0f));
    } else if (key == "Pr") {
      s_.roughness = std::clamp(number(1), 0.0f, 1.0f);
    } else if (key == "Pm") {
      s_.metallic = std::clamp(number(1), 0.0f, 1.0f);
    } else if (key == "map_Pr") {
      s_.roughness = float_map();
    } else if (key == "map_Pm") {
      s_.metallic = float_map();
    } else {
      surface_statement(key);
    }
  }

  void surface_statement(const std::string& key) {
    if (key == "d" || key == "Tr") {
      const size_t at = words_.size() > 1 && words_[1] == "-halo" ? 2 : 1;
      const float value = std::clamp(number(at), 0.0f, 1.0f);
      if (s_.opacity.texture < 0) s_.opacity = key == "d" ? value : 1.0f - value;
    } else if (key == "map_d") {
      s_.opacity = float_map();
    } else if (key == "bump" || key == "map_bump" || key == "map_Bump") {
      const Map m = map();
      s_.bump = FloatInput(m.bump);
      s_.bump->texture = texture(m, TextureEncoding::Linear);
    } else if (key == "norm") {
      s_.normal_map = texture(map(), TextureEncoding::Linear);
    }
  }

  std::string path_;
  SceneDescription& scene_;
  int line_ = 0, line_of_name_ = 0;
  std::vector<std::string> words_;
  Statements s_;
};

// One name, which may hold blanks, or several.
std::vector<std::string> files_named(const fs::path& folder, const std::string& names) {
  std::error_code ignored;
  if (fs::exists(folder / names, ignored)) return {names};
  std::vector<std::string> files;
  std::istringstream stream(names);
  for (std::string name; stream >> name;) files.push_back(name);
  return files;
}

}  // namespace

ObjMaterials read_mtl_libraries(const std::string& obj_path,
                                const std::vector<std::string>& libraries,
                                SceneDescription& scene) {
  ObjMaterials materials;
  const fs::path folder = fs::path(obj_path).parent_path();
  std::set<std::string> known;
  for (const std::string& names : libraries) {
    for (const std::string& name : files_named(folder, names)) {
      if (!known.insert(name).second) continue;
      const fs::path path = folder / name;
      std::error_code ignored;
      if (fs::is_regular_file(path, ignored)) {
        Reader(path.string(), scene).read(materials);
      } else {
        scene.warnings.push_back(obj_path + ": the material file \"" + printable(name) +
                                 "\" is missing; a diffuse grey is used");
      }
    }
  }
  return materials;
}

void add_obj_part(ObjPart part, const ObjMaterials& materials, SceneDescription& scene) {
  const auto found = materials.find(part.material);
  const bool known = found != materials.end();
  scene.materials.push_back(known ? found->second.material : Material());
  Shape shape{std::move(part.mesh), int(scene.materials.size()) - 1, {}};
  if (known) shape.emission = found->second.emission;
  scene.shapes.push_back(std::move(shape));
}

}  // namespace lockstep
