#include "lobelia/transfer/reflection.h"

#include <algorithm>
#include <span>
#include <utility>

#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/transfer/interpolation-inl.h"
#include "lobelia/transfer/quick_moments.h"
#include "lobelia/transfer/reflected_lobes.h"

namespace lobelia::transfer {
namespace {

// The active lobes of a Bsdf, in its order.
struct ActiveLobes {
  int count = 0;
  std::array<const Lobe*, kMaxLobes> lobes{};
};
ActiveLobes activeLobes(const Bsdf& bsdf, Vec3f wo) {
  ActiveLobes active;
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    const Lobe& lobe = bsdf.lobes[i];
    if (isActive(lobe, dot(wo, bsdf.frameOf(lobe).n)))
      active.lobes[static_cast<size_t>(active.count++)] = &lobe;
  }
  return active;
}

// Is it one anisotropic lobe alone?
bool isStreak(const ActiveLobes& active) {
  if (active.count != 1) return false;
  const Lobe& lobe = *active.lobes[0];
  return lobe.type != LobeType::phong && lobe.alphaX != lobe.alphaY;
}

// Wide ones last. By insertion: there are few.
void sortByWidth(Reflection* out) {
  for (size_t i = 1; i < static_cast<size_t>(out->count); ++i)
    for (size_t j = i; j > 0 && out->lobes[j - 1].kappa < out->lobes[j].kappa; --j)
      std::swap(out->lobes[j - 1], out->lobes[j]);
}

void setSum(const LobeMoments& all, Reflection* out) {
  out->glossy = all.albedo;
  const float energy = luminance(all.albedo);
  if (energy > 0) out->r = all.first / energy;
}

// Shares the places for lobes out among the Bsdf's; the last place is for all that are left.
void addGlossy(const Bsdf& glossy, Vec3f wo, Reflection* out) {
  const ActiveLobes active = activeLobes(glossy, wo);
  const int most = isStreak(active) ? Reflection::kMostLobes : Reflection::kFewLobes;
  LobeMoments all, rest;
  for (int i = 0; i < active.count; ++i) {
    const Lobe& lobe = *active.lobes[static_cast<size_t>(i)];
    const LobeMoments moments = quickMoments(glossy, lobe, wo);
    all.add(moments);
    const int left = active.count - i, room = most - out->count;
    if (room == 1 && left + i > most) {
      rest.add(moments);
    } else {
      const auto places = std::span(out->lobes).subspan(static_cast<size_t>(out->count));
      const int share = std::max(room / left, 1);
      out->count +=
          reflectedLobes(glossy, lobe, wo, moments, places.first(static_cast<size_t>(share)));
    }
  }
  if (luminance(rest.albedo) > 0)
    out->lobes[static_cast<size_t>(out->count++)] = reflectedLobe(rest);
  sortByWidth(out);
  setSum(all, out);
}

// All but what its glossy lobes give.
Reflection withoutGlossy(const Bsdf& bsdf, Vec3f wo) {
  Reflection out;
  const Vec3f n = bsdf.frames[0].n;
  out.n = dot(n, wo) < 0 ? -n : n;
  out.mirror = normalize(out.n * (2 * dot(out.n, wo)) - wo);
  out.diffuse = diffuseAlbedo(bsdf, wo);
  return out;
}

}  // namespace

Reflection reflectionOf(const Bsdf& bsdf, Vec3f wo) {
  Reflection out = withoutGlossy(bsdf, wo);
  addGlossy(glossyPart(bsdf), wo, &out);
  return out;
}

Reflection summaryOf(const Bsdf& bsdf, Vec3f wo) {
  Reflection out = withoutGlossy(bsdf, wo);
  const Bsdf glossy = glossyPart(bsdf);
  const ActiveLobes active = activeLobes(glossy, wo);
  LobeMoments all;
  for (int i = 0; i < active.count; ++i)
    all.add(quickMoments(glossy, *active.lobes[static_cast<size_t>(i)], wo));
  setSum(all, &out);
  return out;
}

Vec3f turned(Vec3f v, Vec3f from, Vec3f to) {
  return fromCore(core::turnedWith(toCore(v), toCore(from), toCore(to)));
}

}  // namespace lobelia::transfer
