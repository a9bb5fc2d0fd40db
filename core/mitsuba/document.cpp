#include "core/mitsuba/document.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <utility>

namespace lockstep::mitsuba {
namespace {

namespace fs = std::filesystem;

constexpr int deepest_nesting = 64, deepest_include = 16, most_documents = 1000;
constexpr std::size_t longest_value = 1 << 20, most_substituted = 1 << 26;
constexpr std::uintmax_t largest_file = std::uintmax_t(1) << 30;

std::string read_text(const std::string& path, const Location& from) {
  const auto refuse = [&](const std::string& why) {
    if (from.file.empty()) throw Error(path + ": " + why);
    fail(from, path + ": " + why);
  };
  std::error_code error;
  const bool is_file = fs::is_regular_file(path, error);
  const std::uintmax_t size = is_file ? fs::file_size(path, error) : 0;
  std::ifstream stream(path, std::ios::binary);
  if (!is_file || !stream) refuse("cannot be opened; check the path");
  if (size > largest_file) refuse("is larger than 1 GiB; move meshes to files of their own");
  std::string text(std::size_t(size), '\0');
  stream.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(stream.gcount()));
  return text;
}

int line_at(const Document& document, std::ptrdiff_t offset) {
  const auto& ends = document.line_ends;
  const auto after = std::upper_bound(ends.begin(), ends.end(),
                                      std::size_t(std::max<std::ptrdiff_t>(offset, 1) - 1));
  return int(after - ends.begin()) + 1;
}

// Before anything recurses into the tree.
struct DepthCheck : pugi::xml_tree_walker {
  const Document* document = nullptr;
  bool for_each(pugi::xml_node& node) override {
    if (depth() > deepest_nesting) {
      fail(Element{node, document}.where(),
           "tags are nested more than " + std::to_string(deepest_nesting) + " deep");
    }
    return true;
  }
};

std::unique_ptr<Document> parse(const std::string& path, const Location& from) {
  auto document = std::make_unique<Document>();
  document->path = path;
  const std::string text = read_text(path, from);
  for (std::size_t i = text.find('\n'); i != text.npos; i = text.find('\n', i + 1)) {
    document->line_ends.push_back(i);
  }
  // Entities that a DOCTYPE defines are never expanded.
  const pugi::xml_parse_result result = document->xml.load_buffer(text.data(), text.size());
  if (!result) {
    fail({path, line_at(*document, result.offset)},
         std::string("is not proper XML: ") + result.description());
  }
  DepthCheck check;
  check.document = document.get();
  document->xml.traverse(check);
  return document;
}

class Loader {
 public:
  Loader(Sources& sources, Warnings& warnings) : sources_(sources), warnings_(warnings) {}

  void load(const std::string& path, const Location& from) {
    std::error_code ignored;
    const fs::path canonical = fs::weakly_canonical(path, ignored);
    if (std::find(open_.begin(), open_.end(), canonical) != open_.end()) {
      fail(from, "the file " + path + " includes itself");
    }
    if (open_.size() >= deepest_include || sources_.documents.size() >= most_documents) {
      fail(from, "too many files are included");
    }
    open_.push_back(canonical);
    sources_.documents.push_back(parse(path, from));
    const Document& document = *sources_.documents.back();
    const pugi::xml_node root = document.xml.document_element();
    if (!root) throw Error(path + ":1: the file has no tags, so it describes no scene");
    const Element top{root, &document};
    if (plain(root.name()) == "scene") {
      prepare_one(top);
      if (open_.size() == 1) sources_.modern = root.attribute("version").as_int(3) >= 2;
      for (const Element& child : top.children()) add_top_level(child);
    } else if (open_.size() > 1) {
      add_top_level(top);
    } else {
      fail(top.where(), "expected <scene>, found " + top.shown());
    }
    open_.pop_back();
  }

 private:
  void add_top_level(const Element& element) {
    prepare(element);
    if (element.tag() == "include") {
      const std::string name = element.attribute("filename");
      if (name.empty()) fail(element.where(), "<include> needs a filename");
      load(resolve(sources_, element, name), element.where());
    } else if (element.tag() == "path") {
      const fs::path folder = element.attribute("value");
      sources_.folders.push_back(
          (fs::path(element.document->path).parent_path() / folder).string());
    } else if (element.tag() != "default" && element.tag() != "alias") {
      sources_.top_level.push_back(element);
    }
  }

