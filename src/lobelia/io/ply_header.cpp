// PLY headers: G. Turk, "The PLY Polygon File Format", 1994; type names of both generations, and
// the 64-bit and half types that Mitsuba adds.
#include "lobelia/io/ply_header.h"

#include <fmt/format.h>

#include <charconv>
#include <sstream>
#include <utility>

namespace lobelia::io {
namespace {

constexpr std::pair<const char*, PlyType> kTypes[] = {
    {"char", PlyType::int8},       {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},     {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},   {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},     {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"long", PlyType::int64},      {"int64", PlyType::int64},     {"ulong", PlyType::uint64},
    {"uint64", PlyType::uint64},   {"half", PlyType::half},       {"float16", PlyType::half},
    {"float", PlyType::float32},   {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64},
};

// The words of one header line and the errors about it.
struct Line {
  std::vector<std::string> words;
  Location where;
  [[noreturn]] void fail(const std::string& message) const { throw InputError(where, message); }
  void expect(bool right, const char* form) const {
    if (!right) fail(fmt::format("malformed line in the PLY header; it should read '{}'", form));
  }
  PlyType type(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto& [known, type] : kTypes) {
      if (name == known) return type;
      names.emplace_back(known);
    }
    fail(fmt::format("unknown PLY type '{}'{}", name, suggestion(name, names)));
  }
  PlyType countType(const std::string& name) const {
    const PlyType t = type(name);
    if (!isInteger(t)) fail(fmt::format("list counts of type '{}'; they must be integers", name));
    return t;
  }
};

void parseFormat(const Line& line, PlyHeader& header) {
  line.expect(line.words.size() == 3, "format ascii|binary_little_endian|binary_big_endian 1.0");
  const std::string& name = line.words[1];
  if (name == "ascii")
    header.format = PlyHeader::Format::ascii;
  else if (name == "binary_little_endian")
    header.format = PlyHeader::Format::littleEndian;
  else if (name == "binary_big_endian")
    header.format = PlyHeader::Format::bigEndian;
  else
    line.fail(
        fmt::format("unknown PLY format '{}'{}", name,
                    suggestion(name, {"ascii", "binary_little_endian", "binary_big_endian"})));
}

void parseElement(const Line& line, PlyHeader& header) {
  line.expect(line.words.size() == 3, "element NAME COUNT");
  PlyElement element;
  element.name = line.words[1];
  element.line = line.where.line;
  const std::string& count = line.words[2];
  const auto [end, error] =
      std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (error != std::errc() || end != count.data() + count.size())
    line.fail(fmt::format("'{}' is not a count of elements", count));
  header.elements.push_back(std::move(element));
}

void parseProperty(const Line& line, PlyHeader& header) {
  if (header.elements.empty()) line.fail("a property before any 'element'");
  PlyProperty property;
  if (line.words.size() > 1 && line.words[1] == "list") {
    line.expect(line.words.size() == 5, "property list COUNT_TYPE TYPE NAME");
    property = {line.words[4], line.type(line.words[3]), true, line.countType(line.words[2])};
  } else {
    line.expect(line.words.size() == 3, "property TYPE NAME");
    property = {line.words[2], line.type(line.words[1]), false, PlyType::uint8};
  }
  for (const PlyProperty& other : header.elements.back().properties)
    if (other.name == property.name)
      line.fail(fmt::format("property '{}' is given twice", other.name));
  header.elements.back().properties.push_back(std::move(property));
}

// Refuses counts for which the rest of the file is too short, before anything is allocated.
void checkCounts(const PlyHeader& header, const std::string& bytes, const std::string& file) {
  uint64_t left = bytes.size() - header.dataOffset + 1;  // the last number needs no blank behind it
  for (const PlyElement& element : header.elements) {
    uint64_t least = 0;
    for (const PlyProperty& p : element.properties)
      least +=
          header.format == PlyHeader::Format::ascii ? 2 : byteSize(p.isList ? p.countType : p.type);
    const Location where{file, element.line, 0};
    if (least == 0 && element.count > 0)
      throw InputError(where, fmt::format("element '{}' has no properties", element.name));
    if (element.count > 0 && element.count > left / least)
      throw InputError(where, fmt::format("the header promises {} of '{}', more than the file can "
                                          "hold; it is damaged or truncated",
                                          element.count, element.name));
    left -= element.count * least;
  }
}

}  // namespace

size_t byteSize(PlyType type) {
  constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
  return kSizes[static_cast<size_t>(type)];
}

PlyHeader parsePlyHeader(const std::string& bytes, const std::string& file) {
  PlyHeader header;
  bool hasFormat = false;
  Line line;
  line.where.file = file;
  for (size_t begin = 0; begin < bytes.size();) {
    const size_t end = bytes.find('\n', begin);
    ++line.where.line;
    if (end == bytes.npos || end - begin > 4096) break;
    std::istringstream text(bytes.substr(begin, end - begin));  // blanks and '\r' separate
    begin = end + 1;
    line.words.clear();
    for (std::string word; text >> word;) line.words.push_back(word);
    if (line.where.line == 1) {
      if (line.words != std::vector<std::string>{"ply"})
        line.fail("not a PLY file; it would start with 'ply'");
      continue;
    }
    if (line.words.empty()) continue;
    const std::string& keyword = line.words[0];
    if (keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "format")
      parseFormat(line, header), hasFormat = true;
    else if (keyword == "element")
      parseElement(line, header);
    else if (keyword == "property")
      parseProperty(line, header);
    else if (keyword == "end_header") {
      if (!hasFormat) line.fail("the PLY header names no format");
      header.dataOffset = begin;
      header.lineCount = line.where.line;
      checkCounts(header, bytes, file);
      return header;
    } else {
      line.fail(fmt::format("unknown keyword '{}' in the PLY header{}", keyword,
                            suggestion(keyword, {"comment", "obj_info", "format", "element",
                                                 "property", "end_header"})));
    }
  }
  if (line.where.line <= 1) line.fail("not a PLY file; it would start with 'ply'");
  line.fail("the PLY header does not end; 'end_header' is missing");
}

}  // namespace lobelia::io
