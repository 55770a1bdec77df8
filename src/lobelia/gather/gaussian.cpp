#include "lobelia/gather/gaussian.h"

#include <algorithm>
#include <cmath>

#include "lobelia/gather/light_block.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::gather {
namespace {

// Mean cosine to the normal of what a surface reflects diffusely.
constexpr float kDiffuseMean = 2 / 3.f;
// Standard deviations, of places and of normals, beyond which what a Gaussian has counts for
// nothing.
constexpr float kExtent = 2.5f;
// Points in the plane of a flat cluster get nothing of it.
constexpr float kLeastFacing = 1e-4f;

float toksvig(float sharpness) { return sharpness / (sharpness + 1); }
float inverseToksvig(float mean) { return mean / std::max(1 - mean, 1e-7f); }

// The paper's: cosine lobes whose normals spread, as a Gaussian with their mean.
PreparedGaussian::Part mergedDiffuse(const GaussianLight& light, bool byToksvig) {
  PreparedGaussian::Part part;
  const float spread = light.normalSharpness;
  const float mean = kDiffuseMean * (byToksvig ? toksvig(spread) : lobes::meanResultant(spread));
  part.sharpness = byToksvig ? inverseToksvig(mean) : lobes::inverseMeanResultant(mean);
  part.peak = light.diffuse / lobes::integral(part.sharpness);
  return part;
}

}  // namespace

PreparedGaussian prepareGaussian(const GaussianLight& light, const GaussianShading& shading) {
  PreparedGaussian out;
  out.mean = light.mean;
  const float scale = 0.5f * shading.spread;
  out.halfTrace = scale * (light.covariance[0] + light.covariance[1] + light.covariance[2]);
  for (int i = 0; i < 6; ++i) {
    out.covariance[i] = light.covariance[i];
    if (shading.projected) out.q[i] = scale * light.covariance[i];
  }
  out.extent = kExtent * std::sqrt(std::max(out.halfTrace, 0.f));
  if (shading.form == GaussianShading::Form::accurate) {
    out.diffuse.sharpness = light.normalSharpness;
    out.diffuse.peak = light.diffuse * kInvPi;
  } else {
    out.diffuse = mergedDiffuse(light, shading.toksvig);
  }
  out.diffuse.axis = light.normal;
  out.normalSharpness = light.normalSharpness;
  out.diffuse.any = maxComponent(light.diffuse) > 0;
  out.glossy.axis = light.axis;
  out.glossy.sharpness = light.sharpness;
  // Above the plane across the normal, as blurred as normals are.
  const float seen =
      light.sharpness * light.normalSharpness / (light.sharpness + light.normalSharpness + 1);
  out.glossy.peak = light.glossy * (lobes::integral(seen) / lobes::integral(light.sharpness) *
                                    lobes::clippedPeak(dot(light.axis, light.normal), seen));
  out.glossy.any = maxComponent(light.glossy) > 0;
  // All sides where normals spread widely.
  out.facingSine = isFlat(light)
                       ? -kLeastFacing
                       : std::min(1.f, kExtent / std::sqrt(std::max(light.normalSharpness, 1.f)));
  for (int i = 0; i < GaussianLight::kPlaces; ++i)
    out.ends[i] = liftedEnd(light.places[i].p, decodeOctahedral(light.places[i].normal));
  return out;
}

}  // namespace lobelia::gather
