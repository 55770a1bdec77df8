// Closed forms, quick enough for a single direction.
//
// Phong's lobe is one of the exact first moment, which has the horizon and the cosine in it: a
// relative L1 error of .01 to .09 where the mirror direction and the exponent give .04 to .41
// (methods.md 0.5). Microfacets have the shapes of bsdf/gaussian_shape.h: GGX two co-axial lobes,
// others a row of up to three in the plane of incidence. Where the horizon cuts off much of a lobe
// they are turned and widened to its first moment, little by little, for a step would be seen.
// Anisotropic ones are a row across their streak: lobes of equal energy, by the slopes of half
// vectors along the rougher tangent.
// What a fit has below the horizon is light from there: it is not cut off.
#include "lobelia/transfer/reflected_lobes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

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

// How much the horizon has to do with the lobe's shape: 0 where it is that of its micro-normals, 1
// where so much is cut off that these say little. Half vectors that send light along the horizon
// are (90 degrees - theta) / 2 from the normal.
float cutByHorizon(const Lobe& lobe, float cosine) {
  const float alpha = std::sqrt(lobe.alphaX * lobe.alphaY);
  const float sine = std::sqrt(1 - std::min(cosine * cosine, 1.f));
  const float t = std::clamp((alpha * sine / std::max(cosine, 1e-6f) - 0.45f) / 0.4f, 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

// Turns and widens (or narrows) lobes together, towards these moments. part: 0 for nothing, 1 for
// all of the way.
void moveTo(const LobeMoments& moments, float part, std::span<ReflectedLobe> lobes) {
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
    const Vec3f axis = turned(lobe.axis, sum / size, moments.first / wanted);
    lobe.axis = normalize(lobe.axis * (1 - part) + axis * part);
    const float wider = std::max(wantedSpread, 1 / kMostKappa) / spread;
    lobe.kappa = std::min(lobe.kappa / (1 - part + wider * part), kMostKappa);
  }
}

// Of a streak: so many that they overlap.
size_t lobesAcross(const Lobe& lobe) {
  const float narrow = std::min(lobe.alphaX, lobe.alphaY);
  const float wide = std::max(lobe.alphaX, lobe.alphaY);
  return static_cast<size_t>(
      std::clamp(2 * wide / narrow, float{Reflection::kFewLobes}, float{Reflection::kMostLobes}));
}

// A row of lobes for a streak: as many of about the same energy as there is room for.
int rowAcross(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo, const LobeMoments& moments,
              std::span<ReflectedLobe> lobes, uint32_t pointCount) {
  thread_local std::vector<LobePoint> points;
  thread_local std::vector<std::pair<float, uint32_t>> bySlope;
  points.clear(), bySlope.clear();
  quadraturePoints(bsdf, lobe, wo, pointCount, &points);
  const ShadingFrame& frame = bsdf.frameOf(lobe);
  float energy = 0;
  for (uint32_t i = 0; i < points.size(); ++i) {
    const Vec3f h = frame.toLocal(points[i].w + wo);
    bySlope.emplace_back((lobe.alphaX > lobe.alphaY ? h.x : h.y) / h.z, i);
    energy += luminance(points[i].weight);
  }
  if (!(energy > 0)) return 0;
  std::ranges::sort(bySlope);
  std::array<LobeMoments, Reflection::kMostLobes> row;
  float before = 0;
  for (const auto& [slope, i] : bySlope) {
    const float mass = luminance(points[i].weight);
    const auto at =
        static_cast<size_t>((before + 0.5f * mass) / energy * static_cast<float>(lobes.size()));
    row[std::min(at, lobes.size() - 1)].add({points[i].weight, points[i].w * mass});
    before += mass;
  }
  int count = 0;
  for (const LobeMoments& part : std::span(row).first(lobes.size())) {
    if (!(luminance(part.albedo) > 0)) continue;
    ReflectedLobe& to = lobes[static_cast<size_t>(count++)];
    to = reflectedLobe(part);
    to.alpha = moments.albedo * (luminance(part.albedo) / energy);
  }
  return count;
}

}  // namespace

ReflectedLobe reflectedLobe(const LobeMoments& moments) {
  const lobes::SphericalGaussian one =
      lobes::lobeOf({luminance(moments.albedo), moments.first}, kMostKappa);
  return {one.axis, one.sharpness, moments.albedo};
}

int reflectedLobes(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo, const LobeMoments& moments,
                   std::span<ReflectedLobe> lobes, uint32_t points) {
  if (!(luminance(moments.albedo) > 0)) return 0;
  if (lobe.type == LobeType::phong || static_cast<int>(lobes.size()) < fewestFor(lobe)) {
    lobes[0] = reflectedLobe(moments);
    return 1;
  }
  if (lobe.alphaX != lobe.alphaY) {
    const size_t most = std::min(lobes.size(), lobesAcross(lobe));
    return rowAcross(bsdf, lobe, wo, moments, lobes.first(most), points);
  }
  const ShadingFrame& frame = bsdf.frameOf(lobe);
  const Vec3f o = frame.toLocal(wo);
  const bool back = o.z < 0;
  std::array<ShapePart, Reflection::kFewLobes> parts;
  const int count = rowShape(lobe, back ? flipZ(o) : o, back && lobe.interface,
                             std::span(parts).first(std::min(lobes.size(), parts.size())));
  float sum = 0;
  for (int i = 0; i < count; ++i) sum += parts[static_cast<size_t>(i)].share;
  for (int i = 0; i < count; ++i) {
    const ShapePart& part = parts[static_cast<size_t>(i)];
    lobes[static_cast<size_t>(i)] = {frame.toWorld(back ? flipZ(part.axis) : part.axis),
                                     std::min(part.sharpness, kMostKappa),
                                     moments.albedo * (part.share / sum)};
  }
  if (const float part = cutByHorizon(lobe, std::abs(o.z)); part > 0)
    moveTo(moments, part, lobes.first(static_cast<size_t>(count)));
  return count;
}

}  // namespace lobelia::transfer
