#include "core/texture_program.h"

#include "core/error.h"

#include <string>

namespace lockstep {
namespace {

class Compiler {
 public:
  Compiler(const std::vector<Texture>& textures, const std::vector<int>& image_of_texture)
      : textures_(textures), image_of_texture_(image_of_texture) {}

  std::vector<TextureNode> program(int texture) {
    nodes_.clear();
    root_ = texture;
    add_texture(texture, 1);
    return std::move(nodes_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    std::string place = "texture " + std::to_string(root_);
    for (const TextureNode& node : nodes_) {
      if (node.image < 0) continue;
      place = where_of_image(node.image) + ": " + place;
      break;
    }
    throw Error(place + ": " + what);
  }

  // Where the scene states the texture that image belongs to.
  std::string where_of_image(int image) const {
    for (std::size_t i = 0; i < textures_.size(); ++i) {
      const auto* texture = std::get_if<ImageTexture>(&textures_[i]);
      if (texture && image_of_texture_[i] == image) return texture->where;
    }
    return "";
  }

  void add(const TextureNode& node) {
    if (nodes_.size() >= max_texture_nodes) {
      fail("its expression has more than " + std::to_string(max_texture_nodes) +
           " parts; simplify it");
    }
    nodes_.push_back(node);
  }

  void add_texture(int texture, int depth) {
    if (texture < 0 || std::size_t(texture) >= textures_.size()) {
      fail("it refers to texture " + std::to_string(texture) + ", which does not exist");
    }
    if (depth > max_texture_depth) {
      fail("it refers to itself, or textures are nested more than " +
           std::to_string(max_texture_depth) + " deep; simplify it");
    }
    std::visit([&](const auto& t) { add_node(t, texture, depth); },
               textures_[std::size_t(texture)]);
  }

  void add_node(const ImageTexture& t, int texture, int) {
    TextureNode node{TextureOp::Image};
    node.image = image_of_texture_[std::size_t(texture)];
    node.uv = t.uv;
    add(node);
  }
  void add_node(const CheckerboardTexture& t, int, int depth) {
    add_input(t.even, depth);
    add_input(t.odd, depth);
    TextureNode node{TextureOp::Checkerboard};
    node.uv = t.uv;
    add(node);
  }
  void add_node(const ProductTexture& t, int, int depth) {
    add_input(t.a, depth);
    add_input(t.b, depth);
    add({TextureOp::Product});
  }
  void add_node(const MixTexture& t, int, int depth) {
    add_input(t.a, depth);
    add_input(t.b, depth);
    add_number(t.amount, depth);
    add({TextureOp::Mix});
  }

  void add_value(TextureOp op, glm::vec3 value) {
    TextureNode node{op};
    node.value = value;
    add(node);
  }
  void add_input(const ColorInput& input, int depth) {
    if (input.texture < 0) return add_value(TextureOp::Constant, input.value);
    add_texture(input.texture, depth + 1);
    if (input.value != glm::vec3(1.0f)) add_value(TextureOp::Scale, input.value);
  }
  void add_number(const FloatInput& input, int depth) {
    if (input.texture < 0) return add_value(TextureOp::Constant, glm::vec3(input.value));
    add_texture(input.texture, depth + 1);
    TextureNode node{TextureOp::Number};
    node.value = glm::vec3(input.value);
    node.channel = input.channel;
    node.power = input.power;
    add(node);
  }

  const std::vector<Texture>& textures_;
  const std::vector<int>& image_of_texture_;
  std::vector<TextureNode> nodes_;
  int root_ = 0;
};

}  // namespace

TexturePrograms compile_textures(const std::vector<Texture>& textures,
                                 const std::vector<int>& image_of_texture) {
  TexturePrograms all;
  Compiler compiler(textures, image_of_texture);
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const std::vector<TextureNode> nodes = compiler.program(int(i));
    all.programs.push_back({std::int32_t(all.nodes.size()), std::int32_t(nodes.size())});
    all.nodes.insert(all.nodes.end(), nodes.begin(), nodes.end());
  }
  return all;
}

}  // namespace lockstep
