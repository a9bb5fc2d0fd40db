#include "experiments/report/report.h"

#include "experiments/output/display_image.h"
#include "experiments/output/html_page.h"
#include "experiments/report/series_style.h"

#include <cstdint>
#include <vector>

namespace lockstep {
namespace {

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
  const PagePart parts[] = {
      {"{{CSS}}", report_assets::style}, {"{{D3}}", report_assets::d3},     {"{{DATA}}", data},
      {"{{IMAGES}}", images.elements},   {"{{JS}}", report_assets::script},
  };
  return filled_page(report_assets::page, parts);
}

}  // namespace lockstep
