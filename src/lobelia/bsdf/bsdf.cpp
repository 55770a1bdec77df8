// A Bsdf as the mixture of its lobes. Lobes are chosen by Lobe::selection among those of the set
// that act for wo; densities are those of the whole mixture (balance heuristic over lobes). The two
// lobes of a rough interface (Lobe::variant) are one choice: see sampleInterface(). Each lobe is
// evaluated in its own frame; which side of its surface a direction is on, each frame decides for
// its lobes.
#include "lobelia/bsdf/bsdf.h"

#include <cmath>

#include "lobelia/base/sampling.h"
#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/lobe_sampling.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

bool inSet(const Lobe& lobe, LobeSet set) {
  const auto bit = lobe.sharp ? LobeSet::sharp : LobeSet::rough;
  return (static_cast<uint8_t>(set) & static_cast<uint8_t>(bit)) != 0;
}

// First of the two lobes of a rough interface, both of which take part?
bool isInterfacePair(const Bsdf& bsdf, int i) {
  return bsdf.lobes[i].type == LobeType::microfacetReflection &&
         (bsdf.lobes[i].variant & kInterfacePair) != 0 && i + 1 < bsdf.lobeCount &&
         bsdf.lobes[i].sharp == bsdf.lobes[i + 1].sharp;
}

// A direction in all frames.
struct Local {
  Vec3f frames[kMaxFrames];
  Local(const Bsdf& bsdf, Vec3f w) {
    for (int f = 0; f < bsdf.frameCount; ++f) frames[f] = bsdf.frames[f].toLocal(w);
  }
  Vec3f of(const Lobe& lobe) const { return frames[lobe.frame]; }
};

float totalSelection(const Bsdf& bsdf, const Local& o, LobeSet set) {
  float total = 0;
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    const Lobe& lobe = bsdf.lobes[i];
    if (inSet(lobe, set) && isActive(lobe, o.of(lobe).z)) total += lobe.selection;
  }
  return total;
}

// Are perturbed and unperturbed normal on the same side of the direction?
bool agrees(const Bsdf& bsdf, const ShadingFrame& frame, Vec3f w, float cosPerturbed) {
  return !frame.perturbed || dot(w, bsdf.baseNormal) * cosPerturbed > 0;
}

// One bit per frame.
using FrameBits = uint32_t;
FrameBits agreeing(const Bsdf& bsdf, Vec3f w, const Local& local) {
  FrameBits bits = 0;
  for (int f = 0; f < bsdf.frameCount; ++f)
    if (agrees(bsdf, bsdf.frames[f], w, local.frames[f].z)) bits |= FrameBits{1} << f;
  return bits;
}

// Adjoint of a BSDF with shading normals, Veach 1997, section 5.3.2.
float shadingNormalCorrection(const Bsdf& bsdf, Vec3f n, Vec3f wo, Vec3f wi) {
  const float numerator = std::abs(dot(wo, n) * dot(wi, bsdf.ng));
  const float denominator = std::abs(dot(wo, bsdf.ng) * dot(wi, n));
  return denominator > 0 ? numerator / denominator : 0.f;
}

// Factor from radiance to importance transport of a direction pair.
float importanceFactor(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo, Vec3f wi) {
  const Vec3f n = bsdf.frameOf(lobe).n;
  float factor = shadingNormalCorrection(bsdf, n, wo, wi);
  if (lobe.type == LobeType::microfacetTransmission || lobe.type == LobeType::deltaTransmission)
    factor *= sqr(relativeEta(lobe, dot(wo, n) < 0));
  return factor;
}

float mixturePdf(const Bsdf& bsdf, const Local& o, const Local& i, FrameBits frames, LobeSet set) {
  float sum = 0;
  for (int l = 0; l < bsdf.lobeCount; ++l) {
    const Lobe& lobe = bsdf.lobes[l];
    const Vec3f wo = o.of(lobe), wi = i.of(lobe);
    if (!inSet(lobe, set) || !isActive(lobe, wo.z) || isDelta(lobe)) continue;
    const bool agree = (frames >> lobe.frame & 1) != 0;
    if (isInterfacePair(bsdf, l)) {
      const Lobe& other = bsdf.lobes[++l];
      if (!agree) continue;
      sum += (lobe.selection + other.selection) * interfacePdf(lobe, other, wo, wi);
    } else if (agree) {
      sum += lobe.selection * lobePdf(lobe, wo, wi);
    }
  }
  return sum;
}

