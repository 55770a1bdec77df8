// Direct lighting at a surface point: one emitter sample, combined with BSDF samples by the power
// heuristic (Veach 1997, section 9.2). `Rays` is Tracer, or what answers the same queries.
#pragma once

#include "lobelia/bsdf/bsdf.h"
#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/path/emitter_sampling.h"

namespace lobelia {

// Where light is asked for.
struct LightQuery {
  Vec3f p, ng;
  float error = 0;  // SurfacePoint::error
  Vec3f n;          // for EmitterSampler: the side that light counts from, zero for both
};

// The shading normal on the side of wo when the lobes only reflect; zero when they transmit. Of
// several frames the normal before bumps, which none of them receives light from behind; zero where
// they disagree about the side of wo.
inline Vec3f lightSide(const Bsdf& bsdf, Vec3f wo) {
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    const LobeType type = bsdf.lobes[i].type;
    if (isTransmission(type) && !isDelta(type)) return {};
  }
  const Vec3f n = bsdf.frameCount > 1 ? bsdf.baseNormal : bsdf.frames[0].n;
  const bool behind = dot(n, wo) < 0;
  for (int f = 0; f < bsdf.frameCount; ++f)
    if ((dot(bsdf.frames[f].n, wo) < 0) != behind) return {};
  return behind ? -n : n;
}
inline LightQuery lightQuery(const SurfacePoint& at, const Bsdf& bsdf, Vec3f wo) {
  return {at.p, at.ng, at.error, lightSide(bsdf, wo)};
}

// The ray that nothing may block for the emitter sample's light to arrive at q.
inline Ray shadowRay(const LightQuery& q, const EmitterDirection& light) {
  Ray ray;
  ray.o = offsetOrigin(q.p, q.ng, q.error, light.wi);
  ray.d = light.wi;
  if (light.distance < 1e38f) ray.d = light.target - ray.o, ray.tMax = kShadowEnd;
  return ray;
}

// The numbers of the i-th of `count` emitter samples, made of three uniform numbers u: the choice
// of the emitter is stratified; places on it are the plastic number's lattice (Roberts 2018).
inline Vec3f directLightNumbers(Vec3f u, int i, int count) {
  const auto fraction = [](float x) { return x - static_cast<float>(static_cast<int>(x)); };
  const float k = static_cast<float>(i), step = 1 / static_cast<float>(count);
  return {std::min((u.x + k) * step, 0x1.fffffep-1f), fraction(u.y + k * 0.7548776662f),
          fraction(u.z + k * 0.5698402910f)};
}

// Light that emitters send to q, times f |cos| of the lobes in `lobes`: `count` emitter samples
// whose mean it is, stratified over the choice of the emitter. `sampled`: the lobes among which the
// one accompanying BSDF sample is drawn (MIS); pass withBsdf = false when there is none. u: three
// uniform numbers. ask(i, light, value): the i-th sample is worth `value`, a share of the mean,
// where nothing blocks shadowRay(q, light); samples that are worth nothing are left out.
template <class Ask>
void sampleDirectLight(const EmitterSampler& emitters, const LightQuery& q, const Bsdf& bsdf,
                       Vec3f wo, LobeSet lobes, LobeSet sampled, bool withBsdf, Vec3f u, int count,
                       const Ask& ask) {
  const float n = static_cast<float>(count), step = 1 / n;
  // A few at a time are drawn before any is used: what is read right after it was written has not
  // settled yet.
  constexpr int kMost = 4;
  for (int first = 0; first < count; first += kMost) {
    std::optional<EmitterDirection> lights[kMost];
    const int end = std::min(first + kMost, count);
    for (int i = first; i < end; ++i) {
      auto& light = lights[i - first];
      const Vec3f ui = directLightNumbers(u, i, count);
      if (!emitters.sampleDirection(q.p, q.n, ui.x, {ui.y, ui.z}, light.emplace())) light.reset();
    }
    for (int i = first; i < end; ++i) {
      if (!lights[i - first]) continue;
      const EmitterDirection& light = *lights[i - first];
      const bool weighed = withBsdf && !light.delta;
      const BsdfValue f = weighed ? evaluateWithPdf(bsdf, wo, light.wi, lobes, sampled)
                                  : BsdfValue{evaluate(bsdf, wo, light.wi, lobes), 0};
      Rgb value = f.value * light.weight;
      if (value == Rgb{}) continue;
      if (weighed) value *= powerHeuristic(n * light.pdf, f.pdf);
      ask(i, light, value * step);
    }
  }
}

// The sum for one emitter sample, its shadow ray traced at once and counted. add(value, emitter,
// direction): what arrived, for callers that keep emitters apart.
template <class Rays, class Add>
Rgb sampleDirectLight(const Rays& tracer, const EmitterSampler& emitters, const LightQuery& q,
                      const Bsdf& bsdf, Vec3f wo, LobeSet lobes, LobeSet sampled, bool withBsdf,
                      Vec3f u, uint64_t* shadowRays, const Add& add) {
  Rgb sum{};
  sampleDirectLight(emitters, q, bsdf, wo, lobes, sampled, withBsdf, u, 1,
                    [&](int, const EmitterDirection& light, Rgb value) {
                      ++*shadowRays;
                      const Ray ray = shadowRay(q, light);
                      if (tracer.occluded(ray)) return;
                      sum += value;
                      add(value, light.emitter, ray.d);
                    });
  return sum;
}

// MIS weight of emission met by a BSDF sample of density bsdfPdf, where `count` emitter samples of
// density lightPdf were taken.
inline float emissionWeight(float bsdfPdf, float lightPdf, int count) {
  return powerHeuristic(bsdfPdf, static_cast<float>(count) * lightPdf);
}
// The same for a BSDF sample drawn at q. delta: it came from a delta lobe, which no emitter sample
// can replace. hit: null when the ray escaped.
inline float emissionWeight(const EmitterSampler& emitters, const LightQuery& q,
                            const SurfacePoint* hit, Vec3f wi, float bsdfPdf, bool delta,
                            int count = 1) {
  if (delta) return 1;
  const float lightPdf =
      hit ? emitters.pdfHit(q.p, q.n, *hit, wi) : emitters.pdfEscaped(q.p, q.n, wi);
  return emissionWeight(bsdfPdf, lightPdf, count);
}

}  // namespace lobelia
