// Light of virtual spherical Gaussian lights at a strip's part of kLanes points [P001 supplement,
// section 4], in place of directions() and addLobes() of shading-inl.h.
//
// Each of a light's parts is seen as one Gaussian of incoming radiance, c G(w; axis, sharpness):
// the product of where the light is (Gaussian of sharpness d² / variance around the direction to
// the mean, equation 6) and of what leaves it (equation 7). Receivers get its fluence c
// A(sharpness) times the mean of their lobes over it (bsdf/filtered-inl.h).
//
// Deviations, with Form::accurate:
//  - the variance is projected of the covariance of the places (section 3.2 there takes the trace,
//    twice what a plane has across the view; GaussianShading::spread);
//  - diffuse light has the cosine of its lobe towards the point, where a Gaussian of sharpness 2 is
//    up to 30 % off and leaks 12 % below the horizon: the mean over normals and places of the
//    cluster. Around that direction it varies as the Gaussian does, which counts where places are
//    seen over a wide angle;
//  - fluence is c A(sharpness), without the approximation A = 2 pi / sharpness.
// The paper's forms are gaussian_paper-inl.h.
#if defined(LOBELIA_GATHER_GAUSSIAN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_GAUSSIAN_INL_H_
#undef LOBELIA_GATHER_GAUSSIAN_INL_H_
#else
#define LOBELIA_GATHER_GAUSSIAN_INL_H_
#endif

#include "lobelia/bsdf/filtered-inl.h"
#include "lobelia/gather/gaussian_paper-inl.h"
#include "lobelia/gather/shading-inl.h"

LOBELIA_CORE_BEGIN

// Directions are as sharp as this at most: for the arithmetic alone.
inline constexpr float kSharpestPlace = 1e5f;

// The light's places as a point sees them.
struct SeenPlaces {
  V3<Vf> w;      // unit, to the mean
  Vf distance2;  // to the mean, squared
  Vf variance;   // across the view; > 0
  Vf sharpness;  // distance2 / variance
  Vf turn;       // variance of the cosine between w and `normal`
};

HWY_INLINE Vf quadraticForm(const float* q, V3<Vf> v) {
  return v.x * (Vf(q[0]) * v.x + Vf(2 * q[3]) * v.y + Vf(2 * q[4]) * v.z) +
         v.y * (Vf(q[1]) * v.y + Vf(2 * q[5]) * v.z) + Vf(q[2]) * v.z * v.z;
}

HWY_INLINE SeenPlaces seenPlaces(const g::PreparedGaussian& light, V3<Vf> p, Vf* cosine) {
  SeenPlaces seen;
  const V3<Vf> d = broadcast(light.mean) - p;
  seen.distance2 = max(dot(d, d), Vf(1e-20f));
  const Vf inverse = Vf(1.f) / sqrt(seen.distance2);
  seen.w = d * inverse;
  const Vf least = seen.distance2 * Vf(1 / kSharpestPlace);
  seen.variance = max(Vf(light.halfTrace) - quadraticForm(light.q, seen.w), least);
  seen.sharpness = seen.distance2 / seen.variance;
  const V3<Vf> n = broadcast(light.diffuse.axis);
  *cosine = Vf(0.f) - dot(n, seen.w);
  // By the cosine's gradient over the place.
  const V3<Vf> slope = n + seen.w * *cosine;
  seen.turn = quadraticForm(light.q, slope) * (inverse * inverse);
  return seen;
}

// Incoming light of one part, by light and lane.
struct IncomingLobes {
  PairScratch::Lanes sharpness[g::kBlockLights], cosine[g::kBlockLights], above[g::kBlockLights];
  PairScratch::Lanes fluence[g::kBlockLights];
  PairScratch::Lanes r[g::kBlockLights], g[g::kBlockLights], b[g::kBlockLights];  // sums
};

// FilteredDirection as a form has it; fluence may change.
HWY_INLINE FilteredDirection<Vf> directionFor(GaussianShading::Form form, V3<Vf> wo, V3<Vf> wi,
                                              Vf sharpness, Vf* fluence) {
  if (form == GaussianShading::Form::accurate) return filteredDirection(wo, wi, sharpness);
  const Vf c = select(wo.z < Vf(0.f), Vf(0.f) - wi.z, wi.z);
  if (form == GaussianShading::Form::product)
    return {wi, sharpness, productCosine(c, sharpness), Vf(1.f)};
  // A = 2 pi / sharpness.
  *fluence = *fluence / expRatio(sharpness + sharpness) * (Vf(0.5f) / sharpness);
  return {wi, sharpness, max(c, Vf(0.f)), Vf(1.f)};
}

