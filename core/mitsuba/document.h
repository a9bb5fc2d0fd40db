// The XML files of a Mitsuba scene: the main one and those that it includes, with parameters put in
// place, ids collected and every tag's line known.
#pragma once

#include "core/location.h"

#include <pugixml.hpp>

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lockstep::mitsuba {

// Names as they are compared: 0.x writes toWorld and intIOR, 2 and 3 write to_world and int_ior.
std::string plain(std::string_view name);

struct Document {
  std::string path;
  pugi::xml_document xml;
  std::vector<std::size_t> line_ends;  // offsets of the newlines
};

// A tag of one of the files. Cheap to copy; valid as long as the Sources it is from.
struct Element {
  pugi::xml_node node;
  const Document* document = nullptr;

  std::string tag() const { return plain(node.name()); }
  Location where() const;
  bool has(const char* attribute) const { return !node.attribute(attribute).empty(); }
  std::string attribute(const char* name) const { return node.attribute(name).as_string(); }
  std::vector<Element> children() const;  // tags only
  std::string shown() const;              // <tag type="..." name="...">, for messages
};

struct Sources {
  std::vector<std::unique_ptr<Document>> documents;
  std::vector<Element> top_level;        // what <scene> holds, includes put in their place
  std::map<std::string, Element> by_id;  // with aliases
  std::vector<std::string> folders;      // of <path>
  bool modern = false;                   // Mitsuba 2 or 3, by the version that <scene> states
};

// Reads the file `path` and what it includes. Throws Error where a file is missing or no XML,
// nested too deeply, includes itself, or uses a parameter that has no value.
Sources read_sources(const std::string& path, Warnings& warnings);

// The path of file `name`, which `element` mentions: beside its document, beside the main file, or
// in one of the folders; beside its document where it is nowhere.
std::string resolve(const Sources& sources, const Element& element, const std::string& name);

}  // namespace lockstep::mitsuba
