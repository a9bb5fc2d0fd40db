// Files that results go to: checked before a long run, so that it does not fail when its result is
// to be written, and written so that nothing is lost when it is stopped or the disk is full.
#pragma once

#include <cstdint>
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

// Gives an earlier file the name that it has with "-previous" before its extension, numbered where
// that is taken. Does nothing where there is none. Throws Error.
void set_aside(const std::string& path);

// A file that lines are added to, each whole or not at all and on the disk when append() returns.
class AppendFile {
 public:
  // Opens or creates it, and keeps other processes from opening it so. Throws Error.
  explicit AppendFile(const std::string& path);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  // Throws Error where the text cannot be written; the file then ends as it did before.
  void append(std::string_view text);

  // Cuts off what follows the first `size` bytes. Throws Error.
  void truncate(std::uint64_t size);

 private:
  [[noreturn]] void fail(int error) const;
  std::string path_;
  int file_ = -1;
};

// True where some process has an AppendFile of this path open.
bool is_being_appended(const std::string& path);

// `text` with all but letters, digits, '.', '=' and '-' replaced, for use in file names.
std::string file_name_safe(std::string_view text);

}  // namespace lockstep
