// Validation of images, textures and materials: handles, cycles, ranges.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "lobelia/bsdf/captured.h"
#include "lobelia/scene/validate.h"

namespace lobelia::validation {
namespace {

// Is there a way from any node back to itself? children(i) lists valid indices. Returns one such
// node.
std::optional<size_t> findCycle(size_t count,
                                const std::function<std::vector<size_t>(size_t)>& children) {
  enum : uint8_t { fresh, open, done };
  std::vector<uint8_t> state(count, fresh);
  struct Step {
    size_t node;
    std::vector<size_t> next;
  };
  for (size_t root = 0; root < count; ++root) {
    if (state[root] != fresh) continue;
    std::vector<Step> stack{{root, children(root)}};
    state[root] = open;
    while (!stack.empty()) {
      if (stack.back().next.empty()) {
        state[stack.back().node] = done;
        stack.pop_back();
        continue;
      }
      const size_t child = stack.back().next.back();
      stack.back().next.pop_back();
      if (state[child] == open) return child;
      if (state[child] != fresh) continue;
      state[child] = open;
      stack.push_back({child, children(child)});
    }
  }
  return std::nullopt;
}

bool checkImages(const Scene& scene, Findings& findings) {
  bool valid = true;
  for (size_t i = 0; i < scene.images.size(); ++i) {
    const Image& image = scene.images[i];
    const std::string who = label("image", image.name, i);
    if (image.width < 1 || image.height < 1 || image.channels < 1 || image.channels > 4 ||
        image.pixels.size() != static_cast<size_t>(image.width) *
                                   static_cast<size_t>(image.height) *
                                   static_cast<size_t>(image.channels)) {
      findings.error(fmt::format("{}: {} values do not make {}x{} pixels of {} channels", who,
                                 image.pixels.size(), image.width, image.height, image.channels));
      valid = false;
    }
    size_t infinite = 0;
    for (float v : image.pixels) infinite += std::isfinite(v) ? 0 : 1;
    if (infinite > 0) {
      findings.warning(fmt::format("{}: {} values are not finite", who, infinite));
    }
  }
  return valid;
}

std::vector<std::string> attributeNames(const Scene& scene) {
  std::vector<std::string> names;
  for (const Mesh& mesh : scene.meshes) {
    for (const MeshAttribute& a : mesh.attributes) {
      if (std::find(names.begin(), names.end(), a.name) == names.end()) names.push_back(a.name);
    }
  }
  return names;
}

std::vector<TextureHandle> children(const Texture& t) {
  switch (t.type) {
    case TextureType::checkerboard:
    case TextureType::product:
      return {t.a, t.b};
    case TextureType::mix:
      return {t.a, t.b, t.c};
    case TextureType::scale:
    case TextureType::power:
      return {t.a};
    default:
      return {};
  }
}

std::vector<MaterialHandle> children(const Material& m) {
  switch (m.type) {
    case MaterialType::twoSided:
      return m.b.valid() ? std::vector{m.a, m.b} : std::vector{m.a};
    case MaterialType::blend:
      return {m.a, m.b};
    case MaterialType::mask:
    case MaterialType::bump:
    case MaterialType::normalMap:
      return {m.a};
    default:
      return {};
  }
}

template <class Item>
std::vector<size_t> childIndices(const Item& item) {
  std::vector<size_t> indices;
  for (const auto& h : children(item)) indices.push_back(h.index);
  return indices;
}

// Largest value that a texture can take.
float upperBound(const Scene& scene, TextureHandle handle) {
  const Texture& t = scene[handle];
  switch (t.type) {
    case TextureType::constant:
      return maxComponent(t.value);
    case TextureType::bitmap: {
      const Image& image = scene[t.image];
      float largest = 0;
      for (float v : image.pixels) largest = std::max(largest, v);
      return largest;
    }
    case TextureType::checkerboard:
    case TextureType::mix:
      return std::max(upperBound(scene, t.a), upperBound(scene, t.b));
    case TextureType::product:
      return upperBound(scene, t.a) * upperBound(scene, t.b);
    case TextureType::power:
      return t.scale > 0 ? std::pow(std::max(upperBound(scene, t.a), 0.f), t.scale) : 1;
    case TextureType::scale:
      return t.scale * upperBound(scene, t.a);
    case TextureType::meshAttribute:
      return 0;  // meshes check their own values
  }
  return 0;
}

struct NamedColour {
  const char* name;
  const ColorParam* value;
};
struct NamedFloat {
  const char* name;
  const FloatParam* value;
};

// The reflectances and transmittances that a type reads.
std::vector<NamedColour> albedos(const Material& m) {
  const NamedColour diffuse{"diffuse reflectance", &m.diffuse};
  const NamedColour specular{"specular reflectance", &m.specular};
  const NamedColour transmittance{"transmittance", &m.transmittance};
  switch (m.type) {
    case MaterialType::diffuse:
      return {diffuse};
    case MaterialType::sphericalGaussians:
      return {diffuse};
    case MaterialType::principled:
      return {{"base colour", &m.diffuse}};
    case MaterialType::metallicRoughness:
      // KHR_materials_specular allows colours above 1: the product with the index counts.
      return m.isSpecularGlossiness
                 ? std::vector<NamedColour>{{"diffuse colour", &m.diffuse}, specular}
                 : std::vector<NamedColour>{{"base colour", &m.diffuse},
                                            {"sheen colour", &m.sheenColor}};
    case MaterialType::diffuseTransmitter:
      return {diffuse, transmittance};
    case MaterialType::coatedConductor:
    case MaterialType::conductor:
    case MaterialType::roughConductor:
      return {specular};
    case MaterialType::dielectric:
    case MaterialType::thinDielectric:
    case MaterialType::roughDielectric:
      return {specular, transmittance};
    case MaterialType::plastic:
    case MaterialType::roughPlastic:
    case MaterialType::phong:
    case MaterialType::ward:
      return {diffuse, specular};
    default:
      return {};
  }
}

bool checkHandles(const Scene& scene, const Material& m, const std::string& who,
                  Findings& findings) {
  bool valid = true;
  const auto texture = [&](const char* name, TextureHandle h) {
    if (!h.valid() || h.index < scene.textures.size()) return;
    findings.error(fmt::format("{}: texture {} of its {} does not exist", who, h.index, name));
    valid = false;
  };
  for (const NamedColour& c : std::array<NamedColour, 6>{{{"diffuse", &m.diffuse},
                                                          {"sheen colour", &m.sheenColor},
                                                          {"specular", &m.specular},
                                                          {"transmittance", &m.transmittance},
                                                          {"eta", &m.eta},
                                                          {"k", &m.k}}}) {
    texture(c.name, c.value->texture);
  }
  for (const NamedFloat& f :
       std::array<NamedFloat, 20>{{{"alpha u", &m.alphaU},
                                   {"specular strength", &m.specularStrength},
                                   {"sheen roughness", &m.sheenRoughness},
                                   {"clearcoat roughness", &m.clearcoatRoughness},
                                   {"anisotropy rotation", &m.anisotropicRotation},
                                   {"coat alpha u", &m.coatAlphaU},
                                   {"coat alpha v", &m.coatAlphaV},
                                   {"alpha v", &m.alphaV},
                                   {"roughness", &m.roughness},
                                   {"anisotropic", &m.anisotropic},
                                   {"metallic", &m.metallic},
                                   {"spec_trans", &m.specTrans},
                                   {"spec_tint", &m.specTint},
                                   {"sheen", &m.sheen},
                                   {"sheen_tint", &m.sheenTint},
                                   {"flatness", &m.flatness},
                                   {"clearcoat", &m.clearcoat},
                                   {"clearcoat_gloss", &m.clearcoatGloss},
                                   {"opacity", &m.opacity},
                                   {"weight", &m.weight}}}) {
    texture(f.name, f.value->texture);
  }
  for (const CapturedLobe& lobe : m.capturedLobes) {
    texture("amplitude", lobe.amplitude.texture);
    texture("sharpness", lobe.sharpness.texture);
  }
  texture("map", m.map);
  texture("clearcoat normal", m.clearcoatNormal);
  texture("anisotropy direction", m.anisotropicDirection);
  for (MaterialHandle h : children(m)) {
    if (h.index < scene.materials.size()) continue;
    findings.error(h.valid() ? fmt::format("{}: material {} inside it does not exist", who, h.index)
                             : who + ": lacks the material that it wraps");
    valid = false;
  }
  if ((m.type == MaterialType::bump || m.type == MaterialType::normalMap) && !m.map.valid()) {
    findings.error(who + ": has no map");
    valid = false;
  }
  return valid;
}

void checkValues(const Scene& scene, const Material& m, const std::string& who,
                 Findings& findings) {
  for (const NamedColour& c : albedos(m)) {
    const bool textured = c.value->texture.valid();
    const Rgb value = c.value->value;
    if (!textured && !isFinite(value)) {
      findings.error(fmt::format("{}: its {} is not finite", who, c.name));
      continue;
    }
    if (!textured && minComponent(value) < 0) {
      findings.warning(fmt::format("{}: its {} is negative", who, c.name));
    }
    const float largest = textured ? upperBound(scene, c.value->texture) : maxComponent(value);
    if (largest > 1) {
      findings.warning(fmt::format("{}: its {} reaches {:.4g}; above 1 it creates energy", who,
                                   c.name, largest));
    }
  }
  // KHR_materials_ior: 0 is an interface that reflects all.
  const bool mayBeZero = m.type == MaterialType::metallicRoughness && m.ior == 0;
  if (!std::isfinite(m.ior) || (!(m.ior > 0) && !mayBeZero)) {
    findings.error(fmt::format("{}: an index of refraction of {}; it must be above 0", who, m.ior));
  }
  if (!std::isfinite(m.coatIor) || !(m.coatIor > 0)) {
    findings.error(fmt::format("{}: its coat has an index of refraction of {}; it must be above 0",
                               who, m.coatIor));
  }
  if (!isFinite(m.absorption) || minComponent(m.absorption) < 0) {
    findings.error(who + ": its absorption must be finite and 0 or more");
  }
  for (const FloatParam* alpha : {&m.alphaU, &m.alphaV, &m.coatAlphaU, &m.coatAlphaV}) {
    if (!alpha->texture.valid() && !(alpha->value >= 0 && std::isfinite(alpha->value))) {
      findings.error(
          fmt::format("{}: a roughness of {}; it must be finite and 0 or more", who, alpha->value));
    }
  }
}

void checkCaptured(const Scene& scene, const Material& m, const std::string& who,
                   Findings& findings) {
  if (m.ior < 1) {
    findings.error(fmt::format(
        "{}: an index of refraction of {}; spherical Gaussians have 1 (no Fresnel term) or more",
        who, m.ior));
  }
  Rgb weights{};
  for (size_t i = 0; i < m.capturedLobes.size(); ++i) {
    const ColorParam& amplitude = m.capturedLobes[i].amplitude;
    const FloatParam& sharpness = m.capturedLobes[i].sharpness;
    const bool textured = amplitude.texture.valid();
    if (!textured && !(isFinite(amplitude.value) && minComponent(amplitude.value) >= 0)) {
      findings.error(fmt::format("{}: amplitude {} must be finite and 0 or more", who, i));
      return;
    }
    if (!sharpness.texture.valid() && !std::isfinite(sharpness.value)) {
      findings.error(fmt::format("{}: sharpness {} is not finite", who, i));
      return;
    }
    if (!sharpness.texture.valid() && sharpness.value < kMinCapturedSharpness) {
      findings.warning(fmt::format("{}: sharpness {} is {:.4g}; below {} it counts as {}", who, i,
                                   sharpness.value, kMinCapturedSharpness, kMinCapturedSharpness));
    }
    // Textured amplitudes and sharpnesses belong together point by point: their means say little.
    if (!textured && !sharpness.texture.valid())
      weights += amplitude.value * projectedIntegral(sharpness.value);
  }
  const Rgb diffuse = m.diffuse.texture.valid() ? mean(scene, m.diffuse) : m.diffuse.value;
  const float scale = capturedScale(diffuse, weights, m.ior);
  if (scale < 0.99f) {
    findings.warning(fmt::format(
        "{}: its lobes would reflect more than they receive; all is scaled by {:.3g}", who, scale));
  }
}

}  // namespace

bool checkTextures(const Scene& scene, Findings& findings) {
  bool valid = checkImages(scene, findings);
  const std::vector<std::string> attributes = attributeNames(scene);
  for (size_t i = 0; i < scene.textures.size(); ++i) {
    const Texture& t = scene.textures[i];
    const std::string who = fmt::format("texture {}", i);
    if (t.type == TextureType::bitmap && t.image.index >= scene.images.size()) {
      findings.error(t.image.valid()
                         ? fmt::format("{}: image {} does not exist", who, t.image.index)
                         : who + ": has no image");
      valid = false;
    }
    for (TextureHandle h : children(t)) {
      if (h.index < scene.textures.size()) continue;
      findings.error(who + ": lacks a texture inside it");
      valid = false;
    }
    for (const auto& row : t.uvMatrix) {
      for (float v : row) {
        if (std::isfinite(v)) continue;
        findings.error(who + ": its uv matrix is not finite");
        valid = false;
      }
    }
    const bool reads = t.type == TextureType::meshAttribute ||
                       (t.type == TextureType::bitmap && !t.attribute.empty());
    if (reads && std::find(attributes.begin(), attributes.end(), t.attribute) == attributes.end()) {
      findings.warning(
          fmt::format("{}: no mesh has an attribute '{}', so {}{}", who, t.attribute,
                      t.type == TextureType::bitmap ? "it takes the meshes' own uv" : "it is black",
                      suggestion(t.attribute, attributes)));
    }
    if (!std::isfinite(t.scale)) {
      findings.error(fmt::format("{}: its {} is not finite", who,
                                 t.type == TextureType::power ? "exponent" : "scale"));
      valid = false;
    }
    if (t.channel < -1 || t.channel > 3) {
      findings.error(fmt::format("{}: channel {}; it may be 0 to 3 (r, g, b, alpha), or -1 for all",
                                 who, t.channel));
      valid = false;
    }
  }
  if (!valid) return false;
  const auto cycle =
      findCycle(scene.textures.size(), [&](size_t i) { return childIndices(scene.textures[i]); });
  if (cycle) findings.error(fmt::format("texture {}: contains itself", *cycle));
  return !cycle;
}

bool checkMaterials(const Scene& scene, bool texturesValid, Findings& findings) {
  bool valid = true;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    const std::string who = label("material", m.name, i);
    const bool handles = checkHandles(scene, m, who, findings);
    valid = valid && handles;
    if (handles && texturesValid) checkValues(scene, m, who, findings);
    if (handles && texturesValid && m.type == MaterialType::sphericalGaussians)
      checkCaptured(scene, m, who, findings);
  }
  if (!valid) return false;
  const auto cycle =
      findCycle(scene.materials.size(), [&](size_t i) { return childIndices(scene.materials[i]); });
  if (cycle) {
    findings.error(label("material", scene.materials[*cycle].name, *cycle) + ": contains itself");
  }
  return !cycle;
}

}  // namespace lobelia::validation
