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

// A Gaussian that is weaker than this by its exponent sends nothing.
inline constexpr float kFaintExponent = -20;

// The light's places as points see them.
struct SeenPlaces {
  V3<Vf> w;      // unit, to the mean
  Vf variance;   // across the view; > 0
  Vf sharpness;  // squared distance over variance
  Vf cosine;     // of the light's normal to the point
  Vf turn;       // variance of that over the places
};

HWY_INLINE Vf quadraticForm(const float* q, V3<Vf> v) {
  return v.x * (Vf(q[0]) * v.x + Vf(2 * q[3]) * v.y + Vf(2 * q[4]) * v.z) +
         v.y * (Vf(q[1]) * v.y + Vf(2 * q[5]) * v.z) + Vf(q[2]) * v.z * v.z;
}

HWY_INLINE SeenPlaces seenPlaces(const g::PreparedGaussian& light, V3<Vf> p) {
  SeenPlaces seen;
  const V3<Vf> d = broadcast(light.mean) - p;
  const Vf distance2 = max(dot(d, d), Vf(1e-20f));
  const Vf inverse = Vf(1.f) / sqrt(distance2);
  seen.w = d * inverse;
  const Vf least = distance2 * Vf(1 / kSharpestPlace);
  seen.variance = max(Vf(light.halfTrace) - quadraticForm(light.q, seen.w), least);
  seen.sharpness = distance2 / seen.variance;
  const V3<Vf> n = broadcast(light.diffuse.axis);
  seen.cosine = Vf(0.f) - dot(n, seen.w);
  // By the cosine's gradient over the place.
  const V3<Vf> slope = n + seen.w * seen.cosine;
  seen.turn = quadraticForm(light.covariance, slope) * (inverse * inverse);
  return seen;
}

// For both parts of all lights.
struct PlacesScratch {
  PairScratch::Lanes v[7][g::kBlockLights];
  HWY_INLINE void store(const SeenPlaces& seen, size_t i) {
    const Vf values[] = {seen.w.x,       seen.w.y,    seen.w.z, seen.variance,
                         seen.sharpness, seen.cosine, seen.turn};
    for (size_t k = 0; k < 7; ++k) values[k].store(v[k][i].v);
  }
  HWY_INLINE SeenPlaces load(size_t i) const {
    const auto at = [&](size_t k) { return Vf::load(v[k][i].v); };
    return {{at(0), at(1), at(2)}, at(3), at(4), at(5), at(6)};
  }
};

// Incoming light of one part, of the lights that have any, [slot][lane].
struct IncomingLobes {
  size_t count = 0;
  size_t pair[g::kBlockLights];  // of slots, in PairScratch
  PairScratch::Lanes sharpness[g::kBlockLights], cosine[g::kBlockLights], above[g::kBlockLights];
  PairScratch::Lanes fluence[g::kBlockLights];
};

// FilteredDirection as a form has it; fluence may change.
HWY_INLINE FilteredDirection<Vf> directionFor(GaussianShading::Form form, V3<Vf> wo, V3<Vf> wi,
                                              Vf sharpness, Vf* fluence) {
  if (form == GaussianShading::Form::accurate) return filteredDirection(wo, wi, sharpness);
  const Vf c = select(wo.z < Vf(0.f), Vf(0.f) - wi.z, wi.z);
  if (form == GaussianShading::Form::product)
    return {wi, sharpness, productCosine(c, sharpness), Vf(1.f)};
  // A = 2 pi / sharpness, where it is not small [P001 supplement, section 4.2].
  const Vf approximate = *fluence / expRatio(sharpness + sharpness) * (Vf(0.5f) / sharpness);
  *fluence = select(sharpness < Vf(3.f), *fluence, approximate);
  return {wi, sharpness, max(c, Vf(0.f)), Vf(1.f)};
}

HWY_INLINE void addIncoming(GaussianShading::Form form, const g::PointStrip& strip, size_t lane,
                            V3<Vf> wi, Vf sharpness, Vf fluence, size_t i, PairScratch* pairs,
                            IncomingLobes* lobes) {
  const V3<Vf> local{dot(wi, load(strip.s, lane)), dot(wi, load(strip.t, lane)),
                     dot(wi, load(strip.n, lane))};
  const auto from = directionFor(form, load(strip.wo, lane), local, sharpness, &fluence);
  const size_t slot = lobes->count++;
  lobes->pair[slot] = i;
  local.x.store(pairs->wiX[slot].v);
  local.y.store(pairs->wiY[slot].v);
  local.z.store(pairs->wiZ[slot].v);
  sharpness.store(lobes->sharpness[slot].v);
  from.cosine.store(lobes->cosine[slot].v);
  from.above.store(lobes->above[slot].v);
  (fluence * bumpShadow(strip, lane, wi)).store(lobes->fluence[slot].v);
}

// The product of the places' Gaussian and of one that leaves, whose value towards the mean is
// `peak` times exp(-sharpness |w + axis|^2 / 2), but for `known` of that exponent. Left out where
// it is faint at all points.
HWY_INLINE void addProduct(GaussianShading::Form form, const g::PointStrip& strip, size_t lane,
                           const SeenPlaces& seen, V3<Vf> axis, Vf leaving, Vf peak, Vf known,
                           size_t i, PairScratch* pairs, IncomingLobes* lobes) {
  const V3<Vf> v = seen.w * seen.sharpness - axis * leaving;
  const Vf length = max(sqrt(dot(v, v)), Vf(1e-6f));
  const V3<Vf> apart = seen.w + axis;
  const Vf square = leaving * dot(apart, apart);
  const Vf exponent = square * (known - seen.sharpness / (length + leaving + seen.sharpness));
  const Mf seenAtAll = (exponent > Vf(kFaintExponent)) & (peak > Vf(0.f));
  if (!any(seenAtAll)) return;
  const Vf fluence = peak * exp(exponent) * (Vf(2.f) / seen.variance) * expRatio(length + length);
  addIncoming(form, strip, lane, v * (Vf(1.f) / length), length,
              select(seenAtAll, fluence, Vf(0.f)), i, pairs, lobes);
}

