// URIs of glTF files (RFC 3986, RFC 2397, RFC 4648).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobelia::io::gltf {

bool isDataUri(std::string_view uri);
// Empty when it is damaged. Base64 with or without its padding, or percent-encoded.
std::optional<std::vector<std::byte>> decodeDataUri(std::string_view uri);
bool hasScheme(std::string_view uri);  // "https:"; a single letter is a Windows drive, a file
std::string percentDecoded(std::string_view text);

}  // namespace lobelia::io::gltf
