// Words of a PBRT file: directives and bare words, quoted strings, brackets, with their places.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobelia/base/error.h"

namespace lobelia::io::pbrt {

enum class TokenType : uint8_t { word, string, open, close };

struct Token {
  TokenType type = TokenType::word;
  std::string text;  // of a string: what it stands for, without quotes
  Location where;
};

class Tokenizer {
 public:
  // name: the file, for messages.
  Tokenizer(std::string bytes, std::string name);

  // Empty at the end. Throws InputError: strings that do not end on their line, unknown escapes.
  std::optional<Token> next();
  // next() without moving on.
  const std::optional<Token>& peek();
  // Reads plain numbers up to what is none, straight from the text: long lists make up most of a
  // file. Throws InputError for words that begin like numbers, and for numbers that are not finite.
  void numbers(std::vector<double>& out);
  Location where() const;
  const std::string& file() const { return file_; }

 private:
  void skipSpace();
  std::optional<Token> scan();
  Token quoted();

  std::string bytes_, file_;
  size_t at_ = 0, lineStart_ = 0;
  int line_ = 1;
  std::optional<Token> peeked_;
  bool hasPeeked_ = false;
};

// The whole word as a finite number; throws InputError.
double parseNumber(std::string_view word, const Location& where);

}  // namespace lobelia::io::pbrt