// Sharpness of the normals' directions as a point sees them: spreads add up as squares of angles
// do; the one of means, k / (k + 1).
HWY_INLINE Vf spreadOfNormals(float sharpness, Vf turn) {
  const Vf normals(sharpness), turns = Vf(1.f) / max(turn, Vf(1e-7f));
  return normals * turns / (normals + turns + Vf(1.f));
}

// Part that leaves by cosine lobes.
HWY_INLINE void addDiffuse(const g::PointStrip& strip, size_t lane, const SeenPlaces& seen,
                           const g::PreparedGaussian::Part& part, size_t i, PairScratch* pairs,
                           IncomingLobes* lobes) {
  const Vf together = spreadOfNormals(part.sharpness, seen.turn);
  addProduct(GaussianShading::Form::accurate, strip, lane, seen, broadcast(part.axis),
             Vf(kPaperDiffuseSharpness), sgCosineMean(seen.cosine, together), Vf(0.5f), i, pairs,
             lobes);
}

// Part that leaves by a Gaussian (equation 7).
HWY_INLINE void addGaussian(GaussianShading::Form form, const g::PointStrip& strip, size_t lane,
                            const SeenPlaces& seen, const g::PreparedGaussian::Part& part,
                            float normals, size_t i, PairScratch* pairs, IncomingLobes* lobes) {
  // Nothing leaves below the surfaces, whose normals spread.
  const Vf above = form == GaussianShading::Form::accurate
                       ? sgShareAbove(seen.cosine, spreadOfNormals(normals, seen.turn))
                       : Vf(1.f);
  addProduct(form, strip, lane, seen, broadcast(part.axis), Vf(part.sharpness), above, Vf(0.f), i,
             pairs, lobes);
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

// What lights send, by pair and lane.
struct PairLight {
  PairScratch::Lanes r[g::kBlockLights], g[g::kBlockLights], b[g::kBlockLights];
  HWY_INLINE static void add(PairScratch::Lanes* sum, const PairScratch::Lanes& lobe, Vf factor) {
    (Vf::load(sum->v) + Vf::load(lobe.v) * factor).store(sum->v);
  }
};

// For one part of all lights of the block: `incoming` adds to IncomingLobes what a light has.
template <class Part, class Incoming, class Lobes>
void addPart(const g::Tile& tile, const g::PointStrip& strip, size_t lane,
             const g::LightBlock& block, const Part& part, const Incoming& incoming,
             const Lobes& evaluate, PairScratch* pairs, IncomingLobes* lobes, PairLight* light) {
  const auto partOf = [&](size_t i) -> const g::PreparedGaussian::Part& {
    return part(block.gaussians[pairs->light[i]]);
  };
  const size_t count = pairs->count;
  lobes->count = 0;
  for (size_t i = 0; i < count; ++i)
    if (partOf(i).any) incoming(partOf(i), i);
  if (lobes->count == 0) return;
  pairs->count = lobes->count;
  addLobes(tile, strip, lane, pairs, evaluate);
  pairs->count = count;
  for (size_t slot = 0; slot < lobes->count; ++slot) {
    const size_t i = lobes->pair[slot];
    const Rgb peak = partOf(i).peak;
    const Vf fluence = Vf::load(lobes->fluence[slot].v);
    PairLight::add(&light->r[i], pairs->r[slot], fluence * Vf(peak.x));
    PairLight::add(&light->g[i], pairs->g[slot], fluence * Vf(peak.y));
    PairLight::add(&light->b[i], pairs->b[slot], fluence * Vf(peak.z));
  }
}

template <bool kPaper>
void gaussianPairsOf(const g::Tile& tile, const g::PointStrip& strip, size_t lane,
                     const g::LightBlock& block, PairScratch* pairs) {
  PairLight light;
  PlacesScratch places;
  for (size_t i = 0; i < pairs->count; ++i) {
    for (auto* sum : {&light.r[i], &light.g[i], &light.b[i]}) Vf(0.f).store(sum->v);
    places.store(seenPlaces(block.gaussians[pairs->light[i]], load(strip.p, lane)), i);
  }
  IncomingLobes lobes;
  const IncomingEvaluation<kPaper> evaluate{lobes};
  const auto diffuse = [](const auto& gaussian) -> auto& { return gaussian.diffuse; };
  const auto glossy = [](const auto& gaussian) -> auto& { return gaussian.glossy; };
  const auto byCosine = [&](const g::PreparedGaussian::Part& part, size_t i) {
    addDiffuse(strip, lane, places.load(i), part, i, pairs, &lobes);
  };
  const auto byGaussian = [&](const g::PreparedGaussian::Part& part, size_t i) {
    addGaussian(block.gaussianShading.form, strip, lane, places.load(i), part,
                block.gaussians[pairs->light[i]].normalSharpness, i, pairs, &lobes);
  };
  if constexpr (kPaper) {
    addPart(tile, strip, lane, block, diffuse, byGaussian, evaluate, pairs, &lobes, &light);
  } else {
    addPart(tile, strip, lane, block, diffuse, byCosine, evaluate, pairs, &lobes, &light);
  }
  addPart(tile, strip, lane, block, glossy, byGaussian, evaluate, pairs, &lobes, &light);
  for (size_t i = 0; i < pairs->count; ++i) {
    pairs->r[i] = light.r[i], pairs->g[i] = light.g[i], pairs->b[i] = light.b[i];
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
