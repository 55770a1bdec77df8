// The diffuse and the glossy part of a Bsdf.
//
// Deviation from [P002]: mirrors and lobes sharper than a slice holds are not left out, but made as
// blunt as the sharpest that it does hold: Beckmann's microfacets of roughness 1/128, whose
// reflected lobe has a kappa of 1 / (2 alpha^2) = 8,192.
#include <algorithm>

#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/transfer/reflection.h"
#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {
namespace {

template <class Taken>
Bsdf withLobes(const Bsdf& bsdf, const Taken& taken) {
  Bsdf part = bsdf;
  part.lobeCount = 0;
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    if (!taken(bsdf.lobes[i])) continue;
    part.add(bsdf.lobes[i]);
    part.lobes[part.lobeCount - 1].sharp = false;
  }
  return part;
}

bool isGlossyReflection(const Lobe& lobe) {
  return !isDiffuse(lobe.type) && !isTransmission(lobe.type);
}

Lobe blunted(Lobe lobe) {
  // Its transmitting twin is gone.
  if (lobe.type == LobeType::microfacetReflection)
    lobe.variant = static_cast<uint8_t>(lobe.variant & ~kInterfacePair);
  if (lobe.type == LobeType::deltaReflection) {
    lobe.type = LobeType::microfacetReflection;
    lobe.distribution = Distribution::beckmann;
    lobe.variant = 0;
    lobe.alphaX = lobe.alphaY = kLeastAlpha;
  } else if (lobe.type == LobeType::phong) {
    lobe.alphaX = lobe.alphaY = std::min(lobe.alphaX, kMostKappa - 1);
  } else {
    lobe.alphaX = std::max(lobe.alphaX, kLeastAlpha);
    lobe.alphaY = std::max(lobe.alphaY, kLeastAlpha);
  }
  return lobe;
}

}  // namespace

Bsdf diffusePart(const Bsdf& bsdf) {
  return withLobes(bsdf, [](const Lobe& lobe) { return isDiffuse(lobe.type); });
}

Bsdf glossyPart(const Bsdf& bsdf) {
  Bsdf part = withLobes(bsdf, isGlossyReflection);
  for (int i = 0; i < part.lobeCount; ++i) part.lobes[i] = blunted(part.lobes[i]);
  return part;
}

}  // namespace lobelia::transfer
