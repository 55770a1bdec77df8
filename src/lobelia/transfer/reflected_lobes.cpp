// Closed forms, quick enough for a single direction.
//
// Phong's lobe is one of the exact first moment, which has the horizon and the cosine in it: a
// relative L1 error of .01 to .09 where the mirror direction and the exponent give .04 to .41
// (methods.md 0.5). Microfacets have the shapes of bsdf/gaussian_shape.h: GGX two co-axial lobes,
// others a row of up to three in the plane of incidence. A share that lies below the horizon is
// light from there: no more than the lobe's fit sends there.
#include "lobelia/transfer/reflected_lobes.h"

#include <algorithm>
#include <array>

#include "lobelia/bsdf/gaussian_shape.h"
#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {

ReflectedLobe reflectedLobe(const LobeMoments& moments) {
  const lobes::SphericalGaussian one =
      lobes::lobeOf({luminance(moments.albedo), moments.first}, kMostKappa);
  return {one.axis, one.sharpness, moments.albedo};
}

int reflectedLobes(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo, const LobeMoments& moments,
                   std::span<ReflectedLobe> lobes) {
  if (!(luminance(moments.albedo) > 0)) return 0;
  if (lobe.type == LobeType::phong || lobes.size() == 1) {
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
  return count;
}

}  // namespace lobelia::transfer
