#include "lobelia/io/gltf/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/io/gltf/material_source.h"

namespace lobelia::io::gltf {
namespace {

// Calls f(textureInfo) for every texture of a material that is used.
template <class F>
void forEachTexture(const Json& object, const F& f) {
  for (const std::string& name : object.members()) {
    if (name == "occlusionTexture" || !name.ends_with("Texture")) continue;
    f(name, object[name]);
  }
}

}  // namespace

std::vector<std::string> variantNames(const Document& document) {
  std::vector<std::string> names;
  const Json variants = document.root().extension("KHR_materials_variants")["variants"];
  for (size_t i = 0; i < variants.size(); ++i) names.push_back(variants.at(i)["name"].text());
  return names;
}

Materials::Materials(const Import& import) : import_(import), textures_(import) {
  const std::string& wanted = import.settings.variant;
  if (wanted.empty()) return;
  const std::vector<std::string> names = variantNames(import.document);
  const auto found = std::find(names.begin(), names.end(), wanted);
  if (found == names.end()) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    throw UsageError(fmt::format("--variant {}: {} has no such material variant; there are {}{}",
                                 wanted, import.document.file(), names.empty() ? "none" : list,
                                 suggestion(wanted, names)));
  }
  variant_ = static_cast<size_t>(found - names.begin());
}

Json Materials::of(const Json& primitive) const {
  if (variant_) {
    const Json mappings = primitive.extension("KHR_materials_variants")["mappings"];
    for (size_t m = 0; m < mappings.size(); ++m) {
      const Json variants = mappings.at(m)["variants"];
      for (size_t v = 0; v < variants.size(); ++v)
        if (variants.at(v).count() == *variant_) return mappings.at(m)["material"];
    }
  }
  return primitive["material"];
}

UvSets Materials::uvSets(const Json& index) const {
  UvSets uv;
  if (!index.exists()) return uv;
  const Json material = import_.document.item("materials", index);
  std::vector<size_t> sets;
  std::optional<size_t> tangent;
  const auto visit = [&](const std::string& name, const Json& info) {
    const size_t set = texCoord(info);
    sets.push_back(set);
    // The surface's own normal map goes before the coat's; both before anisotropy.
    if (name == "normalTexture" || (name == "clearcoatNormalTexture" && !tangent)) tangent = set;
  };
  const Json extensions = material["extensions"];
  const Json anisotropy = extensions["KHR_materials_anisotropy"];
  forEachTexture(material, visit);
  forEachTexture(material["pbrMetallicRoughness"], visit);
  for (const std::string& name : extensions.members()) forEachTexture(extensions[name], visit);
  uv.tangents = tangent.has_value() || anisotropy.exists();
  if (!tangent && anisotropy["anisotropyTexture"].exists())
    tangent = texCoord(anisotropy["anisotropyTexture"]);
  std::sort(sets.begin(), sets.end());
  sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
  uv.needed = !sets.empty();
  uv.first = tangent ? *tangent : sets.empty() ? 0 : sets.front();
  for (const size_t set : sets)
    if (set != uv.first) uv.others.push_back(set);
  return uv;
}

bool Materials::usesAlpha(const Json& index) const {
  return index.exists() &&
         import_.document.item("materials", index)["alphaMode"].text("OPAQUE") != "OPAQUE";
}

const BuiltMaterial& Materials::build(const Json& index, MaterialUse use) {
  const size_t count = import_.document.size("materials");
  const size_t i = index.exists() ? index.index(count, "materials") : count;
  const auto [entry, isNew] = built_.try_emplace({i, use});
  if (isNew) {
    const Json json = index.exists() ? import_.document.item("materials", index)
                                     : import_.document.root()["materials (default)"];
    entry->second = create({json, uvSets(index), use});
  }
  return entry->second;
}

MaterialHandle Materials::add(Material material) {
  import_.scene.materials.push_back(std::move(material));
  return {static_cast<uint32_t>(import_.scene.materials.size() - 1)};
}

MaterialHandle Materials::wrap(MaterialType type, MaterialHandle inner) {
  Material material;
  material.type = type;
  material.a = inner;
  return add(material);
}

TextureHandle Materials::texture(const Source& from, const Json& info, bool raw, int channel) {
  return info.exists() ? textures_.bitmap(info, from.uv, raw, channel) : TextureHandle{};
}

