// Light of visible pairs of receiver points and Rich-VPLs [Simon15 section 3]: a directional
// look-up, or a mixture of Gaussians, in the place of a diffuse light's cosine lobe
// (rich_radiance.h).
#if defined(LOBELIA_GATHER_RICH_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_RICH_SHADING_INL_H_
#undef LOBELIA_GATHER_RICH_SHADING_INL_H_
#else
#define LOBELIA_GATHER_RICH_SHADING_INL_H_
#endif

#include "lobelia/gather/rich_cube-inl.h"
#include "lobelia/gather/rich_radiance.h"
#include "lobelia/gather/shading-inl.h"
#include "lobelia/lobes/kernels-inl.h"

LOBELIA_CORE_BEGIN

// Over the squared distance, but no less than the light is spread over.
HWY_INLINE Vf richFactor(const g::RichRadiance& rich, uint32_t index, Vf inverseDistance) {
  const float least = rich.light(index).leastSquared;
  const Vf geometry = inverseDistance * inverseDistance;
  return least > 0 ? min(geometry, Vf(1 / least)) : geometry;
}

// w: local to the light's surface.
inline V3<Vf> texelsAlong(V3<Vf> w, const float* texels, int edge) {
  const CubeTaps<Vf> taps = cubeTaps(V3<Vf>{w.x, w.y, max(w.z, Vf(0.f))}, static_cast<float>(edge));
  const Vf one(1.f), below = taps.first + Vf(static_cast<float>(edge));
  const size_t count = g::RichRadiance::texelCount(edge);
  Vf channels[3];
  for (size_t c = 0; c < 3; ++c, texels += count) {
    const auto at = [&](Vf texel) { return lobelia::HWY_NAMESPACE::gather(texels, texel); };
    const Vf first = at(taps.first) * (one - taps.across) + at(taps.first + one) * taps.across;
    const Vf second = at(below) * (one - taps.across) + at(below + one) * taps.across;
    channels[c] = first * (one - taps.down) + second * taps.down;
  }
  return {channels[0], channels[1], channels[2]};
}

// Intensity of light l of the block along w, W/sr.
inline V3<Vf> richIntensity(const g::LightBlock& block, size_t l, V3<Vf> w) {
  const g::RichRadiance& rich = *block.rich;
  const g::RichRadiance::Light& light = rich.light(block.index[l]);
  V3<Vf> sum = broadcast(light.cosine) * max(dot(broadcast(light.n), w), Vf(0.f));
  for (const g::RichLobe& lobe : rich.lobes(block.index[l])) {
    const Vf value = gaussian(broadcast(lobe.axis), Vf(lobe.sharpness), w);
    sum = sum + broadcast(lobe.amplitude) * value;
  }
  if (!light.hasTexels) return sum;
  const Frame frame = frameFromNormal(light.n);
  const V3<Vf> local{dot(broadcast(frame.s), w), dot(broadcast(frame.t), w),
                     dot(broadcast(frame.n), w)};
  return sum + texelsAlong(local, &block.richTexels[l * block.richStride], rich.texels());
}

// Makes of the pairs' geometry what a light's lobe makes of it, so that times the peak it is the
// light sent: the factor has the largest channel, and is clamped as that of a lobe that peaks at 1;
// the receiver's lobes take the colour.
inline void applyRich(const g::PointStrip& strip, size_t lane, const g::LightBlock& block,
                      float clamp, PairScratch* pairs) {
  // Less, in tails of sharp lobes, is nothing: one over it would overflow.
  constexpr float kLeast = 1e-30f;
  const g::RichRadiance& rich = *block.rich;
  const V3<Vf> p = load(strip.p, lane);
  for (size_t i = 0; i < pairs->count; ++i) {
    const size_t l = pairs->light[i];
    const V3<Vf> d = p - broadcast(block.lights[l].p);
    const V3<Vf> sent = richIntensity(block, l, d * (Vf(1.f) / sqrt(dot(d, d))));
    const Vf largest = max(sent.x, max(sent.y, sent.z));
    const float peak = rich.light(block.index[l]).peak;
    Vf factor = Vf::load(pairs->factor[i].v) * largest * Vf(peak > kLeast ? 1 / peak : 0.f);
    if (clamp > 0) factor = clamped(*pairs, i, factor, clamp);
    if (rich.limitsDepth()) {
      alignas(64) float share[kLanes];
      for (size_t k = 0; k < kLanes; ++k)
        share[k] = rich.share(block.index[l], strip.depth[lane + k]);
      factor = factor * Vf::load(share);
    }
    factor.store(pairs->factor[i].v);
    const Vf scale = select(largest > Vf(kLeast), Vf(1.f) / largest, Vf(0.f));
    (Vf::load(pairs->r[i].v) * sent.x * scale).store(pairs->r[i].v);
    (Vf::load(pairs->g[i].v) * sent.y * scale).store(pairs->g[i].v);
    (Vf::load(pairs->b[i].v) * sent.z * scale).store(pairs->b[i].v);
  }
}

LOBELIA_CORE_END

#endif  // per-target include guard