// Direction of a delta lobe and its factor f |cos|, radiance transport.
struct DeltaEvent {
  Vec3f wi;
  Rgb value;
  float eta = 1;
};
std::optional<DeltaEvent> deltaEvent(const Lobe& lobe, Vec3f wo) {
  const bool behind = wo.z < 0;
  const Vec3f w = behind ? flipZ(wo) : wo;
  DeltaEvent event;
  if (lobe.type == LobeType::deltaReflection) {
    event.wi = {-w.x, -w.y, w.z};
    event.value = lobe.weight * fresnelOf(lobe, w.z, behind && lobe.interface);
  } else if (lobe.type == LobeType::null) {
    event.wi = -w;
    event.value = lobe.weight;
    if (lobe.fresnel != Fresnel::one) event.value *= Rgb(1.f) - fresnelOf(lobe, w.z, false);
  } else {
    event.eta = relativeEta(lobe, behind);
    const auto refracted = refract(w, Vec3f(0, 0, 1), event.eta);
    if (!refracted) return std::nullopt;
    event.wi = *refracted;
    event.value = lobe.weight * ((1 - core::fresnelDielectric(w.z, event.eta)) / sqr(event.eta));
  }
  if (behind) event.wi = flipZ(event.wi);
  return event;
}

// o, i: wo, wi in the frames; those in `agreeing` take part. Taken apart from the world's
// directions because rounding them matters where alpha is 1e-4.
Rgb evaluateLocal(const Bsdf& bsdf, Vec3f wo, Vec3f wi, const Local& o, const Local& i,
                  FrameBits frames, LobeSet set, Transport transport) {
  Rgb sum{};
  float shadow[kMaxFrames];
  for (int f = 0; f < bsdf.frameCount; ++f)
    shadow[f] = bumpShadow(bsdf.baseNormal, bsdf.frames[f].bumpAlpha2,
                           transport == Transport::radiance ? wi : wo);
  for (int l = 0; l < bsdf.lobeCount; ++l) {
    const Lobe& lobe = bsdf.lobes[l];
    if (!inSet(lobe, set) || isDelta(lobe) || (frames >> lobe.frame & 1) == 0) continue;
    const Rgb value = evaluateLobe(lobe, o.of(lobe), i.of(lobe)) * shadow[lobe.frame];
    if (transport == Transport::radiance) {
      sum += value;
    } else {
      sum += value * importanceFactor(bsdf, lobe, wo, wi);
    }
  }
  return sum;
}

// Value (radiance) and density, not yet over the sum of all selections, of the lobes that take
// part.
BsdfValue evaluateMixture(const Bsdf& bsdf, Vec3f wi, const Local& o, const Local& i,
                          FrameBits frames, LobeSet set) {
  BsdfValue sum;
  for (int l = 0; l < bsdf.lobeCount; ++l) {
    const Lobe& lobe = bsdf.lobes[l];
    const Vec3f localO = o.of(lobe), localI = i.of(lobe);
    if (!inSet(lobe, set) || !isActive(lobe, localO.z) || isDelta(lobe)) continue;
    if ((frames >> lobe.frame & 1) == 0) continue;
    Rgb value;
    if (isInterfacePair(bsdf, l)) {
      const Lobe& other = bsdf.lobes[++l];
      value = evaluateLobe(lobe, localO, localI) + evaluateLobe(other, localO, localI);
      sum.pdf += (lobe.selection + other.selection) * interfacePdf(lobe, other, localO, localI);
    } else {
      const LobeValue own = evaluateWithPdf(lobe, localO, localI);
      value = own.value;
      sum.pdf += lobe.selection * own.pdf;
    }
    sum.value += value * bumpShadow(bsdf.baseNormal, bsdf.frameOf(lobe).bumpAlpha2, wi);
  }
  return sum;
}

// The only lobe of a plain diffuse surface, the commonest there is, or null. Such a surface needs
// none of the bookkeeping of mixtures; values are the kernels' up to rounding.
const Lobe* onlyLambert(const Bsdf& bsdf, LobeSet set) {
  const Lobe& lobe = bsdf.lobes[0];
  const bool is = bsdf.lobeCount == 1 && lobe.type == LobeType::lambert && inSet(lobe, set) &&
                  !bsdf.frameOf(lobe).perturbed;
  return is ? &lobe : nullptr;
}
// 1 or -1: the side of the surface that wo is on; 0 where the lobe does not act.
float sideOf(const Lobe& lobe, float cosThetaO) {
  return !isActive(lobe, cosThetaO) ? 0.f : cosThetaO > 0 ? 1.f : -1.f;
}

