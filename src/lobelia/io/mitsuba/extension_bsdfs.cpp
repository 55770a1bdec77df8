// Materials that Mitsuba does not have, under names of our own (docs/manual.md): what converted
// glTF and PBRT scenes need.
#include "lobelia/io/mitsuba/reader.h"

namespace lobelia::io::mitsuba {

// Of the inside of a closed surface, per unit of length.
Rgb Reader::absorption(Object& object) {
  return constantColor(object, "absorption", Rgb(0.f), SpectrumUse::unbounded);
}

TextureHandle Reader::textureOnly(Object& object, const std::string& name) {
  const Element* e = object.property(name);
  if (!e) return {};
  const ColorParam param = color(*e, SpectrumUse::unbounded);
  if (!param.texture.valid()) throw InputError(e->where, "'" + name + "' must be a texture");
  return param.texture;
}

// The parameters of glTF 2.0 and its extensions, with its defaults.
Material Reader::metallicRoughness(Object& object) {
  Material m;
  m.type = MaterialType::metallicRoughness;
  m.isSpecularGlossiness = object.boolean("specular_glossiness", false);
  m.diffuse = color(object, "base_color", Rgb(1.f));
  m.roughness = scalar(object, "roughness", 1);
  m.metallic = scalar(object, "metallic", m.isSpecularGlossiness ? 0.f : 1.f);
  m.ior = object.number("ior", 1.5f);
  m.specular = color(object, "specular_color", Rgb(1.f), SpectrumUse::unbounded);
  m.specularStrength = scalar(object, "specular", 1);
  m.specTrans = scalar(object, "transmission", 0);
  m.thin = object.boolean("thin", false);
  m.absorption = absorption(object);
  m.anisotropic = scalar(object, "anisotropy", 0);
  m.anisotropicRotation = scalar(object, "anisotropy_rotation", 0);
  m.anisotropicDirection = textureOnly(object, "anisotropy_direction");
  m.clearcoat = scalar(object, "clearcoat", 0);
  m.clearcoatRoughness = scalar(object, "clearcoat_roughness", 0);
  m.clearcoatNormal = textureOnly(object, "clearcoat_normal");
  m.sheenColor = color(object, "sheen_color", Rgb(0.f));
  m.sheenRoughness = scalar(object, "sheen_roughness", 0);
  return m;
}

Material Reader::coatedConductor(Object& object) {
  Material m;
  m.type = MaterialType::coatedConductor;
  conductor(object, &m);
  m.specular = color(object, "specular_reflectance", Rgb(1.f));
  roughness(object, &m);
  m.coatIor = namedOrNumber(object, "coat_ior", "bk7");
  const FloatParam alpha = scalar(object, "coat_alpha", 0);
  m.coatAlphaU = object.has("coat_alpha_u") ? scalar(object, "coat_alpha_u", 0) : alpha;
  m.coatAlphaV = object.has("coat_alpha_v") ? scalar(object, "coat_alpha_v", 0) : alpha;
  return m;
}

}  // namespace lobelia::io::mitsuba
