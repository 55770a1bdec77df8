// A rough conductor under a rough dielectric coat of negligible thickness, PBRT-v4's
// CoatedConductorBxDF (Pharr, Jakob and Humphreys 2023, section 14.3), in closed form instead of a
// random walk: the reflection of the coat, and the conductor seen through it.
//
// The conductor's index is taken relative to the coat, its Fresnel factor at the refracted cosine,
// and light that the coat sends back to it is summed: T T f / (1 - r f), exact where both are
// smooth (throughLayers() in bsdf/kernels-inl.h). T is one minus the albedo of the coat
// (bsdf/layers.h). Its roughness is what comes out: a tilt d of a micro-normal in the metal turns
// the ray inside by 2 d and outside by 2 n d; tilts d1, d2 of the coat where light goes in and out
// turn it by (n - 1) (d1
// + d2). Variances of slopes add: alpha^2 = n^2 alphaMetal^2 + (n - 1)^2 / 2 alphaCoat^2.
// Deviations: that is first order in the tilts and at normal incidence, the same for all
// directions; the sum over reflections keeps the roughness of the first.
#include <cmath>

#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/layers.h"
#include "lobelia/scene/lobe_builder.h"

namespace lobelia {
namespace {

float throughCoat(float metal, float coat, float n) {
  return std::min(std::sqrt(sqr(n * metal) + 0.5f * sqr((n - 1) * coat)), 1.f);
}

// Tables are kept for each value: what varies over a surface is rounded.
float forTable(float alpha, const FloatParam& param) {
  return param.texture.valid() ? std::max(std::round(alpha * 128), 1.f) / 128 : alpha;
}

}  // namespace

void addCoatedConductorLobes(const Builder& b) {
  const Material& m = b.material;
  const float n = std::max(m.coatIor, 1e-3f);
  Lobe coat = b.microfacets(LobeType::microfacetReflection);
  coat.fresnel = Fresnel::dielectric;
  coat.eta = Rgb(n);
  coat.alphaX = b.alpha(m.coatAlphaU), coat.alphaY = b.alpha(m.coatAlphaV);
  Lobe above = coat;
  above.alphaX = forTable(coat.alphaX, m.coatAlphaU);
  above.alphaY = forTable(coat.alphaY, m.coatAlphaV);
  const TransmittanceTable& table = layerTransmittance({&above, 1});
  const bool smoothCoat = std::max(coat.alphaX, coat.alphaY) <= kMinAlpha;
  if (smoothCoat) coat.type = LobeType::deltaReflection;

  Lobe metal = b.microfacets(LobeType::microfacetReflection);
  metal.fresnel = Fresnel::coatedConductor;
  metal.eta = evaluate(b.scene, m.eta, b.at) / n;
  metal.k = evaluate(b.scene, m.k, b.at) / n;
  metal.parameters.x = n;
  metal.alphaX = throughCoat(metal.alphaX, smoothCoat ? 0 : coat.alphaX, n);
  metal.alphaY = throughCoat(metal.alphaY, smoothCoat ? 0 : coat.alphaY, n);
  Rgb value = b.color(m.specular);
  if (smoothCoat && std::max(metal.alphaX, metal.alphaY) <= 2 * kMinAlpha * std::max(n, 1.f)) {
    metal.type = LobeType::deltaReflection;
    const float r = lobeAlbedo(coat, std::abs(b.cosThetaO)).x;
    const Rgb f = lobeAlbedo(metal, std::abs(b.cosThetaO));
    value *= Rgb(sqr(1 - r)) / max(Rgb(1.f) - f * r, Rgb(1e-4f));
  } else {
    metal.variant = kCoated;
    metal.table = table.data();
  }
  const float cosine = b.twoSided ? std::abs(b.cosThetaO) : b.cosThetaO;
  b.add(coat, Rgb(b.weight), b.weight * lobeAlbedo(coat, cosine).x);
  Lobe seen = metal;
  seen.weight = value;
  b.add(metal, value, mean(lobeAlbedo(seen, cosine)));
}

}  // namespace lobelia
