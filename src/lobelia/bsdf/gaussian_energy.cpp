// Directional albedo of a glossy lobe for one direction.
#include <cmath>

#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/gaussian_shape.h"
#include "lobelia/bsdf/lobe_sampling.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

constexpr uint32_t kSamples = 256;

// Hammersley points: i / n and the bit-reversed i, both at the centres of their strata.
Vec2f hammersley(uint32_t i) {
  uint32_t reversed = 0;
  for (uint32_t bit = 1, to = kSamples >> 1; bit < kSamples; bit <<= 1, to >>= 1) {
    if (i & bit) reversed |= to;
  }
  return {(static_cast<float>(i) + 0.5f) / kSamples,
          (static_cast<float>(reversed) + 0.5f) / kSamples};
}

// Mean of value over density at points drawn by the lobe's own sampler: nearly constant for visible
// micro-normals, so that few points do.
Rgb sampledAlbedo(const Lobe& lobe, Vec3f wo) {
  Rgb sum{};
  for (uint32_t i = 0; i < kSamples; ++i) {
    const auto w = sampleLobe(lobe, wo, hammersley(i));
    if (!w) continue;
    const float density = lobePdf(lobe, wo, *w);
    if (density > 0) sum += evaluateLobe(lobe, wo, *w) / density;
  }
  return sum / static_cast<float>(kSamples);
}

}  // namespace

Rgb glossyEnergy(const Lobe& lobe, Vec3f wo) {
  if (!isActive(lobe, wo.z)) return {};
  if (lobe.type == LobeType::microfacetTransmission) {
    // Light, not radiance: without the 1/eta^2 that the kernels include.
    return sampledAlbedo(lobe, wo) * sqr(relativeEta(lobe, wo.z < 0));
  }
  if (isCoated(lobe)) return sampledAlbedo(lobe, wo);
  if (lobe.type != LobeType::phong && lobe.alphaX != lobe.alphaY) return sampledAlbedo(lobe, wo);
  return lobeAlbedo(lobe, wo.z);
}

}  // namespace lobelia
