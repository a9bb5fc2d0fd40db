// The bytes that glTF files refer to: files, data URIs, chunks of the binary container.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lockstep::gltf {

using Bytes = std::vector<unsigned char>;

// A regular file's bytes; nothing where it cannot be read. Pipes and devices, which might never
// end, are not opened.
std::optional<Bytes> read_file(const std::string& path);

inline bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

// What a data URI of any media type holds (RFC 2397), base64 (RFC 4648) or percent-encoded; nothing
// where it is malformed.
std::optional<Bytes> decode_data_uri(std::string_view uri);

// The path that a relative URI in `file` means, with its percent-encoding undone.
std::string resolve_uri(const std::string& file, std::string_view uri);

// The two chunks that glTF 2.0 defines (specification, section 4.4), as ranges of the file.
struct Container {
  std::string_view json;
  std::string_view binary;  // empty: none
};

bool is_container(std::string_view file);

// Throws Error ("what is wrong", without the file's name) where a length does not fit.
Container split_container(std::string_view file);

}  // namespace lockstep::gltf
