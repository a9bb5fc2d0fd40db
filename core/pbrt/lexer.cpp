#include "core/pbrt/lexer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <utility>

namespace lockstep::pbrt {

namespace {

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

bool ends_word(char c) { return is_blank(c) || c == '"' || c == '[' || c == ']' || c == '#'; }

bool starts_number(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.'; }

}  // namespace

Lexer::Lexer(std::string file, std::string text) : file_(std::move(file)), text_(std::move(text)) {
  if (text_.starts_with("\xEF\xBB\xBF")) position_ = 3;  // byte order mark
  advance();
}

Token Lexer::next() {
  const Token current = token_;
  advance();
  return current;
}

void Lexer::skip_blanks() {
  for (; position_ < text_.size(); ++position_) {
    const char c = text_[position_];
    if (c == '\n') {
      ++line_;
    } else if (c == '#') {
      position_ = std::min(text_.find('\n', position_), text_.size()) - 1;
    } else if (!is_blank(c)) {
      return;
    }
  }
}

void Lexer::advance() {
  skip_blanks();
  if (position_ >= text_.size()) {
    token_ = {Token::Kind::End, {}, line_};
    return;
  }
  const std::string_view rest = std::string_view(text_).substr(position_);
  if (rest[0] == '"') {
    token_ = quoted_token();
    return;
  }
  if (rest[0] == '[' || rest[0] == ']') {
    ++position_;
    token_ = {rest[0] == '[' ? Token::Kind::Open : Token::Kind::Close, rest.substr(0, 1), line_};
    return;
  }
  size_t length = 1;
  while (length < rest.size() && !ends_word(rest[length])) ++length;
  position_ += length;
  const auto kind = starts_number(rest[0]) ? Token::Kind::Number : Token::Kind::Word;
  token_ = {kind, rest.substr(0, length), line_};
}

Token Lexer::quoted_token() {
  const size_t begin = position_ + 1;
  size_t end = begin;
  while (end < text_.size() && text_[end] != '"' && text_[end] != '\n') {
    end += text_[end] == '\\' && text_[end + 1] != '\n' ? 2 : 1;
  }
  if (end >= text_.size() || text_[end] != '"') {
    fail({file_, line_}, "the string that starts here has no closing quote");
  }
  position_ = end + 1;
  return {Token::Kind::String, std::string_view(text_).substr(begin, end - begin), line_};
}

std::string Lexer::expect_string(const std::string& what) {
  if (token_.kind != Token::Kind::String) {
    fail(at(token_), "expected " + what + ", found " + shown(token_));
  }
  return unescaped(next().text);
}

double Lexer::expect_number(const std::string& what) {
  if (token_.kind != Token::Kind::Number) {
    fail(at(token_), "expected " + what + ", found " + shown(token_));
  }
  return number(next());
}

void Lexer::expect(Token::Kind kind, const std::string& what) {
  if (token_.kind != kind) fail(at(token_), "expected " + what + ", found " + shown(token_));
  advance();
}

double Lexer::number(const Token& token) const {
  const char* first = token.text.data();
  const char* last = first + token.text.size();
  if (*first == '+') ++first;
  double value = 0.0;
  const auto [rest, status] = std::from_chars(first, last, value);
  if (rest != last || status == std::errc::invalid_argument) {
    fail(at(token), "expected a number, found " + shown(token));
  }
  if (status == std::errc::result_out_of_range) {
    value = std::strtod(std::string(first, last).c_str(), nullptr);
  }
  if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()))) {
    fail(at(token), "the number " + shown(token) + " is out of range");
  }
  return value;
}

std::string read_text(const std::string& path, const Location& where) {
  std::ifstream file(path, std::ios::binary);
  std::error_code ignored;
  if (!file || !std::filesystem::is_regular_file(path, ignored)) {
    const std::string what = "\"" + path + "\" cannot be opened; check the path";
    if (where.file.empty()) throw Error(what);
    fail(where, what);
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string shown(const Token& token) {
  if (token.kind == Token::Kind::End) return "the end of the file";
  constexpr size_t longest = 40;
  std::string text(token.text.substr(0, longest));
  if (token.text.size() > longest) text += "...";
  return "\"" + text + "\"";
}

std::string unescaped(std::string_view text) {
  std::string value;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      value += text[i];
      continue;
    }
    const char c = text[++i];
    value += c == 'n' ? '\n' : c == 't' ? '\t' : c == 'r' ? '\r' : c;
  }
  return value;
}

}  // namespace lockstep::pbrt
