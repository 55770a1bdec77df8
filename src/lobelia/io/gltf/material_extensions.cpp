// Extensions of materials: KHR_materials_pbrSpecularGlossiness, _specular, _ior, _clearcoat,
// _sheen, _anisotropy, _transmission, _volume.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/io/gltf/material_source.h"

namespace lobelia::io::gltf {

Materials::Source::BaseFactor Materials::Source::baseFactor() const {
  const Json glossiness = json.extension("KHR_materials_pbrSpecularGlossiness");
  const Json holder = glossiness.exists() ? glossiness : json["pbrMetallicRoughness"];
  const Json factor = holder[glossiness.exists() ? "diffuseFactor" : "baseColorFactor"];
  BaseFactor base{
      {1, 1, 1}, 1, holder[glossiness.exists() ? "diffuseTexture" : "baseColorTexture"]};
  if (!factor.exists()) return base;
  const std::vector<double> v = factor.numbers(4);
  for (const double c : v)
    if (!(c >= 0)) factor.fail("is negative; colours and alpha must be 0 or more");
  base.color = {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  base.alpha = v[3];
  return base;
}

void Materials::addSpecularGlossiness(const Source& from, const Json& extension,
                                      Material& material) {
  material.isSpecularGlossiness = true;
  const Source::BaseFactor base = from.baseFactor();
  TextureHandle diffuse = texture(from, base.texture, false);
  if (from.use.vertexColor)
    diffuse = textures_.product(diffuse, textures_.attribute("vertex_color"));
  material.diffuse = textures_.color(base.color, diffuse);
  const Json both = extension["specularGlossinessTexture"];
  material.specular =
      textures_.color(extension["specularFactor"].vector(Rgb(1.f)), texture(from, both, false));
  material.metallic = 0.f;
  // roughness = 1 - glossiness
  const FloatParam glossiness = textures_.number(
      extension["glossinessFactor"].numberWithin(0, 1, 1), texture(from, both, false, 3));
  if (glossiness.texture.valid()) {
    material.roughness = textures_.mix(textures_.constant(Rgb(1.f)), textures_.constant(Rgb(0.f)),
                                       glossiness.texture);
  } else {
    material.roughness = 1 - glossiness.value;
  }
}

void Materials::addReflection(const Source& from, Material& material) {
  const Json& json = from.json;
  material.ior = 1.5f;
  if (const Json ior = json.extension("KHR_materials_ior")["ior"]; ior.exists()) {
    const double value = ior.number();
    // 0 stands for a normal reflectance of 1, which an index of refraction has in the limit.
    constexpr float kReflectsAll = 1e4f;
    if (value != 0 && !(value >= 1))
      ior.fail(fmt::format("is {}; it must be 0, or 1 or more", value));
    material.ior = value == 0 ? kReflectsAll : static_cast<float>(value);
  }
  if (const Json specular = json.extension("KHR_materials_specular");
      specular.exists() && !material.isSpecularGlossiness) {
    material.specularStrength =
        textures_.number(specular["specularFactor"].numberWithin(0, 1, 1),
                         texture(from, specular["specularTexture"], true, 3));
    material.specular = textures_.color(specular["specularColorFactor"].vector(Rgb(1.f)),
                                        texture(from, specular["specularColorTexture"], false));
  }
  if (const Json coat = json.extension("KHR_materials_clearcoat"); coat.exists()) {
    material.clearcoat = textures_.number(coat["clearcoatFactor"].numberWithin(0, 1, 0),
                                          texture(from, coat["clearcoatTexture"], true, 0));
    material.clearcoatRoughness =
        textures_.number(coat["clearcoatRoughnessFactor"].numberWithin(0, 1, 0),
                         texture(from, coat["clearcoatRoughnessTexture"], true, 1));
    if (const Json info = coat["clearcoatNormalTexture"]; info.exists())
      material.clearcoatNormal = normalTexture(from, info);
  }
  if (const Json sheen = json.extension("KHR_materials_sheen"); sheen.exists()) {
    material.sheenColor = textures_.color(sheen["sheenColorFactor"].vector(Rgb(0.f)),
                                          texture(from, sheen["sheenColorTexture"], false));
    material.sheenRoughness =
        textures_.number(sheen["sheenRoughnessFactor"].numberWithin(0, 1, 0),
                         texture(from, sheen["sheenRoughnessTexture"], true, 3));
  }
}

void Materials::addAnisotropy(const Source& from, Material& material) {
  const Json anisotropy = from.json.extension("KHR_materials_anisotropy");
  if (!anisotropy.exists()) return;
  material.anisotropic = static_cast<float>(anisotropy["anisotropyStrength"].numberWithin(0, 1, 0));
  const auto rotation = static_cast<float>(anisotropy["anisotropyRotation"].number(0));
  material.anisotropicRotation = from.use.mirrored ? -rotation : rotation;
  const TextureHandle direction = texture(from, anisotropy["anisotropyTexture"], true);
  // y of the direction turned over, as in normalTexture().
  material.anisotropicDirection =
      direction.valid() && from.use.mirrored ? textures_.turned(direction, {0, 1, 0}) : direction;
}

void Materials::addTransmission(const Source& from, Material& material) {
  const Json transmission = from.json.extension("KHR_materials_transmission");
  if (!transmission.exists()) return;
  material.specTrans =
      textures_.number(transmission["transmissionFactor"].numberWithin(0, 1, 0),
                       texture(from, transmission["transmissionTexture"], true, 0));
  const Json volume = from.json.extension("KHR_materials_volume");
  material.thin = !(volume["thicknessFactor"].number(0) > 0);
  if (material.thin || !volume["attenuationDistance"].exists()) return;
  const double distance = volume["attenuationDistance"].number();
  if (!(distance > 0)) volume["attenuationDistance"].fail("must be above 0");
  const Rgb color = volume["attenuationColor"].vector(Rgb(1.f));
  // Transmittance after `distance` is the colour; black is taken for nearly black.
  for (int c = 0; c < 3; ++c) {
    const double transmittance = std::clamp(static_cast<double>(color[c]), 1e-6, 1.0);
    material.absorption[c] = static_cast<float>(-std::log(transmittance) / distance);
  }
}

}  // namespace lobelia::io::gltf
