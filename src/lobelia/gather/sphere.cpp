#include "lobelia/gather/sphere.h"

#include <algorithm>
#include <cmath>

#include "lobelia/base/random.h"
#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/gaussian_shape.h"
#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/scene/shading.h"

namespace lobelia::gather {
namespace {

// Per lobe, for drawing directions: GGX takes two.
constexpr int kFitGaussians = 2;

// indices: of the BSDF's lobes among the sphere's, -1 for others.
void addLobes(const Bsdf& bsdf, Vec3f wi, PreparedSphere* sphere, int* indices) {
  for (int l = 0; l < bsdf.lobeCount; ++l) {
    const Lobe& lobe = bsdf.lobes[l];
    indices[l] = -1;
    if (lobe.sharp || isDelta(lobe)) continue;
    const ShadingFrame& frame = bsdf.frameOf(lobe);
    const float share = arrivingShare(bsdf, frame, wi);
    const Vec3f local = frame.toLocal(wi);
    if (!(share > 0) || local.z == 0) continue;
    indices[l] = sphere->lobeCount;
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

SamplingLobes samplingLobes(const Bsdf& bsdf, Vec3f w) {
  SamplingLobes result;
  PreparedSphere::Gaussian all[kMaxLobes * kFitGaussians];
  std::pair<float, int> order[kMaxLobes * kFitGaussians];
  int count = 0;
  float strongest = 0;
  for (int l = 0; l < bsdf.lobeCount; ++l) {
    const Lobe& lobe = bsdf.lobes[l];
    const ShadingFrame& frame = bsdf.frameOf(lobe);
    Vec3f local = frame.toLocal(w);
    const Rgb albedo = lobeAlbedo(lobe, local.z);
    const float energy = luminance(albedo);
    if (lobe.sharp || isDelta(lobe) || !(energy > 0) || !std::isfinite(energy)) continue;
    if (isDiffuse(lobe.type) || lobe.type == LobeType::diffuseTransmission) {
      result.diffuse += energy * kInvPi;
      result.diffuseColor += albedo * kInvPi;
      continue;
    }
    const bool behind = local.z < 0;
    if (behind) local = flipZ(local);
    ShapePart parts[kFitGaussians];
    const int partCount = shapeOf(lobe, local, behind && lobe.interface, parts);
    for (int i = 0; i < partCount; ++i) {
      const Vec3f axis = behind ? flipZ(parts[i].axis) : parts[i].axis;
      const float sharpness = std::clamp(parts[i].sharpness, 1e-3f, 1e7f);
      order[count] = {-energy * parts[i].share, count};
      const float integral = lobes::integral(sharpness);
      all[count++] = {frame.toWorld(axis), sharpness, energy * parts[i].share / integral,
                      albedo * (parts[i].share / integral)};
      result.sharpest = std::max(result.sharpest, sharpness);
    }
    if (drawnByHalfVector(lobe) && energy > strongest) {
      strongest = energy;
      result.halfLobe = l;
      const float thin = std::max(std::min(lobe.alphaX, lobe.alphaY), 1e-3f);
      result.sharpest = std::max(result.sharpest, 0.5f / (thin * thin));
    }
  }
  std::sort(order, order + count);
  result.gaussianCount = std::min(count, kSphereGaussians);
  for (int i = 0; i < result.gaussianCount; ++i) result.gaussians[i] = all[order[i].second];
  return result;
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
  int indices[kMaxLobes];
  addLobes(bsdf, wi, sphere, indices);
  const SamplingLobes sampling = samplingLobes(bsdf, wi);
  sphere->diffuse = sampling.diffuse;
  sphere->diffuseColor = sampling.diffuseColor;
  sphere->gaussianCount = sampling.gaussianCount;
  std::copy_n(sampling.gaussians, sampling.gaussianCount, sphere->gaussians);
  sphere->sharpest = sampling.sharpest;
  sphere->halfLobe = sampling.halfLobe < 0 ? -1 : indices[sampling.halfLobe];
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