std::optional<BsdfSample> sampleLambert(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo, Vec2f u) {
  const ShadingFrame& frame = bsdf.frameOf(lobe);
  const float side = sideOf(lobe, dot(wo, frame.n));
  Vec3f wi = sampleHemisphereCosine(u);
  if (side == 0 || !(wi.z > 0) || !(maxComponent(lobe.weight) > 0)) return std::nullopt;
  std::optional<BsdfSample> result(std::in_place);
  result->pdf = wi.z * kInvPi;
  wi.z *= side;
  result->wi = frame.toWorld(wi);
  result->sharp = lobe.sharp;
  result->weight = lobe.weight;
  return result;
}

}  // namespace

Rgb evaluate(const Bsdf& bsdf, Vec3f wo, Vec3f wi, LobeSet set, Transport transport) {
  const Local o(bsdf, wo), i(bsdf, wi);
  const FrameBits frames = agreeing(bsdf, wi, i);
  if (frames == 0) return {};
  return evaluateLocal(bsdf, wo, wi, o, i, frames, set, transport);
}

float pdf(const Bsdf& bsdf, Vec3f wo, Vec3f wi, LobeSet set) {
  const Local o(bsdf, wo), i(bsdf, wi);
  const float total = totalSelection(bsdf, o, set);
  if (!(total > 0)) return 0;
  return mixturePdf(bsdf, o, i, agreeing(bsdf, wi, i), set) / total;
}

BsdfValue evaluateWithPdf(const Bsdf& bsdf, Vec3f wo, Vec3f wi, LobeSet set, LobeSet sampled) {
  if (const Lobe* const lobe = onlyLambert(bsdf, set); lobe && set == sampled) {
    const Vec3f n = bsdf.frameOf(*lobe).n;
    const float cosine = std::max(sideOf(*lobe, dot(wo, n)) * dot(wi, n), 0.f) * kInvPi;
    return {lobe->weight * cosine, cosine};
  }
  const Local o(bsdf, wo), i(bsdf, wi);
  const FrameBits frames = agreeing(bsdf, wi, i);
  if (frames == 0) return {};
  const float total = totalSelection(bsdf, o, sampled);
  if (set != sampled) {
    const Rgb value = evaluateLocal(bsdf, wo, wi, o, i, frames, set, Transport::radiance);
    return {value, total > 0 ? mixturePdf(bsdf, o, i, frames, sampled) / total : 0.f};
  }
  BsdfValue result = evaluateMixture(bsdf, wi, o, i, frames, set);
  result.pdf = total > 0 ? result.pdf / total : 0.f;
  return result;
}

