// Light at a pixel and its sum over a lobe, in registers of nodes (pixel_kernels.h).
#if defined(LOBELIA_RELIGHT_PIXEL_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_RELIGHT_PIXEL_SHADING_INL_H_
#undef LOBELIA_RELIGHT_PIXEL_SHADING_INL_H_
#else
#define LOBELIA_RELIGHT_PIXEL_SHADING_INL_H_
#endif

#include <bit>

#include "lobelia/base/simd-inl.h"
#include "lobelia/bsdf/kernels-inl.h"
#include "lobelia/relight/pixel_kernels.h"

LOBELIA_CORE_BEGIN

HWY_INLINE V3<Vf> splatVector(Vec3f v) { return {Vf(v.x), Vf(v.y), Vf(v.z)}; }

// The three vertices' light of a channel, interpolated, where the mask is set.
HWY_INLINE Vf interpolated(const relight::VertexLights& lights, size_t channel, size_t at,
                           Mf front) {
  Vf sum(0.f);
  for (size_t v = 0; v < 3; ++v)
    sum += Vf::load(lights.rows[v].channel(channel) + at) * Vf(lights.weight[v]);
  return select(front, sum, Vf(0.f));
}

inline void findLit(const relight::LightRows& rows, size_t chunkCount, uint16_t* lit) {
  for (size_t chunk = 0; chunk < chunkCount; ++chunk) {
    uint32_t bits = 0;
    for (size_t lane = 0; lane < relight::kChunk; lane += kLanes) {
      const size_t at = chunk * relight::kChunk + lane;
      const Mf any = (Vf::load(rows.channel(0) + at) != Vf(0.f)) |
                     (Vf::load(rows.channel(1) + at) != Vf(0.f)) |
                     (Vf::load(rows.channel(2) + at) != Vf(0.f));
      bits |= maskBits(any) << lane;
    }
    lit[chunk] = static_cast<uint16_t>(bits);
  }
}

inline void appendLight(const relight::VertexLights& lights, size_t chunkCount, Vec3f normal,
                        relight::DirectedLight* out) {
  const V3<Vf> n = splatVector(normal);
  for (size_t chunk = 0; chunk < chunkCount; ++chunk) {
    if (lights.lit[0] != nullptr &&
        (lights.lit[0][chunk] | lights.lit[1][chunk] | lights.lit[2][chunk]) == 0)
      continue;
    const size_t to = out->chunkCount * relight::kChunk;
    uint32_t lit = 0;
    for (size_t lane = 0; lane < relight::kChunk; lane += kLanes) {
      const size_t at = chunk * relight::kChunk + lane;
      const V3<Vf> d{Vf::load(lights.direction[0] + at), Vf::load(lights.direction[1] + at),
                     Vf::load(lights.direction[2] + at)};
      const Mf front = dot(n, d) > Vf(0.f);
      if (!any(front)) {
        for (relight::AlignedFloats* c : {&out->r, &out->g, &out->b})
          Vf(0.f).store(c->data() + to + lane);
        continue;
      }
      const Vf r = interpolated(lights, 0, at, front), g = interpolated(lights, 1, at, front),
               b = interpolated(lights, 2, at, front);
      lit |= maskBits((r != Vf(0.f)) | (g != Vf(0.f)) | (b != Vf(0.f))) << lane;
      d.x.store(out->x.data() + to + lane);
      d.y.store(out->y.data() + to + lane);
      d.z.store(out->z.data() + to + lane);
      r.store(out->r.data() + to + lane);
      g.store(out->g.data() + to + lane);
      b.store(out->b.data() + to + lane);
    }
    if (lit == 0) continue;
    out->chunk[out->chunkCount] = static_cast<uint32_t>(chunk);
    out->lit[out->chunkCount++] = static_cast<uint16_t>(lit);
  }
}

// Transmittance of layers, linear between tabulated cosines.
struct LayerTable {
  const float* table;
  HWY_INLINE Vf operator()(Vf cosine) const {
    const Vf x = max(cosine, Vf(0.f)) * Vf(static_cast<float>(kTransmittanceSize - 1));
    const Vf i = min(floor(x), Vf(static_cast<float>(kTransmittanceSize - 2)));
    const Vf a = lobelia::HWY_NAMESPACE::gather(table, i);
    const Vf b = lobelia::HWY_NAMESPACE::gather(table, i + Vf(1.f));
    return a + (b - a) * (x - i);
  }
};

// What bsdf/bsdf.cpp asks of directions at a surface with bump or normal maps: the same side of
// both normals (agrees()), and the softened terminator (bumpShadow()).
HWY_INLINE Vf bumpFactor(const ShadingFrame& frame, Vec3f baseNormal, V3<Vf> wi, Vf cosine) {
  const Vf c = dot(splatVector(baseNormal), wi);
  return select(c * cosine > Vf(0.f), bumpShadowing(c, Vf(frame.bumpAlpha2)), Vf(0.f));
}

struct LightSum {
  V3<Vf> sum;
  uint64_t lanes;
};
// Not by a constructor, which the compiler would make for the baseline target.
HWY_INLINE LightSum noLight() { return {{Vf(0.f), Vf(0.f), Vf(0.f)}, 0}; }

