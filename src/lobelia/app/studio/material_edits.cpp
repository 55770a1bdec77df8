#include "lobelia/app/studio/material_edits.h"

#include <cmath>

namespace lobelia::app {
namespace {

constexpr int kMostNested = 32;

bool isMap(MaterialType type) {
  return type == MaterialType::bump || type == MaterialType::normalMap;
}
bool wraps(MaterialType type) {
  return isMap(type) || type == MaterialType::twoSided || type == MaterialType::mask ||
         type == MaterialType::blend;
}

// What roughness, metal and colour a material shows, in the terms of `principled`.
struct Look {
  ColorParam color;
  FloatParam alphaU, alphaV;  // of microfacets
  float metallic = 0;
};

FloatParam squared(const FloatParam& roughness) {
  FloatParam alpha = roughness;  // a texture keeps: its square would need another
  alpha.value = std::max(roughness.value * roughness.value, 1e-4f);
  return alpha;
}

Look lookOf(const Material& m) {
  Look look{m.diffuse, m.alphaU, m.alphaV, 0};
  switch (m.type) {
    case MaterialType::conductor:
    case MaterialType::roughConductor:
    case MaterialType::coatedConductor:
      look.color = m.specular, look.metallic = 1;
      break;
    case MaterialType::dielectric:
    case MaterialType::thinDielectric:
    case MaterialType::roughDielectric:
      look.color = m.transmittance;
      break;
    case MaterialType::principled:
    case MaterialType::metallicRoughness:
      look.alphaU = look.alphaV = squared(m.roughness);
      look.metallic = m.metallic.texture.valid() ? 0 : m.metallic.value;
      break;
    case MaterialType::phong:  // the alpha whose lobe is about as wide [Walter07]
      look.alphaU = look.alphaV = std::sqrt(2 / (m.alphaU.value + 2));
      break;
    default:
      break;
  }
  const bool smooth = m.type == MaterialType::conductor || m.type == MaterialType::dielectric ||
                      m.type == MaterialType::thinDielectric || m.type == MaterialType::plastic;
  if (smooth) look.alphaU = look.alphaV = 0.1f;
  return look;
}

Material withLook(MaterialType type, const Look& look) {
  Material m;
  m.type = type;
  m.alphaU = look.alphaU, m.alphaV = look.alphaV;
  switch (type) {
    case MaterialType::conductor:
    case MaterialType::roughConductor:
    case MaterialType::coatedConductor:
      m.specular = look.color;  // eta 0, k 1: reflects all, so that the colour is this
      break;
    case MaterialType::dielectric:
    case MaterialType::thinDielectric:
    case MaterialType::roughDielectric:
      break;  // clear: a wall's colour would make dark glass
    case MaterialType::diffuseTransmitter:
      m.diffuse = m.transmittance = look.color;
      m.diffuse.value *= 0.5f, m.transmittance.value *= 0.5f;
      break;
    case MaterialType::principled:
    case MaterialType::metallicRoughness:
      m.diffuse = look.color;
      m.roughness = look.alphaU;
      m.roughness.value = std::sqrt(look.alphaU.value);
      m.metallic = look.metallic;
      break;
    case MaterialType::phong:
      m.diffuse = look.color, m.specular = Rgb(0.2f);
      m.alphaU = std::max(2 / std::max(look.alphaU.value * look.alphaU.value, 1e-4f) - 2, 0.f);
      break;
    case MaterialType::ward:
      m.diffuse = look.color, m.specular = Rgb(0.2f);
      break;
    default:
      m.diffuse = look.color;
      break;
  }
  return m;
}

// The map around a material, or the material itself.
uint32_t mapPlace(const Design& design, uint32_t material) {
  for (int depth = 0; depth < kMostNested; ++depth) {
    const Material& m = design.materials[material];
    if (isMap(m.type) || !wraps(m.type) || !m.a.valid()) break;
    material = m.a.index;
  }
  return material;
}

void setMap(Design& design, uint32_t material, MaterialType type, TextureHandle map, float scale) {
  const uint32_t at = mapPlace(design, material);
  if (!isMap(design.materials[at].type)) {
    if (!map.valid()) return;
    // The handle stays that of the whole; what it was moves.
    const MaterialHandle inner{static_cast<uint32_t>(design.materials.size())};
    Material moved = design.materials[at];
    moved.name.clear();
    design.materials.push_back(std::move(moved));
    Material wrapper;
    wrapper.name = design.materials[at].name;
    wrapper.a = inner;
    design.materials[at] = std::move(wrapper);
  } else if (!map.valid()) {
    const std::string name = design.materials[at].name;
    Material inner = design.materials[design.materials[at].a.index];
    design.materials[at] = std::move(inner);
    design.materials[at].name = name;
    return;
  }
  Material& m = design.materials[at];
  m.type = type, m.map = map, m.scale = scale;
}

}  // namespace

uint32_t shownMaterial(const Design& design, uint32_t material) {
  for (int depth = 0; depth < kMostNested; ++depth) {
    const Material& m = design.materials[material];
    if (!wraps(m.type) || !m.a.valid()) break;
    material = m.a.index;
  }
  return material;
}

void changeType(Design& design, uint32_t material, MaterialType type) {
  Material& m = design.materials[shownMaterial(design, material)];
  if (m.type == type) return;
  Material next = withLook(type, lookOf(m));
  next.name = m.name;
  next.distribution = m.distribution;
  m = std::move(next);
}

void setBump(Design& design, uint32_t material, TextureHandle heights, float scale) {
  setMap(design, material, MaterialType::bump, heights, scale);
}
void setNormalMap(Design& design, uint32_t material, TextureHandle normals) {
  setMap(design, material, MaterialType::normalMap, normals, 1);
}

}  // namespace lobelia::app
