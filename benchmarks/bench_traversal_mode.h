// The traversal that belongs to a kernel's width, for figures that compare widths.
#pragma once

#include "packets/traversal_mode.h"

namespace lockstep {

// Packets of `width` lanes without the coherent flag; single rays for a width of 1.
constexpr TraversalMode packets_of(int width) {
  return {width == 1   ? Packets::Single
          : width == 4 ? Packets::Four
          : width == 8 ? Packets::Eight
                       : Packets::Sixteen,
          false};
}

}  // namespace lockstep