// tags: a LobeTags, or a constant that converts to one, for which the compiler moves what depends
// on wo alone out of the loop: if it has all of it at hand, which it has to be told.
template <class Tags>
HWY_FLATTEN LightSum sumLobeOf(Tags tags, const relight::LobeQuery& query,
                               const relight::DirectedLight& light, const uint16_t* masks) {
  const Lobe& lobe = *query.lobe;
  const ShadingFrame& frame = *query.frame;
  LobeParameters<Vf> p;
  p.alphaX = Vf(lobe.alphaX), p.alphaY = Vf(lobe.alphaY);
  p.weight = splatVector(lobe.weight), p.eta = splatVector(lobe.eta), p.k = splatVector(lobe.k);
  p.parameters = splatVector(lobe.parameters), p.tint = splatVector(lobe.tint);
  p.sides = Vf(lobe.interface ? 2.f : (lobe.twoSided ? 1.f : 0.f));
  const V3<Vf> s = splatVector(frame.s), t = splatVector(frame.t), n = splatVector(frame.n);
  const V3<Vf> wo = splatVector(frame.toLocal(query.wo));
  const V3<Vf> mirror = splatVector(query.mirror);
  const LayerTable table{lobe.table};
  LightSum out = noLight();
  for (size_t chunk = 0; chunk < light.chunkCount; ++chunk) {
    for (size_t lane = 0; lane < relight::kChunk; lane += kLanes) {
      const uint32_t bits = (static_cast<uint32_t>(masks[chunk]) >> lane) & ((1u << kLanes) - 1);
      if (bits == 0) continue;
      const size_t at = chunk * relight::kChunk + lane;
      const V3<Vf> d{Vf::load(light.x.data() + at), Vf::load(light.y.data() + at),
                     Vf::load(light.z.data() + at)};
      if (!any(dot(mirror, d) > Vf(query.leastCosine))) continue;
      const V3<Vf> wi{dot(s, d), dot(t, d), dot(n, d)};
      V3<Vf> f = evaluateLobe(LobeTags(tags), p, wo, wi, table);
      if (frame.perturbed) f = f * bumpFactor(frame, query.baseNormal, d, wi.z);
      const Mf mask = maskFromBits(bits);
      out.sum.x += select(mask, f.x * Vf::load(light.r.data() + at), Vf(0.f));
      out.sum.y += select(mask, f.y * Vf::load(light.g.data() + at), Vf(0.f));
      out.sum.z += select(mask, f.z * Vf::load(light.b.data() + at), Vf(0.f));
      out.lanes += kLanes;
    }
  }
  return out;
}

template <LobeType kType, Distribution kDistribution = Distribution::ggx,
          Fresnel kFresnel = Fresnel::one, uint8_t kVariant = 0>
struct FixedTags {
  HWY_INLINE operator LobeTags() const { return {kType, kDistribution, kFresnel, kVariant}; }
  static bool equal(const Lobe& lobe) {
    return lobe.type == kType && lobe.distribution == kDistribution && lobe.fresnel == kFresnel &&
           lobe.variant == kVariant;
  }
};

// Frequent kinds get code of their own.
template <class... Fixed>
LightSum sumByKind(const relight::LobeQuery& query, const relight::DirectedLight& light,
                   const uint16_t* masks) {
  LightSum out = noLight();
  const Lobe& lobe = *query.lobe;
  const auto tryOne = [&]<class C>(C fixed) {
    if (!C::equal(lobe)) return false;
    out = sumLobeOf(fixed, query, light, masks);
    return true;
  };
  if (!(tryOne(Fixed()) || ...))
    out = sumLobeOf(LobeTags{lobe.type, lobe.distribution, lobe.fresnel, lobe.variant}, query,
                    light, masks);
  return out;
}

inline Rgb sumLobe(const relight::LobeQuery& query, const relight::DirectedLight& light,
                   const uint16_t* masks, uint64_t* evaluations) {
  using enum LobeType;
  const LightSum out =
      sumByKind<FixedTags<lambert>,  //
                FixedTags<coatedDiffuse>,
                FixedTags<coatedDiffuse, Distribution::ggx, Fresnel::one, 1>,
                FixedTags<microfacetReflection, Distribution::ggx, Fresnel::conductor>,
                FixedTags<microfacetReflection, Distribution::ggx, Fresnel::dielectric>,
                FixedTags<microfacetReflection, Distribution::ggx, Fresnel::schlick>,
                FixedTags<microfacetReflection, Distribution::beckmann, Fresnel::conductor>,
                FixedTags<microfacetReflection, Distribution::beckmann, Fresnel::dielectric>>(
          query, light, masks);
  *evaluations += out.lanes;
  alignas(64) float lanes[3][kLanes];
  out.sum.x.store(lanes[0]);
  out.sum.y.store(lanes[1]);
  out.sum.z.store(lanes[2]);
  Rgb sum{};
  for (size_t i = 0; i < kLanes; ++i) sum += Rgb(lanes[0][i], lanes[1][i], lanes[2][i]);
  return sum;
}

inline void findUnits(const relight::FineUnits& units, Vec3f axis, float radius,
                      std::vector<uint32_t>* found) {
  const V3<Vf> a = splatVector(axis);
  const Vf cosine(std::cos(radius)), sine(std::sin(radius));
  for (size_t at = 0; at < units.x.size(); at += kLanes) {
    const Vf c = Vf::load(units.cosine.data() + at), s = Vf::load(units.sine.data() + at);
    const Vf d = dot(a, {Vf::load(units.x.data() + at), Vf::load(units.y.data() + at),
                         Vf::load(units.z.data() + at)});
    // Within the sum of both angles, or that is more than half a turn.
    const Mf meets = (d >= c * cosine - s * sine) | (s * cosine + c * sine < Vf(0.f));
    for (uint32_t bits = maskBits(meets); bits != 0; bits &= bits - 1) {
      const size_t unit = at + static_cast<size_t>(std::countr_zero(bits));
      if (unit < units.count) found->push_back(static_cast<uint32_t>(unit));
    }
  }
}

LOBELIA_CORE_END

#endif  // per-target include guard
