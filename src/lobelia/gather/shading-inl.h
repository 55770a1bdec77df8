// Light of visible pairs at a strip of 16 receiver points, in three steps over the block's lights:
// directions and light factors; the lobes, one after the other with their kinds as compile-time
// constants where that pays; sums, or the values of pairs one by one. Lanes that are not visible
// are computed and dropped: points stay in their registers, nothing is gathered.
#if defined(LOBELIA_GATHER_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_SHADING_INL_H_
#undef LOBELIA_GATHER_SHADING_INL_H_
#else
#define LOBELIA_GATHER_SHADING_INL_H_
#endif

#include "lobelia/bsdf/kernels-inl.h"
#include "lobelia/gather/facing-inl.h"
#include "lobelia/gather/kernels.h"

LOBELIA_CORE_BEGIN

// What a strip's part of kLanes points and the block's lights (those with a visible lane) have in
// common. Arrays [light][lane].
struct PairScratch {
  struct alignas(64) Lanes {
    float v[kLanes];
  };
  size_t count = 0;
  uint32_t light[g::kBlockLights];  // index into the block
  uint32_t mask[g::kBlockLights];
  Lanes wiX[g::kBlockLights], wiY[g::kBlockLights], wiZ[g::kBlockLights];  // local frame
  Lanes factor[g::kBlockLights];  // geometry x lobe of the light, without its intensity
  Lanes r[g::kBlockLights], g[g::kBlockLights], b[g::kBlockLights];  // lobes of the receiver
};

// Lobe of the light towards the point over the squared distance; wi is the unit direction to it.
template <g::LightClass kClass>
HWY_INLINE Vf lightFactor(const g::PreparedLight& light, V3<Vf> wi, Vf inverseDistance) {
  if constexpr (kClass == g::LightClass::directional) return Vf(1.f);
  const Vf geometry = inverseDistance * inverseDistance;
  if constexpr (kClass == g::LightClass::diffuse) {
    return geometry * max(Vf(0.f) - dot(broadcast(light.n), wi), Vf(0.f));
  }
  if constexpr (kClass == g::LightClass::glossy) {
    // |axis - w|^2 / 2 = 1 - axis.w, without its cancellation; w = -wi.
    const V3<Vf> difference = broadcast(light.axis) + wi;
    return geometry * exp(dot(difference, difference) * Vf(-0.5f * light.sharpness));
  }
  return geometry;
}

HWY_INLINE Vf bumpShadow(const g::PointStrip& strip, size_t lane, V3<Vf> wi) {
  if (!strip.perturbed) return Vf(1.f);
  return bumpShadowing(dot(load(strip.base, lane), wi), Vf::load(strip.bumpAlpha2 + lane));
}

// rich_shading-inl.h
HWY_INLINE Vf richFactor(const g::RichRadiance& rich, uint32_t index, Vf inverseDistance);
void applyRich(const g::PointStrip& strip, size_t lane, const g::LightBlock& block, float clamp,
               PairScratch* pairs);

template <g::LightClass kClass>
void directions(const g::PointStrip& strip, size_t lane, const g::LightBlock& block,
                PairScratch* pairs) {
  const V3<Vf> p = load(strip.p, lane);
  const V3<Vf> s = load(strip.s, lane), t = load(strip.t, lane), n = load(strip.n, lane);
  for (size_t i = 0; i < pairs->count; ++i) {
    const g::PreparedLight& light = block.lights[pairs->light[i]];
    V3<Vf> wi = toLight<kClass>(light, p);
    Vf inverseDistance(1.f);
    if constexpr (kClass != g::LightClass::directional) {
      inverseDistance = Vf(1.f) / sqrt(dot(wi, wi));
      wi = wi * inverseDistance;
    }
    Vf factor = kClass == g::LightClass::diffuse && block.rich != nullptr
                    ? richFactor(*block.rich, block.index[pairs->light[i]], inverseDistance)
                    : lightFactor<kClass>(light, wi, inverseDistance);
    if (g::hasShares(kClass) && strip.near)
      factor = factor * gatheredShare(strip, lane, Vf(1.f) / inverseDistance);
    (factor * bumpShadow(strip, lane, wi)).store(pairs->factor[i].v);
    dot(wi, s).store(pairs->wiX[i].v);
    dot(wi, t).store(pairs->wiY[i].v);
    dot(wi, n).store(pairs->wiZ[i].v);
  }
}

