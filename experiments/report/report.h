// report.html: one page that shows a comparison, readable without network and without the program.
// Everything is inside: charts, images with their values, settings.
#pragma once

#include "experiments/report/report_images.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace lockstep {

// Pages stay below 30 MB, of which text, script and numbers take less than 4.
constexpr std::size_t kReportImageBytes = 26'000'000;

// The page for what summarize() made.
std::string report_html(const nlohmann::ordered_json& summary, const ReportImages& images);

// Sources of the page, embedded at build time.
namespace report_assets {
extern const std::string_view page;  // with {{CSS}}, {{D3}}, {{DATA}}, {{IMAGES}} and {{JS}}
extern const std::string_view style;
extern const std::string_view script;
extern const std::string_view d3;
}  // namespace report_assets

}  // namespace lockstep
