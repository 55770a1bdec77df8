// One non-delta lobe under light that arrives as a spherical Gaussian, written once for float and
// for SIMD registers as kernels-inl.h is: the mean of evaluateLobe() over a von Mises-Fisher lobe
// of directions around wi.
//
//   FilteredDirection<F> from = filteredDirection(wo, wi, sharpness);
//   V3<F> value = evaluateFiltered(tags, p, wo, from, table);
//
// Cosine lobes: their cosine is integrated over the Gaussian (lobes/kernels-inl.h). Microfacets:
// their slopes' distribution is widened by that of the half vectors, as a matrix: half as wide as
// the light's directions in the plane of incidence, 1 / (2 cos) across it, so that highlights at
// grazing angles keep their shape [Tokuyoshi24, section 4]; the rest is evaluated at one direction,
// times the share of the Gaussian above the horizon. A sharp Gaussian gives
// evaluateLobe(wi).
//
// The matrix is diagonal in a frame turned about the normal, in which the lobe is evaluated; lobes
// that are no microfacets in slopes (phong, gtr1, sphericalGaussian, transmission) are widened by
// one number; sheen is not.
#if defined(LOBELIA_BSDF_FILTERED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_BSDF_FILTERED_INL_H_
#undef LOBELIA_BSDF_FILTERED_INL_H_
#else
#define LOBELIA_BSDF_FILTERED_INL_H_
#endif

#include "lobelia/bsdf/kernels-inl.h"

LOBELIA_CORE_BEGIN

template <class F>
struct FilteredDirection {
  V3<F> wi;     // unit, mean of the Gaussian
  F sharpness;  // > 0
  F cosine;     // mean of the clamped cosine on the side of wo
  F above;      // share of the Gaussian on that side
};

// For a Gaussian that is wide enough to be seen as more than a direction.
template <class F>
LOBELIA_HD FilteredDirection<F> filteredDirection(V3<F> wo, V3<F> wi, F sharpness) {
  const F c = select(wo.z < F(0.f), F(0.f) - wi.z, wi.z);
  return {wi, sharpness, sgCosineMean(c, sharpness), sgShareAbove(c, sharpness)};
}

// The direction at which lobes are evaluated that depend on the half vector: wi, lifted to the mean
// cosine of the part of the Gaussian that is above the horizon of `side` (+1 or -1).
template <class F>
LOBELIA_HD V3<F> liftedDirection(V3<F> wi, F side, F cosine, F above) {
  const F mean = max(cosine, F(1e-4f)) / max(above, F(1e-3f));
  return unitVector(V3<F>{wi.x, wi.y, side * max(wi.z * side, mean)});
}

// Share above the horizon of the product of the light and of a lobe around the mirror direction.
template <class F>
LOBELIA_HD F shareAbove(F sharpness, V3<F> wo, const FilteredDirection<F>& from) {
  const V3<F> mirror{F(0.f) - wo.x, F(0.f) - wo.y, wo.z};
  const V3<F> v = mirror * sharpness + from.wi * from.sharpness;
  const F length = max(sqrt(dot(v, v)), F(1e-6f));
  const F cosine = select(wo.z < F(0.f), F(0.f) - v.z, v.z) / length;
  return sgShareAbove(cosine, length);
}

// Squared roughness as it is added to, and back: of GGX such that it stays below 1 whatever is
// added [Tokuyoshi24, section 4.2], and unchanged from 1 on; of Gaussian slopes as it is.
template <class F>
LOBELIA_HD F addableRoughness(bool bounded, F alpha) {
  const F a2 = alpha * alpha;
  return bounded ? a2 / max(F(1.f) - a2, F(1e-4f)) : a2;
}
template <class F>
LOBELIA_HD F roughnessOfAddable(bool bounded, F squared, F alpha) {
  if (!bounded) return sqrt(squared);
  return select(alpha < F(0.99f), sqrt(squared / (F(1.f) + squared)), alpha);
}

// Widens alphas along the axes in which it is diagonal, and turns both directions to them.
template <class F>
LOBELIA_HD void widenByHalfVectors(bool bounded, F sharpness, LobeParameters<F>* p, V3<F>* wo,
                                   V3<F>* wi) {
  const V3<F> h = unitVector(*wo + *wi);
  const V3<F> t = unitVector(*wi - *wo);
  const F cosine = dot(h, *wi);
  const F across = F(1.f) / max(cosine * cosine, F(1e-4f));
  const F scale = F(0.5f) / sharpness;
  // t tᵀ, and what is left of the plane across h.
  const F xx = t.x * t.x, xy = t.x * t.y, yy = t.y * t.y;
  const F a = scale * (xx + across * max(F(1.f) - h.x * h.x - xx, F(0.f)));
  const F b = scale * (xy + across * (F(0.f) - h.x * h.y - xy));
  const F c = scale * (yy + across * max(F(1.f) - h.y * h.y - yy, F(0.f)));
  const F ax = addableRoughness(bounded, p->alphaX) + a;
  const F ay = addableRoughness(bounded, p->alphaY) + c;
  const F mean = F(0.5f) * (ax + ay), half = F(0.5f) * (ax - ay);
  const F root = sqrt(half * half + b * b);
  const F inverse = F(1.f) / max(root, F(1e-20f));
  // Of the angle to the first axis: cos 2x = half / root.
  const F cos2 = select(root > F(1e-20f), half * inverse, F(1.f));
  const F cx = sqrt(max(F(0.5f) * (F(1.f) + cos2), F(0.f)));
  const F sx = sqrt(max(F(0.5f) * (F(1.f) - cos2), F(0.f))) * select(b < F(0.f), F(-1.f), F(1.f));
  const auto turned = [&](V3<F> v) { return V3<F>{cx * v.x + sx * v.y, cx * v.y - sx * v.x, v.z}; };
  *wo = turned(*wo);
  *wi = turned(*wi);
  const F widest = max(p->alphaX, p->alphaY);
  p->alphaX = roughnessOfAddable(bounded, mean + root, widest);
  p->alphaY = roughnessOfAddable(bounded, max(mean - root, F(1e-10f)), widest);
}

