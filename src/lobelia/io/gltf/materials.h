// Materials (glTF 2.0, 3.9, and the KHR_materials_* extensions) as MaterialType::metallicRoughness.
//
// Conventions.
//  - Opaque materials reflect on both sides, whether doubleSided or not: a renderer has no reason
//    to cull, closed objects look the same, and open ones are not holes.
//  - alphaMode MASK and BLEND become an opacity by which rays pass; MASK's step is the power 64 of
//    alpha / alphaCutoff, clamped to 1, where alpha comes from a texture or vertices.
//  - Emission leaves the front of a surface only; both sides of one that is doubleSided, unless it
//  is
//    half-transparent (transmission or BLEND), where a second layer would be seen.
//  - KHR_materials_unlit emits its base colour and reflects nothing.
//  - Occlusion textures are not used: light transport finds occlusion itself.
//  - Normal maps and anisotropy need tangents. They follow the uv, not TANGENT, and since a shading
//    frame here is right-handed, surfaces whose uv are mirrored get a mirrored copy of the material
//    (green channel and rotation turned over).
//  - KHR_materials_volume: the surface's own geometry is the thickness; thicknessFactor says only
//    whether there is a volume (above 0) or a thin sheet.
#pragma once

#include <map>
#include <optional>
#include <tuple>

#include "lobelia/io/gltf/textures.h"

namespace lobelia::io::gltf {

// What of a mesh a material depends on.
struct MaterialUse {
  bool vertexColor = false, vertexAlpha = false;
  bool mirrored = false;  // uv run against the surface's orientation
  friend auto operator<=>(const MaterialUse&, const MaterialUse&) = default;
};

struct BuiltMaterial {
  MaterialHandle material;
  std::optional<ColorParam> emission;
  bool shinesBothWays = false;
};

// The sets of materials among which --variant chooses (KHR_materials_variants).
std::vector<std::string> variantNames(const Document& document);

class Materials {
 public:
  explicit Materials(const Import& import);

  // The material index of a primitive, under the variant that was asked for; missing: the default.
  Json of(const Json& primitive) const;
  UvSets uvSets(const Json& index) const;
  bool usesAlpha(const Json& index) const;
  const BuiltMaterial& build(const Json& index, MaterialUse use);

 private:
  struct Source;  // a material's JSON, its uv sets and how it is used (materials.cpp)
  TextureHandle texture(const Source& from, const Json& info, bool raw, int channel = -1);
  BuiltMaterial create(const Source& from);
  void addBase(const Source& from, Material& material);
  void addSpecularGlossiness(const Source& from, const Json& extension, Material& material);
  void addReflection(const Source& from, Material& material);  // specular, ior, clearcoat, sheen
  void addAnisotropy(const Source& from, Material& material);
  void addTransmission(const Source& from, Material& material);  // and volume
  TextureHandle normalTexture(const Source& from, const Json& info);
  FloatParam opacity(const Source& from);
  std::optional<ColorParam> emission(const Source& from, const Material& base);
  MaterialHandle add(Material material);
  MaterialHandle wrap(MaterialType type, MaterialHandle inner);

  const Import& import_;
  Textures textures_;
  std::optional<size_t> variant_;
  std::map<std::tuple<size_t, MaterialUse>, BuiltMaterial> built_;
};

}  // namespace lobelia::io::gltf
