// Closed forms, quick enough for a single direction.
//
// Phong's lobe is one of the exact first moment, which has the horizon and the cosine in it: a
// relative L1 error of .01 to .09 where the mirror direction and the exponent give .04 to .41
// (methods.md 0.5). Microfacets have the shapes of bsdf/gaussian_shape.h: GGX two co-axial lobes,
// others a row of up to three in the plane of incidence. Where the horizon cuts off much of a lobe
// they are turned and widened to its first moment (GGX of 0.4 at 60 degrees: .42 instead of .66).
// What a fit has below the horizon is light from there: it is not cut off.
#include "lobelia/transfer/reflected_lobes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobelia/bsdf/gaussian_shape.h"
#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {

namespace {

// Below two lobes GGX is better off with its first moment, GTR1 below three.
int fewestFor(const Lobe& lobe) {
  if (lobe.type != LobeType::microfacetReflection) return 2;
  return lobe.distribution == Distribution::gtr1 ? 3 : 2;
}

// Is so much of the lobe cut off that its shape has little to do with that of its micro-normals?
// Half vectors that send light along the horizon are (90 degrees - theta) / 2 from the normal.
bool reachesHorizon(const Lobe& lobe, float cosine) {
  const float alpha = std::sqrt(lobe.alphaX * lobe.alphaY);
  return alpha * std::sqrt(1 - std::min(cosine * cosine, 1.f)) > 0.65f * cosine;
}

// Turns and widens (or narrows) lobes together, towards these moments.
void moveTo(const LobeMoments& moments, std::span<ReflectedLobe> lobes) {
  Vec3f sum{};
  float energy = 0;
  for (const ReflectedLobe& lobe : lobes) {
    sum += lobe.axis * (luminance(lobe.alpha) * lobes::meanResultant(lobe.kappa));
    energy += luminance(lobe.alpha);
  }
  const float size = length(sum), wanted = length(moments.first);
  if (!(size > 0) || !(wanted > 0)) return;
  // Of sharp lobes 1 / kappa is one less the mean's length.
  const float spread = 1 - size / energy;
  const float wantedSpread = 1 - wanted / luminance(moments.albedo);
  for (ReflectedLobe& lobe : lobes) {
    lobe.axis = normalize(turned(lobe.axis, sum / size, moments.first / wanted));
    lobe.kappa = std::min(lobe.kappa * spread / std::max(wantedSpread, 1 / kMostKappa), kMostKappa);
  }
}

}  // namespace

ReflectedLobe reflectedLobe(const LobeMoments& moments) {
  const lobes::SphericalGaussian one =
      lobes::lobeOf({luminance(moments.albedo), moments.first}, kMostKappa);
  return {one.axis, one.sharpness, moments.albedo};
}

int reflectedLobes(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo, const LobeMoments& moments,
                   std::span<ReflectedLobe> lobes) {
  if (!(luminance(moments.albedo) > 0)) return 0;
  if (lobe.type == LobeType::phong || static_cast<int>(lobes.size()) < fewestFor(lobe)) {
    lobes[0] = reflectedLobe(moments);
    return 1;
  }
  const ShadingFrame& frame = bsdf.frameOf(lobe);
  const Vec3f o = frame.toLocal(wo);
  const bool back = o.z < 0;
  std::array<ShapePart, Reflection::kMostLobes> parts;
  const int count = rowShape(lobe, back ? flipZ(o) : o, back && lobe.interface,
                             std::span(parts).first(lobes.size()));
  float sum = 0;
  for (int i = 0; i < count; ++i) sum += parts[static_cast<size_t>(i)].share;
  for (int i = 0; i < count; ++i) {
    const ShapePart& part = parts[static_cast<size_t>(i)];
    lobes[static_cast<size_t>(i)] = {frame.toWorld(back ? flipZ(part.axis) : part.axis),
                                     std::min(part.sharpness, kMostKappa),
                                     moments.albedo * (part.share / sum)};
  }
  if (reachesHorizon(lobe, std::abs(o.z))) moveTo(moments, lobes.first(static_cast<size_t>(count)));
  return count;
}

}  // namespace lobelia::transfer
