// A BSDF's rough lobes as light sources: diffuse ones keep their cosine, glossy ones become
// spherical Gaussians (shape: gaussian_shape.cpp) whose energy above the horizon is the lobe's
// directional albedo (albedo.h), times the share of the light that gets to the lobe's frame.
#include "lobelia/bsdf/gaussians.h"

#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/bsdf/gaussian_shape.h"
#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia {
namespace {

bool isGlossy(const Lobe& lobe) {
  return !lobe.sharp && !isDelta(lobe) && !isDiffuse(lobe.type) &&
         lobe.type != LobeType::diffuseTransmission;
}

// wi: in the frame.
void addGlossy(const Frame& frame, const Lobe& lobe, Vec3f wi, float arriving, int limit,
               LobeExpansion* out) {
  const Rgb energy = glossyEnergy(lobe, wi) * arriving;
  if (!(maxComponent(energy) > 0)) return;
  const bool back = wi.z < 0;
  const Vec3f front = back ? flipZ(wi) : wi;
  std::array<ShapePart, LobeExpansion::kMaxGaussians> parts;
  const int count = shapeOf(lobe, front, back && lobe.interface,
                            std::span(parts).first(static_cast<size_t>(limit)));
  const bool transmission = isTransmission(lobe);
  const Vec3f normal = back != transmission ? -frame.n : frame.n;
  for (int i = 0; i < count; ++i) {
    const ShapePart& part = parts[static_cast<size_t>(i)];
    const float cosine = transmission ? -part.axis.z : part.axis.z;
    const float above = lobes::hemisphereIntegral(cosine, part.sharpness);
    const Vec3f axis = frame.toWorld(back ? flipZ(part.axis) : part.axis);
    const Rgb amplitude = energy * (part.share / above);
    if (!(maxComponent(amplitude) > 0) || !isFinite(amplitude)) continue;
    out->gaussians[static_cast<size_t>(out->count++)] = {axis, part.sharpness, amplitude, normal};
  }
}

}  // namespace

LobeExpansion expand(const Bsdf& bsdf, Vec3f wi, int gaussiansPerLobe) {
  LobeExpansion out;
  Vec3f locals[kMaxFrames];
  float shares[kMaxFrames];
  for (int f = 0; f < bsdf.frameCount; ++f) {
    locals[f] = bsdf.frames[f].toLocal(wi);
    shares[f] = arrivingShare(bsdf, bsdf.frames[f], wi);
  }
  int glossyLeft = 0;
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    if (isGlossy(bsdf.lobes[i]) && isActive(bsdf.lobes[i], locals[bsdf.lobes[i].frame].z))
      ++glossyLeft;
  }
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    const Lobe& lobe = bsdf.lobes[i];
    const Vec3f local = locals[lobe.frame];
    const float share = shares[lobe.frame];
    if (lobe.sharp || isDelta(lobe) || !isActive(lobe, local.z)) continue;
    if (isDiffuse(lobe.type)) {
      out.diffuse += lobeAlbedo(lobe, local.z) * share;
    } else if (lobe.type == LobeType::diffuseTransmission) {
      out.diffuseTransmitted += lobeAlbedo(lobe, local.z) * share;
    } else {
      const int room = (LobeExpansion::kMaxGaussians - out.count) / glossyLeft--;
      addGlossy(bsdf.frameOf(lobe), lobe, local, share, std::clamp(gaussiansPerLobe, 1, room),
                &out);
    }
  }
  return out;
}

}  // namespace lobelia
