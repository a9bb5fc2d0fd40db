// report.html: one page that shows a comparison, readable without network and without the program.
// Images stand beside it as files; everything else is inside.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace lockstep {

// The page for what summarize() made.
std::string report_html(const nlohmann::ordered_json& summary);

// Sources of the page, embedded at build time.
namespace report_assets {
extern const std::string_view page;  // with {{CSS}}, {{D3}}, {{DATA}} and {{JS}} to fill in
extern const std::string_view style;
extern const std::string_view script;
extern const std::string_view d3;
}  // namespace report_assets

}  // namespace lockstep
