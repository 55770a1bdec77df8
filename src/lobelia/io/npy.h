// Arrays of numbers as NumPy's NPY files, to be read by other programs.
//
// Format 1.0: a magic number, the length of a header, a Python dictionary of the type, the order
// and the shape padded to a multiple of 64 bytes, and the values, the last index the fastest
// [numpy.lib.format, https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html].
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace lobelia::io {

// kind: 'f' (floating), 'i' or 'u' (integer), of `itemBytes` bytes in this machine's order. As
// NumPy calls it: "<f4".
std::string npyType(char kind, size_t itemBytes);
// values: all of the shape. Written whole or not at all; throws RuntimeError.
void writeNpy(const std::string& file, const std::string& type, std::span<const size_t> shape,
              std::span<const std::byte> values);

}  // namespace lobelia::io
