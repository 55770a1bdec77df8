// Light of surfaces at a pixel, in registers of nodes (local_kernels.h).
#if defined(LOBELIA_RELIGHT_LOCAL_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_RELIGHT_LOCAL_SHADING_INL_H_
#undef LOBELIA_RELIGHT_LOCAL_SHADING_INL_H_
#else
#define LOBELIA_RELIGHT_LOCAL_SHADING_INL_H_
#endif

#include <cmath>

#include "lobelia/base/simd-inl.h"
#include "lobelia/relight/local_kernels.h"
#include "lobelia/relight/pixel_shading-inl.h"

LOBELIA_CORE_BEGIN

HWY_INLINE V3<Vf> loadVector(const float* const values[3], size_t at) {
  return {Vf::load(values[0] + at), Vf::load(values[1] + at), Vf::load(values[2] + at)};
}

HWY_INLINE Vf interpolatedRow(const relight::NearLights& lights, size_t channel, size_t at) {
  return Vf::load(lights.rows[0].channel(channel) + at) * Vf(lights.weight[0]) +
         Vf::load(lights.rows[1].channel(channel) + at) * Vf(lights.weight[1]) +
         Vf::load(lights.rows[2].channel(channel) + at) * Vf(lights.weight[2]);
}

inline void gatherNearLight(const relight::NearLights& lights, std::span<const uint32_t> chunks,
                            Vec3f place, Vec3f normal, relight::NearLight* out) {
  const V3<Vf> p{Vf(place.x), Vf(place.y), Vf(place.z)};
  const V3<Vf> n{Vf(normal.x), Vf(normal.y), Vf(normal.z)};
  const Vf softening(lights.softening), zero(0.f), least(0.5f * std::sqrt(lights.softening));
  float* const to[7] = {out->x.data(), out->y.data(), out->z.data(),       out->r.data(),
                        out->g.data(), out->b.data(), out->widening.data()};
  size_t count = 0;  // of nodes with light, packed: lobes then see full registers
  for (const uint32_t chunk : chunks)
    for (size_t lane = 0; lane < relight::kChunk; lane += kLanes) {
      const size_t at = size_t{chunk} * relight::kChunk + lane;
      const V3<Vf> straight = loadVector(lights.place, at) - p;
      const V3<Vf> facet = loadVector(lights.normal, at);
      const Vf height = zero - dot(straight, facet);
      const Vf lift = select(height > zero, max(least - height, zero), zero);
      const V3<Vf> v = straight - facet * lift;
      const Vf d2 = max(dot(v, v), Vf(1e-30f)), inverse = Vf(1.f) / sqrt(d2);
      const Vf cosine = zero - dot(v, facet) * inverse;
      const Vf variance = Vf::load(lights.variance + at);
      const Vf facing = Vf(0.5f) * (cosine + sqrt(cosine * cosine + variance));
      // What is left of nodes that face away is not worth a lobe.
      const Mf front = (dot(v, n) > zero) & (facing > min(variance, Vf(0.02f)));
      if (!any(front)) continue;
      const Vf geometry = facing / (d2 + softening);
      const Vf r = interpolatedRow(lights, 0, at), g = interpolatedRow(lights, 1, at),
               b = interpolatedRow(lights, 2, at);
      const Mf lit = front & ((r != zero) | (g != zero) | (b != zero));
      const Vf values[7] = {v.x * inverse,
                            v.y * inverse,
                            v.z * inverse,
                            r * geometry,
                            g * geometry,
                            b * geometry,
                            Vf(0.25f) * (Vf::load(lights.extent2 + at) + Vf(5.f) * softening) / d2};
      size_t added = 0;
      for (size_t i = 0; i < 7; ++i)
        added = hn::CompressStore(values[i].v, lit.m, Df(), to[i] + count);
      count += added;
    }
  out->chunkCount = (count + relight::kChunk - 1) / relight::kChunk;
  for (size_t chunk = 0; chunk < out->chunkCount; ++chunk) out->lit[chunk] = 0xffff;
  if (count % relight::kChunk != 0)
    out->lit[out->chunkCount - 1] = static_cast<uint16_t>((1u << count % relight::kChunk) - 1);
}

