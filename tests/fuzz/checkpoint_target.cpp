// Saved films. The input says how one is damaged: its first four bytes where it is cut off (0: not
// at all), each five bytes more a place and a byte to put there, behind the end too.
#include "packets/checkpoint.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/own_errors.h"
#include "tests/fuzz/playground.h"

#include <fstream>
#include <iterator>
#include <string>

namespace lockstep::fuzz {
namespace {

constexpr const char* key = "scene and settings";

RenderState empty_state() {
  RenderState state;
  for (Film* film : {&state.pilot, &state.half_pilot, &state.image}) *film = Film(3, 2);
  return state;
}

std::string saved(const std::string& path) {
  RenderState state = empty_state();
  state.image.samples = 5;
  state.image.sums.assign(state.image.sums.size(), 2.5);
  save_checkpoint(path, key, state);
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::uint32_t word(const std::uint8_t* bytes) {
  return bytes[0] | std::uint32_t(bytes[1]) << 8 | std::uint32_t(bytes[2]) << 16 |
         std::uint32_t(bytes[3]) << 24;
}

std::string damaged(std::string film, const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t head = 4, edit = 5;
  if (size < head) return film;
  const std::size_t end = film.size() + film.size() / 4;
  if (const std::uint32_t cut = word(data); cut > 0) film.resize(cut % end);
  for (std::size_t i = head; i + edit <= size; i += edit) {
    const std::size_t at = word(data + i) % end;
    film.resize(std::max(film.size(), at + 1));
    film[at] = char(data[i + head]);
  }
  return film;
}

void check_load(const std::string& path, bool whole) {
  RenderState state = empty_state();
  try {
    require(load_checkpoint(path, key, state), "a file is not seen");
  } catch (const Error&) {
    require(!whole, "a film that is whole is refused");
    throw;
  }
  require(state.image.sums.size() == empty_state().image.sums.size(), "a film of another size");
  require(!whole || (state.image.samples == 5 && state.image.sums.back() == 2.5), "another film");
}

}  // namespace
}  // namespace lockstep::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lockstep::fuzz;
  static const Playground playground;
  static const std::string film = saved(playground.path("input.film"));
  const std::string bytes = damaged(film, data, size);
  const std::string path = playground.write("input.film", bytes.data(), bytes.size());
  expect_own_errors("checkpoint", [&] { check_load(path, bytes == film); });
  return 0;
}
