// Mitsuba 3's principled BSDF (after Burley 2012 and 2015): diffuse with retro-reflection, flatness
// and sheen; a GGX lobe whose Fresnel factor blends exact dielectric, tinted and metallic Schlick
// terms; GGX transmission; a GTR1 clearcoat. Sampling shares are Mitsuba's: diffuse (1 - metallic)
// (1 - transmission), specular 1, clearcoat a quarter.
#include <cmath>

#include "lobelia/scene/material_lobes.h"

namespace lobelia {
namespace {

float unitParam(const Scene& scene, const FloatParam& param, const TextureContext& at) {
  return std::clamp(evaluate(scene, param, at), 0.f, 1.f);
}

}  // namespace

void addPrincipledLobes(const Scene& scene, const Material& material, const TextureContext& at,
                        float weight, bool twoSided, Bsdf& bsdf) {
  const Rgb base = max(evaluate(scene, material.diffuse, at), Rgb(0.f));
  const float roughness = unitParam(scene, material.roughness, at);
  const float metallic = unitParam(scene, material.metallic, at);
  const float specTrans = unitParam(scene, material.specTrans, at);
  const float specTint = unitParam(scene, material.specTint, at);
  const float sheen = std::max(evaluate(scene, material.sheen, at), 0.f);
  const float clearcoat = std::max(evaluate(scene, material.clearcoat, at), 0.f);
  const float diffuseShare = (1 - metallic) * (1 - specTrans);
  const float transmissionShare = (1 - metallic) * specTrans;
  const float lum = luminance(base);
  const Rgb tint = lum > 0 ? base / lum : Rgb(1.f);
  // An index of one has no micro-normals to refract at.
  const float eta = specTrans > 0 && material.ior == 1 ? 1.001f : material.ior;

  if (diffuseShare > 0) {
    Lobe diffuse;
    diffuse.type = LobeType::principledDiffuse;
    diffuse.twoSided = twoSided;
    diffuse.weight = Rgb(weight);
    diffuse.k = base * diffuseShare;
    diffuse.parameters = {roughness, unitParam(scene, material.flatness, at),
                          sheen * (1 - metallic)};
    diffuse.tint = lerp(Rgb(1.f), tint, unitParam(scene, material.sheenTint, at));
    diffuse.selection = weight * diffuseShare;
    bsdf.add(diffuse);
  }

  const float aspect = std::sqrt(1 - 0.9f * unitParam(scene, material.anisotropic, at));
  Lobe specular;
  specular.type = LobeType::microfacetReflection;
  specular.distribution = Distribution::ggx;
  specular.fresnel = Fresnel::principled;
  specular.twoSided = twoSided;
  specular.alphaX = std::max(0.001f, roughness * roughness / aspect);
  specular.alphaY = std::max(0.001f, roughness * roughness * aspect);
  specular.weight = Rgb(weight);
  specular.eta = Rgb(eta);
  specular.parameters = {(1 - metallic) * (1 - specTint), transmissionShare, 0};
  specular.tint = base * metallic + tint * ((1 - metallic) * specTint * sqr((eta - 1) / (eta + 1)));
  specular.selection = weight;
  if (transmissionShare > 0) {
    specular.interface = true;
    specular.variant = 1;
    specular.selection = 0.5f * weight;
    Lobe transmission = specular;
    transmission.type = LobeType::microfacetTransmission;
    transmission.fresnel = Fresnel::dielectric;
    transmission.weight =
        Rgb(std::sqrt(base.x), std::sqrt(base.y), std::sqrt(base.z)) * (transmissionShare * weight);
    transmission.parameters = {0, 0, transmissionShare};
    transmission.tint = {};
    bsdf.add(specular);
    bsdf.add(transmission);
  } else {
    bsdf.add(specular);
  }

  if (clearcoat > 0) {
    Lobe coat;
    coat.type = LobeType::microfacetReflection;
    coat.distribution = Distribution::gtr1;
    coat.fresnel = Fresnel::principled;  // plain Schlick from 0.04 to 1
    coat.twoSided = twoSided;
    coat.alphaX = coat.alphaY =
        0.1f + (0.001f - 0.1f) * unitParam(scene, material.clearcoatGloss, at);
    coat.weight = Rgb(0.25f * clearcoat * weight);
    coat.eta = Rgb(eta);
    coat.tint = Rgb(0.04f);
    coat.selection = 0.25f * clearcoat * weight;
    bsdf.add(coat);
  }
}

}  // namespace lobelia
