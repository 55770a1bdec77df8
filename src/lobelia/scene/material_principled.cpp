// Mitsuba 3's principled BSDF (after Burley 2012 and 2015): diffuse with retro-reflection, flatness
// and sheen; a GGX lobe whose Fresnel factor blends exact dielectric, tinted and metallic Schlick
// terms; GGX transmission; a GTR1 clearcoat. Sampling shares are Mitsuba's: diffuse (1 - metallic)
// (1 - transmission), specular 1, clearcoat a quarter.
#include <cmath>

#include "lobelia/scene/lobe_builder.h"

namespace lobelia {

void addPrincipledLobes(const Builder& b) {
  const Material& material = b.material;
  const float weight = b.weight;
  const Rgb base = max(evaluate(b.scene, material.diffuse, b.at), Rgb(0.f));
  const float roughness = b.unit(material.roughness);
  const float metallic = b.unit(material.metallic);
  const float specTrans = b.unit(material.specTrans);
  const float specTint = b.unit(material.specTint);
  const float sheen = std::max(evaluate(b.scene, material.sheen, b.at), 0.f);
  const float clearcoat = std::max(evaluate(b.scene, material.clearcoat, b.at), 0.f);
  const float diffuseShare = (1 - metallic) * (1 - specTrans);
  const float transmissionShare = (1 - metallic) * specTrans;
  const float lum = luminance(base);
  const Rgb tint = lum > 0 ? base / lum : Rgb(1.f);
  // An index of one has no micro-normals to refract at.
  const float eta = specTrans > 0 && material.ior == 1 ? 1.001f : material.ior;

  if (diffuseShare > 0) {
    Lobe diffuse = b.lobe(LobeType::principledDiffuse);
    diffuse.weight = Rgb(weight);
    diffuse.k = base * diffuseShare;
    diffuse.parameters = {roughness, b.unit(material.flatness), sheen * (1 - metallic)};
    diffuse.tint = lerp(Rgb(1.f), tint, b.unit(material.sheenTint));
    diffuse.selection = weight * diffuseShare;
    b.bsdf.add(diffuse);
  }

  const float aspect = std::sqrt(1 - 0.9f * b.unit(material.anisotropic));
  Lobe specular = b.lobe(LobeType::microfacetReflection);
  specular.distribution = Distribution::ggx;
  specular.fresnel = Fresnel::principled;
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
    b.bsdf.add(specular);
    b.bsdf.add(transmission);
  } else {
    b.bsdf.add(specular);
  }

  if (clearcoat > 0) {
    Lobe coat = b.lobe(LobeType::microfacetReflection);
    coat.distribution = Distribution::gtr1;
    coat.fresnel = Fresnel::principled;  // plain Schlick from 0.04 to 1
    coat.alphaX = coat.alphaY = 0.1f + (0.001f - 0.1f) * b.unit(material.clearcoatGloss);
    coat.weight = Rgb(0.25f * clearcoat * weight);
    coat.eta = Rgb(eta);
    coat.tint = Rgb(0.04f);
    coat.selection = 0.25f * clearcoat * weight;
    b.bsdf.add(coat);
  }
}

}  // namespace lobelia
