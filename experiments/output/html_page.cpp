#include "experiments/output/html_page.h"

namespace lockstep {

std::string embeddable(const nlohmann::ordered_json& json) {
  std::string text;
  for (char c : json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

std::string filled_page(std::string_view page, std::span<const PagePart> parts) {
  std::string html;
  for (const PagePart& part : parts) {
    const std::size_t at = page.find(part.mark);
    html += page.substr(0, at);
    html += part.text;
    page.remove_prefix(at + part.mark.size());
  }
  return html += page;
}

}  // namespace lockstep
