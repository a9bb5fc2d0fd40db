// Checks made before a long run, so that it does not fail when its result is to be written.
#pragma once

#include <string>
#include <string_view>

namespace lockstep {

// Throws Error where no file can be created at `path`.
void check_writable(const std::string& path);

// check_writable, and the extension is one that write_image knows.
void check_writable_image(const std::string& path);

// Creates the directory and its parents. Throws Error where that fails or nothing can be written.
void make_output_directory(const std::string& path);

// Writes beside the place and renames: the file appears whole or not at all. Throws Error.
void write_text_file(const std::string& path, std::string_view text);

// `text` with all but letters, digits, '.', '=' and '-' replaced, for use in file names.
std::string file_name_safe(std::string_view text);

}  // namespace lockstep