// Transmittance of a coat, linear between tabulated cosines.
struct CoatTable {
  const float* tables;
  Vf offset;
  HWY_INLINE Vf operator()(Vf cosine) const {
    const Vf x = cosine * Vf(static_cast<float>(kTransmittanceSize - 1));
    const Vf i = min(floor(x), Vf(static_cast<float>(kTransmittanceSize - 2)));
    const Vf a = lobelia::HWY_NAMESPACE::gather(tables, offset + i);
    const Vf b = lobelia::HWY_NAMESPACE::gather(tables, offset + i + Vf(1.f));
    return a + (b - a) * (x - i);
  }
};

// A lobe for light from one direction.
struct PlainLobes {
  template <class Table>
  HWY_INLINE V3<Vf> operator()(LobeTags tags, const LobeParameters<Vf>& p, V3<Vf> wo, V3<Vf> wi,
                               size_t, const Table& table) const {
    return evaluateLobe(tags, p, wo, wi, table);
  }
};

// Adds one lobe of every pair. `tags` is a LobeTags or a constant that converts to one; evaluate:
// PlainLobes or what is in its place, asked for pair by pair.
template <class Tags, class Evaluate>
void addLobe(Tags tags, const g::LobeStrip& lobe, const float* tables, size_t lane, V3<Vf> wo,
             const Evaluate& evaluate, PairScratch* pairs) {
  LobeParameters<Vf> p;
  p.alphaX = Vf::load(lobe.alphaX + lane);
  p.alphaY = Vf::load(lobe.alphaY + lane);
  p.weight = load(lobe.weight, lane);
  p.eta = load(lobe.eta, lane);
  p.k = load(lobe.k, lane);
  p.parameters = load(lobe.parameters, lane);
  p.tint = load(lobe.tint, lane);
  p.sides = Vf::load(lobe.sides + lane);
  const CoatTable table{tables, Vf::load(lobe.tableOffset + lane)};
  for (size_t i = 0; i < pairs->count; ++i) {
    const V3<Vf> wi{Vf::load(pairs->wiX[i].v), Vf::load(pairs->wiY[i].v),
                    Vf::load(pairs->wiZ[i].v)};
    const V3<Vf> f = evaluate(LobeTags(tags), p, wo, wi, i, table);
    (Vf::load(pairs->r[i].v) + f.x).store(pairs->r[i].v);
    (Vf::load(pairs->g[i].v) + f.y).store(pairs->g[i].v);
    (Vf::load(pairs->b[i].v) + f.z).store(pairs->b[i].v);
  }
}

template <LobeType kType, Distribution kDistribution = Distribution::ggx,
          Fresnel kFresnel = Fresnel::one>
struct ConstantTags {
  HWY_INLINE operator LobeTags() const { return {kType, kDistribution, kFresnel, 0}; }
  static bool equal(const g::LobeStrip& lobe) {
    return lobe.type == kType && lobe.distribution == kDistribution && lobe.fresnel == kFresnel &&
           lobe.variant == 0;
  }
};

// The frequent kinds get code of their own, in which the compiler moves what depends on the points
// alone (masking of wo, 1/alpha) out of the loop over lights.
template <class... Constants, class Evaluate>
void addLobeOfKind(const g::LobeStrip& lobe, const float* tables, size_t lane, V3<Vf> wo,
                   const Evaluate& evaluate, PairScratch* pairs) {
  const auto tryOne = [&]<class C>(C constant) {
    if (!C::equal(lobe)) return false;
    addLobe(constant, lobe, tables, lane, wo, evaluate, pairs);
    return true;
  };
  if ((tryOne(Constants()) || ...)) return;
  addLobe(LobeTags{lobe.type, lobe.distribution, lobe.fresnel, lobe.variant}, lobe, tables, lane,
          wo, evaluate, pairs);
}

