// The table of what materials have. Words are Mitsuba's names where it has them. Ranges are those
// of validate() where it has some, else what makes sense to drag.
#include "lobelia/app/studio/material_fields.h"

#include <array>

namespace lobelia::app {
namespace {

using M = Material;

constexpr const char* kDistributions[] = {"ggx", "beckmann", "phong"};
constexpr const char* kWardVariants[] = {"ward", "ward-duer", "balanced"};
constexpr float kLeastAlpha = 1e-4f;

constexpr MaterialField color(const char* label, const char* word, ColorParam M::*member,
                              float most = 1) {
  MaterialField f{label, word, FieldKind::color};
  f.most = most, f.color = member, f.texturable = true;
  return f;
}
constexpr MaterialField scalar(const char* label, const char* word, FloatParam M::*member,
                               float least = 0, float most = 1, bool logarithmic = false) {
  MaterialField f{label, word, FieldKind::scalar};
  f.least = least, f.most = most, f.logarithmic = logarithmic;
  f.scalar = member, f.texturable = true;
  return f;
}
constexpr MaterialField both(MaterialField field, FloatParam M::*also) {
  field.also = also;
  return field;
}
constexpr MaterialField number(const char* label, const char* word, float M::*member, float least,
                               float most) {
  MaterialField f{label, word, FieldKind::number};
  f.least = least, f.most = most, f.number = member;
  return f;
}
constexpr MaterialField flag(const char* label, const char* word, bool M::*member) {
  MaterialField f{label, word, FieldKind::flag};
  f.flag = member;
  return f;
}
constexpr MaterialField choice(const char* label, const char* word,
                               std::span<const char* const> choices, int M::*index) {
  MaterialField f{label, word, FieldKind::choice};
  f.most = static_cast<float>(choices.size() - 1), f.choices = choices, f.index = index;
  return f;
}
constexpr MaterialField map(const char* label, const char* word, TextureHandle M::*member) {
  MaterialField f{label, word, FieldKind::map};
  f.map = member, f.texturable = true;
  return f;
}

constexpr MaterialField kDiffuse = color("diffuse colour", "diffuse_reflectance", &M::diffuse);
constexpr MaterialField kSpecular = color("specular colour", "specular_reflectance", &M::specular);
constexpr MaterialField kTransmitted =
    color("transmitted colour", "specular_transmittance", &M::transmittance);
constexpr MaterialField kIor = number("index of refraction", "int_ior", &M::ior, 1, 4);
constexpr MaterialField kAlpha =
    both(scalar("roughness", "alpha", &M::alphaU, kLeastAlpha, 1, true), &M::alphaV);
constexpr MaterialField kAlphaU =
    scalar("roughness along u", "alpha_u", &M::alphaU, kLeastAlpha, 1, true);
constexpr MaterialField kAlphaV =
    scalar("roughness along v", "alpha_v", &M::alphaV, kLeastAlpha, 1, true);
constexpr MaterialField kDistribution =
    choice("microfacets", "distribution", kDistributions, nullptr);
constexpr MaterialField kEta = color("index of refraction", "eta", &M::eta, 20);
constexpr MaterialField kK = color("extinction", "k", &M::k, 20);
constexpr MaterialField kBase = color("base colour", "base_color", &M::diffuse);
constexpr MaterialField kRoughness = scalar("roughness", "roughness", &M::roughness);
constexpr MaterialField kMetallic = scalar("metallic", "metallic", &M::metallic);
constexpr MaterialField kNonlinear = flag("colour shifts inside", "nonlinear", &M::nonlinear);
constexpr MaterialField kAbsorption = [] {
  MaterialField f{"absorption", "absorption", FieldKind::color};
  f.most = 100, f.plainColor = &M::absorption;
  return f;
}();

constexpr std::array kDiffuseFields{color("colour", "reflectance", &M::diffuse)};
constexpr std::array kConductorFields{kSpecular, kEta, kK};
constexpr std::array kRoughConductorFields{kSpecular,     kAlpha, kAlphaU, kAlphaV,
                                           kDistribution, kEta,   kK};
constexpr std::array kDielectricFields{kSpecular, kTransmitted, kIor, kAbsorption};
constexpr std::array kThinDielectricFields{kSpecular, kTransmitted, kIor};
constexpr std::array kRoughDielectricFields{kSpecular, kTransmitted,  kAlpha, kAlphaU,
                                            kAlphaV,   kDistribution, kIor,   kAbsorption};
constexpr std::array kPlasticFields{kDiffuse, kSpecular, kIor, kNonlinear};
constexpr std::array kRoughPlasticFields{kDiffuse,      kSpecular, kAlpha,
                                         kDistribution, kIor,      kNonlinear};
constexpr std::array kPrincipledFields{
    kBase,
    kRoughness,
    scalar("anisotropy", "anisotropic", &M::anisotropic),
    kMetallic,
    scalar("transmission", "spec_trans", &M::specTrans),
    scalar("specular tint", "spec_tint", &M::specTint),
    scalar("sheen", "sheen", &M::sheen),
    scalar("sheen tint", "sheen_tint", &M::sheenTint),
    scalar("flatness", "flatness", &M::flatness),
    scalar("clearcoat", "clearcoat", &M::clearcoat),
    scalar("clearcoat gloss", "clearcoat_gloss", &M::clearcoatGloss),
    number("index of refraction", "eta", &M::ior, 1.01f, 4)};
constexpr std::array kPhongFields{kDiffuse, kSpecular,
                                  scalar("exponent", "exponent", &M::alphaU, 0, 10'000, true)};
constexpr std::array kWardFields{
    kDiffuse, kSpecular, kAlpha,
    kAlphaU,  kAlphaV,   choice("variant", "variant", kWardVariants, &M::wardVariant)};
constexpr std::array kTransmitterFields{
    color("reflected colour", "reflectance", &M::diffuse),
    color("transmitted colour", "transmittance", &M::transmittance)};
constexpr std::array kMetallicRoughnessFields{
    kBase,
    kRoughness,
    kMetallic,
    color("specular colour", "specular_color", &M::specular),
    scalar("specular strength", "specular", &M::specularStrength),
    number("index of refraction", "ior", &M::ior, 1, 4),
    scalar("transmission", "transmission", &M::specTrans),
    flag("thin", "thin", &M::thin),
    kAbsorption,
    scalar("anisotropy", "anisotropy", &M::anisotropic),
    scalar("direction of anisotropy", "anisotropy_rotation", &M::anisotropicRotation, 0, kTwoPi),
    map("map of anisotropy", "anisotropy_direction", &M::anisotropicDirection),
    scalar("clearcoat", "clearcoat", &M::clearcoat),
    scalar("clearcoat roughness", "clearcoat_roughness", &M::clearcoatRoughness),
    map("clearcoat normals", "clearcoat_normal", &M::clearcoatNormal),
    color("sheen colour", "sheen_color", &M::sheenColor),
    scalar("sheen roughness", "sheen_roughness", &M::sheenRoughness)};
constexpr std::array kCoatedConductorFields{
    kSpecular,
    kAlpha,
    kAlphaU,
    kAlphaV,
    kDistribution,
    kEta,
    kK,
    number("index of the coat", "coat_ior", &M::coatIor, 1, 4),
    both(scalar("roughness of the coat", "coat_alpha", &M::coatAlphaU), &M::coatAlphaV)};
constexpr std::array kCapturedFields{kDiffuse, number("index of refraction", "ior", &M::ior, 1, 4)};
constexpr std::array kMaskFields{scalar("opacity", "opacity", &M::opacity)};
constexpr std::array kBlendFields{scalar("share of the second", "weight", &M::weight)};
constexpr std::array kBumpFields{map("bump map", "bump_map", &M::map),
                                 number("bump scale", "bump_scale", &M::scale, -100, 100)};
constexpr std::array kNormalMapFields{map("normal map", "normal_map", &M::map)};

constexpr MaterialType kSimple[] = {MaterialType::diffuse,
                                    MaterialType::conductor,
                                    MaterialType::roughConductor,
                                    MaterialType::dielectric,
                                    MaterialType::thinDielectric,
                                    MaterialType::roughDielectric,
                                    MaterialType::plastic,
                                    MaterialType::roughPlastic,
                                    MaterialType::principled,
                                    MaterialType::phong,
                                    MaterialType::ward,
                                    MaterialType::diffuseTransmitter,
                                    MaterialType::metallicRoughness,
                                    MaterialType::coatedConductor};

constexpr const char* kWords[] = {"diffuse",
                                  "conductor",
                                  "roughconductor",
                                  "dielectric",
                                  "thindielectric",
                                  "roughdielectric",
                                  "plastic",
                                  "roughplastic",
                                  "principled",
                                  "phong",
                                  "ward",
                                  "difftrans",
                                  "metallicroughness",
                                  "coatedconductor",
                                  "sphericalgaussians",
                                  "twosided",
                                  "mask",
                                  "blendbsdf",
                                  "bumpmap",
                                  "normalmap",
                                  "null"};
static_assert(std::size(kWords) == static_cast<size_t>(MaterialType::null) + 1);

}  // namespace

std::span<const MaterialType> simpleTypes() { return kSimple; }
const char* typeWord(MaterialType type) { return kWords[static_cast<size_t>(type)]; }
std::optional<MaterialType> simpleType(const std::string& word) {
  for (const MaterialType type : kSimple)
    if (word == typeWord(type)) return type;
  return {};
}

std::span<const MaterialField> fieldsOf(MaterialType type) {
  switch (type) {
    case MaterialType::diffuse:
      return kDiffuseFields;
    case MaterialType::conductor:
      return kConductorFields;
    case MaterialType::roughConductor:
      return kRoughConductorFields;
    case MaterialType::dielectric:
      return kDielectricFields;
    case MaterialType::thinDielectric:
      return kThinDielectricFields;
    case MaterialType::roughDielectric:
      return kRoughDielectricFields;
    case MaterialType::plastic:
      return kPlasticFields;
    case MaterialType::roughPlastic:
      return kRoughPlasticFields;
    case MaterialType::principled:
      return kPrincipledFields;
    case MaterialType::phong:
      return kPhongFields;
    case MaterialType::ward:
      return kWardFields;
    case MaterialType::diffuseTransmitter:
      return kTransmitterFields;
    case MaterialType::metallicRoughness:
      return kMetallicRoughnessFields;
    case MaterialType::coatedConductor:
      return kCoatedConductorFields;
    case MaterialType::sphericalGaussians:
      return kCapturedFields;
    case MaterialType::mask:
      return kMaskFields;
    case MaterialType::blend:
      return kBlendFields;
    case MaterialType::bump:
      return kBumpFields;
    case MaterialType::normalMap:
      return kNormalMapFields;
    case MaterialType::twoSided:
    case MaterialType::null:
      return {};
  }
  return {};
}

}  // namespace lobelia::app