HWY_INLINE void storeIncoming(GaussianShading::Form form, const g::PointStrip& strip, size_t lane,
                              V3<Vf> wi, Vf sharpness, Vf fluence, size_t i, PairScratch* pairs,
                              IncomingLobes* lobes) {
  const V3<Vf> local{dot(wi, load(strip.s, lane)), dot(wi, load(strip.t, lane)),
                     dot(wi, load(strip.n, lane))};
  const auto from = directionFor(form, load(strip.wo, lane), local, sharpness, &fluence);
  local.x.store(pairs->wiX[i].v);
  local.y.store(pairs->wiY[i].v);
  local.z.store(pairs->wiZ[i].v);
  sharpness.store(lobes->sharpness[i].v);
  from.cosine.store(lobes->cosine[i].v);
  from.above.store(lobes->above[i].v);
  (fluence * bumpShadow(strip, lane, wi)).store(lobes->fluence[i].v);
}

// The product of the places' Gaussian and of one that leaves, whose value towards the mean is
// `peak` times exp(-sharpness |w + axis|^2 / 2), but for `known` of that exponent.
HWY_INLINE void incomingProduct(GaussianShading::Form form, const g::PointStrip& strip, size_t lane,
                                const SeenPlaces& seen, V3<Vf> axis, Vf leaving, Vf peak, Vf known,
                                size_t i, PairScratch* pairs, IncomingLobes* lobes) {
  const V3<Vf> v = seen.w * seen.sharpness - axis * leaving;
  const Vf length = max(sqrt(dot(v, v)), Vf(1e-6f));
  const V3<Vf> apart = seen.w + axis;
  const Vf square = leaving * dot(apart, apart);
  const Vf exponent = square * (known - seen.sharpness / (length + leaving + seen.sharpness));
  const Vf fluence = peak * exp(exponent) * (Vf(2.f) / seen.variance) * expRatio(length + length);
  storeIncoming(form, strip, lane, v * (Vf(1.f) / length), length, fluence, i, pairs, lobes);
}

// Part that leaves by cosine lobes.
HWY_INLINE void incomingDiffuse(const g::PointStrip& strip, size_t lane,
                                const g::PreparedGaussian& light, size_t i, PairScratch* pairs,
                                IncomingLobes* lobes) {
  Vf cosine(0.f);
  const SeenPlaces seen = seenPlaces(light, load(strip.p, lane), &cosine);
  // Spreads add up as squares of angles do; the one of means, k / (k + 1).
  const Vf normals(light.diffuse.sharpness), turns = Vf(1.f) / max(seen.turn, Vf(1e-7f));
  const Vf together = normals * turns / (normals + turns + Vf(1.f));
  const Vf leaving = sgCosineIntegral(cosine, together) / sgIntegral(together);
  incomingProduct(GaussianShading::Form::accurate, strip, lane, seen, broadcast(light.diffuse.axis),
                  Vf(kPaperDiffuseSharpness), leaving, Vf(0.5f), i, pairs, lobes);
}

// Part that leaves by a Gaussian (equation 7).
HWY_INLINE void incomingGaussian(GaussianShading::Form form, const g::PointStrip& strip,
                                 size_t lane, const g::PreparedGaussian& light,
                                 const g::PreparedGaussian::Part& part, size_t i,
                                 PairScratch* pairs, IncomingLobes* lobes) {
  Vf cosine(0.f);
  const SeenPlaces seen = seenPlaces(light, load(strip.p, lane), &cosine);
  incomingProduct(form, strip, lane, seen, broadcast(part.axis), Vf(part.sharpness), Vf(1.f),
                  Vf(0.f), i, pairs, lobes);
}

