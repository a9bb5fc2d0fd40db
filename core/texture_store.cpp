#include "core/texture_store.h"

#include "core/fingerprint.h"

#include <tbb/parallel_for.h>

#include <array>
#include <exception>
#include <filesystem>
#include <map>
#include <tuple>

namespace lockstep {
namespace {

// An image to load, for the first texture that asks for it.
struct Task {
  const ImageTexture* texture = nullptr;
  bool pyramid = false;
  std::exception_ptr error{};
};

// Textures with equal keys share their texels. Only the encoding Gamma depends on gamma.
using Key = std::tuple<std::string, const void*, TextureEncoding, float>;

Key key_of(const ImageTexture& t) {
  const float gamma = t.encoding == TextureEncoding::Gamma && t.gamma > 0.0f ? t.gamma : 0.0f;
  if (t.encoded) return {"", t.encoded.get(), t.encoding, gamma};
  return {std::filesystem::path(t.file).lexically_normal().string(), nullptr, t.encoding, gamma};
}

// Index of the task that loads each texture's image; -1 for expressions.
std::vector<int> collect(const std::vector<Texture>& textures, std::vector<Task>& tasks) {
  std::map<Key, int> known;
  std::vector<int> task_of;
  for (const Texture& texture : textures) {
    const auto* image = std::get_if<ImageTexture>(&texture);
    task_of.push_back(-1);
    if (!image) continue;
    const auto [at, added] = known.try_emplace(key_of(*image), int(tasks.size()));
    if (added) tasks.push_back({image});
    task_of.back() = at->second;
    if (image->filter == TextureFilter::Trilinear) tasks[std::size_t(at->second)].pyramid = true;
  }
  return task_of;
}

std::vector<TextureImage> load(std::vector<Task>& tasks) {
  std::vector<TextureImage> images(tasks.size());
  tbb::parallel_for(std::size_t(0), tasks.size(), [&](std::size_t i) {
    try {
      images[i] = read_texture_image(*tasks[i].texture);
      if (tasks[i].pyramid) add_pyramid(images[i]);
    } catch (...) {
      tasks[i].error = std::current_exception();
    }
  });
  for (const Task& task : tasks) {
    if (task.error) std::rethrow_exception(task.error);
  }
  return images;
}

ImageLookup lookup_of(const ImageTexture& texture, const TextureImage& image) {
  ImageLookup lookup{image.view(), texture.wrap_u, texture.wrap_v, texture.filter, texture.invert};
  // Another texture may have asked for the pyramid.
  if (texture.filter != TextureFilter::Trilinear) lookup.texels.level_count = 1;
  return lookup;
}

void add(Fingerprint& print, const TextureNode& node) {
  const UvTransform& uv = node.uv;
  print.add_all(std::array{std::int32_t(node.op), node.image, node.channel});
  print.add_all(std::array{node.value.x, node.value.y, node.value.z, node.power, uv.u_row.x,
                           uv.u_row.y, uv.v_row.x, uv.v_row.y, uv.offset.x, uv.offset.y});
}

}  // namespace

TextureStore::TextureStore(const std::vector<Texture>& textures) {
  std::vector<Task> tasks;
  const std::vector<int> task_of = collect(textures, tasks);
  images_ = load(tasks);
  std::vector<int> lookup_of_texture(textures.size(), -1);
  for (std::size_t i = 0; i < textures.size(); ++i) {
    if (task_of[i] < 0) continue;
    lookup_of_texture[i] = int(lookups_.size());
    const auto& image = images_[std::size_t(task_of[i])];
    lookups_.push_back(lookup_of(std::get<ImageTexture>(textures[i]), image));
  }
  programs_ = compile_textures(textures, lookup_of_texture);
}

TextureTable TextureStore::table() const {
  return {programs_.programs.data(), programs_.nodes.data(), lookups_.data()};
}

std::size_t TextureStore::memory_bytes() const {
  std::size_t bytes = lookups_.size() * sizeof(ImageLookup) +
                      programs_.programs.size() * sizeof(TextureProgram) +
                      programs_.nodes.size() * sizeof(TextureNode);
  for (const TextureImage& image : images_) bytes += image.memory_bytes();
  return bytes;
}

std::uint64_t TextureStore::fingerprint() const {
  Fingerprint print;
  for (const TextureImage& image : images_) image.add_to(print);
  for (const ImageLookup& l : lookups_) {
    for (std::size_t i = 0; i < images_.size(); ++i) {
      if (images_[i].words.data() == l.texels.words) print.add(std::uint32_t(i));
    }
    print.add(std::uint32_t(int(l.wrap_u) | int(l.wrap_v) << 4 | int(l.filter) << 8 |
                            int(l.invert) << 12));
  }
  for (const TextureProgram& p : programs_.programs) print.add(std::uint32_t(p.count));
  for (const TextureNode& node : programs_.nodes) add(print, node);
  return print.value();
}

}  // namespace lockstep
