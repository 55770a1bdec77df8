// Deviations from Mitsuba 3: quadrature with 40 x 40 nodes for both tables (there 32 x 32 outside
// and 128 x 128 inside). Its internal reflectance is the plain mean over 64 cosines from 0 to 1,
// both ends included, about 1.5 % below the integral; kept, because the brightness of the base
// follows.
#include "lobelia/bsdf/coat.h"

#include <cmath>
#include <tuple>

#include "lobelia/bsdf/layers.h"
#include "lobelia/bsdf/lobe_sampling.h"
#include "lobelia/bsdf/memo.h"
#include "lobelia/bsdf/microfacet_sampling.h"
#include "lobelia/bsdf/quadrature.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

// Importance weight of a sampled micro-normal without the masking of the second direction.
float normalWeight(Distribution distribution, float alpha, Vec3f w, Vec3f m) {
  if (distribution == Distribution::ggx || distribution == Distribution::beckmann) return 1;
  return core::smithMasking(distribution, alpha, alpha, toCore(w)) * dot(w, m) / (w.z * m.z);
}

RoughCoat integrateCoat(Distribution distribution, float alpha, float eta) {
  const GaussRule rule = gaussLegendre(40);
  RoughCoat coat;
  double internal = 0;
  for (int i = 0; i < kTransmittanceSize; ++i) {
    const float mu =
        std::max(1e-6f, static_cast<float>(i) / static_cast<float>(kTransmittanceSize - 1));
    const Vec3f w(std::sqrt(1 - mu * mu), 0, mu);
    double through = 0, back = 0;
    for (size_t a = 0; a < rule.nodes.size(); ++a) {
      for (size_t b = 0; b < rule.nodes.size(); ++b) {
        const Vec2f u(static_cast<float>(rule.nodes[a]), static_cast<float>(rule.nodes[b]));
        const Vec3f m = sampleMicroNormal(distribution, alpha, alpha, w, u);
        const float cosine = dot(w, m);
        if (cosine <= 0) continue;
        const double weight =
            rule.weights[a] * rule.weights[b] * normalWeight(distribution, alpha, w, m);
        const auto masking = [&](Vec3f v) {
          return static_cast<double>(core::smithMasking(distribution, alpha, alpha, toCore(v)));
        };
        const auto refracted = refract(w, m, eta);
        if (refracted && refracted->z < 0)
          through += weight * masking(*refracted) * (1 - core::fresnelDielectric(cosine, eta));
        const Vec3f reflected = reflect(w, m);
        if (reflected.z > 0)
          back += weight * masking(reflected) * core::fresnelDielectric(cosine, 1 / eta);
      }
    }
    coat.transmittance[static_cast<size_t>(i)] = static_cast<float>(through);
    internal += 2 * back * mu / kTransmittanceSize;
  }
  coat.transmittance[kTransmittanceSize] = diffuseMean(coat.transmittance);
  coat.internalReflectance = static_cast<float>(internal);
  return coat;
}

using CoatKey = std::tuple<Distribution, float, float>;

}  // namespace

float fresnelDiffuseReflectance(float eta) {
  if (eta < 1) return -1.4399f * eta * eta + 0.7099f * eta + 0.6681f + 0.0636f / eta;
  const float x = 1 / eta;
  return 0.919317f +
         x * (-3.4793f + x * (6.75335f + x * (-7.80989f + x * (4.98554f + x * -1.36881f))));
}

const RoughCoat& roughCoat(Distribution distribution, float alpha, float eta) {
  static Memo<CoatKey, RoughCoat> memo;
  const size_t slot = std::hash<float>{}(alpha) ^ (std::hash<float>{}(eta) >> 7);
  return memo.find({distribution, alpha, eta}, slot,
                   [&] { return integrateCoat(distribution, alpha, eta); });
}

}  // namespace lobelia
