#include "lobelia/io/mitsuba/design_changes.h"

#include <algorithm>

namespace lobelia::io::mitsuba {
namespace {

bool same(const ColorParam& a, const ColorParam& b) {
  return a.texture == b.texture && (a.texture.valid() || a.value == b.value);
}
bool same(const FloatParam& a, const FloatParam& b) {
  return a.texture == b.texture && (a.texture.valid() || a.value == b.value);
}

bool sameOwn(const Material& a, const Material& b) {
  constexpr ColorParam Material::*kColors[] = {
      &Material::diffuse, &Material::specular, &Material::transmittance,
      &Material::eta,     &Material::k,        &Material::sheenColor};
  constexpr FloatParam Material::*kScalars[] = {&Material::alphaU,
                                                &Material::alphaV,
                                                &Material::roughness,
                                                &Material::anisotropic,
                                                &Material::metallic,
                                                &Material::specTrans,
                                                &Material::specTint,
                                                &Material::sheen,
                                                &Material::sheenTint,
                                                &Material::flatness,
                                                &Material::clearcoat,
                                                &Material::clearcoatGloss,
                                                &Material::specularStrength,
                                                &Material::sheenRoughness,
                                                &Material::clearcoatRoughness,
                                                &Material::anisotropicRotation,
                                                &Material::coatAlphaU,
                                                &Material::coatAlphaV,
                                                &Material::opacity,
                                                &Material::weight};
  const auto equal = [&](auto member) { return same(a.*member, b.*member); };
  return a.type == b.type && std::all_of(std::begin(kColors), std::end(kColors), equal) &&
         std::all_of(std::begin(kScalars), std::end(kScalars), equal) && a.ior == b.ior &&
         a.distribution == b.distribution && a.wardVariant == b.wardVariant &&
         a.nonlinear == b.nonlinear && a.isSpecularGlossiness == b.isSpecularGlossiness &&
         a.clearcoatNormal == b.clearcoatNormal &&
         a.anisotropicDirection == b.anisotropicDirection && a.thin == b.thin &&
         a.coatIor == b.coatIor && a.absorption == b.absorption && a.map == b.map &&
         a.scale == b.scale &&
         std::equal(a.capturedLobes.begin(), a.capturedLobes.end(), b.capturedLobes.begin(),
                    b.capturedLobes.end(), [](const CapturedLobe& x, const CapturedLobe& y) {
                      return same(x.amplitude, y.amplitude) && same(x.sharpness, y.sharpness);
                    });
}

}  // namespace

bool sameMaterial(const Material& a, const Material& b) {
  return sameOwn(a, b) && a.a == b.a && a.b == b.b;
}

bool sameEmitter(const Emitter& a, const Emitter& b) {
  return a.type == b.type && a.name == b.name && a.group == b.group &&
         a.toWorld.to == b.toWorld.to && same(a.radiance, b.radiance) && a.scale == b.scale &&
         a.image == b.image && a.cutoff == b.cutoff && a.beamWidth == b.beamWidth &&
         a.pattern == b.pattern && a.fov == b.fov && a.direction == b.direction &&
         a.angularRadius == b.angularRadius;
}

bool sameCamera(const Camera& a, const Camera& b) {
  const auto keys = [](const CameraKey& x, const CameraKey& y) {
    return x.time == y.time && x.toWorld.to == y.toWorld.to;
  };
  return a.type == b.type && a.toWorld.to == b.toWorld.to && a.fovX == b.fovX &&
         a.principalPointOffset == b.principalPointOffset && a.nearClip == b.nearClip &&
         a.farClip == b.farClip && a.apertureRadius == b.apertureRadius &&
         (a.focusDistance == b.focusDistance || a.apertureRadius == 0) && a.width == b.width &&
         a.height == b.height && a.cropX0 == b.cropX0 && a.cropY0 == b.cropY0 &&
         a.cropX1 == b.cropX1 && a.cropY1 == b.cropY1 && a.filter == b.filter &&
         a.filterRadius == b.filterRadius && a.spp == b.spp &&
         std::equal(a.path.begin(), a.path.end(), b.path.begin(), b.path.end(), keys);
}

}  // namespace lobelia::io::mitsuba