template <class Evaluate = PlainLobes>
void addLobes(const g::Tile& tile, const g::PointStrip& strip, size_t lane, PairScratch* pairs,
              const Evaluate& evaluate = {}) {
  using enum LobeType;
  const V3<Vf> wo = load(strip.wo, lane);
  for (size_t i = 0; i < pairs->count; ++i) {
    Vf(0.f).store(pairs->r[i].v);
    Vf(0.f).store(pairs->g[i].v);
    Vf(0.f).store(pairs->b[i].v);
  }
  for (size_t l = 0; l < strip.lobeCount; ++l) {
    addLobeOfKind<ConstantTags<lambert>,  //
                  ConstantTags<microfacetReflection, Distribution::ggx, Fresnel::conductor>,
                  ConstantTags<microfacetReflection, Distribution::ggx, Fresnel::dielectric>,
                  ConstantTags<microfacetReflection, Distribution::beckmann, Fresnel::conductor>,
                  ConstantTags<microfacetReflection, Distribution::beckmann, Fresnel::dielectric>,
                  ConstantTags<phong>>(tile.lobes[strip.firstLobe + l], tile.tables.data(), lane,
                                       wo, evaluate, pairs);
  }
}

// Multiplies by the directional pattern of a spot, projector or goniometric emitter: a few lights,
// done point by point.
inline void applyPattern(const g::PointStrip& strip, size_t lane, const g::PreparedLight& light,
                         const EmissionPattern& pattern, size_t i, PairScratch* pairs) {
  for (size_t k = 0; k < kLanes; ++k) {
    const Vec3f p = strip.p.get(static_cast<int>(lane + k));
    const Rgb value = pattern.at(pattern.toLocal(p - light.p));
    pairs->r[i].v[k] *= value.x;
    pairs->g[i].v[k] *= value.y;
    pairs->b[i].v[k] *= value.z;
  }
}

// The factor of pair i, where lobes and it are above the clamp.
HWY_INLINE Vf clamped(const PairScratch& pairs, size_t i, Vf factor, float clamp) {
  const Vf r = Vf::load(pairs.r[i].v), gg = Vf::load(pairs.g[i].v), b = Vf::load(pairs.b[i].v);
  const Vf largest = factor * max(r, max(gg, b));
  return select(largest > Vf(clamp), factor * (Vf(clamp) / largest), factor);
}

// Where values of pairs go: into sums over the lights...
struct LaneSums {
  g::TileSums* sums;
  V3<Vf> sum{Vf(0.f), Vf(0.f), Vf(0.f)};
  uint32_t nonfiniteLanes = 0;
  HWY_INLINE void add(size_t, V3<Vf> value) {
    sum.x += value.x;
    sum.y += value.y;
    sum.z += value.z;
  }
  void markNonfinite(uint32_t lanes) { nonfiniteLanes |= lanes; }
  void finish(size_t s, size_t lane) const {
    alignas(64) float x[kLanes], y[kLanes], z[kLanes];
    sum.x.store(x);
    sum.y.store(y);
    sum.z.store(z);
    g::TileSums::Strip& strip = sums->strips[s];
    strip.nonfinite |= nonfiniteLanes << lane;
    for (size_t k = 0; k < kLanes; ++k) {
      strip.x[lane + k] += static_cast<double>(x[k]);
      strip.y[lane + k] += static_cast<double>(y[k]);
      strip.z[lane + k] += static_cast<double>(z[k]);
    }
  }
};

// ...or each to its place. `at`: of light 0 and the first of the lanes.
struct LaneValues {
  g::PairValues* values;
  size_t at, stride;
  HWY_INLINE void add(size_t light, V3<Vf> value) {
    const size_t i = at + light * stride;
    value.x.store(&values->x[i]);
    value.y.store(&values->y[i]);
    value.z.store(&values->z[i]);
  }
  void markNonfinite(uint32_t) {}
  void finish(size_t, size_t) const {}
};

// ...or its luminance.
struct LaneLuminances {
  static constexpr float kRed = luminance(Rgb(1, 0, 0)), kGreen = luminance(Rgb(0, 1, 0)),
                         kBlue = luminance(Rgb(0, 0, 1));
  float* values;
  size_t at, stride;
  HWY_INLINE void add(size_t light, V3<Vf> value) {
    (value.x * Vf(kRed) + value.y * Vf(kGreen) + value.z * Vf(kBlue))
        .store(values + at + light * stride);
  }
  void markNonfinite(uint32_t) {}
  void finish(size_t, size_t) const {}
};

