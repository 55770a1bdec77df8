#include "lobelia/io/gltf/uri.h"

#include <cctype>
#include <cstdint>

#include "lobelia/io/hex_digit.h"

namespace lobelia::io::gltf {
namespace {

int base64Digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

std::optional<std::vector<std::byte>> decodeBase64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) return {};
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = base64Digit(c);
    if (digit < 0) return {};
    bits = (bits << 6 | static_cast<uint32_t>(digit)) & 0xffffffu;
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<std::byte>(bits >> count & 0xffu));
    }
  }
  return bytes;
}

}  // namespace

bool isDataUri(std::string_view uri) { return uri.starts_with("data:"); }

std::optional<std::vector<std::byte>> decodeDataUri(std::string_view uri) {
  const size_t comma = uri.find(',');
  if (comma == uri.npos) return {};
  const std::string_view head = uri.substr(0, comma), data = uri.substr(comma + 1);
  if (head.ends_with(";base64")) return decodeBase64(data);
  const std::string text = percentDecoded(data);
  std::vector<std::byte> bytes;
  for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
  return bytes;
}

bool hasScheme(std::string_view uri) {
  const size_t colon = uri.find(':');
  if (colon == uri.npos || colon < 2 || !std::isalpha(static_cast<unsigned char>(uri[0])))
    return false;
  for (const char c : uri.substr(0, colon))
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '+' && c != '-' && c != '.')
      return false;
  return true;
}

std::string percentDecoded(std::string_view text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hexDigit(text[i + 1]) : -1;
    const int low = high >= 0 ? hexDigit(text[i + 2]) : -1;
    if (low >= 0) {
      out += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

}  // namespace lobelia::io::gltf
