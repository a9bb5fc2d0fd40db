#include "packets/checkpoint.h"

#include "core/error.h"

#include <filesystem>
#include <fstream>

namespace lockstep {
namespace {

constexpr std::string_view magic = "lockstep film 1\n";

template <class T>
void write(std::ostream& out, const T* data, std::size_t count) {
  out.write(reinterpret_cast<const char*>(data), std::streamsize(count * sizeof(T)));
}
template <class T>
void read(std::istream& in, T* data, std::size_t count) {
  in.read(reinterpret_cast<char*>(data), std::streamsize(count * sizeof(T)));
}

}  // namespace

bool load_checkpoint(const std::string& path, const std::string& key, std::vector<Film*> films) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return false;
  std::string found_magic(magic.size(), '\0'), found_key(key.size(), '\0');
  read(in, found_magic.data(), found_magic.size());
  std::uint64_t key_size = 0;
  read(in, &key_size, 1);
  if (!in || found_magic != magic) throw Error(path + ": not a saved film; remove it to start anew");
  if (key_size == key.size()) read(in, found_key.data(), found_key.size());
  if (found_key != key) {
    throw Error(path + ": saved with other settings; use them again, or remove it to start anew");
  }
  for (Film* film : films) {
    read(in, &film->samples, 1);
    read(in, film->sum.data(), film->sum.size());
    read(in, film->count.data(), film->count.size());
  }
  if (!in) throw Error(path + ": the saved film is cut off; remove it to start anew");
  return true;
}

void save_checkpoint(const std::string& path, const std::string& key,
                     const std::vector<const Film*>& films) {
  const std::string beside = path + ".tmp";
  {
    std::ofstream out(beside, std::ios::binary);
    write(out, magic.data(), magic.size());
    const std::uint64_t key_size = key.size();
    write(out, &key_size, 1);
    write(out, key.data(), key.size());
    for (const Film* film : films) {
      write(out, &film->samples, 1);
      write(out, film->sum.data(), film->sum.size());
      write(out, film->count.data(), film->count.size());
    }
    out.flush();
    if (!out) {
      std::error_code ignored;
      std::filesystem::remove(beside, ignored);
      throw Error(path + ": cannot write the film; check space and permissions");
    }
  }
  std::filesystem::rename(beside, path);
}

}  // namespace lockstep
