#include "lobelia/io/exr_header.h"

#include <fmt/format.h>

#include <cstring>
#include <optional>
#include <string_view>

namespace lobelia::io {
namespace {

constexpr std::string_view kMagic = "v/1\x01";
constexpr uint32_t kMultiPart = 1u << 12;
constexpr size_t kLongestName = 255;

class Cursor {
 public:
  Cursor(std::span<const std::byte> bytes, uint64_t fileSize)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), fileSize_(fileSize) {}
  // Of a string that ends in a zero; empty optional: not among the bytes.
  std::optional<std::string_view> name() {
    const size_t end = text_.find('\0', at_);
    if (end == text_.npos) return {};
    const std::string_view found = text_.substr(at_, end - at_);
    at_ = end + 1;
    return found;
  }
  std::optional<int32_t> integer() {
    if (at_ + sizeof(int32_t) > text_.size()) return {};
    int32_t value = 0;
    std::memcpy(&value, text_.data() + at_, sizeof(value));
    at_ += sizeof(value);
    return value;
  }
  uint64_t left() const { return fileSize_ - at_; }
  void skip(size_t n) { at_ += n; }
  bool inside() const { return at_ < text_.size(); }
  bool fileEnds() const { return fileSize_ <= text_.size(); }
  size_t position() const { return at_; }
  void moveTo(size_t at) { at_ = at; }

 private:
  std::string_view text_;
  uint64_t fileSize_;
  size_t at_ = 0;
};

// Types whose values have one size (OpenEXR file layout, "Predefined attribute types").
struct TypeSize {
  std::string_view type;
  int32_t bytes;
};
constexpr TypeSize kTypeSizes[] = {{"box2i", 16},
                                   {"box2f", 16},
                                   {"chromaticities", 32},
                                   {"compression", 1},
                                   {"deepImageState", 1},
                                   {"double", 8},
                                   {"envmap", 1},
                                   {"float", 4},
                                   {"int", 4},
                                   {"keycode", 28},
                                   {"lineOrder", 1},
                                   {"m33d", 72},
                                   {"m33f", 36},
                                   {"m44d", 128},
                                   {"m44f", 64},
                                   {"rational", 8},
                                   {"tiledesc", 9},
                                   {"timecode", 8},
                                   {"v2d", 16},
                                   {"v2f", 8},
                                   {"v2i", 8},
                                   {"v3d", 24},
                                   {"v3f", 12},
                                   {"v3i", 12}};

// Does the value take the bytes that are stated for it? The library reads most values by what they
// hold, and where that differs it takes numbers from the middle of others for sizes. Values that do
// not lie among the bytes are believed.
bool fits(Cursor in, std::string_view type, int32_t size) {
  for (const TypeSize& known : kTypeSizes)
    if (type == known.type) return size == known.bytes;
  const size_t end = in.position() + static_cast<size_t>(size);
  if (type == "chlist") {  // name, then type, linearity and sampling in 16 bytes; an empty name
    constexpr size_t kChannel = 16;
    while (in.position() < end) {
      const auto name = in.name();
      if (!name) return true;
      if (name->empty()) return in.position() == end;
      in.skip(kChannel);
    }
    return false;
  }
  if (type == "preview") {  // width, height, pixels of four bytes
    const auto width = in.integer(), height = width ? in.integer() : std::nullopt;
    if (!height) return size >= 8;
    return *width >= 0 && *height >= 0 && *width < (1 << 14) && *height < (1 << 14) &&
           int64_t{size} == 8 + 4 * int64_t{*width} * *height;
  }
  if (type == "stringvector") {
    while (in.position() < end) {
      const auto length = in.integer();
      if (!length) return true;
      if (*length < 0 || static_cast<size_t>(*length) > end - std::min(end, in.position()))
        return false;
      in.skip(static_cast<size_t>(*length));
    }
    return in.position() == end;
  }
  return type != "floatvector" || size % 4 == 0;
}

// minX, minY, maxX, maxY.
std::string windowProblem(Cursor& in, int maxSide) {
  int64_t v[4];
  for (int64_t& x : v) {
    const auto value = in.integer();
    if (!value) return "";
    x = *value;
  }
  const int64_t width = v[2] - v[0] + 1, height = v[3] - v[1] + 1;
  if (width >= 1 && height >= 1 && width <= maxSide && height <= maxSide) return "";
  return fmt::format("an image of {} x {} pixels; sides may be 1 to {}", width, height, maxSide);
}

}  // namespace

std::string exrHeaderProblem(std::span<const std::byte> start, uint64_t fileSize, int maxSide) {
  const std::string_view text(reinterpret_cast<const char*>(start.data()), start.size());
  if (!text.starts_with(kMagic)) return "";
  Cursor in(start, fileSize);
  in.skip(kMagic.size());
  const auto version = in.integer();
  const bool multiPart = version && (static_cast<uint32_t>(*version) & kMultiPart) != 0;
  // A header ends with an empty name; the headers of several parts with another one.
  bool first = true;
  while (in.inside()) {
    const auto name = in.name();
    if (!name) return in.fileEnds() ? "its header ends too early" : "";
    if (name->empty()) {
      if (!multiPart || first) return "";
      first = true;
      continue;
    }
    first = false;
    const auto type = in.name();
    const auto size = type ? in.integer() : std::nullopt;
    if (!size) return in.fileEnds() ? "its header ends too early" : "";
    if (name->size() > kLongestName || type->size() > kLongestName)
      return "its header is damaged: a name of an attribute is too long";
    if (*size < 0 || static_cast<uint64_t>(*size) > in.left())
      return fmt::format(
          "its header is damaged: attribute '{}' has {} bytes, {} are left in the "
          "file",
          *name, *size, in.left());
    if (!fits(in, *type, *size))
      return fmt::format("its header is damaged: attribute '{}' of type {} cannot have {} bytes",
                         *name, *type, *size);
    const size_t next = in.position() + static_cast<size_t>(*size);
    if (*type == "box2i" && *size == 16) {
      const std::string problem = windowProblem(in, maxSide);
      if (!problem.empty()) return problem;
    }
    in.moveTo(next);
  }
  return in.fileEnds() ? "its header ends too early" : "";
}

}  // namespace lobelia::io
