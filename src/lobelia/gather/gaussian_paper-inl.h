// Receivers of virtual spherical Gaussian lights as the paper shades them [P001 supplement, section
// 4.2]: diffuse ones by the product of Gaussians (for few lights) or by the cosine at the mean and
// A = 2 pi / sharpness (for thousands); microfacets by an anisotropic Gaussian [Xu13] around the
// mirror direction, of bandwidths sharpness / 8 in the plane of incidence and sharpness / (8 cos²)
// across it, times the rest of the lobe at the light's mean direction.
//
// Deviations: lobes of other kinds, of which the paper has none, are evaluated at the mean
// direction; so is Ward's model, whose density of facets is taken as Beckmann's. Roughness that
// differs along two axes counts along the plane of incidence and across it.
#if defined(LOBELIA_GATHER_GAUSSIAN_PAPER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_GAUSSIAN_PAPER_INL_H_
#undef LOBELIA_GATHER_GAUSSIAN_PAPER_INL_H_
#else
#define LOBELIA_GATHER_GAUSSIAN_PAPER_INL_H_
#endif

#include "lobelia/bsdf/filtered-inl.h"

LOBELIA_CORE_BEGIN

inline constexpr float kPaperDiffuseSharpness = 2;  // of the Gaussian that a cosine lobe is told by

// In place of the mean cosine: pi times the product of the light's and the cosine's normalised
// Gaussians.
template <class F>
LOBELIA_HD F productCosine(F cosine, F sharpness) {
  const F s = sqrt(max(F(0.f), F(1.f) - cosine * cosine));
  const F d(kPaperDiffuseSharpness);
  const F product =
      sgProductIntegral(V3<F>{s, F(0.f), cosine}, sharpness, V3<F>{F(0.f), F(0.f), F(1.f)}, d);
  return F(kSgPi) * product / (sgIntegral(d) * sgIntegral(sharpness));
}

// Frame of the anisotropic Gaussian, and its bandwidths.
template <class F>
struct MirrorLobe {
  V3<F> x, y, z;
  F etaX, etaY;
};
template <class F>
LOBELIA_HD MirrorLobe<F> mirrorLobe(const LobeParameters<F>& p, V3<F> wo) {
  MirrorLobe<F> lobe;
  lobe.z = {F(0.f) - wo.x, F(0.f) - wo.y, wo.z};
  const F s2 = wo.x * wo.x + wo.y * wo.y;
  const F inverse = F(1.f) / sqrt(max(s2, F(1e-12f)));
  const F cx = select(s2 > F(1e-12f), lobe.z.x * inverse, F(1.f));
  const F cy = select(s2 > F(1e-12f), lobe.z.y * inverse, F(0.f));
  lobe.y = {F(0.f) - cy, cx, F(0.f)};
  lobe.x = {cx * lobe.z.z, cy * lobe.z.z, F(0.f) - (cx * lobe.z.x + cy * lobe.z.y)};
  const F ax = p.alphaX * p.alphaX, ay = p.alphaY * p.alphaY;
  const F cosine2 = max(wo.z * wo.z, F(1e-4f));
  lobe.etaX = F(0.25f) / (ax * cx * cx + ay * cy * cy);
  lobe.etaY = F(0.25f) / ((ax * cy * cy + ay * cx * cx) * cosine2);
  return lobe;
}

// What multiplies D(h) / D(n): at alpha 1 the density of GGX is 1 / pi everywhere.
template <class F, class Table>
LOBELIA_HD V3<F> withoutDensity(LobeTags tags, const LobeParameters<F>& p, V3<F> wo, V3<F> wi,
                                const Table& table) {
  LobeParameters<F> flat = p;
  flat.alphaX = flat.alphaY = F(1.f);
  const Distribution facets = tags.distribution;
  tags.distribution = Distribution::ggx;
  const auto masking = [&](Distribution d, const LobeParameters<F>& q) {
    return smithMasking(d, q.alphaX, q.alphaY, wo) * smithMasking(d, q.alphaX, q.alphaY, wi);
  };
  const V3<F> n{F(0.f), F(0.f), F(1.f)};
  const F factor = F(kSgPi) * microfacetDensity(facets, p.alphaX, p.alphaY, n) *
                   masking(facets, p) / max(masking(Distribution::ggx, flat), F(1e-6f));
  return evaluateLobe(tags, flat, wo, wi, table) * factor;
}

// FilteredDirection::cosine is what the paper has for it; `above` is not read.
template <class F, class Table>
LOBELIA_HD V3<F> evaluateAsPaper(LobeTags tags, const LobeParameters<F>& p, V3<F> wo,
                                 const FilteredDirection<F>& from, const Table& table) {
  V3<F> wi = from.wi;
  const F side = select(wo.z < F(0.f), F(-1.f), F(1.f));
  if (tags.type == LobeType::lambert || tags.type == LobeType::coatedDiffuse ||
      tags.type == LobeType::principledDiffuse) {
    wi.z = side * from.cosine;
    return evaluateLobe(tags, p, wo, wi, table);
  }
  const bool slopes =
      tags.type == LobeType::microfacetReflection &&
      (tags.distribution == Distribution::ggx || tags.distribution == Distribution::beckmann);
  if (!slopes) return evaluateLobe(tags, p, wo, wi, table);
  const V3<F> front{wo.x, wo.y, wo.z * side}, seen{wi.x, wi.y, wi.z * side};
  const MirrorLobe<F> lobe = mirrorLobe(p, front);
  const F nu = F(0.5f) * from.sharpness;
  const F sumX = lobe.etaX + nu, sumY = lobe.etaY + nu;
  const F x = dot(seen, lobe.x), y = dot(seen, lobe.y);
  const F gaussian = max(dot(seen, lobe.z), F(0.f)) *
                     exp(F(0.f) - lobe.etaX * nu / sumX * x * x - lobe.etaY * nu / sumY * y * y);
  const F mean = F(kSgPi) * gaussian / (sqrt(sumX * sumY) * sgIntegral(from.sharpness));
  return withoutDensity(tags, p, wo, wi, table) * mean;
}

LOBELIA_CORE_END

#endif  // per-target include guard
