// Exact evaluation and sampling of a Bsdf (scalar side of the kernels in bsdf/kernels-inl.h).
#pragma once

#include <optional>

#include "lobelia/bsdf/lobe.h"

namespace lobelia {

// Which lobes take part: rough ones are receivers and leave virtual lights; sharp ones (delta
// included) extend paths.
enum class LobeSet : uint8_t { rough = 1, sharp = 2, all = 3 };
// radiance: wo is towards the eye (refracted radiance scales by eta^2); importance: light paths,
// with the shading-normal correction of Veach 1997, section 5.3.
enum class Transport : uint8_t { radiance, importance };

struct BsdfSample {
  Vec3f wi;            // unit, world space, leaves the surface
  Rgb weight;          // f |cos| / pdf over the chosen LobeSet
  float pdf = 0;       // solid angle, of the whole LobeSet's mixture; 0 for delta
  bool delta = false;  // chosen from a delta lobe
  bool sharp = false;  // the lobe it was drawn from is sharp
  bool transmission = false;
  float eta = 1;  // relative index along the path (for Russian roulette)
};

// f |cos| of the non-delta lobes of the set; world-space unit directions.
Rgb evaluate(const Bsdf& bsdf, Vec3f wo, Vec3f wi, LobeSet set = LobeSet::all,
             Transport transport = Transport::radiance);
// Density of sample() with the same set; the delta lobes' share of the choice is left out.
float pdf(const Bsdf& bsdf, Vec3f wo, Vec3f wi, LobeSet set = LobeSet::all);
// evaluate() of one set for radiance and pdf() of another at once.
struct BsdfValue {
  Rgb value{};
  float pdf = 0;
};
BsdfValue evaluateWithPdf(const Bsdf& bsdf, Vec3f wo, Vec3f wi, LobeSet set, LobeSet sampled);
std::optional<BsdfSample> sample(const Bsdf& bsdf, Vec3f wo, float uLobe, Vec2f u,
                                 LobeSet set = LobeSet::all,
                                 Transport transport = Transport::radiance);
// Share of the light from direction w (leaving the surface) that reaches a bump- or normal-mapped
// surface: the microfacet shadowing function of Conty Estevez, Lecocq and Stein 2019 [Estevez19],
// which softens the terminator. alpha2: ShadingFrame::bumpAlpha2. evaluate() and sample() contain
// it.
inline float bumpShadow(Vec3f baseNormal, float alpha2, Vec3f w) {
  if (alpha2 == 0) return 1;
  const float c2 = sqr(dot(w, baseNormal));
  return c2 > 0 ? 2 / (1 + std::sqrt(1 + alpha2 * (1 - c2) / c2)) : 0.f;
}
// What bumps leave of light from w in a frame, w's cosine in it given: bumpShadow(), and 0 where
// perturbed and unperturbed normal disagree about the side.
float throughBumps(const Bsdf& bsdf, const ShadingFrame& frame, Vec3f w, float cosPerturbed);
// Share of the power arriving from wi that lobes in this frame scatter, as seen from the eye
// [Veach97 eq. 5.18]: |cos| to the shading normal over that to the geometric one, with the
// shadowing by bumps; 0 where the two normals disagree about the side.
float arrivingShare(const Bsdf& bsdf, const ShadingFrame& frame, Vec3f wi);
bool hasLobes(const Bsdf& bsdf, LobeSet set);
bool onlyDelta(const Bsdf& bsdf);
// Hemispherical reflectance plus transmittance for light towards wo, estimated (tables and fits;
// for AOVs, selection and Russian roulette, not for energy).
Rgb albedo(const Bsdf& bsdf, Vec3f wo, LobeSet set = LobeSet::all);
// Roughness by which a lobe is compared with the specular limit: alpha; sqrt(2/(n+2)) for Phong;
// 0 for delta; 1 for diffuse lobes.
float roughness(const Lobe& lobe);
// Sets Lobe::sharp of every lobe.
void classify(Bsdf& bsdf, float specularLimit);

}  // namespace lobelia
