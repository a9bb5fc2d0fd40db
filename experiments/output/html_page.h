// Pages for people: one HTML file with everything inside.
#pragma once

#include <nlohmann/json.hpp>

#include <span>
#include <string>
#include <string_view>

namespace lockstep {

// JSON that may stand in a script element: without "<", nothing in it ends or hides that. Text that
// is not UTF-8 loses the bytes that are not.
std::string embeddable(const nlohmann::ordered_json& json);

struct PagePart {
  std::string_view mark;  // such as "{{CSS}}": every part's is in the page, in the parts' order
  std::string_view text;
};

// The page with each mark replaced. What is filled in is never searched for marks.
std::string filled_page(std::string_view page, std::span<const PagePart> parts);

}  // namespace lockstep
