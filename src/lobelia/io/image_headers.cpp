// PNG: W3C Portable Network Graphics, 5.3 (chunk layout). JPEG: ITU-T T.81, B.1 and B.2.2 (frame
// header). BMP: the core header of OS/2 and the info headers of Windows, which begin alike.
#include "lobelia/io/image_headers.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

namespace lobelia::io {
namespace {

class Bytes {
 public:
  explicit Bytes(std::span<const std::byte> bytes) : bytes_(bytes) {}
  size_t size() const { return bytes_.size(); }
  uint32_t at(size_t i) const {
    return i < bytes_.size() ? std::to_integer<uint32_t>(bytes_[i]) : 0;
  }
  uint32_t big(size_t i, size_t count) const {
    uint32_t value = 0;
    for (size_t k = 0; k < count; ++k) value = value << 8 | at(i + k);
    return value;
  }
  uint32_t little(size_t i, size_t count) const {
    uint32_t value = 0;
    for (size_t k = count; k-- > 0;) value = value << 8 | at(i + k);
    return value;
  }

 private:
  std::span<const std::byte> bytes_;
};

std::string sizeProblem(uint64_t width, uint64_t height, uint64_t channels, uint64_t maxValues) {
  if (width == 0 || height == 0 || width * height <= maxValues / channels) return "";
  return fmt::format("an image of {} x {} pixels with {} channels; at most {} numbers are read",
                     width, height, channels, maxValues);
}

std::string pngProblem(const Bytes& in) {
  constexpr size_t kSignature = 8, kAround = 12;  // length, type and checksum of a chunk
  for (size_t at = kSignature; at + kAround <= in.size();) {
    const uint32_t length = in.big(at, 4);
    if (length > in.size() - at - kAround)
      return fmt::format(
          "a chunk at byte {} has {} bytes, {} are left; the file is damaged or "
          "truncated",
          at, length, in.size() - at - kAround);
    if (in.big(at + 4, 4) == 0x49454e44) break;  // IEND
    at += kAround + length;
  }
  return "";
}

std::string jpegProblem(const Bytes& in, uint64_t maxValues) {
  for (size_t at = 2; at + 4 <= in.size();) {
    const uint32_t marker = in.at(at + 1);
    // As libjpeg does: what is no marker is skipped.
    if (in.at(at) != 0xff || marker == 0) {
      ++at;
      continue;
    }
    if (marker == 0xff || marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8)) {
      at += marker == 0xff ? 1 : 2;  // fill bytes; markers that stand alone
      continue;
    }
    const bool isFrame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (isFrame) {
      const uint32_t channels = in.at(at + 9);
      return channels == 0 ? ""
                           : sizeProblem(in.big(at + 7, 2), in.big(at + 5, 2), channels, maxValues);
    }
    if (marker == 0xda || marker == 0xd9) return "its pixels come before its size";
    at += 2 + in.big(at + 2, 2);
  }
  return "";
}

std::string bmpProblem(const Bytes& in, uint64_t maxValues) {
  constexpr uint32_t kCoreHeader = 12;
  if (in.little(14, 4) == kCoreHeader)
    return sizeProblem(in.little(18, 2), in.little(20, 2), 4, maxValues);
  const auto width = static_cast<int32_t>(in.little(18, 4));
  const auto height = static_cast<int32_t>(in.little(22, 4));  // negative: top row first
  if (width <= 0) return "its width is not above 0";
  return sizeProblem(static_cast<uint64_t>(width), static_cast<uint64_t>(std::abs(int64_t{height})),
                     4, maxValues);
}

}  // namespace

std::string imageHeaderProblem(std::span<const std::byte> bytes, uint64_t maxValues) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const Bytes in(bytes);
  if (text.starts_with("\x89PNG")) return pngProblem(in);
  if (text.starts_with("\xff\xd8\xff")) return jpegProblem(in, maxValues);
  if (text.starts_with("BM")) return bmpProblem(in, maxValues);
  return "";
}

}  // namespace lobelia::io
