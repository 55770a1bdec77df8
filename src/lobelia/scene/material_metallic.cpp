// The material of glTF 2.0, specification appendix B ("BRDF implementation"), with the extensions
// KHR_materials_ior, _specular, _anisotropy, _transmission, _volume, _clearcoat, _sheen and the
// older _pbrSpecularGlossiness.
//
// Lobes from top to bottom: clearcoat (GGX, Schlick from 0.04), sheen (Charlie), specular (GGX; the
// Schlick factors of the dielectric and the metal mixed by `metallic`), then what lies under all
// these: diffuse reflection, or transmission, mixed by `specTrans`. alpha = roughness^2;
// anisotropic: alpha across the direction, mix(alpha, 1, strength^2) along it.
// Transmission of a thin sheet is the reflection's mirror image times one minus its Fresnel factor;
// of a volume it is refraction with the exact Fresnel factors on both sides.
//
// Deviations, all for energy and reciprocity: the specification weights a base by one minus the
// Fresnel factor of the layer above at the half vector (sheen and clearcoat: at the viewing angle
// alone). That is not reciprocal or gives back more than it gets; here a base is seen through its
// layers on the way in and on the way out (bsdf/layers.h). For these tables textured roughnesses
// are rounded to 1/128 and textured weights to 1/32. Strength and colour of KHR_materials_specular
// do not change the transmitting share of a volume, whose Fresnel factor follows from its index.
// The clearcoat has its own normals or the surface's, whatever map the base has, as
// KHR_materials_clearcoat says; what it leaves to the base is looked up at cosines to the base's
// normal, which may return a few percent too much at grazing angles where the two normals differ
// much. Visibility is the separable Smith term. Sheen has an alpha of at least 0.07: below,
// Charlie's distribution reflects more than it gets.
#include <algorithm>
#include <cmath>
#include <span>

#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/layers.h"
#include "lobelia/scene/lobe_builder.h"

