// Typed integer handles into the scene's vectors.
#pragma once

#include <cstdint>

namespace lobelia {

template <class Tag>
struct Handle {
  uint32_t index = 0xffffffffu;
  constexpr bool valid() const { return index != 0xffffffffu; }
  friend constexpr bool operator==(Handle, Handle) = default;
};
using MeshHandle = Handle<struct Mesh>;
using ImageHandle = Handle<struct Image>;
using TextureHandle = Handle<struct Texture>;
using MaterialHandle = Handle<struct Material>;
using EmitterHandle = Handle<struct Emitter>;

}  // namespace lobelia
