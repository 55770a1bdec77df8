// Lobes at fixed directions, in registers of directions (lobe_kernels.h).
#if defined(LOBELIA_TRANSFER_LOBE_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_TRANSFER_LOBE_KERNELS_INL_H_
#undef LOBELIA_TRANSFER_LOBE_KERNELS_INL_H_
#else
#define LOBELIA_TRANSFER_LOBE_KERNELS_INL_H_
#endif

#include <bit>

#include "lobelia/base/simd-inl.h"
#include "lobelia/bsdf/kernels-inl.h"
#include "lobelia/relight/pixel_shading-inl.h"
#include "lobelia/transfer/lobe_kernels.h"

LOBELIA_CORE_BEGIN

// Do all channels have the same value but for the weight?
constexpr bool isColourless(LobeType type, Fresnel fresnel) {
  const bool dielectric = fresnel == Fresnel::one || fresnel == Fresnel::dielectric ||
                          fresnel == Fresnel::thinDielectric;
  return type == LobeType::microfacetReflection
             ? dielectric
             : type == LobeType::lambert || type == LobeType::coatedDiffuse ||
                   type == LobeType::phong || type == LobeType::ward;
}

template <class Tags>
HWY_FLATTEN void addWeightsOf(Tags tags, const transfer::LobeLanes& query,
                              std::span<const uint32_t> chunks, bool first, float* out) {
  const Lobe& lobe = *query.lobe;
  const ShadingFrame& frame = *query.frame;
  const bool colourless = isColourless(LobeTags(tags).type, LobeTags(tags).fresnel);
  LobeParameters<Vf> p;
  p.alphaX = Vf(lobe.alphaX), p.alphaY = Vf(lobe.alphaY);
  // Luminance is in the weights: of one channel, or of all three.
  p.weight = splatVector(colourless ? Rgb(luminance(lobe.weight))
                                    : Rgb(luminance({lobe.weight.x, 0, 0}),
                                          luminance({0, lobe.weight.y, 0}),
                                          luminance({0, 0, lobe.weight.z})));
  p.eta = splatVector(lobe.eta), p.k = splatVector(lobe.k);
  p.parameters = splatVector(lobe.parameters), p.tint = splatVector(lobe.tint);
  p.sides = Vf(lobe.interface ? 2.f : (lobe.twoSided ? 1.f : 0.f));
  const V3<Vf> s = splatVector(frame.s), t = splatVector(frame.t), n = splatVector(frame.n);
  const V3<Vf> wo = splatVector(frame.toLocal(query.wo));
  const LayerTable table{lobe.table};
  for (size_t i = 0; i < chunks.size(); ++i)
    for (size_t lane = 0; lane < relight::kChunk; lane += kLanes) {
      const size_t at = chunks[i] * relight::kChunk + lane;
      float* const to = out + i * relight::kChunk + lane;
      const V3<Vf> d{Vf::load(query.x + at), Vf::load(query.y + at), Vf::load(query.z + at)};
      const V3<Vf> wi{dot(s, d), dot(t, d), dot(n, d)};
      const V3<Vf> f = evaluateLobe(LobeTags(tags), p, wo, wi, table);
      Vf value = colourless ? f.x : f.x + f.y + f.z;
      if (frame.perturbed) value = value * bumpFactor(frame, query.baseNormal, d, wi.z);
      (first ? value : value + Vf::load(to)).store(to);
    }
}

// Frequent kinds get code of their own.
template <class... Fixed>
void addWeightsByKind(const transfer::LobeLanes& query, std::span<const uint32_t> chunks,
                      bool first, float* out) {
  const Lobe& lobe = *query.lobe;
  const auto tryOne = [&]<class C>(C fixed) {
    if (!C::equal(lobe)) return false;
    addWeightsOf(fixed, query, chunks, first, out);
    return true;
  };
  if (!(tryOne(Fixed()) || ...))
    addWeightsOf(LobeTags{lobe.type, lobe.distribution, lobe.fresnel, lobe.variant}, query, chunks,
                 first, out);
}

inline void addWeights(const transfer::LobeLanes& query, std::span<const uint32_t> chunks,
                       bool first, float* out) {
  using enum LobeType;
  addWeightsByKind<FixedTags<lambert>, FixedTags<phong>, FixedTags<coatedDiffuse>,
                   FixedTags<coatedDiffuse, Distribution::ggx, Fresnel::one, 1>,
                   FixedTags<microfacetReflection, Distribution::ggx, Fresnel::conductor>,
                   FixedTags<microfacetReflection, Distribution::ggx, Fresnel::dielectric>,
                   FixedTags<microfacetReflection, Distribution::ggx, Fresnel::schlick>,
                   FixedTags<microfacetReflection, Distribution::beckmann, Fresnel::conductor>,
                   FixedTags<microfacetReflection, Distribution::beckmann, Fresnel::dielectric>>(
      query, chunks, first, out);
}

inline void findMeeting(const transfer::ChunkCones& cones,
                        std::span<const transfer::LobeCone> lobes, std::vector<uint32_t>* chunks) {
  for (size_t at = 0; at < cones.count; at += kLanes) {
    const V3<Vf> axis{Vf::load(cones.x + at), Vf::load(cones.y + at), Vf::load(cones.z + at)};
    const Vf c = Vf::load(cones.cosine + at), s = Vf::load(cones.sine + at), zero(0.f);
    Mf meets = zero > zero;
    for (const transfer::LobeCone& lobe : lobes) {
      const Vf cosine(lobe.cosine), sine(lobe.sine);
      const Vf d = dot(splatVector(lobe.mirror), axis);
      // Within the sum of both angles, or that is more than half a turn.
      const Mf near = (d >= c * cosine - s * sine) | (s * cosine + c * sine < zero);
      const Mf above = (dot(splatVector(lobe.normal), axis) > zero - s) | (c < zero);
      meets = meets | (near & above);
    }
    for (uint32_t bits = maskBits(meets); bits != 0; bits &= bits - 1) {
      const size_t chunk = at + static_cast<size_t>(std::countr_zero(bits));
      if (chunk < cones.count) chunks->push_back(static_cast<uint32_t>(chunk));
    }
  }
}

LOBELIA_CORE_END

#endif  // per-target include guard