// Out counts pairs and non-finite ones; what they are worth goes to the sink.
template <g::LightClass kClass, class Sink, class Out>
void sumUp(const g::PointStrip& strip, size_t lane, const g::LightBlock& block, float clamp,
           PairScratch* pairs, Sink* sink, Out* out) {
  constexpr bool kClamped =
      kClass != g::LightClass::directional && kClass != g::LightClass::gaussian;
  for (size_t i = 0; i < pairs->count; ++i) {
    const g::PreparedLight& light = block.lights[pairs->light[i]];
    Vf factor = Vf::load(pairs->factor[i].v);
    if (kClamped && clamp > 0) factor = clamped(*pairs, i, factor, clamp);
    if (kClass == g::LightClass::omni && light.pattern != g::PreparedLight::kNoPattern) {
      applyPattern(strip, lane, light, block.patterns[light.pattern], i, pairs);
    }
    const V3<Vf> value{Vf::load(pairs->r[i].v) * factor * Vf(light.intensity.x),
                       Vf::load(pairs->g[i].v) * factor * Vf(light.intensity.y),
                       Vf::load(pairs->b[i].v) * factor * Vf(light.intensity.z)};
    const Vf total = value.x + value.y + value.z;
    const Mf visible = maskFromBits(pairs->mask[i]);
    const Mf good = visible & (total - total == Vf(0.f));
    sink->add(pairs->light[i], {select(good, value.x, Vf(0.f)), select(good, value.y, Vf(0.f)),
                                select(good, value.z, Vf(0.f))});
    const size_t visibleCount = hn::CountTrue(Df(), visible.m);
    out->pairs += visibleCount;
    const size_t goodCount = hn::CountTrue(Df(), good.m);
    if (goodCount == visibleCount) continue;
    out->nonfinite += visibleCount - goodCount;
    sink->markNonfinite(pairs->mask[i] & ~maskBits(good));
  }
}

// gaussian-inl.h
void gaussianPairs(const g::Tile& tile, const g::PointStrip& strip, size_t lane,
                   const g::LightBlock& block, PairScratch* pairs);
// spherical-inl.h
void sphericalPairs(const g::Tile& tile, size_t stripIndex, size_t lane, const g::LightBlock& block,
                    PairScratch* pairs);

inline LaneSums sinkFor(g::TileSums* sums, size_t, size_t, const g::PairMasks&) { return {sums}; }
inline LaneValues sinkFor(g::PairValues* values, size_t s, size_t lane, const g::PairMasks& masks) {
  return {values, s * g::kStrip + lane, masks.strips * g::kStrip};
}
inline LaneLuminances sinkFor(g::PairLuminances* luminances, size_t s, size_t lane,
                              const g::PairMasks& masks) {
  return {luminances->values, s * g::kStrip + lane, masks.strips * g::kStrip};
}

// Out: TileSums, PairValues or PairLuminances.
template <g::LightClass kClass, class Out>
void shadeOf(const g::Tile& tile, const g::LightBlock& block, float clamp,
             const g::PairMasks& pairMasks, Out* out) {
  PairScratch pairs;
  for (size_t s = 0; s < tile.strips.size(); ++s) {
    const g::PointStrip& strip = tile.strips[s];
    for (size_t lane = 0; lane < g::kStrip; lane += kLanes) {
      pairs.count = 0;
      for (size_t l = 0; l < static_cast<size_t>(block.count); ++l) {
        const uint32_t bits =
            (static_cast<uint32_t>(pairMasks.bits[l * pairMasks.strips + s]) >> lane) &
            ((1u << kLanes) - 1);
        if (bits == 0) continue;
        pairs.light[pairs.count] = static_cast<uint32_t>(l);
        pairs.mask[pairs.count++] = bits;
      }
      if (pairs.count == 0) continue;
      if constexpr (kClass == g::LightClass::spherical) {
        sphericalPairs(tile, s, lane, block, &pairs);
      } else if constexpr (kClass == g::LightClass::gaussian) {
        gaussianPairs(tile, strip, lane, block, &pairs);
      } else {
        directions<kClass>(strip, lane, block, &pairs);
        addLobes(tile, strip, lane, &pairs);
      }
      const bool rich = kClass == g::LightClass::diffuse && block.rich != nullptr;
      if (rich) applyRich(strip, lane, block, clamp, &pairs);
      auto sink = sinkFor(out, s, lane, pairMasks);
      sumUp<kClass>(strip, lane, block, rich ? 0.f : clamp, &pairs, &sink, out);
      sink.finish(s, lane);
    }
  }
}

LOBELIA_CORE_END

#endif  // per-target include guard
