// Materials as a scene file describes them: a tree of tagged records. makeBsdf() (scene/shading.h)
// turns one into a Bsdf value at a hit.
#pragma once

#include <string>

#include "lobelia/bsdf/lobe.h"
#include "lobelia/scene/texture.h"

namespace lobelia {

enum class MaterialType : uint8_t {
  diffuse, conductor, roughConductor, dielectric, thinDielectric, roughDielectric, plastic,
  roughPlastic, principled, phong, ward, diffuseTransmitter,
  // these wrap others
  twoSided,   // a: front, b: back (a again when not given)
  mask,       // a with opacity
  blend,      // a (1 - weight) + b weight
  bump,       // a with the height map `map` times `scale`
  normalMap,  // a with the normal map `map` (raw, 0..1)
  null,       // an invisible boundary
};

// Defaults are Mitsuba's.
struct Material {
  MaterialType type = MaterialType::diffuse;
  std::string name;
  MaterialHandle a, b;

  ColorParam diffuse = Rgb(0.5f);        // diffuse/plastic/phong/ward reflectance; principled: base colour
  ColorParam specular = Rgb(1.f);        // specular reflectance
  ColorParam transmittance = Rgb(1.f);   // specular transmittance
  ColorParam eta = Rgb(0.f), k = Rgb(1.f);  // conductor: eta = 0, k = 1 is a perfect mirror
  float ior = 1.5046f;                   // inside / outside, dielectrics, plastics, principled
  Distribution distribution = Distribution::beckmann;
  FloatParam alphaU = 0.1f, alphaV = 0.1f;  // phong: alphaU is the exponent
  int wardVariant = 2;
  bool nonlinear = false;                // plastics: colour shifts by internal scattering

  // principled, Mitsuba's names
  FloatParam roughness = 0.5f, anisotropic = 0.f, metallic = 0.f, specTrans = 0.f, specTint = 0.f,
             sheen = 0.f, sheenTint = 0.f, flatness = 0.f, clearcoat = 0.f, clearcoatGloss = 0.f;

  FloatParam opacity = 1.f;              // mask
  FloatParam weight = 0.5f;              // blend
  TextureHandle map;                     // bump, normalMap
  float scale = 1;                       // bump
};

}  // namespace lobelia
