// The definitions are those of Mitsuba 3 and, for phong, ward and the diffuse transmitter, of
// Mitsuba 0.6; formulas at the kernels (bsdf/kernels-inl.h). Deviations: a roughness texture on a
// rough plastic's coat is rounded to 1/128 for its tables; an interface without refraction (index
// 1) is straight transmission.
#include "lobelia/scene/material_lobes.h"

#include <cmath>

#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/bsdf/coat.h"
#include "lobelia/scene/lobe_builder.h"

namespace lobelia {
namespace {

void addDiffuse(const Builder& b) {
  b.add(b.lobe(LobeType::lambert), b.color(b.material.diffuse), b.weight);
}

// Mitsuba 0.6 has transmission alone (there m.diffuse is black), PBRT reflection as well.
void addDiffuseTransmitter(const Builder& b) {
  const Rgb reflectance = b.color(b.material.diffuse);
  Lobe r = b.lobe(LobeType::lambert);
  r.twoSided = true;
  b.add(r, reflectance, mean(reflectance));
  Lobe l = b.lobe(LobeType::diffuseTransmission);
  l.twoSided = true;
  const Rgb transmittance = b.color(b.material.transmittance);
  b.add(l, transmittance, mean(transmittance));
}

void addConductor(const Builder& b, bool rough) {
  Lobe l =
      rough ? b.microfacets(LobeType::microfacetReflection) : b.lobe(LobeType::deltaReflection);
  l.fresnel = Fresnel::conductor;
  l.eta = evaluate(b.scene, b.material.eta, b.at);
  l.k = evaluate(b.scene, b.material.k, b.at);
  b.add(l, b.color(b.material.specular), b.weight);
}

// Sampling shares of smooth interfaces follow the Fresnel reflectance of this very direction.
void addDielectric(const Builder& b) {
  Lobe r = b.lobe(LobeType::deltaReflection);
  r.fresnel = Fresnel::dielectric;
  r.interface = true;
  r.eta = Rgb(b.material.ior);
  Lobe t = r;
  t.type = LobeType::deltaTransmission;
  const float reflectance = lobeAlbedo(r, b.cosThetaO).x;
  b.add(r, b.color(b.material.specular), b.weight * reflectance);
  b.add(t, b.color(b.material.transmittance), b.weight * (1 - reflectance));
}

void addThinDielectric(const Builder& b) {
  Lobe r = b.lobe(LobeType::deltaReflection);
  r.fresnel = Fresnel::thinDielectric;
  r.twoSided = true;
  r.eta = Rgb(b.material.ior);
  Lobe t = r;
  t.type = LobeType::null;
  const float reflectance = lobeAlbedo(r, b.cosThetaO).x;
  b.add(r, b.color(b.material.specular), b.weight * reflectance);
  b.add(t, b.color(b.material.transmittance), b.weight * (1 - reflectance));
}

void addRoughDielectric(const Builder& b) {
  if (std::abs(b.material.ior - 1) < 1e-4f) {
    b.addStraight(b.color(b.material.transmittance));
    return;
  }
  Lobe r = b.microfacets(LobeType::microfacetReflection);
  r.fresnel = Fresnel::dielectric;
  r.interface = true;
  r.eta = Rgb(b.material.ior);
  Lobe t = r;
  t.type = LobeType::microfacetTransmission;
  const Rgb reflectance = b.color(b.material.specular);
  const Rgb transmittance = b.color(b.material.transmittance);
  // Where both take part one choice of micro-normal serves both.
  if (maxComponent(reflectance) > 0 && maxComponent(transmittance) > 0) {
    r.variant = t.variant = 1;
    t.parameters.z = 1;
  }
  b.add(r, reflectance, 0.5f * b.weight);
  b.add(t, transmittance, 0.5f * b.weight);
}

// Specular coat over a diffuse base; transmittance: of the coat for wo; internal: its reflectance
// for diffuse light from below.
void addPlastic(const Builder& b, Lobe coat, Lobe base, float transmittance, float internal) {
  coat.fresnel = Fresnel::dielectric;
  coat.eta = base.eta = Rgb(b.material.ior);
  const Rgb specular = b.color(b.material.specular);
  const Rgb diffuse = max(evaluate(b.scene, b.material.diffuse, b.at), Rgb(0.f));
  const Rgb lost = b.material.nonlinear ? diffuse * internal : Rgb(internal);
  const Rgb below = diffuse / max(Rgb(1.f) - lost, Rgb(1e-4f)) * (b.weight / sqr(b.material.ior));
  const float s = mean(specular), d = mean(diffuse) * b.weight;
  b.add(coat, specular, (1 - transmittance) * s);
  b.add(base, below, transmittance * d);
}

void addSmoothPlastic(const Builder& b) {
  Lobe coat = b.lobe(LobeType::deltaReflection);
  coat.fresnel = Fresnel::dielectric;
  coat.eta = Rgb(b.material.ior);
  const float reflectance = lobeAlbedo(coat, std::abs(b.cosThetaO)).x;
  addPlastic(b, coat, b.lobe(LobeType::coatedDiffuse), 1 - reflectance,
             fresnelDiffuseReflectance(1 / b.material.ior));
}

void addRoughPlastic(const Builder& b) {
  Lobe coat = b.microfacets(LobeType::microfacetReflection);
  // The tables are isotropic: the roughness whose slopes have the same variance.
  float alpha = std::sqrt(0.5f * (sqr(coat.alphaX) + sqr(coat.alphaY)));
  if (b.material.alphaU.texture.valid() || b.material.alphaV.texture.valid())
    alpha = std::max(std::round(alpha * 128) / 128, 1.f / 256);
  const RoughCoat& table = roughCoat(coat.distribution, alpha, b.material.ior);
  Lobe base = b.lobe(LobeType::coatedDiffuse);
  base.variant = 1;
  base.table = table.transmittance.data();
  const float x = std::min(std::abs(b.cosThetaO), 1.f) * (kTransmittanceSize - 1);
  const auto nearest = static_cast<size_t>(std::lround(x));
  addPlastic(b, coat, base, std::clamp(table.transmittance[nearest], 0.f, 1.f),
             table.internalReflectance);
}

// phong and ward: a glossy lobe over a diffuse one, side by side. Where they add up to more than
// one both are scaled to 0.99 in all, as Mitsuba 0.6 does (there by the maxima of textures, here by
// their values).
void addGlossy(const Builder& b, Lobe glossy) {
  Rgb diffuse = b.color(b.material.diffuse), specular = b.color(b.material.specular);
  const float most = maxComponent(diffuse + specular);
  if (most > b.weight) {
    const float scale = 0.99f * b.weight / most;
    diffuse *= scale, specular *= scale;
  }
  b.add(b.lobe(LobeType::lambert), diffuse, mean(diffuse));
  b.add(glossy, specular, mean(specular));
}

void addPhong(const Builder& b) {
  Lobe l = b.lobe(LobeType::phong);
  l.alphaX = l.alphaY = std::max(evaluate(b.scene, b.material.alphaU, b.at), 0.f);
  addGlossy(b, l);
}

void addWard(const Builder& b) {
  Lobe l = b.lobe(LobeType::ward);
  l.variant = static_cast<uint8_t>(b.material.wardVariant);
  l.alphaX = b.alpha(b.material.alphaU), l.alphaY = b.alpha(b.material.alphaV);
  addGlossy(b, l);
}

}  // namespace

void addLobes(const Builder& b) {
  switch (b.material.type) {
    case MaterialType::diffuse:
      return addDiffuse(b);
    case MaterialType::conductor:
      return addConductor(b, false);
    case MaterialType::roughConductor:
      return addConductor(b, true);
    case MaterialType::dielectric:
      return addDielectric(b);
    case MaterialType::thinDielectric:
      return addThinDielectric(b);
    case MaterialType::roughDielectric:
      return addRoughDielectric(b);
    case MaterialType::plastic:
      return addSmoothPlastic(b);
    case MaterialType::roughPlastic:
      return addRoughPlastic(b);
    case MaterialType::principled:
      return addPrincipledLobes(b);
    case MaterialType::sphericalGaussians:
      return addCapturedLobes(b);
    case MaterialType::phong:
      return addPhong(b);
    case MaterialType::ward:
      return addWard(b);
    case MaterialType::diffuseTransmitter:
      return addDiffuseTransmitter(b);
    case MaterialType::metallicRoughness:
      return addMetallicRoughnessLobes(b);
    case MaterialType::coatedConductor:
      return addCoatedConductorLobes(b);
    case MaterialType::null:
      return b.addStraight(Rgb(b.weight));
    case MaterialType::twoSided:
    case MaterialType::mask:
    case MaterialType::blend:
    case MaterialType::bump:
    case MaterialType::normalMap:
      break;  // make_bsdf.cpp
  }
}

}  // namespace lobelia
