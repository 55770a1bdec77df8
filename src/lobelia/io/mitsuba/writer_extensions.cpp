// The materials of extension_bsdfs.cpp in the Mitsuba writer. Defaults are left out.
#include "lobelia/io/mitsuba/writer.h"

namespace lobelia::io::mitsuba {
namespace {

bool is(const FloatParam& p, float value) { return !p.texture.valid() && p.value == value; }
bool is(const ColorParam& p, Rgb value) { return !p.texture.valid() && p.value == value; }

}  // namespace

void Writer::absorption(Node node, const Material& m) {
  if (!(m.absorption == Rgb(0.f))) property(node, "rgb", "absorption", text(m.absorption));
}

void Writer::metallicRoughness(Node node, const Material& m) {
  const auto number = [&](const char* name, const FloatParam& p, float otherwise) {
    if (!is(p, otherwise)) scalar(node, name, p);
  };
  const auto texture = [&](const char* name, TextureHandle t) {
    if (t.valid()) reference(node, textureId(t, false), name);
  };
  const auto flag = [&](const char* name, bool value) {
    if (value) property(node, "boolean", name, "true");
  };
  flag("specular_glossiness", m.isSpecularGlossiness);
  color(node, "base_color", m.diffuse);
  scalar(node, "roughness", m.roughness);
  scalar(node, "metallic", m.metallic);
  property(node, "float", "ior", text(m.ior));
  if (!is(m.specular, Rgb(1.f))) color(node, "specular_color", m.specular);
  number("specular", m.specularStrength, 1);
  number("transmission", m.specTrans, 0);
  flag("thin", m.thin);
  absorption(node, m);
  number("anisotropy", m.anisotropic, 0);
  number("anisotropy_rotation", m.anisotropicRotation, 0);
  texture("anisotropy_direction", m.anisotropicDirection);
  number("clearcoat", m.clearcoat, 0);
  number("clearcoat_roughness", m.clearcoatRoughness, 0);
  texture("clearcoat_normal", m.clearcoatNormal);
  if (!is(m.sheenColor, Rgb(0.f))) color(node, "sheen_color", m.sheenColor);
  number("sheen_roughness", m.sheenRoughness, 0);
}

void Writer::coatedConductor(Node node, const Material& m) {
  color(node, "eta", m.eta);
  color(node, "k", m.k);
  color(node, "specular_reflectance", m.specular);
  roughness(node, m);
  property(node, "float", "coat_ior", text(m.coatIor));
  scalar(node, "coat_alpha_u", m.coatAlphaU);
  scalar(node, "coat_alpha_v", m.coatAlphaV);
}

}  // namespace lobelia::io::mitsuba
