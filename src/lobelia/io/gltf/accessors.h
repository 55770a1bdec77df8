// Accessors: typed arrays in buffer views (glTF 2.0, 3.6.2). Every size is checked against the
// bytes there are before anything is allocated.
#pragma once

#include <string_view>
#include <vector>

#include "lobelia/io/gltf/document.h"

namespace lobelia::io::gltf {

// `count` elements of `components` numbers each, converted to floats (normalised integers to [0,1]
// or [-1,1]).
struct FloatArray {
  size_t count = 0, components = 0;
  std::vector<float> values;
  const float* operator[](size_t i) const { return &values[i * components]; }
  Vec3f vec3(size_t i) const { return {values[i * 3], values[i * 3 + 1], values[i * 3 + 2]}; }
};

// Number of components of "VEC3" and the like; fails on an unknown type.
size_t componentCount(const Json& accessor);
// `types`: those allowed, as in "VEC3" or "VEC3 VEC4". Non-finite values are an InputError.
FloatArray readFloats(Document& document, const Json& index, std::string_view types);
// Unsigned integers of 8, 16 or 32 bits.
std::vector<uint32_t> readIntegers(Document& document, const Json& index, std::string_view type);

}  // namespace lobelia::io::gltf
