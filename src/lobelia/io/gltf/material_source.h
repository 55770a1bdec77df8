// What a material is made from (internal to materials.cpp and material_extensions.cpp).
#pragma once

#include "lobelia/io/gltf/materials.h"

namespace lobelia::io::gltf {

struct Materials::Source {
  Json json;
  UvSets uv;
  MaterialUse use;

  // Base colour, or the diffuse colour of specular-glossiness, with its alpha and its texture.
  struct BaseFactor {
    Rgb color{1, 1, 1};
    double alpha = 1;
    Json texture;
  };
  BaseFactor baseFactor() const;
};

}  // namespace lobelia::io::gltf
