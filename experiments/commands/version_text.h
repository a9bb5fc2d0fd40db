// What this program was built from, how, and what it runs on.
#pragma once

#include <string>

namespace lockstep {

// The version on the first line; then commit, compiler, instruction sets and libraries.
std::string version_text();

// Generated at build time: the commit that was built and whether files differ from it, or empty
// where there is no repository.
extern const char* const build_commit;

}  // namespace lockstep