std::optional<BsdfSample> sample(const Bsdf& bsdf, Vec3f wo, float uLobe, Vec2f u, LobeSet set,
                                 Transport transport) {
  if (transport == Transport::radiance) {
    if (const Lobe* const lobe = onlyLambert(bsdf, set)) return sampleLambert(bsdf, *lobe, wo, u);
  }
  const Local local(bsdf, wo);
  const float total = totalSelection(bsdf, local, set);
  if (!(total > 0)) return std::nullopt;

  // The last lobe that takes part catches what rounding leaves over.
  float target = uLobe * total, share = 0;
  int chosen = -1;
  bool pair = false;
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    const Lobe& lobe = bsdf.lobes[i];
    if (!inSet(lobe, set) || !isActive(lobe, local.of(lobe).z)) continue;
    if (chosen >= 0) target -= share;
    chosen = i;
    pair = isInterfacePair(bsdf, i);
    share = lobe.selection;
    if (pair) share += bsdf.lobes[++i].selection;
    if (target < share) break;
  }
  const Lobe& lobe = bsdf.lobes[chosen];
  const ShadingFrame& frame = bsdf.frameOf(lobe);
  const Vec3f o = local.of(lobe);
  const float remapped = std::clamp(target / share, 0.f, 0x1.fffffep-1f);

  BsdfSample result;
  result.sharp = lobe.sharp;
  if (isDelta(lobe)) {
    const auto event = deltaEvent(lobe, o);
    if (!event) return std::nullopt;
    result.wi = normalize(frame.toWorld(event->wi));
    result.delta = true;
    result.transmission = isTransmission(lobe);
    result.eta = event->eta;
    result.weight = event->value * (total / share);
    // Straight on is straight on whatever the normals are.
    if (lobe.type == LobeType::null) {
      result.wi = -wo;
      return result;
    }
    if (!agrees(bsdf, frame, result.wi, event->wi.z)) return std::nullopt;
    if (transport == Transport::importance)
      result.weight *= importanceFactor(bsdf, lobe, wo, result.wi);
    result.weight *= bumpShadow(bsdf.baseNormal, frame.bumpAlpha2,
                                transport == Transport::radiance ? result.wi : wo);
    if (maxComponent(result.weight) <= 0) return std::nullopt;
    return result;
  }

  const auto i =
      pair ? sampleInterface(lobe, bsdf.lobes[chosen + 1], o, remapped, u) : sampleLobe(lobe, o, u);
  if (!i) return std::nullopt;
  result.wi = frame.toWorld(*i);
  if (!agrees(bsdf, frame, result.wi, i->z)) return std::nullopt;
  Local localI(bsdf, result.wi);
  localI.frames[lobe.frame] = *i;
  const FrameBits frames = agreeing(bsdf, result.wi, localI);
  const bool radiance = transport == Transport::radiance;
  BsdfValue value;
  if (radiance)
    value = evaluateMixture(bsdf, result.wi, local, localI, frames, set);
  else
    value.pdf = mixturePdf(bsdf, local, localI, frames, set);
  result.pdf = value.pdf / total;
  if (!(result.pdf > 0) || !std::isfinite(result.pdf)) return std::nullopt;
  result.transmission = i->z * o.z < 0;
  if (result.transmission && (pair || lobe.type == LobeType::microfacetTransmission))
    result.eta = relativeEta(lobe, o.z < 0);
  if (!radiance)
    value.value = evaluateLocal(bsdf, wo, result.wi, local, localI, frames, set, transport);
  result.weight = value.value / result.pdf;
  if (!(maxComponent(result.weight) > 0)) return std::nullopt;
  return result;
}

float throughBumps(const Bsdf& bsdf, const ShadingFrame& frame, Vec3f w, float cosPerturbed) {
  return agrees(bsdf, frame, w, cosPerturbed) ? bumpShadow(bsdf.baseNormal, frame.bumpAlpha2, w)
                                              : 0.f;
}

float arrivingShare(const Bsdf& bsdf, const ShadingFrame& frame, Vec3f wi) {
  const float cosShading = dot(wi, frame.n), cosGeometric = dot(wi, bsdf.ng);
  if (!(cosShading * cosGeometric > 0)) return 0;
  return cosShading / cosGeometric * bumpShadow(bsdf.baseNormal, frame.bumpAlpha2, wi);
}

bool hasLobes(const Bsdf& bsdf, LobeSet set) {
  for (int i = 0; i < bsdf.lobeCount; ++i)
    if (inSet(bsdf.lobes[i], set)) return true;
  return false;
}

bool onlyDelta(const Bsdf& bsdf) {
  for (int i = 0; i < bsdf.lobeCount; ++i)
    if (!isDelta(bsdf.lobes[i])) return false;
  return true;
}

Rgb albedo(const Bsdf& bsdf, Vec3f wo, LobeSet set) {
  Rgb sum{};
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    const Lobe& lobe = bsdf.lobes[i];
    if (inSet(lobe, set)) sum += lobeAlbedo(lobe, dot(wo, bsdf.frameOf(lobe).n));
  }
  return sum;
}

float roughness(const Lobe& lobe) {
  switch (lobe.type) {
    case LobeType::lambert:
    case LobeType::coatedDiffuse:
    case LobeType::principledDiffuse:
    case LobeType::diffuseTransmission:
    case LobeType::sheen:
      return 1;
    case LobeType::microfacetReflection:
    case LobeType::thinTransmission:
    case LobeType::microfacetTransmission:
    case LobeType::ward:
      return std::sqrt(lobe.alphaX * lobe.alphaY);
    case LobeType::phong:
      return std::sqrt(2 / (lobe.alphaX + 2));
    case LobeType::deltaReflection:
    case LobeType::deltaTransmission:
    case LobeType::null:
      break;
  }
  return 0;
}

void classify(Bsdf& bsdf, float specularLimit) {
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    Lobe& lobe = bsdf.lobes[i];
    lobe.sharp = isDelta(lobe) || roughness(lobe) < specularLimit;
  }
}

}  // namespace lobelia
