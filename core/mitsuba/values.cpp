#include "core/mitsuba/values.h"

#include <charconv>
#include <cmath>
#include <limits>

namespace lockstep::mitsuba {
namespace {

double to_number(const Element& element, const std::string& word) {
  const char* end = word.data() + word.size();
  const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
  double value = 0.0;
  const auto [rest, status] = std::from_chars(first, end, value);
  const bool tiny = status == std::errc::result_out_of_range && std::abs(value) < 1.0;
  if (rest != end || (status != std::errc() && !tiny)) {
    fail(element.where(),
         element.shown() + ": expected a number, found \"" + word.substr(0, 40) + "\"");
  }
  if (!(std::abs(value) <= double(std::numeric_limits<float>::max()))) {
    fail(element.where(), element.shown() + ": a number is beyond the range of float");
  }
  return value;
}

}  // namespace

std::vector<std::string> words_of(const std::string& text) {
  constexpr const char* separators = " \t\r\n,;";
  std::vector<std::string> words;
  for (std::size_t begin = 0; (begin = text.find_first_not_of(separators, begin)) != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

std::vector<double> numbers_of(const Element& element, const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& word : words_of(text)) numbers.push_back(to_number(element, word));
  return numbers;
}

double number(const Element& element, const char* attribute) {
  const std::vector<double> numbers = numbers_of(element, element.attribute(attribute));
  if (numbers.size() != 1) {
    fail(element.where(), element.shown() + " needs a number as its " + attribute);
  }
  return numbers[0];
}

double number(const Element& element, const char* attribute, double fallback) {
  return element.has(attribute) ? number(element, attribute) : fallback;
}

glm::dvec3 vector(const Element& element, double fallback) {
  if (element.has("value")) {
    const std::vector<double> v = numbers_of(element, element.attribute("value"));
    if (v.size() == 1) return glm::dvec3(v[0]);
    if (v.size() == 3) return {v[0], v[1], v[2]};
    fail(element.where(), element.shown() + " needs one or three numbers");
  }
  return {number(element, "x", fallback), number(element, "y", fallback),
          number(element, "z", fallback)};
}

}  // namespace lockstep::mitsuba
