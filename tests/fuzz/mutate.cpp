#include "tests/fuzz/mutate.h"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace lockstep::fuzz {
namespace {

constexpr std::size_t longest = std::size_t(1) << 18;

struct Span {
  std::size_t begin = 0, size = 0;
};

// Mostly short: long ones leave little of a file.
Span random_span(const std::string& text, Random& random) {
  const std::size_t begin = random.below(text.size());
  const std::size_t most = random.below(4) == 0 ? text.size() : 32;
  return {begin, std::min(1 + random.below(most), text.size() - begin)};
}

// Words of a text file rather than bytes: one that starts and ends at a blank.
Span random_words(const std::string& text, Random& random) {
  Span span = random_span(text, random);
  constexpr const char* blanks = " \t\n,[]{}<>\"";
  const std::size_t begin = text.find_last_of(blanks, span.begin);
  span.size += begin == text.npos ? 0 : span.begin - begin;
  span.begin = begin == text.npos ? span.begin : begin;
  const std::size_t end = text.find_first_of(blanks, std::min(span.begin + span.size, text.size()));
  if (end != text.npos) span.size = end - span.begin;
  return span;
}

Span any_span(const std::string& text, Random& random) {
  return random.below(2) ? random_words(text, random) : random_span(text, random);
}

void flip(std::string& text, Random& random) {
  for (std::size_t n = 1 + random.below(4); n > 0; --n) {
    text[random.below(text.size())] ^= char(1u << random.below(8));
  }
}

void erase(std::string& text, Random& random) {
  const Span s = any_span(text, random);
  text.erase(s.begin, s.size);
}

void repeat(std::string& text, Random& random, std::size_t times) {
  const Span s = any_span(text, random);
  const std::string piece = text.substr(s.begin, s.size);
  std::string many;
  for (std::size_t i = 0; i < times && many.size() + text.size() < longest; ++i) many += piece;
  text.insert(s.begin, many);
}

void move(std::string& text, Random& random) {
  const Span s = any_span(text, random);
  const std::string piece = text.substr(s.begin, s.size);
  text.erase(s.begin, s.size);
  text.insert(random.below(text.size() + 1), piece);
}

void splice(std::string& text, const std::string& other, Random& random) {
  const Span from = any_span(other, random), to = any_span(text, random);
  text.replace(to.begin, to.size, other, from.begin, from.size);
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

void replace_number(std::string& text, Random& random) {
  constexpr std::string_view extremes[] = {
      "0",   "-1",   "1",        "2",          "1e38",       "-1e38", "3e-39",
      "nan", "-inf", "1e999",    "4294967295", "2147483648", "0.5",   "18446744073709551616",
      "180", "1e30", "99999999", "-2147483649"};
  const std::string_view extreme = extremes[random.below(std::size(extremes))];
  const auto from = text.begin() + std::ptrdiff_t(random.below(text.size()));
  const auto begin = std::find_if(from, text.end(), is_digit);
  const auto end =
      std::find_if_not(begin, text.end(), [](char c) { return is_digit(c) || c == '.'; });
  if (begin != text.end()) text.replace(begin, end, extreme.begin(), extreme.end());
}

void replace_word(std::string& text, Random& random) {
  constexpr std::uint32_t extremes[] = {0,          1,          0xffffffff, 0x7fffffff, 0x80000000,
                                        0x7f800000, 0x7fc00000, 0x7e967699, 0x00000100, 0x01000000};
  if (text.size() < 4) return;
  const std::size_t at = random.below(text.size() - 3);
  std::uint32_t value = extremes[random.below(std::size(extremes))];
  for (std::size_t i = 0; i < 4; ++i, value >>= 8) text[at + i] = char(value);
}

bool is_text(const std::string& text) { return text.find('\0') == text.npos; }

void change(std::string& text, const std::string& other, Random& random) {
  constexpr std::size_t few = 2, many = 20'000;
  if (text.empty()) text = other;
  if (text.empty()) return;
  switch (random.below(12)) {
    case 0:
      return flip(text, random);
    case 1:
      return erase(text, random);
    case 2:
      return repeat(text, random, few);
    case 3:
      // Rarely: such files take long to read.
      return repeat(text, random, random.below(8) == 0 ? many : 100);
    case 4:
      return move(text, random);
    case 5:
      return text.resize(random.below(text.size()));
    case 6:
    case 7:
      return other.empty() ? flip(text, random) : splice(text, other, random);
    default:
      return is_text(text) ? replace_number(text, random) : replace_word(text, random);
  }
}

}  // namespace

std::uint64_t Random::next() {
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

std::size_t Random::below(std::size_t end) { return end == 0 ? 0 : std::size_t(next() % end); }

std::string mutated(const std::vector<std::string>& corpus, std::size_t index, Random& random) {
  std::string text = corpus[index];
  for (std::size_t n = 1 + random.below(4); n > 0; --n) {
    change(text, corpus[random.below(corpus.size())], random);
    if (text.size() > longest) text.resize(longest);
  }
  return text;
}

}  // namespace lockstep::fuzz
