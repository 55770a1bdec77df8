#include "lobelia/gather/sphere.h"

#include <algorithm>
#include <cmath>

#include "lobelia/base/random.h"
#include "lobelia/bsdf/gaussians.h"
#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/scene/shading.h"

namespace lobelia::gather {
namespace {

// Gaussians per lobe of a fit for drawing directions: GGX takes two.
constexpr int kFitGaussians = 2;

void addLobes(const Bsdf& bsdf, Vec3f wi, PreparedSphere* sphere) {
  for (int l = 0; l < bsdf.lobeCount; ++l) {
    const Lobe& lobe = bsdf.lobes[l];
    if (lobe.sharp || isDelta(lobe)) continue;
    const ShadingFrame& frame = bsdf.frameOf(lobe);
    const float share = arrivingShare(bsdf, frame, wi);
    const Vec3f local = frame.toLocal(wi);
    if (!(share > 0) || local.z == 0) continue;
    // arrivingShare() counts f without its cosine; the lobe's value has it.
    PreparedSphere::LightLobe& out = sphere->lobes[sphere->lobeCount++];
    out = {lobe, frame, local, share / std::abs(local.z)};
    sphere->transmits |= isTransmission(lobe);
  }
}

void setDisc(const SphericalLight& light, Vec3f litNormal, PreparedSphere* sphere) {
  sphere->disc = discFrame(litNormal);
  sphere->radius = light.radius;
  sphere->squaredRadius = light.radius * light.radius;
  sphere->whole = (light.coverage[0] & light.coverage[1]) == ~0u;
  if (!sphere->whole) sphere->weights = cellWeights(light);
}

void setRandom(const SphericalLight& light, PreparedSphere* sphere) {
  uint64_t key = hashCombine(light.triangle, light.instance);
  for (const float v : {light.b1, light.b2, light.p.x, light.p.y, light.p.z})
    key = hashCombine(key, std::bit_cast<uint32_t>(v));
  for (float& u : sphere->random) {
    u = toUnitFloat(static_cast<uint32_t>(key >> 32));
    key = mixBits(key + 1);
  }
}

}  // namespace

int strongestGaussians(const Bsdf& bsdf, Vec3f w, PreparedSphere::Gaussian* gaussians,
                       float* diffuse) {
  const LobeExpansion all = expand(bsdf, w, kFitGaussians);
  *diffuse = luminance(all.diffuse + all.diffuseTransmitted) * kInvPi;
  std::pair<float, int> order[LobeExpansion::kMaxGaussians];
  int count = 0;
  for (int i = 0; i < all.count; ++i) {
    const GaussianLobe& g = all.gaussians[static_cast<size_t>(i)];
    const float energy = luminance(g.amplitude) * lobes::integral(g.sharpness);
    if (energy > 0 && std::isfinite(energy)) order[count++] = {-energy, i};
  }
  std::sort(order, order + count);
  count = std::min(count, kSphereGaussians);
  for (int i = 0; i < count; ++i) {
    const GaussianLobe& g = all.gaussians[static_cast<size_t>(order[i].second)];
    gaussians[i] = {g.axis, g.sharpness, luminance(g.amplitude)};
  }
  return count;
}

void prepareSphere(const Scene& scene, const SphericalLight& light, float specularLimit,
                   PreparedSphere* sphere) {
  const SurfacePoint at =
      surfacePoint(scene, {0, light.b1, light.b2, light.instance, light.triangle});
  const Vec3f wi = decodeOctahedral(light.arriving);
  const Bsdf bsdf = makeBsdf(scene, at, wi, specularLimit);
  sphere->lobeCount = 0, sphere->transmits = false;
  setDisc(light, dot(bsdf.ng, wi) < 0 ? -bsdf.ng : bsdf.ng, sphere);
  setRandom(light, sphere);
  addLobes(bsdf, wi, sphere);
  sphere->gaussianCount = strongestGaussians(bsdf, wi, sphere->gaussians, &sphere->diffuse);
  sphere->sharpest = 0;
  for (int i = 0; i < sphere->gaussianCount; ++i)
    sphere->sharpest = std::max(sphere->sharpest, sphere->gaussians[i].sharpness);
}

Rgb leavingRadiance(const PreparedSphere& sphere, Vec3f w) {
  Rgb sum{};
  for (int l = 0; l < sphere.lobeCount; ++l) {
    const PreparedSphere::LightLobe& lobe = sphere.lobes[l];
    sum += evaluateLobe(lobe.lobe, lobe.frame.toLocal(w), lobe.wi) * lobe.factor;
  }
  return sum;
}

}  // namespace lobelia::gather
