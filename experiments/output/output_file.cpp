#include "experiments/output/output_file.h"

#include "core/error.h"
#include "core/image.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace lockstep {

namespace fs = std::filesystem;

namespace {

// A device or a pipe, such as /dev/stdout: written in place, for a file must not replace it.
bool is_special(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace

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
  if (is_special(path)) return;
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
  const bool in_place = is_special(path);
  const std::string temporary = in_place ? path : path + ".part";
  std::error_code error;
  errno = 0;
  std::ofstream file(temporary, std::ios::binary);
  file << text;
  file.close();
  if (!file) {
    error.assign(errno ? errno : EIO, std::generic_category());
  } else if (!in_place) {
    fs::rename(temporary, path, error);
  }
  if (!error) return;
  std::error_code ignored;
  if (!in_place) fs::remove(temporary, ignored);
  throw Error(
      fmt::format("{}: cannot be written: {}; make room or choose another place; what was there "
                  "before is unchanged",
                  path, error.message()));
}

void set_aside(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return;
  const fs::path whole(path);
  const std::string stem = (whole.parent_path() / whole.stem()).string() + "-previous";
  std::string target = stem + whole.extension().string();
  for (int n = 2; fs::exists(target, error); ++n) {
    target = fmt::format("{}-{}{}", stem, n, whole.extension().string());
  }
  fs::rename(path, target, error);
  if (error) throw Error(fmt::format("{}: cannot be renamed: {}", path, error.message()));
}

AppendFile::AppendFile(const std::string& path)
    : path_(path), file_(::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {
  if (file_ < 0) fail(errno);
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(file_);
    throw Error(path_ +
                ": another process writes to this file; wait for it, or choose another "
                "folder");
  }
}

AppendFile::~AppendFile() { ::close(file_); }

void AppendFile::fail(int error) const {
  throw Error(fmt::format("{}: cannot be written: {}; what was written before is unchanged", path_,
                          std::strerror(error)));
}

void AppendFile::append(std::string_view text) {
  const off_t size = ::lseek(file_, 0, SEEK_END);
  while (!text.empty()) {
    const ssize_t written = ::write(file_, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int error = written < 0 ? errno : ENOSPC;
      if (::ftruncate(file_, size) != 0) fail(errno);
      fail(error);
    }
    text.remove_prefix(std::size_t(written));
  }
  // Some file systems find out that they are full only now; those that cannot do this are no error.
  if (::fdatasync(file_) != 0 && errno != EINVAL && errno != EROFS) fail(errno);
}

void AppendFile::truncate(std::uint64_t size) {
  if (::ftruncate(file_, off_t(size)) != 0) fail(errno);
}

bool is_being_appended(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool locked = ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  return locked;
}

std::string file_name_safe(std::string_view text) {
  std::string safe(text);
  for (char& c : safe) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '=' && c != '-') c = '_';
  }
  return safe;
}

}  // namespace lockstep
