// A render's film on disk, so that an interrupted or shorter render can be continued.
#pragma once

#include "packets/pass.h"

#include <string>

namespace lockstep {

// All that a render has computed: the films of the pilot, of its first half and of the image, and
// what they cost.
struct RenderState {
  Film pilot, half_pilot, image;
  PassTotals totals;
  double wall_seconds = 0.0;
};

// Restores `state`, whose films have their size already, if `path` is there and was saved under the
// same key, which states all settings that the samples depend on. Returns false where there is no
// such file. Throws Error where the key differs or the file is damaged, which its checksum tells.
bool load_checkpoint(const std::string& path, const std::string& key, RenderState& state);

// Writes `state` beside `path` and renames it into place. Throws Error.
void save_checkpoint(const std::string& path, const std::string& key, const RenderState& state);

}  // namespace lockstep
