// A closed set of types, each known by its place.
#pragma once

#include <array>
#include <utility>

namespace lockstep {

template <class... Ts>
struct TypeList {
  static constexpr int size = sizeof...(Ts);

  // What each says of itself.
  static constexpr auto infos() { return std::array{Ts::info...}; }

  // Calls f with a value of the type at `place`.
  template <class F>
  static void visit(int place, const F& f) {
    int i = 0;
    (void)((i++ == place && (f(Ts{}), true)) || ...);
  }
};

}  // namespace lockstep
