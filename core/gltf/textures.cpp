#include "core/gltf/textures.h"

#include "core/gltf/extensions.h"

#include <cmath>
#include <optional>
#include <utility>

namespace lockstep::gltf {

namespace {

// The specification of KHR_texture_transform has T R S. Its rotation is counter-clockwise where v
// points up; its GLSL turns the other way than its own example, its sample model and all viewers
// (KhronosGroup/glTF, issue 1563), whom this follows.
UvTransform make_transform(const tinygltf::Value& extension) {
  const glm::vec2 scale = get_vec2(extension, "scale", glm::vec2(1.0f));
  const float angle = get_number(extension, "rotation", 0.0f);
  const float c = std::cos(angle), s = std::sin(angle);
  UvTransform uv;
  uv.u_row = glm::vec2(c, s) * scale;
  uv.v_row = glm::vec2(-s, c) * scale;
  uv.offset = get_vec2(extension, "offset", glm::vec2(0.0f));
  return uv;
}

void apply_extension(const tinygltf::Value* extension, TextureUse& use) {
  if (extension == nullptr) return;
  use.uv = make_transform(*extension);
  use.uv_set = get_index(*extension, "texCoord", use.uv_set);
}

template <class Info>
TextureUse use_of(const Info& info) {
  TextureUse use;
  use.texture = info.index;
  use.uv_set = info.texCoord;
  apply_extension(find_extension(info.extensions, "KHR_texture_transform"), use);
  return use;
}

TextureWrap wrap_mode(int mode) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return TextureWrap::Clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return TextureWrap::Mirror;
    default:
      return TextureWrap::Repeat;
  }
}

// Where the file leaves the filter of what is far away open, as it may, nothing is averaged.
TextureFilter filter_of(const tinygltf::Sampler& sampler) {
  if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) return TextureFilter::Nearest;
  switch (sampler.minFilter) {
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
      return TextureFilter::Trilinear;
    default:
      return TextureFilter::Bilinear;
  }
}

Bytes read_view(const Document& document, int index, const std::string& name) {
  const tinygltf::Model& model = document.model;
  if (index < 0 || size_t(index) >= model.bufferViews.size()) {
    fail(document.path, name + " has neither a URI nor a bufferView");
  }
  const tinygltf::BufferView& view = model.bufferViews[size_t(index)];
  if (view.buffer < 0 || size_t(view.buffer) >= model.buffers.size()) {
    fail(document.path, name + " is in a buffer that does not exist");
  }
  const Bytes& buffer = model.buffers[size_t(view.buffer)].data;
  if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset) {
    fail(document.path, name + " reaches past the end of its buffer");
  }
  const auto first = buffer.begin() + std::ptrdiff_t(view.byteOffset);
  return Bytes(first, first + std::ptrdiff_t(view.byteLength));
}

void set_image(Document& document, int index, ImageTexture& texture) {
  const std::string name = "image " + std::to_string(index);
  if (index < 0 || size_t(index) >= document.images.size()) {
    fail(document.path, name + " does not exist");
  }
  texture.where = document.path + ": " + name;
  ImageSource& source = document.images[size_t(index)];
  if (!source.uri.empty() && !is_data_uri(source.uri)) {
    texture.file = resolve_uri(document.path, source.uri);
    return;
  }
  texture.file = source.name.empty() ? "embedded " + name : printable(source.name);
  if (!source.encoded) {
    std::optional<Bytes> bytes = source.uri.empty() ? read_view(document, source.buffer_view, name)
                                                    : decode_data_uri(source.uri);
    if (!bytes) fail(document.path, name + " has a malformed data URI");
    source.encoded = std::make_shared<const Bytes>(std::move(*bytes));
    source.uri.clear();
  }
  texture.encoded = source.encoded;
}

// The texture's image; extensions have their own where there is no other. -1: none.
int image_of(const tinygltf::Texture& texture) {
  if (texture.source >= 0) return texture.source;
  const tinygltf::Value* webp = find_extension(texture.extensions, "EXT_texture_webp");
  return webp != nullptr ? get_index(*webp, "source", -1) : -1;
}

}  // namespace

TextureUse texture_use(const tinygltf::TextureInfo& info) { return use_of(info); }
TextureUse texture_use(const tinygltf::NormalTextureInfo& info) { return use_of(info); }

TextureUse texture_use(const tinygltf::Value& object, const std::string& name) {
  TextureUse use;
  const tinygltf::Value* info = find_member(object, name);
  if (info == nullptr) return use;
  use.texture = get_index(*info, "index", -1);
  use.uv_set = get_index(*info, "texCoord", 0);
  if (const tinygltf::Value* extensions = find_member(*info, "extensions")) {
    apply_extension(find_member(*extensions, "KHR_texture_transform"), use);
  }
  return use;
}

int scene_texture(Document& document, const TextureUse& use, TextureEncoding encoding,
                  TextureTable& table, SceneDescription& scene) {
  if (use.texture == -1) return -1;
  const tinygltf::Model& model = document.model;
  const std::string name = "texture " + std::to_string(use.texture);
  if (use.texture < 0 || size_t(use.texture) >= model.textures.size()) {
    fail(document.path, name + " does not exist");
  }
  const std::array<float, 6> transform{use.uv.u_row.x, use.uv.u_row.y,  use.uv.v_row.x,
                                       use.uv.v_row.y, use.uv.offset.x, use.uv.offset.y};
  const auto [entry, is_new] = table.try_emplace({use.texture, encoding, transform}, -1);
  if (!is_new) return entry->second;

  const tinygltf::Texture& source = model.textures[size_t(use.texture)];
  if (image_of(source) < 0) {
    document.warnings.add(name, "textures without an image of a known kind are ignored");
    return -1;
  }
  ImageTexture texture;
  texture.encoding = encoding;
  texture.uv = use.uv;
  if (source.sampler >= 0) {
    if (size_t(source.sampler) >= model.samplers.size()) {
      fail(document.path, name + " has a sampler that does not exist");
    }
    const tinygltf::Sampler& sampler = model.samplers[size_t(source.sampler)];
    texture.wrap_u = wrap_mode(sampler.wrapS);
    texture.wrap_v = wrap_mode(sampler.wrapT);
    texture.filter = filter_of(sampler);
  }
  set_image(document, image_of(source), texture);
  entry->second = static_cast<int>(scene.textures.size());
  scene.textures.emplace_back(std::move(texture));
  return entry->second;
}

}  // namespace lockstep::gltf
