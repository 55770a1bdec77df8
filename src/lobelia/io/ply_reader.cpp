// Stanford PLY meshes, ascii and binary of both byte orders, as Mitsuba 3 understands them:
//  - element 'vertex': x y z, nx ny nz, uv as (u, v), (texture_u, texture_v) or (s, t);
//  - element 'face': list 'vertex_index' or 'vertex_indices', polygons become fans;
//  - (r, g, b[, a]) or (red, green, blue[, alpha]) are the attribute vertex_color or face_color,
//    NAME_x NAME_y .. (also 0 1 2 3 or 1 2 3 4) are vertex_NAME, NAME_r NAME_g .. are
//    vertex_NAME_color; integers stand for 0..1, and colours of integers are decoded from sRGB.
// Deviation: a number whose name follows no such scheme, which Mitsuba leaves out, becomes an
// attribute vertex_NAME of one float; attributes may have four components.
#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

#include "lobelia/io/file_bytes.h"
#include "lobelia/io/gzip.h"
#include "lobelia/io/mesh_checks.h"
#include "lobelia/io/ply_header.h"

namespace lobelia::io {
namespace {

// Reads the numbers behind the header one after the other.
class Cursor {
 public:
  Cursor(const std::string& bytes, const PlyHeader& header, const std::string& file)
      : at_(bytes.data() + header.dataOffset),
        end_(bytes.data() + bytes.size()),
        format_(header.format),
        where_{file, header.format == PlyHeader::Format::ascii ? header.lineCount + 1 : 0, 0} {}

  // At the declaration of an element.
  [[noreturn]] void failIn(const PlyElement& element, const std::string& message) const {
    throw InputError({where_.file, element.line, 0}, message);
  }
  void setContext(const PlyElement& element, uint64_t index) {
    element_ = &element, index_ = index;
  }
  size_t bytesLeft() const { return static_cast<size_t>(end_ - at_); }
  bool isAscii() const { return format_ == PlyHeader::Format::ascii; }

  double number(PlyType type) { return isAscii() ? asciiNumber() : binaryNumber(type); }
  uint64_t count(PlyType type) {
    const double n = number(type);
    if (!(n >= 0) || n != std::floor(n)) failHere(fmt::format("a list of {} entries", n));
    // Each entry takes at least a byte.
    if (n > static_cast<double>(bytesLeft()))
      failHere(fmt::format("a list of {} entries is longer than the rest of the file", n));
    return static_cast<uint64_t>(n);
  }
  [[noreturn]] void failHere(const std::string& message) const {
    throw InputError(where_, fmt::format("in {} {} (from 0): {}", element_->name, index_, message));
  }

 private:
  double asciiNumber() {
    while (at_ < end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\r' || *at_ == '\n'))
      where_.line += *at_++ == '\n';
    if (at_ == end_) failHere("the file ends; it is truncated");
    const char* begin = at_;
    while (at_<end_&& static_cast<unsigned char>(*at_)> ' ') ++at_;
    const char* digits = *begin == '+' ? begin + 1 : begin;
    double value = 0;
    const auto [stop, error] = std::from_chars(digits, at_, value);
    if (stop != at_ || stop == digits || error == std::errc::invalid_argument)
      failHere(fmt::format("'{}' is not a number", std::string(begin, std::min(at_, begin + 40))));
    // Out of range and not as small as a zero: infinite.
    const bool tooLarge = error == std::errc::result_out_of_range &&
                          std::string_view(digits, at_).find('-', 1) == std::string_view::npos;
    if (!std::isfinite(value) || tooLarge)
      failHere("a number that is not finite; all numbers of a mesh must be");
    return value;
  }

  template <class T>
  T raw() {
    if (bytesLeft() < sizeof(T)) failHere("the file ends; it is truncated");
    unsigned char buffer[sizeof(T)];
    std::memcpy(buffer, at_, sizeof(T));
    at_ += sizeof(T);
    const bool swap =
        (format_ == PlyHeader::Format::bigEndian) == (std::endian::native == std::endian::little);
    if (swap) std::reverse(std::begin(buffer), std::end(buffer));
    T value;
    std::memcpy(&value, buffer, sizeof(T));
    return value;
  }
  static double fromHalf(uint16_t bits) {
    const int exponent = (bits >> 10) & 31, mantissa = bits & 1023;
    const double sign = (bits >> 15) ? -1 : 1;
    if (exponent == 31) return mantissa ? std::nan("") : sign * HUGE_VAL;
    return exponent ? sign * std::ldexp(1024 + mantissa, exponent - 25)
                    : sign * std::ldexp(mantissa, -24);
  }
  double binaryNumber(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return raw<int8_t>();
      case PlyType::uint8:
        return raw<uint8_t>();
      case PlyType::int16:
        return raw<int16_t>();
      case PlyType::uint16:
        return raw<uint16_t>();
      case PlyType::int32:
        return raw<int32_t>();
      case PlyType::uint32:
        return raw<uint32_t>();
      case PlyType::int64:
        return static_cast<double>(raw<int64_t>());
      case PlyType::uint64:
        return static_cast<double>(raw<uint64_t>());
      case PlyType::half:
        return fromHalf(raw<uint16_t>());
      case PlyType::float32:
        return static_cast<double>(raw<float>());
      case PlyType::float64:
        return raw<double>();
    }
    return 0;
  }

