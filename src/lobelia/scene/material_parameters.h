// Every parameter of a material that a texture may drive, in one list: for hashes, comparisons and
// whoever renumbers textures. A new parameter is added here.
#pragma once

#include "lobelia/scene/material.h"

namespace lobelia {

// f(ColorParam&), or of a const Material f(const ColorParam&). Without those of captured lobes.
template <class AnyMaterial, class F>
void eachColorParam(AnyMaterial& m, const F& f) {
  for (auto* p : {&m.diffuse, &m.specular, &m.transmittance, &m.eta, &m.k, &m.sheenColor}) f(*p);
}
// The same of FloatParam.
template <class AnyMaterial, class F>
void eachFloatParam(AnyMaterial& m, const F& f) {
  for (auto* p : {&m.alphaU,
                  &m.alphaV,
                  &m.roughness,
                  &m.anisotropic,
                  &m.metallic,
                  &m.specTrans,
                  &m.specTint,
                  &m.sheen,
                  &m.sheenTint,
                  &m.flatness,
                  &m.clearcoat,
                  &m.clearcoatGloss,
                  &m.opacity,
                  &m.weight,
                  &m.specularStrength,
                  &m.sheenRoughness,
                  &m.clearcoatRoughness,
                  &m.anisotropicRotation,
                  &m.coatAlphaU,
                  &m.coatAlphaV})
    f(*p);
}

}  // namespace lobelia
