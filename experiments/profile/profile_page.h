// profile.html: one page that shows a profile, readable without network and without the program.
#pragma once

#include "experiments/profile/profile.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace lockstep {

// What the page shows.
nlohmann::ordered_json profile_json(const Profile& profile, const ProfileSettings& settings);

std::string profile_html(const Profile& profile, const ProfileSettings& settings);

// Sources of the page, embedded at build time.
namespace profile_assets {
extern const std::string_view page;  // with {{CSS}}, {{D3}}, {{DATA}} and {{JS}} to fill in
extern const std::string_view style;
extern const std::string_view script;
}  // namespace profile_assets

}  // namespace lockstep
