#include "lobelia/bsdf/captured.h"

#include <algorithm>
#include <cmath>

#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

// What is left of the light that enters at normal incidence.
float normalTransmittance(float ior) { return 1 - sqr((ior - 1) / (ior + 1)); }

}  // namespace

float projectedIntegral(float sharpness) {
  return core::sgProjectedIntegral(std::max(sharpness, kMinCapturedSharpness));
}

Lobe capturedLobe(Rgb amplitude, float sharpness, float ior) {
  Lobe lobe;
  lobe.type = LobeType::microfacetReflection;
  lobe.distribution = Distribution::sphericalGaussian;
  lobe.fresnel = ior > 1 ? Fresnel::dielectric : Fresnel::one;
  lobe.eta = Rgb(ior);
  lobe.alphaX = lobe.alphaY = std::sqrt(2 / std::max(sharpness, kMinCapturedSharpness));
  lobe.weight = amplitude * projectedIntegral(sharpness);
  return lobe;
}

Lobe capturedDiffuse(Rgb diffuse, float ior) {
  Lobe lobe;
  lobe.weight = diffuse;
  if (ior > 1) {
    lobe.type = LobeType::coatedDiffuse;
    lobe.eta = Rgb(ior);
    lobe.weight /= sqr(normalTransmittance(ior));
  }
  return lobe;
}

float capturedScale(Rgb diffuse, Rgb weights, float ior) {
  // Without Fresnel the two add up. With it the diffuse part has at most diffuse / T(0) of T(o),
  // the lobes `weights` of F(o) = 1 - T(o): the greater of the two bounds the sum.
  const Rgb most = ior > 1 ? max(diffuse / normalTransmittance(ior), weights) : diffuse + weights;
  return 1 / std::max(maxComponent(most), 1.f);
}

}  // namespace lobelia
