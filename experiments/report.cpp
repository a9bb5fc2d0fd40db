#include "experiments/report.h"

#include "experiments/display_image.h"
#include "experiments/series_style.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace lockstep {
namespace {

// JSON that may stand in a script element: without "<", nothing in it ends or hides that. File
// names that are not UTF-8 lose the bytes that are not.
std::string embeddable(const nlohmann::ordered_json& json) {
  using Json = nlohmann::ordered_json;
  std::string text;
  for (char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

// Display codes of magma, RGB after RGB, for 256 values from 0 to 1.
nlohmann::ordered_json magma_codes() {
  Image ramp(256, 1, 1);
  for (int x = 0; x < ramp.width; ++x) *ramp.at(x, 0) = float(x) / float(ramp.width - 1);
  const Image colours = magma(ramp);
  std::vector<std::uint8_t> codes(colours.pixels.size());
  display_codes(colours.pixels.data(), int(codes.size()), codes.data());
  return codes;
}

}  // namespace

std::string report_html(const nlohmann::ordered_json& summary, const ReportImages& images) {
  const std::string data = embeddable({{"summary", summary},
                                       {"images", images.index},
                                       {"magma", magma_codes()},
                                       {"colours", kSeriesColours},
                                       {"series_per_dash", kSeriesPerDash}});
  const std::pair<std::string_view, std::string_view> parts[] = {
      {"{{CSS}}", report_assets::style}, {"{{D3}}", report_assets::d3},     {"{{DATA}}", data},
      {"{{IMAGES}}", images.elements},   {"{{JS}}", report_assets::script},
  };
  // Parts stand in the page in this order; what is filled in is never searched again.
  std::string html;
  std::string_view rest = report_assets::page;
  for (const auto& [mark, text] : parts) {
    const std::size_t at = rest.find(mark);
    html += rest.substr(0, at);
    html += text;
    rest.remove_prefix(at + mark.size());
  }
  return html += rest;
}

}  // namespace lockstep
