// A photon: light that a particle has brought to a surface with rough lobes [Jensen01].
#pragma once

#include "lobelia/base/vec.h"

namespace lobelia {

struct Photon {
  Vec3f p;
  Rgb power;        // W
  uint32_t wi;      // where it came from, leaving the surface; octahedral, as lights' normals
  uint32_t normal;  // geometric, of the outside; octahedral
  uint32_t tag;     // depth in the low 8 bits, group above
  int depth() const { return static_cast<int>(tag & 0xff); }
  uint16_t group() const { return static_cast<uint16_t>(tag >> 8); }
};
static_assert(sizeof(Photon) == 36);

}  // namespace lobelia