  const char* at_;
  const char* end_;
  PlyHeader::Format format_;
  Location where_;
  const PlyElement* element_ = nullptr;
  uint64_t index_ = 0;
};

// Where a property's value goes: component `component` of slot `slot`.
enum Slot : int { kIgnored = -4, kPosition = -3, kNormal = -2, kUv = -1 };  // >= 0: attribute
struct Target {
  int slot = kIgnored;
  int component = 0;
  double scale = 1;  // integers of attributes stand for 0..1
  bool sRgb = false;
};

double largest(PlyType type) {
  const auto bits = static_cast<int>(8 * byteSize(type));
  const bool isSigned = type == PlyType::int8 || type == PlyType::int16 || type == PlyType::int32 ||
                        type == PlyType::int64;
  return std::ldexp(1, isSigned ? bits - 1 : bits) - 1;
}

double decodeSrgb8(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// Assigns properties to slots, in Mitsuba's groups.
class Layout {
 public:
  Layout(const PlyElement& element, const std::string& prefix)
      : element_(element), prefix_(prefix), targets(element.properties.size()) {}

  bool bind(std::initializer_list<const char*> names, int slot) {
    std::vector<size_t> found;
    for (const char* name : names)
      if (const auto i = find(name); i && targets[*i].slot == kIgnored) found.push_back(*i);
    if (found.size() != names.size()) return false;
    for (size_t k = 0; k < found.size(); ++k)
      targets[found[k]] = {slot, static_cast<int>(k), 1, false};
    return true;
  }
  void bindAttributes() {
    bindColor({"r", "g", "b"}, "a") || bindColor({"red", "green", "blue"}, "alpha");
    for (size_t i = 0; i < targets.size(); ++i)
      if (targets[i].slot == kIgnored && !element_.properties[i].isList) i = bindGroup(i);
  }

 private:
  const PlyElement& element_;
  std::string prefix_;

  std::optional<size_t> find(const std::string& name) const {
    for (size_t i = 0; i < element_.properties.size(); ++i)
      if (element_.properties[i].name == name && !element_.properties[i].isList) return i;
    return {};
  }
  void assign(size_t property, bool isColor) {
    MeshAttribute& attribute = attributes.back();
    const PlyType type = element_.properties[property].type;
    targets[property] = {static_cast<int>(attributes.size()) - 1, attribute.size++,
                         isInteger(type) ? 1 / largest(type) : 1, isColor && isInteger(type)};
  }
  void open(const std::string& name) {
    attributes.push_back({prefix_ + name, prefix_ == "face_", 0, {}});
  }
  bool bindColor(std::initializer_list<const char*> names, const char* alpha) {
    for (const char* name : names)
      if (!find(name)) return false;
    open("color");
    for (const char* name : names) assign(*find(name), true);
    if (const auto a = find(alpha)) assign(*a, false);
    return true;
  }
  // Groups the properties from i on that have one prefix and consecutive endings; returns the last.
  size_t bindGroup(size_t i) {
    static constexpr const char* kEndings[] = {"xyzw", "rgba", "0123", "1234"};
    const std::string& name = element_.properties[i].name;
    const size_t bar = name.rfind('_');
    if (bar != name.npos && bar > 0 && bar + 2 == name.size())
      for (const char* endings : kEndings) {
        if (name[bar + 1] != endings[0]) continue;
        const std::string stem = name.substr(0, bar);
        const bool isColor = endings[0] == 'r';
        open(stem + (isColor ? "_color" : ""));
        size_t last = i;
        for (size_t k = 0; k < 4 && i + k < targets.size(); ++k) {
          const PlyProperty& p = element_.properties[i + k];
          if (p.isList || p.name != stem + "_" + endings[k]) break;
          assign(last = i + k, isColor && k < 3);
        }
        return last;
      }
    open(name);
    assign(i, false);
    return i;
  }

 public:
  std::vector<Target> targets;
  std::vector<MeshAttribute> attributes;
};

float convert(const Target& target, double value) {
  value *= target.scale;
  return static_cast<float>(target.sRgb ? decodeSrgb8(value) : value);
}

void skip(Cursor& in, const PlyProperty& property) {
  const uint64_t n = property.isList ? in.count(property.countType) : 1;
  for (uint64_t k = 0; k < n; ++k) in.number(property.type);
}

void readVertices(Cursor& in, const PlyElement& element, Mesh& mesh) {
  Layout layout(element, "vertex_");
  if (!layout.bind({"x", "y", "z"}, kPosition))
    in.failIn(element, "the vertices have no x, y and z");
  const bool hasNormals = layout.bind({"nx", "ny", "nz"}, kNormal);
  const bool hasUvs = layout.bind({"u", "v"}, kUv) ||
                      layout.bind({"texture_u", "texture_v"}, kUv) || layout.bind({"s", "t"}, kUv);
  layout.bindAttributes();
  mesh.positions.resize(element.count);
  if (hasNormals) mesh.normals.resize(element.count);
  if (hasUvs) mesh.uvs.resize(element.count);
  for (MeshAttribute& a : layout.attributes)
    a.values.resize(element.count * static_cast<size_t>(a.size));
  for (uint64_t i = 0; i < element.count; ++i) {
    in.setContext(element, i);
    for (size_t p = 0; p < element.properties.size(); ++p) {
      const Target& target = layout.targets[p];
      if (target.slot == kIgnored) {
        skip(in, element.properties[p]);
        continue;
      }
      const float value = convert(target, in.number(element.properties[p].type));
      if (!std::isfinite(value))
        in.failHere(fmt::format("{} is not finite; all numbers of a mesh must be",
                                element.properties[p].name));
      if (target.slot == kPosition)
        mesh.positions[i][target.component] = value;
      else if (target.slot == kNormal)
        mesh.normals[i][target.component] = value;
      else if (target.slot == kUv)
        mesh.uvs[i][target.component] = value;
      else {
        MeshAttribute& a = layout.attributes[static_cast<size_t>(target.slot)];
        a.values[i * static_cast<size_t>(a.size) + static_cast<size_t>(target.component)] = value;
      }
    }
  }
  for (MeshAttribute& a : layout.attributes) mesh.attributes.push_back(std::move(a));
}

// Returns how many faces had less than three corners (left out).
uint64_t readFaces(Cursor& in, const PlyElement& element, Mesh& mesh) {
  Layout layout(element, "face_");
  layout.bindAttributes();
  size_t list = element.properties.size();
  for (size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    if (property.isList && isInteger(property.type) &&
        (property.name == "vertex_index" || property.name == "vertex_indices"))
      list = p;
  }
  if (list == element.properties.size())
    in.failIn(element, "the faces have no integer list 'vertex_indices' or 'vertex_index'");
  uint64_t tooSmall = 0;
  std::vector<uint32_t> corners;
  std::vector<float> values;
  for (uint64_t i = 0; i < element.count; ++i) {
    in.setContext(element, i);
    corners.clear(), values.clear();
    for (size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (p == list) {
        const uint64_t n = in.count(property.countType);
        for (uint64_t k = 0; k < n; ++k) {
          const double index = in.number(property.type);
          if (!(index >= 0) || index > 4294967294.0 || index != std::floor(index))
            in.failHere(fmt::format("{} is not the index of a vertex", index));
          corners.push_back(static_cast<uint32_t>(index));
        }
      } else if (property.isList) {
        skip(in, property);
      } else {
        values.push_back(convert(layout.targets[p], in.number(property.type)));
      }
    }
    tooSmall += corners.size() < 3;
    for (size_t k = 2; k < corners.size(); ++k) {
      mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
      size_t next = 0;
      for (size_t p = 0; p < element.properties.size(); ++p) {
        if (element.properties[p].isList) continue;
        layout.attributes[static_cast<size_t>(layout.targets[p].slot)].values.push_back(
            values[next++]);
      }
    }
  }
  for (MeshAttribute& a : layout.attributes) mesh.attributes.push_back(std::move(a));
  return tooSmall;
}

}  // namespace

Mesh readPly(const std::string& file, const MeshOptions& options, const Location& from,
             std::vector<Finding>& findings) {
  std::string bytes = readFileBytes(file, "mesh", from);
  if (isGzip(bytes)) bytes = gunzip(bytes, {file, 0, 0});
  const PlyHeader header = parsePlyHeader(bytes, file);
  Cursor in(bytes, header, file);
  Mesh mesh;
  bool hasVertices = false, hasFaces = false;
  uint64_t tooSmall = 0;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex" && !hasVertices) {
      hasVertices = true;
      readVertices(in, element, mesh);
    } else if (element.name == "face" && !hasFaces) {
      hasFaces = true;
      tooSmall = readFaces(in, element, mesh);
    } else {
      for (uint64_t i = 0; i < element.count; ++i) {
        in.setContext(element, i);
        for (const PlyProperty& property : element.properties) skip(in, property);
      }
    }
  }
  const Location where{file, 0, 0};
  if (!hasVertices || !hasFaces)
    throw InputError(
        where, fmt::format("the PLY file has no element '{}'; a mesh needs 'vertex' and 'face'",
                           hasVertices ? "face" : "vertex"));
  if (tooSmall > 0)
    addWarning(findings, where,
               fmt::format("{} faces with less than three vertices left out", tooSmall));
  if (options.flipTexCoords.value_or(false))
    for (Vec2f& uv : mesh.uvs) uv.y = 1 - uv.y;
  finishMesh(mesh, file, options, findings);
  return mesh;
}

}  // namespace lobelia::io
