// A render's film on disk, so that an interrupted or shorter render can be continued.
#pragma once

#include "packets/film.h"

#include <string>
#include <vector>

namespace lockstep {

// Restores films from `path` if it is there and was saved under the same key, which states all
// settings that the samples depend on. Returns false where there is no such file.
// Throws Error where the key differs or the file is damaged.
bool load_checkpoint(const std::string& path, const std::string& key, std::vector<Film*> films);

// Writes the films beside `path` and renames them into place. Throws Error.
void save_checkpoint(const std::string& path, const std::string& key,
                     const std::vector<const Film*>& films);

}  // namespace lockstep
