#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/path/path_walk-inl.h"

namespace lobelia {

Rgb sharpPart(const Bsdf& bsdf, Vec3f wo, const BsdfSample& s, Transport transport) {
  bool rough = false, sharp = false, sharpDensity = false;
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    const Lobe& lobe = bsdf.lobes[i];
    (lobe.sharp ? sharp : rough) = true;
    if (lobe.sharp && !isDelta(lobe.type)) sharpDensity = true;
  }
  if (!rough) return s.weight;
  if (!sharp) return {};
  if (s.delta) return s.sharp ? s.weight : Rgb{};
  if (!sharpDensity) return {};
  return min(evaluate(bsdf, wo, s.wi, LobeSet::sharp, transport) / s.pdf, s.weight);
}

template class PathWalk<Tracer>;

}  // namespace lobelia
