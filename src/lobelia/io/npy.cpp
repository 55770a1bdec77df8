#include "lobelia/io/npy.h"

#include <fmt/format.h>

#include <bit>

#include "lobelia/base/file.h"

namespace lobelia::io {

std::string npyType(char kind, size_t itemBytes) {
  return fmt::format("{}{}{}", std::endian::native == std::endian::little ? '<' : '>', kind,
                     itemBytes);
}

void writeNpy(const std::string& file, const std::string& type, std::span<const size_t> shape,
              std::span<const std::byte> values) {
  std::string sides;  // a tuple of one has a comma, too
  for (const size_t side : shape) sides += fmt::format("{}, ", side);
  if (shape.size() > 1) sides.resize(sides.size() - 2);
  if (shape.size() == 1) sides.resize(sides.size() - 1);
  std::string dictionary =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, sides);
  constexpr size_t kBefore = 10, kMultiple = 64;  // magic, version and length; of the whole header
  const size_t length = (kBefore + dictionary.size() + 1 + kMultiple - 1) / kMultiple * kMultiple;
  dictionary.resize(length - kBefore - 1, ' ');
  dictionary += '\n';
  std::string head = "\x93NUMPY";
  head += '\x01', head += '\x00';
  head += static_cast<char>(dictionary.size() & 0xff);
  head += static_cast<char>(dictionary.size() >> 8);
  head += dictionary;
  const std::span<const std::byte> parts[] = {std::as_bytes(std::span<const char>(head)), values};
  writeFileAtomically(file, parts);
}

}  // namespace lobelia::io
