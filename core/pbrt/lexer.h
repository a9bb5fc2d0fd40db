// Cuts a pbrt file into tokens: words, quoted strings, numbers and brackets; '#' starts a comment.
#pragma once

#include "core/location.h"

#include <string>
#include <string_view>

namespace lockstep::pbrt {

struct Token {
  enum class Kind { Word, String, Number, Open, Close, End };
  Kind kind = Kind::End;
  std::string_view text;  // of a string: what stands between the quotes, escapes untouched
  int line = 0;
};

class Lexer {
 public:
  Lexer(std::string file, std::string text);
  Lexer(const Lexer&) = delete;  // tokens point into the text
  Lexer& operator=(const Lexer&) = delete;

  const Token& peek() const { return token_; }
  Token next();

  const std::string& file() const { return file_; }
  Location at(const Token& token) const { return {file_, token.line}; }

  // The next token as a string or a number; otherwise an error that says "expected WHAT".
  std::string expect_string(const std::string& what);
  double expect_number(const std::string& what);
  void expect(Token::Kind kind, const std::string& what);

  // `token` as a number that a float can hold; tiny values become zero.
  double number(const Token& token) const;

 private:
  void advance();
  void skip_blanks();
  Token quoted_token();

  std::string file_;
  std::string text_;
  size_t position_ = 0;
  int line_ = 1;
  Token token_;
};

// The text of a file; throws where it cannot be read, blaming `where`.
std::string read_text(const std::string& path, const Location& where);

// A token as messages show it: printable, in quotes, not too long.
std::string shown(const Token& token);

// The value of a quoted string, its escapes resolved.
std::string unescaped(std::string_view text);

}  // namespace lockstep::pbrt
