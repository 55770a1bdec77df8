// Captured reflectance: the sum of spherical Gaussians of bsdf/captured.h with textured amplitudes
// and sharpnesses. Deviation: where a point would reflect more than it receives, all of it is
// scaled down (capturedScale()), as phong and ward are.
#include <cmath>

#include "lobelia/bsdf/captured.h"
#include "lobelia/scene/material_lobes.h"

namespace lobelia {
namespace {

float mean(Rgb c) { return (c.x + c.y + c.z) / 3; }

// Of the weight that is reflected, about: Fresnel by Schlick's formula.
float share(const Lobe& part, float cosine) {
  if (part.eta.x <= 1) return 1;
  const float f0 = sqr((part.eta.x - 1) / (part.eta.x + 1)), m = 1 - std::min(cosine, 1.f);
  const float reflected = f0 + (1 - f0) * sqr(sqr(m)) * m;
  return part.type == LobeType::microfacetReflection ? reflected : 1 - reflected;
}

}  // namespace

void addCapturedLobes(const Scene& scene, const Material& material, const TextureContext& at,
                      float cosThetaO, float weight, bool twoSided, Bsdf& bsdf) {
  const auto color = [&](const ColorParam& p) { return max(evaluate(scene, p, at), Rgb(0.f)); };
  Lobe parts[kMaxLobes];
  int count = 0;
  const Rgb diffuse = color(material.diffuse);
  parts[count++] = capturedDiffuse(diffuse, material.ior);
  Rgb weights{};
  for (const CapturedLobe& lobe : material.capturedLobes) {
    if (count == kMaxLobes) break;  // validate() says so
    const float sharpness = evaluate(scene, lobe.sharpness, at);
    parts[count] = capturedLobe(color(lobe.amplitude), sharpness, material.ior);
    weights += parts[count++].weight;
  }
  const float scale = weight * capturedScale(diffuse, weights, material.ior);
  for (int i = 0; i < count; ++i) {
    Lobe& part = parts[i];
    part.weight *= scale;
    part.twoSided = twoSided;
    part.selection = mean(part.weight) * share(part, std::abs(cosThetaO));
    // Black lobes are left out: nothing would ever come of them.
    if (part.selection > 0) bsdf.add(part);
  }
}

}  // namespace lobelia
