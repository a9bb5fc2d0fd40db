#include "experiments/report.h"

#include <utility>

namespace lockstep {
namespace {

// JSON that may stand in a script element: no "</" ends it early.
std::string embeddable(const nlohmann::ordered_json& json) {
  std::string text = json.dump();
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3) {
    text.replace(at, 2, "<\\/");
  }
  return text;
}

}  // namespace

std::string report_html(const nlohmann::ordered_json& summary) {
  const std::string data = embeddable(summary);
  const std::pair<std::string_view, std::string_view> parts[] = {
      {"{{CSS}}", report_assets::style},
      {"{{D3}}", report_assets::d3},
      {"{{DATA}}", data},
      {"{{JS}}", report_assets::script},
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