  // Recursion goes no deeper than DepthCheck allows.
  void prepare(const Element& element) {
    prepare_one(element);
    for (const Element& child : element.children()) prepare(child);
  }

  void prepare_one(const Element& element) {
    pugi::xml_node node = element.node;
    for (pugi::xml_attribute a : node.attributes()) {
      const std::string value = a.value();
      if (value.find('$') != value.npos) a.set_value(substituted(value, element).c_str());
    }
    const std::string tag = element.tag();
    if (tag == "default") {
      values_.try_emplace(element.attribute("name"), element.attribute("value"));
    } else if (tag == "alias") {
      const auto target = sources_.by_id.find(element.attribute("id"));
      if (target == sources_.by_id.end()) {
        fail(element.where(), "no object before has the id \"" + element.attribute("id") + "\"");
      }
      sources_.by_id.try_emplace(element.attribute("as"), target->second);
    } else if (element.has("id") && tag != "ref") {
      if (!sources_.by_id.try_emplace(element.attribute("id"), element).second) {
        warnings_.add(element.where(), "the id \"" + element.attribute("id") +
                                           "\" is used twice; the first is used");
      }
    }
  }

  // Parameters are those with the longest names that fit.
  std::string substituted(const std::string& text, const Element& element) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
      if (text[at] != '$') {
        result += text[at++];
        continue;
      }
      std::size_t end = ++at;
      while (end < text.size() &&
             (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_')) {
        ++end;
      }
      // No name is so long; text of any length would be searched for ever.
      constexpr std::size_t longest_name = 256;
      std::size_t length = std::min(end - at, longest_name);
      auto found = values_.find(text.substr(at, length));
      while (found == values_.end() && length > 1) found = values_.find(text.substr(at, --length));
      if (found == values_.end()) {
        const std::string name = text.substr(at, std::min<std::size_t>(end - at, 40));
        fail(element.where(), "the parameter $" + name + " has no value; add <default name=\"" +
                                  name + "\" value=\"...\"/>");
      }
      result += found->second;
      at += length;
      if (result.size() > longest_value) fail(element.where(), "a value is too long");
    }
    substituted_ += result.size();
    if (substituted_ > most_substituted) {
      fail(element.where(), "the values that parameters stand for are too long in all");
    }
    return result;
  }

  Sources& sources_;
  Warnings& warnings_;
  std::vector<fs::path> open_;
  std::map<std::string, std::string> values_;
  std::size_t substituted_ = 0;  // bytes in all: values of values grow fast
};

}  // namespace

std::string plain(std::string_view name) {
  std::string result;
  for (const char c : name) {
    if (c != '_') result += char(std::tolower(static_cast<unsigned char>(c)));
  }
  return result;
}

Location Element::where() const {
  return {document->path, line_at(*document, node.offset_debug())};
}

std::vector<Element> Element::children() const {
  std::vector<Element> result;
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() == pugi::node_element) result.push_back({child, document});
  }
  return result;
}

std::string Element::shown() const {
  std::string result = "<";
  result += std::string_view(node.name()).substr(0, 40);
  for (const char* name : {"type", "name"}) {
    if (has(name)) result += std::string(" ") + name + "=\"" + attribute(name).substr(0, 40) + "\"";
  }
  return result + ">";
}

Sources read_sources(const std::string& path, Warnings& warnings) {
  Sources sources;
  Loader(sources, warnings).load(path, {});
  return sources;
}

std::string resolve(const Sources& sources, const Element& element, const std::string& name) {
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  const fs::path file = slashes;
  const fs::path beside = fs::path(element.document->path).parent_path() / file;
  std::error_code ignored;
  if (fs::exists(beside, ignored)) return beside.string();
  std::vector<fs::path> folders{fs::path(sources.documents.front()->path).parent_path()};
  folders.insert(folders.end(), sources.folders.begin(), sources.folders.end());
  for (const fs::path& folder : folders) {
    if (fs::exists(folder / file, ignored)) return (folder / file).string();
  }
  return beside.string();
}

}  // namespace lockstep::mitsuba