// alpha, or an exponent of Phong's, widened (bsdf's alpha of half vectors: lobe_reach.cpp).
HWY_INLINE Vf widenedParameter(LobeType type, float parameter, Vf widening) {
  if (type != LobeType::phong) return min(sqrt(Vf(parameter * parameter) + widening), Vf(1.f));
  const Vf alpha2 = Vf(0.5f / (parameter + 1)) + widening;
  return max(Vf(0.5f) / alpha2 - Vf(1.f), Vf(0.f));
}

template <class Tags>
HWY_FLATTEN LightSum sumWidened(Tags tags, const relight::LobeQuery& query,
                                const relight::NearLight& light, float reach) {
  const Lobe& lobe = *query.lobe;
  const ShadingFrame& frame = *query.frame;
  LobeParameters<Vf> p;
  p.weight = splatVector(lobe.weight), p.eta = splatVector(lobe.eta), p.k = splatVector(lobe.k);
  p.parameters = splatVector(lobe.parameters), p.tint = splatVector(lobe.tint);
  p.sides = Vf(lobe.interface ? 2.f : (lobe.twoSided ? 1.f : 0.f));
  const V3<Vf> s = splatVector(frame.s), t = splatVector(frame.t), n = splatVector(frame.n);
  const V3<Vf> wo = splatVector(frame.toLocal(query.wo));
  const LayerTable table{lobe.table};
  const V3<Vf> mirror = splatVector(query.mirror);
  LightSum out = noLight();
  for (size_t chunk = 0; chunk < light.chunkCount; ++chunk)
    for (size_t lane = 0; lane < relight::kChunk; lane += kLanes) {
      const uint32_t bits =
          (static_cast<uint32_t>(light.lit[chunk]) >> lane) & ((1u << kLanes) - 1);
      if (bits == 0) continue;
      const size_t at = chunk * relight::kChunk + lane;
      const V3<Vf> d{Vf::load(light.x.data() + at), Vf::load(light.y.data() + at),
                     Vf::load(light.z.data() + at)};
      const Vf widening = Vf::load(light.widening.data() + at);
      if (reach < 2) {  // chords
        const Vf far = Vf(reach) + Vf(4.f) * sqrt(widening);
        if (!any(Vf(2.f) - Vf(2.f) * dot(mirror, d) < far * far)) continue;
      }
      p.alphaX = widenedParameter(lobe.type, lobe.alphaX, widening);
      p.alphaY = widenedParameter(lobe.type, lobe.alphaY, widening);
      const V3<Vf> wi{dot(s, d), dot(t, d), dot(n, d)};
      V3<Vf> f = evaluateLobe(LobeTags(tags), p, wo, wi, table);
      if (frame.perturbed) f = f * bumpFactor(frame, query.baseNormal, d, wi.z);
      const Mf mask = maskFromBits(bits);
      out.sum.x += select(mask, f.x * Vf::load(light.r.data() + at), Vf(0.f));
      out.sum.y += select(mask, f.y * Vf::load(light.g.data() + at), Vf(0.f));
      out.sum.z += select(mask, f.z * Vf::load(light.b.data() + at), Vf(0.f));
      out.lanes += kLanes;
    }
  return out;
}

inline Rgb sumWidenedLobe(const relight::LobeQuery& query, const relight::NearLight& light,
                          float reach, uint64_t* evaluations) {
  const Lobe& lobe = *query.lobe;
  using Conductor =
      FixedTags<LobeType::microfacetReflection, Distribution::ggx, Fresnel::conductor>;
  using Dielectric =
      FixedTags<LobeType::microfacetReflection, Distribution::ggx, Fresnel::dielectric>;
  const LightSum out =
      Conductor::equal(lobe) ? sumWidened(Conductor(), query, light, reach)
      : Dielectric::equal(lobe)
          ? sumWidened(Dielectric(), query, light, reach)
          : sumWidened(LobeTags{lobe.type, lobe.distribution, lobe.fresnel, lobe.variant}, query,
                       light, reach);
  *evaluations += out.lanes;
  alignas(64) float lanes[3][kLanes];
  out.sum.x.store(lanes[0]);
  out.sum.y.store(lanes[1]);
  out.sum.z.store(lanes[2]);
  Rgb sum{};
  for (size_t i = 0; i < kLanes; ++i) sum += Rgb(lanes[0][i], lanes[1][i], lanes[2][i]);
  return sum;
}

LOBELIA_CORE_END

#endif  // per-target include guard
