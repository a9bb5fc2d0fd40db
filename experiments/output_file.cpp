#include "experiments/output_file.h"

#include "core/error.h"
#include "core/image.h"

#include <fmt/format.h>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace lockstep {

namespace fs = std::filesystem;

void check_writable(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    throw Error(fmt::format("{}: is a folder; name a file in it", path));
  }
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, error)) {
    throw Error(
        fmt::format("{}: the folder {} does not exist; create it first", path, folder.string()));
  }
  const std::string probe = path + ".probe";
  errno = 0;
  if (!std::ofstream(probe)) {
    throw Error(fmt::format("{}: cannot write here ({}); choose another place", path,
                            std::strerror(errno)));
  }
  fs::remove(probe, error);
}

void check_writable_image(const std::string& path) {
  if (!can_write_image(path)) {
    throw UsageError(fmt::format("{}: an image file ends in .exr, .hdr, .png or .jpg", path));
  }
  check_writable(path);
}

void make_output_directory(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!fs::is_directory(path)) {
    throw Error(fmt::format("{}: cannot create this folder ({}); choose another place", path,
                            error ? error.message() : "a file is in its place"));
  }
  check_writable((fs::path(path) / "errors.csv").string());
}

void write_text_file(const std::string& path, std::string_view text) {
  const std::string temporary = path + ".part";
  std::ofstream file(temporary, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw Error(fmt::format("{}: cannot be written; is the disk full?", path));
  fs::rename(temporary, path);
}

std::string file_name_safe(std::string_view text) {
  std::string safe(text);
  for (char& c : safe) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '=' && c != '-') c = '_';
  }
  return safe;
}

}  // namespace lockstep