// By one number: the geometric mean of both axes.
template <class F>
LOBELIA_HD void widenEvenly(bool bounded, F added, LobeParameters<F>* p) {
  for (F* alpha : {&p->alphaX, &p->alphaY})
    *alpha = roughnessOfAddable(bounded, addableRoughness(bounded, *alpha) + added, *alpha);
}

// Around the mirror direction, a Gaussian of sharpness n + 1. wi: lifted.
template <class F, class Table>
LOBELIA_HD V3<F> evaluateFilteredPhong(LobeTags tags, LobeParameters<F> p, V3<F> wo, V3<F> wi,
                                       const FilteredDirection<F>& from, const Table& table) {
  const F n = p.alphaX + F(1.f), wide = n * from.sharpness / (n + from.sharpness);
  const V3<F> apart{wi.x + wo.x, wi.y + wo.y, wi.z - wo.z};
  const auto near = wide * dot(apart, apart) < F(40.f);  // else below e^-20 of its peak
  if (!any(near)) return splat(F(0.f));
  p.alphaX = max(wide - F(1.f), F(0.f));
  // With the peak of such a Gaussian; evaluation has (exponent + 2).
  const F scale = shareAbove(n, wo, from) * (n + F(1.f)) * wide / (n * (p.alphaX + F(2.f)));
  return evaluateLobe(tags, p, wo, wi, table) * select(near, scale, F(0.f));
}

template <class F, class Table>
LOBELIA_HD V3<F> evaluateFiltered(LobeTags tags, LobeParameters<F> p, V3<F> wo,
                                  const FilteredDirection<F>& from, const Table& table) {
  const F side = select(wo.z < F(0.f), F(-1.f), F(1.f));
  V3<F> wi = from.wi;
  switch (tags.type) {
    case LobeType::lambert:
    case LobeType::coatedDiffuse:
    case LobeType::principledDiffuse:
      wi.z = side * from.cosine;
      return evaluateLobe(tags, p, wo, wi, table);
    case LobeType::diffuseTransmission:
      // The mean of the cosine without a clamp is what both sides differ by.
      wi.z = wi.z * sgMeanResultant(from.sharpness) - side * from.cosine;
      return evaluateLobe(tags, p, wo, wi, table);
    default:
      break;
  }
  const bool through =
      tags.type == LobeType::microfacetTransmission || tags.type == LobeType::thinTransmission;
  F above = through ? F(1.f) - from.above : from.above;
  wi = through ? liftedDirection(wi, F(0.f) - side,
                                 from.cosine - side * wi.z * sgMeanResultant(from.sharpness), above)
               : liftedDirection(wi, side, from.cosine, above);
  const F spread = F(1.f) / from.sharpness;  // variance of the light's directions along an axis
  const bool slopes =
      tags.type == LobeType::ward ||
      (tags.type == LobeType::microfacetReflection &&
       (tags.distribution == Distribution::ggx || tags.distribution == Distribution::beckmann));
  const bool bounded = tags.type != LobeType::ward && tags.distribution != Distribution::beckmann;
  V3<F> out = wo;
  if (slopes) {
    widenByHalfVectors(bounded, from.sharpness, &p, &out, &wi);
  } else if (tags.type == LobeType::phong) {
    return evaluateFilteredPhong(tags, p, wo, wi, from, table);
  } else if (tags.type == LobeType::microfacetTransmission) {
    const F eta = select(wo.z < F(0.f), F(1.f) / p.eta.x, p.eta.x);
    const V3<F> h = wo + wi * eta;
    widenEvenly(bounded, F(2.f) * eta * eta * spread / max(dot(h, h), F(1e-3f)), &p);
  } else if (tags.type != LobeType::sheen) {
    const V3<F> mirrored{wi.x, wi.y, through ? F(0.f) - wi.z : wi.z};
    const F cosine = sqrt(max(F(0.5f) * (F(1.f) + dot(wo, mirrored)), F(1e-2f)));
    widenEvenly(bounded, F(0.5f) * spread / cosine, &p);
  }
  return evaluateLobe(tags, p, out, wi, table) * above;
}

LOBELIA_CORE_END

#endif  // per-target include guard
