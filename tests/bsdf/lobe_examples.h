// Lobes and BSDFs that the tests of this room go through.
#pragma once

#include <string>
#include <vector>

#include "lobelia/bsdf/bsdf.h"
#include "lobelia/bsdf/captured.h"
#include "lobelia/bsdf/coat.h"
#include "lobelia/bsdf/layers.h"
#include "lobelia/bsdf/lobe_sampling.h"
#include "support/chi_squared.h"

namespace lobelia::test {

struct Example {
  std::string name;
  Bsdf bsdf;
  float spread = 1;      // angular width of its sharpest lobe
  bool lossless = true;  // may not create energy
};

inline Lobe microfacets(Distribution distribution, float alphaX, float alphaY, Fresnel fresnel) {
  Lobe lobe;
  lobe.type = LobeType::microfacetReflection;
  lobe.distribution = distribution;
  lobe.fresnel = fresnel;
  lobe.alphaX = alphaX, lobe.alphaY = alphaY;
  if (fresnel == Fresnel::conductor) lobe.eta = {0.2f, 0.92f, 1.1f}, lobe.k = {3.9f, 2.45f, 2.14f};
  if (fresnel == Fresnel::dielectric) lobe.eta = Rgb(1.5f);
  if (fresnel == Fresnel::schlick) lobe.eta = {0.9f, 0.6f, 0.04f};
  return lobe;
}

inline Bsdf roughGlass(Distribution distribution, float alphaX, float alphaY, float eta) {
  Lobe r = microfacets(distribution, alphaX, alphaY, Fresnel::dielectric);
  r.eta = Rgb(eta);
  r.interface = true;
  r.variant = 1;
  Lobe t = r;
  t.type = LobeType::microfacetTransmission;
  t.parameters.z = 1;
  Bsdf bsdf;
  bsdf.add(r);
  bsdf.add(t);
  return bsdf;
}

inline Bsdf single(const Lobe& lobe) {
  Bsdf bsdf;
  bsdf.add(lobe);
  return bsdf;
}

inline Lobe simple(LobeType type, float alphaX = 0, float alphaY = 0, int variant = 0) {
  Lobe lobe;
  lobe.type = type;
  lobe.alphaX = alphaX, lobe.alphaY = alphaY;
  lobe.variant = static_cast<uint8_t>(variant);
  return lobe;
}

inline Lobe clearcoat(float alpha) {
  Lobe lobe = microfacets(Distribution::gtr1, alpha, alpha, Fresnel::principled);
  lobe.weight = Rgb(0.25f);
  lobe.eta = Rgb(1.5f);
  lobe.tint = Rgb(0.04f);
  return lobe;
}

inline Lobe principledBase(float roughness, float flatness, float sheen) {
  Lobe lobe = simple(LobeType::principledDiffuse);
  lobe.k = {0.8f, 0.5f, 0.2f};
  lobe.parameters = {roughness, flatness, sheen};
  lobe.tint = {0.9f, 1.f, 1.1f};
  return lobe;
}

inline Lobe roughCoated(float alpha) {
  Lobe lobe = simple(LobeType::coatedDiffuse, 0, 0, 1);
  lobe.eta = Rgb(1.5f);
  lobe.table = roughCoat(Distribution::ggx, alpha, 1.5f).transmittance.data();
  return lobe;
}

inline Lobe smoothCoated() {
  Lobe lobe = simple(LobeType::coatedDiffuse);
  lobe.eta = Rgb(1.5f);
  return lobe;
}

// Under a rough dielectric coat.
inline Lobe underCoat(Lobe lobe) {
  const Lobe coat = microfacets(Distribution::ggx, 0.2f, 0.2f, Fresnel::dielectric);
  lobe.variant = static_cast<uint8_t>(lobe.variant | kCoated);
  lobe.table = layerTransmittance({&coat, 1}).data();
  return lobe;
}

// One of every kind at several roughnesses.
inline std::vector<Example> examples() {
  std::vector<Example> all;
  const auto add = [&](std::string name, const Bsdf& bsdf, float spread, bool lossless = true) {
    all.push_back({std::move(name), bsdf, spread, lossless});
  };
  const struct {
    Distribution distribution;
    const char* name;
  } distributions[] = {{Distribution::ggx, "ggx"},
                       {Distribution::beckmann, "beckmann"},
                       {Distribution::phong, "phong microfacets"}};
  const float alphas[][2] = {{0.02f, 0.02f}, {0.1f, 0.1f}, {0.3f, 0.3f}, {1, 1}, {0.05f, 0.4f}};
  for (const auto& d : distributions) {
    for (const auto& a : alphas) {
      const std::string name =
          std::string(d.name) + " " + std::to_string(a[0]) + " " + std::to_string(a[1]);
      const float spread = std::min(a[0], a[1]);
      // The Phong distribution borrows Beckmann's masking, which does not bound its energy.
      const bool lossless = d.distribution != Distribution::phong || spread < 0.2f;
      add(name + " conductor", single(microfacets(d.distribution, a[0], a[1], Fresnel::conductor)),
          spread, lossless);
      add(name + " glass", roughGlass(d.distribution, a[0], a[1], 1.5f), spread, lossless);
    }
  }
  add("clearcoat 0.1", single(clearcoat(0.1f)), 0.1f);
  add("clearcoat 0.01", single(clearcoat(0.01f)), 0.01f);
  add("lambert", single(simple(LobeType::lambert)), 1);
  add("diffuse transmission", single(simple(LobeType::diffuseTransmission)), 1);
  add("coated diffuse", single(smoothCoated()), 1);
  add("rough coated diffuse", single(roughCoated(0.3f)), 1);
  add("principled diffuse", single(principledBase(0.7f, 0.3f, 0.5f)), 1, false);
  for (const float n : {0.f, 5.f, 100.f, 5000.f})
    add("phong " + std::to_string(n), single(simple(LobeType::phong, n)), std::sqrt(2 / (n + 2)));
  for (int variant = 0; variant < 3; ++variant)
    for (const auto& a : alphas)
      add("ward " + std::to_string(variant) + " " + std::to_string(a[0]) + " " +
              std::to_string(a[1]),
          single(simple(LobeType::ward, a[0], a[1], variant)), std::min(a[0], a[1]), false);
  for (const float sharpness : {20000.f, 200.f, 20.f, 2.f, 0.5f}) {
    const Rgb whole(1 / projectedIntegral(sharpness));
    for (const float ior : {1.f, 1.5f})
      add("spherical Gaussian " + std::to_string(sharpness) + " ior " + std::to_string(ior),
          single(capturedLobe(whole, sharpness, ior)), std::sqrt(2 / sharpness));
  }
  // Under a dielectric's Fresnel term all of it may be given to both parts.
  Bsdf captured;
  captured.add(capturedDiffuse(Rgb(0.9f), 1.5f));
  captured.add(capturedLobe(Rgb(0.5f / projectedIntegral(300)), 300, 1.5f));
  captured.add(capturedLobe(Rgb(0.5f / projectedIntegral(8)), 8, 1.5f));
  add("captured", captured, 0.08f);
  for (const float alpha : {0.08f, 0.3f, 0.9f})
    add("sheen " + std::to_string(alpha), single(simple(LobeType::sheen, alpha)), 1);
  add("coated sheen", single(underCoat(simple(LobeType::sheen, 0.4f))), 1);
  for (const auto& a : {std::pair(0.05f, 0.05f), std::pair(0.4f, 0.15f)}) {
    Lobe sheet = microfacets(Distribution::ggx, a.first, a.second, Fresnel::dielectric);
    sheet.type = LobeType::thinTransmission;
    sheet.twoSided = true;
    const std::string name = std::to_string(a.first);
    add("thin transmission " + name, single(sheet), a.second);
    add("coated thin transmission " + name, single(underCoat(sheet)), a.second);
    Bsdf glass = roughGlass(Distribution::ggx, a.first, a.second, 1.5f);
    for (int i = 0; i < 2; ++i) glass.lobes[i] = underCoat(glass.lobes[i]);
    add("coated glass " + name, glass, a.second);
    Lobe metal = microfacets(Distribution::ggx, a.first, a.second, Fresnel::coatedConductor);
    metal.eta = Rgb(0.2f), metal.k = Rgb(2.6f);
    metal.parameters.x = 1.5f;
    add("coated conductor " + name, single(underCoat(metal)), a.second);
  }
  Bsdf mixture;
  mixture.add(simple(LobeType::lambert));
  mixture.add(microfacets(Distribution::ggx, 0.2f, 0.1f, Fresnel::schlick));
  mixture.add(simple(LobeType::deltaReflection));
  for (int i = 0; i < 3; ++i) mixture.lobes[i].weight = Rgb(0.3f);
  mixture.lobes[1].selection = 2;
  add("mixture", mixture, 0.1f);
  return all;
}

// Where the energy of a BSDF goes: an axis that its sharp lobes are about, and the side (sign of z)
// to which that holds. Integrate and test each part by its own chart.
struct Part {
  Vec3f axis;
  float side;
  float spread;
  bool holds(Vec3f w) const { return w.z * side >= 0; }
};
inline std::vector<Part> partsOf(const Example& e, Vec3f wo) {
  const float sign = wo.z < 0 ? -1.f : 1.f;
  std::vector<Part> parts{{{-wo.x, -wo.y, wo.z}, sign, e.spread}};
  const Lobe& first = e.bsdf.lobes[0];
  Vec3f through(-wo.x, -wo.y, -wo.z);
  float spread = e.spread;
  if (first.interface) {
    const Vec3f n(0, 0, sign);
    if (const auto refracted = refract(wo, n, wo.z > 0 ? first.eta.x : 1 / first.eta.x)) {
      through = normalize(*refracted);
      spread *= 0.3f;
    }
  }
  parts.push_back({through, -sign, spread});
  return parts;
}

// Scattered share of importance that arrives from wo, by adaptive quadrature over the sphere.
inline Rgb quadratureAlbedo(const Example& e, Vec3f wo) {
  Values<3> total{};
  for (const Part& part : partsOf(e, wo)) {
    const auto f = [&](Vec3f wi) {
      if (!part.holds(wi)) return Values<3>{};
      const Rgb v = evaluate(e.bsdf, wo, wi, LobeSet::all, Transport::importance);
      return Values<3>{static_cast<double>(v.x), static_cast<double>(v.y),
                       static_cast<double>(v.z)};
    };
    const Values<3> v =
        integrateSphere<3>(SphereChart(part.axis, static_cast<double>(part.spread)), f, 1e-5);
    for (size_t k = 0; k < 3; ++k) total[k] += v[k];
  }
  return {static_cast<float>(total[0]), static_cast<float>(total[1]), static_cast<float>(total[2])};
}

inline Vec3f directionAt(float cosTheta, float phi) {
  const float s = std::sqrt(1 - cosTheta * cosTheta);
  return {s * std::cos(phi), s * std::sin(phi), cosTheta};
}

}  // namespace lobelia::test
