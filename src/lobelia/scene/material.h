// Materials as a scene file describes them: a tree of tagged records. makeBsdf() (scene/shading.h)
// turns one into a Bsdf value at a hit.
#pragma once

#include <string>
#include <vector>

#include "lobelia/bsdf/lobe.h"
#include "lobelia/scene/texture.h"

namespace lobelia {

enum class MaterialType : uint8_t {
  diffuse, conductor, roughConductor, dielectric, thinDielectric, roughDielectric, plastic,
  roughPlastic, principled, phong, ward, diffuseTransmitter,
  metallicRoughness,   // glTF 2.0 with its extensions; isSpecularGlossiness: the older workflow
  coatedConductor,     // PBRT-v4: a rough conductor under a rough dielectric coat
  sphericalGaussians,  // captured reflectance: a diffuse part and a sum of SG lobes [P000 eq. 5]
  // these wrap others
  twoSided,   // a: front, b: back (a again when not given)
  mask,       // a with opacity
  blend,      // a (1 - weight) + b weight
  bump,       // a with the height map `map` times `scale`
  normalMap,  // a with the normal map `map` (raw, 0..1)
  null,       // an invisible boundary
};

// A lobe of captured reflectance: amplitude exp(sharpness (h.n - 1)) over the half vector h [Wang09],
// times the shadowing and Fresnel terms of bsdf/captured.h (Material::ior; 1: no Fresnel term).
struct CapturedLobe {
  ColorParam amplitude = Rgb(0.f);
  FloatParam sharpness = 50.f;
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

  // metallicRoughness (glTF 2.0): diffuse: base colour (specularGlossiness: diffuse colour);
  // specular: colour of the dielectric's normal reflectance (specularGlossiness: the reflectance
  // itself); roughness, metallic, ior, specTrans (transmission), clearcoat, anisotropic (strength,
  // along anisotropicRotation from the tangent), as glTF defines them
  bool isSpecularGlossiness = false;
  FloatParam specularStrength = 1.f;
  ColorParam sheenColor = Rgb(0.f);
  FloatParam sheenRoughness = 0.f;
  FloatParam clearcoatRoughness = 0.f;
  TextureHandle clearcoatNormal;         // none: the surface's normals, whatever wraps this
  FloatParam anisotropicRotation = 0.f;  // radians, counter-clockwise
  TextureHandle anisotropicDirection;    // glTF's texture: r, g: direction in [0,1], b: strength
  bool thin = false;                     // transmission without refraction (no volume)

  // coatedConductor: eta, k, alphaU, alphaV, specular of the conductor; of the coat:
  FloatParam coatAlphaU = 0.f, coatAlphaV = 0.f;
  float coatIor = 1.5f;

  // dielectrics and metallicRoughness with transmission: absorption inside, per scene unit
  // (Beer-Lambert); applied to a path that meets the surface from behind
  Rgb absorption{};

  std::vector<CapturedLobe> capturedLobes;  // sphericalGaussians

  FloatParam opacity = 1.f;              // mask
  FloatParam weight = 0.5f;              // blend
  TextureHandle map;                     // bump, normalMap
  float scale = 1;                       // bump
};

}  // namespace lobelia
