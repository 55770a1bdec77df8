// The header of a PLY file (internal to io).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lobelia/base/error.h"

namespace lobelia::io {

enum class PlyType : uint8_t {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  half,
  float32,
  float64
};
size_t byteSize(PlyType type);
inline bool isInteger(PlyType type) { return type < PlyType::half; }

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool isList = false;
  PlyType countType = PlyType::uint8;
};
struct PlyElement {
  std::string name;
  uint64_t count = 0;
  int line = 0;  // where it is declared
  std::vector<PlyProperty> properties;
};
struct PlyHeader {
  enum class Format : uint8_t { ascii, littleEndian, bigEndian } format = Format::ascii;
  std::vector<PlyElement> elements;
  size_t dataOffset = 0;  // of the first byte behind the header
  int lineCount = 0;      // of the header
};

// Throws InputError with the line. Counts that the file's size cannot hold are refused.
PlyHeader parsePlyHeader(const std::string& bytes, const std::string& file);

}  // namespace lobelia::io