template <bool kPaper>
struct IncomingEvaluation {
  const IncomingLobes& incoming;
  template <class Table>
  HWY_INLINE V3<Vf> operator()(LobeTags tags, const LobeParameters<Vf>& p, V3<Vf> wo, V3<Vf> wi,
                               size_t i, const Table& table) const {
    const FilteredDirection<Vf> from{wi, Vf::load(incoming.sharpness[i].v),
                                     Vf::load(incoming.cosine[i].v), Vf::load(incoming.above[i].v)};
    if constexpr (kPaper) return evaluateAsPaper(tags, p, wo, from, table);
    return evaluateFiltered(tags, p, wo, from, table);
  }
};

HWY_INLINE void addTo(PairScratch::Lanes* sum, const PairScratch::Lanes& lobe, Vf factor) {
  (Vf::load(sum->v) + Vf::load(lobe.v) * factor).store(sum->v);
}

// For one part of all lights of the block: `incoming` fills IncomingLobes of a light that has it.
template <class Part, class Incoming, class Lobes>
void addPart(const g::Tile& tile, const g::PointStrip& strip, size_t lane,
             const g::LightBlock& block, const Part& part, const Incoming& incoming,
             const Lobes& evaluate, PairScratch* pairs, IncomingLobes* lobes) {
  const auto lightOf = [&](size_t i) -> auto& { return block.gaussians[pairs->light[i]]; };
  bool any = false;
  for (size_t i = 0; i < pairs->count; ++i) any = any || part(lightOf(i)).any;
  if (!any) return;
  for (size_t i = 0; i < pairs->count; ++i) incoming(lightOf(i), i);
  addLobes(tile, strip, lane, pairs, evaluate);
  for (size_t i = 0; i < pairs->count; ++i) {
    const Rgb peak = part(lightOf(i)).peak;
    const Vf fluence = Vf::load(lobes->fluence[i].v);
    addTo(&lobes->r[i], pairs->r[i], fluence * Vf(peak.x));
    addTo(&lobes->g[i], pairs->g[i], fluence * Vf(peak.y));
    addTo(&lobes->b[i], pairs->b[i], fluence * Vf(peak.z));
  }
}

template <bool kPaper>
void gaussianPairsOf(const g::Tile& tile, const g::PointStrip& strip, size_t lane,
                     const g::LightBlock& block, PairScratch* pairs) {
  IncomingLobes lobes;
  for (size_t i = 0; i < pairs->count; ++i)
    for (auto* sum : {&lobes.r[i], &lobes.g[i], &lobes.b[i]}) Vf(0.f).store(sum->v);
  const auto diffuse = [](const auto& light) -> auto& { return light.diffuse; };
  const auto glossy = [](const auto& light) -> auto& { return light.glossy; };
  const auto product = [&](const auto& part) {
    return [&, part](const g::PreparedGaussian& light, size_t i) {
      incomingGaussian(block.gaussianShading.form, strip, lane, light, part(light), i, pairs,
                       &lobes);
    };
  };
  const auto cosine = [&](const g::PreparedGaussian& light, size_t i) {
    incomingDiffuse(strip, lane, light, i, pairs, &lobes);
  };
  const IncomingEvaluation<kPaper> evaluate{lobes};
  if constexpr (kPaper) {
    addPart(tile, strip, lane, block, diffuse, product(diffuse), evaluate, pairs, &lobes);
  } else {
    addPart(tile, strip, lane, block, diffuse, cosine, evaluate, pairs, &lobes);
  }
  addPart(tile, strip, lane, block, glossy, product(glossy), evaluate, pairs, &lobes);
  for (size_t i = 0; i < pairs->count; ++i) {
    pairs->r[i] = lobes.r[i], pairs->g[i] = lobes.g[i], pairs->b[i] = lobes.b[i];
    Vf(1.f).store(pairs->factor[i].v);
  }
}

// Fills what sumUp() reads: the receivers' lobes times the light, and factors of 1.
void gaussianPairs(const g::Tile& tile, const g::PointStrip& strip, size_t lane,
                   const g::LightBlock& block, PairScratch* pairs) {
  if (block.gaussianShading.form == GaussianShading::Form::accurate) {
    gaussianPairsOf<false>(tile, strip, lane, block, pairs);
  } else {
    gaussianPairsOf<true>(tile, strip, lane, block, pairs);
  }
}

LOBELIA_CORE_END

#endif  // per-target include guard
