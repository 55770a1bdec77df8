// Captured reflectance: the sum of spherical Gaussians of bsdf/captured.h with textured amplitudes
// and sharpnesses. Deviation: where a point would reflect more than it receives, all of it is
// scaled down (capturedScale()), as phong and ward are.
#include <cmath>

#include "lobelia/bsdf/captured.h"
#include "lobelia/scene/lobe_builder.h"

namespace lobelia {
namespace {

// Of the weight that is reflected, about: Fresnel by Schlick's formula.
float share(const Lobe& part, float cosine) {
  if (part.eta.x <= 1) return 1;
  const float f0 = sqr((part.eta.x - 1) / (part.eta.x + 1)), m = 1 - std::min(cosine, 1.f);
  const float reflected = f0 + (1 - f0) * sqr(sqr(m)) * m;
  return part.type == LobeType::microfacetReflection ? reflected : 1 - reflected;
}

}  // namespace

void addCapturedLobes(const Builder& b) {
  const Material& material = b.material;
  const auto color = [&](const ColorParam& p) { return max(evaluate(b.scene, p, b.at), Rgb(0.f)); };
  Lobe parts[kMaxLobes];
  int count = 0;
  const Rgb diffuse = color(material.diffuse);
  parts[count++] = capturedDiffuse(diffuse, material.ior);
  Rgb weights{};
  for (const CapturedLobe& lobe : material.capturedLobes) {
    if (count == kMaxLobes) break;  // validate() says so
    const float sharpness = evaluate(b.scene, lobe.sharpness, b.at);
    parts[count] = capturedLobe(color(lobe.amplitude), sharpness, material.ior);
    weights += parts[count++].weight;
  }
  const float scale = b.weight * capturedScale(diffuse, weights, material.ior);
  for (int i = 0; i < count; ++i) {
    Lobe& part = parts[i];
    part.weight *= scale;
    part.frame = b.frame;
    part.twoSided = b.twoSided;
    part.selection = mean(part.weight) * share(part, std::abs(b.cosThetaO));
    // Black lobes are left out: nothing would ever come of them.
    if (part.selection > 0) b.bsdf.add(part);
  }
}

}  // namespace lobelia
