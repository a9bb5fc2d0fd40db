// tinygltf 2.7 reads images past the end of their buffers, wants files of exactly a buffer's size,
// decodes + in URIs, opens pipes and recurses through extras. So it is given the JSON alone, with a
// bounded depth and without what refers to bytes; buffers and images are read here.
#include "core/gltf/document.h"

#include "core/gltf/extensions.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>

namespace lockstep::gltf {

namespace {

using Json = nlohmann::json;

struct BufferSource {
  std::optional<std::string> uri;  // nothing: the container's binary chunk
  std::size_t size = 0;
};

// How deep arrays and objects are nested. nlohmann's parser could count with a callback, but then
// takes time quadratic in the length of an array.
int depth_of(std::string_view text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return deepest;
}

Json parse_json(const Document& document, std::string_view text) {
  if (depth_of(text) > 100) fail(document.path, "the JSON is nested more than 100 deep");
  try {
    Json json = Json::parse(text);
    if (!json.is_object()) fail(document.path, "not a glTF file: the JSON is not an object");
    return json;
  } catch (const nlohmann::json::exception& error) {
    fail(document.path, std::string("not a glTF file, or damaged: ") + error.what());
  }
}

// The array `name` of the file, taken out of it; empty where there is none.
Json take_array(const Document& document, Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end()) return Json::array();
  Json array = std::move(*found);
  json.erase(found);
  if (!array.is_array()) fail(document.path, std::string("\"") + name + "\" is not an array");
  for (const Json& element : array) {
    if (!element.is_object()) {
      fail(document.path, std::string("\"") + name + "\" has an element that is not an object");
    }
  }
  return array;
}

std::string take_string(Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_string()) return "";
  return std::move(found->get_ref<std::string&>());
}

std::vector<BufferSource> take_buffers(const Document& document, Json& json) {
  std::vector<BufferSource> sources;
  for (Json& object : take_array(document, json, "buffers")) {
    BufferSource source;
    const auto size = object.find("byteLength");
    if (size == object.end() || !size->is_number_unsigned()) {
      fail(document.path, "buffer " + std::to_string(sources.size()) + " needs a byteLength");
    }
    source.size = size->get<std::size_t>();
    if (object.contains("uri")) source.uri = take_string(object, "uri");
    sources.push_back(std::move(source));
  }
  return sources;
}

std::vector<ImageSource> take_images(const Document& document, Json& json) {
  std::vector<ImageSource> sources;
  for (Json& object : take_array(document, json, "images")) {
    ImageSource source;
    source.name = take_string(object, "name");
    source.uri = take_string(object, "uri");
    const auto view = object.find("bufferView");
    if (view != object.end() && view->is_number_unsigned()) {
      const auto index = view->get<std::uint64_t>();
      source.buffer_view = index <= 0x7fffffff ? static_cast<int>(index) : -1;
    }
    sources.push_back(std::move(source));
  }
  return sources;
}

void check_version(const Document& document, const Json& json) {
  const auto asset = json.find("asset");
  if (asset == json.end() || !asset->is_object()) {
    fail(document.path, "not a glTF file: \"asset\" is missing");
  }
  for (const char* key : {"version", "minVersion"}) {
    const auto version = asset->find(key);
    if (version == asset->end() || !version->is_string()) continue;
    const auto& text = version->get_ref<const std::string&>();
    const bool known = *key == 'v' ? text.starts_with("2.") : text == "2.0";
    if (!known) fail(document.path, "glTF version " + text + " is not understood; export 2.0");
  }
}

void parse_model(Document& document, const Json& json) {
  const std::string text = json.dump();
  if (text.size() > std::numeric_limits<unsigned>::max())
    fail(document.path, "the JSON is too long");
  std::string error, warning;
  bool parsed = false;
  try {
    parsed = tinygltf::TinyGLTF().LoadASCIIFromString(
        &document.model, &error, &warning, text.data(), static_cast<unsigned>(text.size()), "");
  } catch (const std::exception& thrown) {
    error = thrown.what();
  }
  // Some errors leave elements out, which would renumber the others.
  if (!parsed || !error.empty()) {
    fail(document.path, error.empty() ? "the file is not valid glTF" : error);
  }
}

// By the path they are read from. Each buffer holds its own copy.
using FileUses = std::map<std::string, int>;

void count_use(const Document& document, const std::string& path, FileUses& uses) {
  constexpr int most = 16;
  std::error_code ignored;
  const std::string file = std::filesystem::weakly_canonical(path, ignored).string();
  if (++uses[file] > most) {
    fail(document.path, "more than " + std::to_string(most) + " buffers are the file " + path +
                            "; use bufferViews of one");
  }
}

Bytes load_buffer(const Document& document, int index, const BufferSource& source,
                  std::string_view binary_chunk, FileUses& uses) {
  const std::string name = "buffer " + std::to_string(index);
  std::optional<Bytes> bytes;
  if (!source.uri) {
    if (index != 0 || binary_chunk.empty()) fail(document.path, name + " has no URI");
    if (binary_chunk.size() >= source.size) binary_chunk = binary_chunk.substr(0, source.size);
    bytes.emplace(binary_chunk.begin(), binary_chunk.end());
  } else if (is_data_uri(*source.uri)) {
    bytes = decode_data_uri(*source.uri);
    if (!bytes) fail(document.path, name + " has a malformed data URI");
  } else {
    const std::string path = resolve_uri(document.path, *source.uri);
    count_use(document, path, uses);
    bytes = read_file(path);
    if (!bytes) fail(document.path, name + ": cannot read " + path + "; put it there");
  }
  if (bytes->size() < source.size) {
    fail(document.path, name + " has " + std::to_string(bytes->size()) +
                            " bytes, but its byteLength is " + std::to_string(source.size));
  }
  bytes->resize(source.size);
  return std::move(*bytes);
}

}  // namespace

Document load_document(const std::string& path) {
  Document document(path);
  const std::optional<Bytes> file = read_file(path);
  if (!file) fail(path, "cannot be read; check the path");
  const std::string_view text(reinterpret_cast<const char*>(file->data()), file->size());
  Container container{text, {}};
  if (is_container(text)) {
    try {
      container = split_container(text);
    } catch (const Error& error) {
      fail(path, error.what());
    }
  }

  Json json = parse_json(document, container.json);
  check_version(document, json);
  const std::vector<BufferSource> buffers = take_buffers(document, json);
  document.images = take_images(document, json);
  if (!take_array(document, json, "animations").empty()) {
    document.warnings.add("", "animations are not supported; nodes stay where they are");
  }
  json.erase("skins");
  parse_model(document, json);
  check_extensions(document);
  FileUses uses;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    tinygltf::Buffer buffer;
    buffer.data = load_buffer(document, static_cast<int>(i), buffers[i], container.binary, uses);
    document.model.buffers.push_back(std::move(buffer));
  }
  return document;
}

}  // namespace lockstep::gltf