namespace lobelia {
namespace {

constexpr float kCoatReflectance = 0.04f;  // index 1.5

// The parameters at a point, as the specification names them.
struct Values {
  Rgb base;
  Rgb f0;     // of the dielectric
  float f90;  // its value at grazing incidence
  float metallic, transmission, roughness;
};

Values valuesAt(const Builder& b) {
  const Material& m = b.material;
  Values v{};
  v.base = min(max(evaluate(b.scene, m.diffuse, b.at), Rgb(0.f)), Rgb(1.f));
  v.roughness = b.unit(m.roughness);
  const Rgb specular = max(evaluate(b.scene, m.specular, b.at), Rgb(0.f));
  if (m.isSpecularGlossiness) {
    v.f0 = min(specular, Rgb(1.f));
    v.f90 = 1;
    v.base *= 1 - maxComponent(v.f0);
    return v;
  }
  v.f90 = b.unit(m.specularStrength);
  v.f0 = min(specular * sqr((m.ior - 1) / (m.ior + 1)), Rgb(1.f)) * v.f90;
  v.metallic = b.unit(m.metallic);
  v.transmission = (1 - v.metallic) * b.unit(m.specTrans);
  return v;
}

float rounded(float value, const auto& param, float steps) {
  return param.texture.valid() ? std::round(value * steps) / steps : value;
}

// alpha of a roughness, for a table.
float alphaForTable(const Builder& b, const FloatParam& param) {
  return std::max(sqr(rounded(b.unit(param), param, 128)), kMinAlpha);
}

// Turns the tangents towards the anisotropy's direction and returns its strength.
float turnTangents(Builder* builder) {
  Builder& b = *builder;
  const Material& m = b.material;
  float strength = b.unit(m.anisotropic);
  if (!(strength > 0)) return 0;
  const float rotation = evaluate(b.scene, m.anisotropicRotation, b.at);
  float x = std::cos(rotation), y = std::sin(rotation);
  if (m.anisotropicDirection.valid()) {
    const Rgb texel = evaluate(b.scene, m.anisotropicDirection, b.at);
    const float dx = 2 * texel.x - 1, dy = 2 * texel.y - 1;
    const float len = std::sqrt(dx * dx + dy * dy);
    if (len > 0) {
      const float c = x, s = y;
      x = (c * dx - s * dy) / len, y = (s * dx + c * dy) / len;
    }
    strength *= std::clamp(texel.z, 0.f, 1.f);
  }
  ShadingFrame turned = b.bsdf.frames[b.frame];
  const Vec3f s = turned.s, t = turned.t;
  turned.s = s * x + t * y;
  turned.t = t * x - s * y;
  // A frame that nothing lies in yet serves no one else.
  const std::span lobes(b.bsdf.lobes, static_cast<size_t>(b.bsdf.lobeCount));
  if (std::ranges::any_of(lobes, [&](const Lobe& l) { return l.frame == b.frame; }))
    b.frame = b.bsdf.addFrame(turned);
  else
    b.bsdf.frames[b.frame] = turned;
  return strength;
}

// The layers above the base, as its tables see them (rounded) and as lobes.
struct Layers {
  std::array<Lobe, kMaxLayers> lobes;
  size_t count = 0;
  void add(const Lobe& lobe) { lobes[count++] = lobe; }
  const TransmittanceTable& transmittance() const {
    return layerTransmittance(std::span(lobes).first(count));
  }
  // Puts a lobe under the layers that there are so far.
  void cover(Lobe* lobe) const {
    if (count == 0) return;
    lobe->variant = static_cast<uint8_t>(lobe->variant | kCoated);
    lobe->table = transmittance().data();
  }
};

// Adds a lobe whose weight is set, with a share by its albedo for this direction.
void addByAlbedo(const Builder& b, const Lobe& lobe) {
  b.add(lobe, lobe.weight, mean(lobeAlbedo(lobe, b.cosThetaO)));
}

void addCoat(const Builder& base, Layers* layers) {
  const Material& m = base.material;
  Builder b = base;
  const float strength = b.unit(m.clearcoat);
  if (!(strength > 0)) return;
  if (b.coatFrame) {
    b.frame = b.bsdf.addFrame(*b.coatFrame);
    b.cosThetaO = b.twoSided ? std::abs(b.coatCosThetaO) : b.coatCosThetaO;
  }
  Lobe coat = b.lobe(LobeType::microfacetReflection);
  coat.fresnel = Fresnel::schlick;
  coat.eta = Rgb(kCoatReflectance);
  coat.alphaX = coat.alphaY = std::max(sqr(b.unit(m.clearcoatRoughness)), kMinAlpha);
  coat.weight = Rgb(strength * b.weight);
  addByAlbedo(b, coat);
  coat.alphaX = coat.alphaY = alphaForTable(b, m.clearcoatRoughness);
  coat.weight = Rgb(rounded(strength, m.clearcoat, 32));
  layers->add(coat);
}

void addSheen(const Builder& b, Layers* layers) {
  const Material& m = b.material;
  const Rgb color = min(max(evaluate(b.scene, m.sheenColor, b.at), Rgb(0.f)), Rgb(1.f));
  if (!(maxComponent(color) > 0)) return;
  Lobe sheen = b.lobe(LobeType::sheen);
  sheen.alphaX = sheen.alphaY = std::max(sqr(b.unit(m.sheenRoughness)), kMinSheenAlpha);
  sheen.weight = color * b.weight;
  layers->cover(&sheen);
  addByAlbedo(b, sheen);
  sheen.variant = 0;
  sheen.table = nullptr;
  sheen.alphaX = sheen.alphaY = std::max(alphaForTable(b, m.sheenRoughness), kMinSheenAlpha);
  sheen.weight = Rgb(rounded(maxComponent(color), m.sheenColor, 32));
  layers->add(sheen);
}

// Reflecting and transmitting lobe of a volume's interface; smooth ones become delta lobes.
void addInterface(const Builder& b, const Values& v, const Layers& layers, Lobe specular) {
  const float n = b.material.ior, share = v.transmission;
  const Rgb others = lerp(v.f0, v.base, v.metallic / std::max(1 - share, 1e-6f));
  specular.interface = true;
  specular.fresnel = Fresnel::principled;
  specular.eta = Rgb(n), specular.k = Rgb(0.f);
  specular.parameters = {share, share, 0};
  specular.tint = others * (1 - share);
  specular.weight = Rgb(b.weight);
  Lobe transmission = specular;
  transmission.fresnel = Fresnel::dielectric;
  transmission.weight = v.base * (share * b.weight);
  transmission.parameters = {0, 0, share};
  transmission.tint = {};
  if (!(maxComponent(transmission.weight) > 0)) return addByAlbedo(b, specular);
  if (sqr(v.roughness) > kMinAlpha || specular.alphaX != specular.alphaY) {
    transmission.type = LobeType::microfacetTransmission;
    specular.variant |= kInterfacePair, transmission.variant |= kInterfacePair;
    const float reflected = mean(lobeAlbedo(specular, b.cosThetaO));
    const float refracted = mean(lobeAlbedo(transmission, b.cosThetaO));
    // Both at least a little, or the pair would fall apart.
    const float least = 0.01f * b.weight;
    b.add(specular, specular.weight, std::max(reflected, least));
    b.add(transmission, transmission.weight, std::max(refracted, least));
    return;
  }
  const bool behind = b.cosThetaO < 0;
  const auto through = [&](float cosine) {
    return layers.count == 0 ? 1 : tableAt(layers.transmittance(), std::min(cosine, 1.f));
  };
  const float c = std::min(std::abs(b.cosThetaO), 1.f), eta = behind ? 1 / n : n;
  const float refracted = std::sqrt(std::max(0.f, 1 - (1 - c * c) / sqr(eta)));
  specular.type = LobeType::deltaReflection;
  specular.variant = 0;
  if (!behind) specular.weight *= sqr(through(c));
  transmission.type = LobeType::deltaTransmission;
  transmission.variant = 0;
  transmission.weight *= through(behind ? refracted : c);
  addByAlbedo(b, specular);
  addByAlbedo(b, transmission);
}

void addThinTransmission(const Builder& b, const Values& v, const Layers& layers, Lobe specular) {
  specular.type = LobeType::thinTransmission;
  specular.eta = v.f0;
  specular.k = Rgb(1 - v.f90);
  specular.weight = v.base * (v.transmission * b.weight);
  if (sqr(v.roughness) > kMinAlpha) return addByAlbedo(b, specular);
  // Clear: straight on.
  const float c = std::min(std::abs(b.cosThetaO), 1.f);
  const float w = std::pow(1 - c, 5.f);
  Rgb weight = specular.weight * (Rgb(1.f) - v.f0 * (1 - w) - Rgb(v.f90 * w));
  if (layers.count > 0) weight *= sqr(tableAt(layers.transmittance(), c));
  Lobe straight = b.lobe(LobeType::null);
  straight.twoSided = true;
  b.add(straight, weight, mean(weight));
}

void addDiffuse(const Builder& b, const Values& v, const Layers& layers) {
  const float share = 1 - v.metallic - v.transmission;
  if (!(share > 0)) return;
  Lobe diffuse = b.lobe(LobeType::coatedDiffuse);
  const TransmittanceTable& table = layers.transmittance();
  diffuse.variant = 1;
  diffuse.table = table.data();
  diffuse.weight = v.base * (share * b.weight / std::max(table[kTransmittanceSize], 1e-4f));
  addByAlbedo(b, diffuse);
}

}  // namespace

void addMetallicRoughnessLobes(const Builder& given) {
  Builder b = given;
  const Values v = valuesAt(b);
  // A sheet has no inside.
  const bool thin = b.material.thin || std::abs(b.material.ior - 1) < 1e-4f || b.material.ior <= 0;
  if (v.transmission > 0 && thin) b.twoSided = true;
  if (b.twoSided) b.cosThetaO = std::abs(b.cosThetaO);
  const float strength = turnTangents(&b);

  Layers layers;
  addCoat(b, &layers);
  addSheen(b, &layers);

  Lobe specular = b.lobe(LobeType::microfacetReflection);
  specular.fresnel = Fresnel::schlick;
  specular.alphaY = std::max(sqr(v.roughness), kMinAlpha);
  specular.alphaX = lerp(specular.alphaY, 1.f, sqr(strength));
  layers.cover(&specular);
  if (v.transmission > 0 && !thin) {
    addInterface(b, v, layers, specular);
  } else {
    if (v.transmission > 0) addThinTransmission(b, v, layers, specular);
    specular.eta = lerp(v.f0, v.base, v.metallic);
    specular.k = Rgb((1 - v.f90) * (1 - v.metallic));
    specular.weight = Rgb(b.weight);
    addByAlbedo(b, specular);
  }

  Lobe above = b.lobe(LobeType::microfacetReflection);
  above.fresnel = Fresnel::schlick;
  above.alphaY = alphaForTable(b, b.material.roughness);
  above.alphaX = lerp(above.alphaY, 1.f, sqr(rounded(strength, b.material.anisotropic, 32)));
  const bool varies =
      b.material.specular.texture.valid() || b.material.specularStrength.texture.valid();
  const float root = std::sqrt(maxComponent(v.f0));
  above.eta = Rgb(sqr(varies ? std::round(root * 64) / 64 : root));
  above.k = Rgb(1 - rounded(v.f90, b.material.specularStrength, 32));
  layers.add(above);
  addDiffuse(b, v, layers);
}

}  // namespace lobelia