// The default material of glTF 2.0, 3.7.2.1, is the one of an empty object.
BuiltMaterial Materials::create(const Source& from) {
  Material material;
  material.type = MaterialType::metallicRoughness;
  material.name = from.json["name"].text("");
  const Json glossiness = from.json.extension("KHR_materials_pbrSpecularGlossiness");
  if (glossiness.exists()) {
    addSpecularGlossiness(from, glossiness, material);
  } else {
    addBase(from, material);
  }
  addReflection(from, material);
  addAnisotropy(from, material);
  addTransmission(from, material);
  if (from.json["occlusionTexture"].exists())
    import_.inform(from.json, "the occlusion texture is not used: light transport finds occlusion");

  BuiltMaterial built;
  built.emission = emission(from, material);
  const bool unlit = from.json.extension("KHR_materials_unlit").exists();
  if (unlit) {
    import_.inform(from.json, "KHR_materials_unlit: emits its base colour and reflects nothing");
    const std::string name = material.name;
    material = Material{};
    material.name = name;
    material.diffuse = Rgb(0.f);
  }
  const bool transmits = material.specTrans.value > 0 || material.specTrans.texture.valid();
  built.material = add(material);
  if (built.emission && from.json["doubleSided"].boolean(false)) {
    built.shinesBothWays = !transmits && from.json["alphaMode"].text("OPAQUE") != "BLEND";
    if (!built.shinesBothWays)
      import_.inform(from.json,
                     "is doubleSided, but half-transparent: it shines to the front only");
  }
  if (const Json info = from.json["normalTexture"]; info.exists() && !unlit) {
    if (const TextureHandle map = normalTexture(from, info); map.valid()) {
      built.material = wrap(MaterialType::normalMap, built.material);
      import_.scene.materials.back().map = map;
    }
  }
  if (!transmits) built.material = wrap(MaterialType::twoSided, built.material);
  const FloatParam opaque = opacity(from);
  if (opaque.texture.valid() || opaque.value < 1) {
    built.material = wrap(MaterialType::mask, built.material);
    import_.scene.materials.back().opacity = opaque;
  }
  return built;
}

void Materials::addBase(const Source& from, Material& material) {
  const Json pbr = from.json["pbrMetallicRoughness"];
  TextureHandle base = texture(from, pbr["baseColorTexture"], false);
  if (from.use.vertexColor) base = textures_.product(base, textures_.attribute("vertex_color"));
  material.diffuse = textures_.color(from.baseFactor().color, base);
  const Json both = pbr["metallicRoughnessTexture"];
  material.roughness =
      textures_.number(pbr["roughnessFactor"].numberWithin(0, 1, 1), texture(from, both, true, 1));
  material.metallic =
      textures_.number(pbr["metallicFactor"].numberWithin(0, 1, 1), texture(from, both, true, 2));
}

// Opacity from the base colour's alpha, the vertices' and alphaCutoff.
FloatParam Materials::opacity(const Source& from) {
  const Json modeJson = from.json["alphaMode"];
  const std::string mode = modeJson.text("OPAQUE");
  if (mode == "OPAQUE") return 1.f;
  if (mode != "MASK" && mode != "BLEND")
    modeJson.fail(fmt::format("'{}' is unknown; it must be OPAQUE, MASK or BLEND{}", mode,
                              suggestion(mode, {"OPAQUE", "MASK", "BLEND"})));
  const Source::BaseFactor base = from.baseFactor();
  TextureHandle alpha = texture(from, base.texture, false, 3);
  if (from.use.vertexAlpha) alpha = textures_.product(alpha, textures_.attribute("vertex_alpha"));
  if (mode == "BLEND") return textures_.number(base.alpha, alpha);
  const auto cutoff = from.json["alphaCutoff"].number(0.5);
  if (cutoff <= 0) return 1.f;
  if (!alpha.valid()) return base.alpha >= cutoff ? 1.f : 0.f;
  Texture step;
  step.type = TextureType::power;
  step.a = textures_.scaled(alpha, Rgb(static_cast<float>(base.alpha / cutoff)));
  // As steep as leaves (1 / cutoff) ^ exponent finite in single precision.
  step.scale = cutoff < 1 ? static_cast<float>(std::min(64.0, 80 / std::log(1 / cutoff))) : 64.f;
  return textures_.add(step);
}

std::optional<ColorParam> Materials::emission(const Source& from, const Material& base) {
  if (from.json.extension("KHR_materials_unlit").exists()) return base.diffuse;
  const Rgb factor = from.json["emissiveFactor"].vector(Rgb(0.f));
  const double strength =
      from.json.extension("KHR_materials_emissive_strength")["emissiveStrength"].numberWithin(
          0, 3.4e38, 1);
  if (!(maxComponent(factor) > 0) || strength == 0) return {};
  return textures_.color(factor * static_cast<float>(strength),
                         texture(from, from.json["emissiveTexture"], false));
}

// The map with its x and y scaled and, where uv are mirrored, y turned over. Only the direction
// counts: instead of x and y growing, z shrinks; so all values stay in [0,1] and a file can hold
// them.
TextureHandle Materials::normalTexture(const Source& from, const Json& info) {
  TextureHandle map = texture(from, info, true);
  const auto scale = static_cast<float>(info["scale"].number(1));
  if (!map.valid()) return map;
  const bool negative = scale < 0;
  map = textures_.turned(map, {negative ? 1.f : 0.f, negative != from.use.mirrored ? 1.f : 0.f, 0});
  const float s = std::abs(scale);
  if (s == 1) return map;
  const Rgb towardsZero = s < 1 ? Rgb(1 - s, 1 - s, 0) : Rgb(0, 0, 1 - 1 / s);
  return textures_.mix(map, textures_.constant(Rgb(0.5f)), textures_.constant(towardsZero));
}

}  // namespace lobelia::io::gltf
