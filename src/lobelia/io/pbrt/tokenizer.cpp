// The lexical rules of PBRT-v4's file format: '#' starts a comment, strings stand in double quotes
// with C's escapes and end on their line, brackets stand alone.
#include "lobelia/io/pbrt/tokenizer.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace lobelia::io::pbrt {
namespace {

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool endsWord(char c) { return isSpace(c) || c == '"' || c == '[' || c == ']' || c == '#'; }
bool startsNumber(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.'; }

}  // namespace

double parseNumber(std::string_view word, const Location& where) {
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  double value = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  const std::string shown(word.substr(0, 40));
  if (digits.empty() || stop != end || error == std::errc::invalid_argument)
    throw InputError(where, fmt::format("'{}' is not a number", shown));
  if (error == std::errc::result_out_of_range) {
    // Too small is zero, too large is refused below.
    const size_t exponent = digits.find_first_of("eE");
    const bool tiny = exponent != digits.npos && digits.find('-', exponent) != digits.npos;
    value = tiny ? 0 : HUGE_VAL;
  }
  if (!std::isfinite(value))
    throw InputError(where, fmt::format("'{}' is not a finite number", shown));
  return value;
}

Tokenizer::Tokenizer(std::string bytes, std::string name)
    : bytes_(std::move(bytes)), file_(std::move(name)) {}

Location Tokenizer::where() const {
  return {file_, line_, static_cast<int>(std::min<size_t>(at_ - lineStart_ + 1, 1u << 30))};
}

void Tokenizer::skipSpace() {
  while (at_ < bytes_.size()) {
    const char c = bytes_[at_];
    if (c == '#') {
      while (at_ < bytes_.size() && bytes_[at_] != '\n') ++at_;
    } else if (isSpace(c)) {
      ++at_;
      if (c == '\n') ++line_, lineStart_ = at_;
    } else {
      return;
    }
  }
}

Token Tokenizer::quoted() {
  Token token{TokenType::string, {}, where()};
  for (++at_; at_ < bytes_.size() && bytes_[at_] != '\n'; ++at_) {
    char c = bytes_[at_];
    if (c == '"') {
      ++at_;
      return token;
    }
    if (c == '\\' && at_ + 1 < bytes_.size()) {
      constexpr std::string_view kNames = "bfnrt\\'\"", kValues = "\b\f\n\r\t\\'\"";
      const size_t i = kNames.find(bytes_[++at_]);
      if (i == kNames.npos)
        throw InputError(where(), fmt::format("the escape '\\{}' is not known; one of \\b \\f \\n "
                                              "\\r \\t \\\\ \\' \\\" was expected",
                                              bytes_[at_]));
      c = kValues[i];
    }
    token.text += c;
  }
  throw InputError(token.where, "the string does not end; put a '\"' behind it, on the same line");
}

std::optional<Token> Tokenizer::scan() {
  skipSpace();
  if (at_ >= bytes_.size()) return std::nullopt;
  const char c = bytes_[at_];
  if (c == '"') return quoted();
  Token token{TokenType::word, {}, where()};
  if (c == '[' || c == ']') {
    ++at_;
    token.type = c == '[' ? TokenType::open : TokenType::close;
    token.text = c;
    return token;
  }
  const size_t begin = at_;
  while (at_ < bytes_.size() && !endsWord(bytes_[at_])) ++at_;
  token.text = bytes_.substr(begin, at_ - begin);
  return token;
}

std::optional<Token> Tokenizer::next() {
  if (!hasPeeked_) return scan();
  hasPeeked_ = false;
  return std::move(peeked_);
}

const std::optional<Token>& Tokenizer::peek() {
  if (!hasPeeked_) peeked_ = scan(), hasPeeked_ = true;
  return peeked_;
}

void Tokenizer::numbers(std::vector<double>& out) {
  if (hasPeeked_) return;  // what was looked at is no number, or the caller's
  for (;;) {
    skipSpace();
    if (at_ >= bytes_.size() || !startsNumber(bytes_[at_])) return;
    const Location here = where();
    const size_t begin = at_;
    while (at_ < bytes_.size() && !endsWord(bytes_[at_])) ++at_;
    out.push_back(parseNumber(std::string_view(bytes_).substr(begin, at_ - begin), here));
  }
}

}  // namespace lobelia::io::pbrt
