#include "packets/checkpoint.h"

#include "core/error.h"
#include "core/fingerprint.h"

#include <cstring>
#include <filesystem>
#include <fstream>

namespace lockstep {
namespace {

// Raise the number when RenderState or what a sample's value is changes.
constexpr std::string_view magic = "lockstep film 5\n";

template <class T>
void write(std::ostream& out, const T* data, std::size_t count) {
  out.write(reinterpret_cast<const char*>(data), std::streamsize(count * sizeof(T)));
}
template <class T>
void read(std::istream& in, T* data, std::size_t count) {
  in.read(reinterpret_cast<char*>(data), std::streamsize(count * sizeof(T)));
}

void resize_earlier(const Film&) {}  // that is saved: it has its size
void resize_earlier(Film& film) { film.earlier.resize(film.sums.size()); }

// Visits everything that is kept, for reading and writing alike.
template <class S, class F>
void for_each_part(S& state, F f) {
  for (auto* film : {&state.pilot, &state.half_pilot, &state.image}) {
    f(&film->samples, 1);
    f(film->sums.data(), film->sums.size());
    if (film->samples > film_block) {
      resize_earlier(*film);
      f(film->earlier.data(), film->earlier.size());
    }
  }
  f(&state.totals, 1);
  f(&state.wall_seconds, 1);
}

// Of all that is kept: any single word that is read as another gives another.
std::uint64_t checksum(const RenderState& state) {
  Fingerprint sum;
  for_each_part(state, [&](const auto* data, std::size_t count) {
    static_assert(sizeof *data % sizeof(std::uint32_t) == 0);
    const auto* bytes = reinterpret_cast<const char*>(data);
    for (std::size_t at = 0; at < count * sizeof *data; at += sizeof(std::uint32_t)) {
      std::uint32_t word = 0;
      std::memcpy(&word, bytes + at, sizeof word);
      sum.add(word);
    }
  });
  return sum.value();
}

}  // namespace

bool load_checkpoint(const std::string& path, const std::string& key, RenderState& state) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return false;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path + ": cannot read the saved film; check its permissions");
  std::string found_magic(magic.size(), '\0'), found_key(key.size(), '\0');
  read(in, found_magic.data(), found_magic.size());
  std::uint64_t key_size = 0;
  read(in, &key_size, 1);
  if (!in || found_magic != magic)
    throw Error(path + ": not a saved film; remove it to start anew");
  if (key_size == key.size()) read(in, found_key.data(), found_key.size());
  if (found_key != key) {
    throw Error(path +
                ": saved with another scene or other settings (for rcs, a pilot that follows "
                "spp is one: give pilot=N); use them again, or remove it to start anew");
  }
  for_each_part(state, [&](auto* data, std::size_t count) { read(in, data, count); });
  std::uint64_t sum = 0;
  read(in, &sum, 1);
  if (!in || sum != checksum(state) || in.peek() != std::char_traits<char>::eof()) {
    throw Error(path + ": the saved film is damaged; remove it to start anew");
  }
  return true;
}

void save_checkpoint(const std::string& path, const std::string& key, const RenderState& state) {
  const std::string beside = path + ".tmp";
  std::ofstream out(beside, std::ios::binary);
  write(out, magic.data(), magic.size());
  const std::uint64_t key_size = key.size();
  write(out, &key_size, 1);
  write(out, key.data(), key.size());
  for_each_part(state, [&](const auto* data, std::size_t count) { write(out, data, count); });
  const std::uint64_t sum = checksum(state);
  write(out, &sum, 1);
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(beside, path, error);
  if (!out || error) {
    std::filesystem::remove(beside, error);
    throw Error(path + ": cannot write the film; check space and permissions");
  }
}

}  // namespace lockstep
