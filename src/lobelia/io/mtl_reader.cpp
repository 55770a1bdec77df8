// Wavefront MTL, parsed by tinyobjloader, with the extension for physically based materials (Pr,
// Pm, Pc, Pcr, map_Pr, map_Pm, norm).
//
// Ks and Ns of the Phong model become a metallic-roughness material: exporters write for Ks the
// "specular level" of a dielectric, whose normal reflectance is 0.08 Ks; Ns becomes the microfacet
// alpha sqrt(2 / (Ns + 2)). So no material reflects more than it receives, whatever Kd + Ks is.
// Illumination models 4, 6, 7 and 9 (glass) become a dielectric; other transparency (d, Tr, map_d)
// an opacity. A black Kd under a map_Kd is taken for white. Ka, reflection maps and displacement
// are not used.
#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "lobelia/io/file_bytes.h"
#include "lobelia/io/image_io.h"
#include "lobelia/io/mesh_checks.h"
#include "lobelia/io/obj_materials.h"

namespace lobelia::io {
namespace {

class MtlBuilder {
 public:
  MtlBuilder(std::string file, float heightUnit, Scene& scene)
      : file_(std::move(file)), heightUnit_(heightUnit), scene_(scene) {}

  MtlMaterial build(const tinyobj::material_t& mtl) {
    Material material;
    material.name = mtl.name;
    const bool glass = mtl.illum == 4 || mtl.illum == 6 || mtl.illum == 7 || mtl.illum == 9;
    if (glass) {
      material.type = MaterialType::dielectric;
      material.ior = std::clamp(finite(mtl.ior, 1.5f), 1.f, 10.f);
    } else {
      reflection(mtl, material);
    }
    MtlMaterial out;
    out.material = add(std::move(material));
    if (const TextureHandle map = texture(mtl.normal_texname, mtl.normal_texopt, true); map.valid())
      out.material = wrap(MaterialType::normalMap, out.material, map, 1);
    else if (const TextureHandle bump = texture(mtl.bump_texname, mtl.bump_texopt, true);
             bump.valid())
      out.material = wrap(MaterialType::bump, out.material, bump,
                          heightUnit_ * finite(mtl.bump_texopt.bump_multiplier, 1));
    if (!glass) {
      out.material = wrap(MaterialType::twoSided, out.material, {}, 1);
      const FloatParam opacity = opacityOf(mtl);
      if (opacity.texture.valid() || opacity.value < 1) {
        out.material = wrap(MaterialType::mask, out.material, {}, 1);
        scene_.materials.back().opacity = opacity;
      }
    }
    const Rgb ke = color(mtl.emission);
    const TextureHandle map = texture(mtl.emissive_texname, mtl.emissive_texopt, false);
    if (map.valid())
      out.emission = product(maxComponent(ke) > 0 ? ke : Rgb(1.f), map);
    else if (maxComponent(ke) > 0)
      out.emission = ColorParam(ke);
    return out;
  }

 private:
  static float finite(float value, float fallback) {
    return std::isfinite(value) ? value : fallback;
  }
  static Rgb color(const float* v) {
    Rgb c;
    for (int i = 0; i < 3; ++i) c[i] = std::max(0.f, finite(v[i], 0));
    return c;
  }
  static float unit(float v) { return std::clamp(finite(v, 0), 0.f, 1.f); }

  void reflection(const tinyobj::material_t& mtl, Material& m) {
    m.type = MaterialType::metallicRoughness;
    m.ior = 1.5f;
    const Rgb kd = min(color(mtl.diffuse), Rgb(1.f));
    const TextureHandle map = texture(mtl.diffuse_texname, mtl.diffuse_texopt, false);
    m.diffuse = map.valid() ? product(maxComponent(kd) > 0 ? kd : Rgb(1.f), map) : ColorParam(kd);
    m.metallic = unit(mtl.metallic);
    m.clearcoat = unit(mtl.clearcoat_thickness);
    m.clearcoatRoughness = unit(mtl.clearcoat_roughness);
    const TextureHandle rough = texture(mtl.roughness_texname, mtl.roughness_texopt, true, 1);
    const TextureHandle metal = texture(mtl.metallic_texname, mtl.metallic_texopt, true, 2);
    if (metal.valid()) m.metallic = metal;
    if (rough.valid() || mtl.roughness > 0 || metal.valid() || mtl.metallic > 0) {
      m.roughness = rough.valid() ? FloatParam(rough) : FloatParam(unit(mtl.roughness));
      return;
    }
    const float ns = std::max(0.f, finite(mtl.shininess, 1));
    m.roughness = std::pow(2 / (ns + 2), 0.25f);            // alpha is its square
    m.specular = min(color(mtl.specular) * 2.f, Rgb(1.f));  // of 0.04
  }

  FloatParam opacityOf(const tinyobj::material_t& mtl) {
    const TextureHandle map = texture(mtl.alpha_texname, mtl.alpha_texopt, true);
    const float d = unit(mtl.dissolve);
    if (!map.valid()) return d;
    Image& image = scene_.images[scene_.textures[map.index].image.index];
    if (image.channels == 4) scene_.textures[map.index].channel = 3;
    return product(Rgb(d), map).texture;
  }

  ColorParam product(Rgb factor, TextureHandle texture) {
    if (factor == Rgb(1.f)) return texture;
    Texture constant, product;
    constant.value = factor;
    product.type = TextureType::product;
    product.a = addTexture(constant), product.b = texture;
    return addTexture(product);
  }

  TextureHandle texture(std::string name, const tinyobj::texture_option_t& option, bool raw,
                        int channel = -1) {
    if (name.empty()) return {};
    std::replace(name.begin(), name.end(), '\\', '/');
    const std::string path = (std::filesystem::path(file_).parent_path() / name).string();
    Texture out;
    out.type = TextureType::bitmap;
    out.channel = channel;
    if (option.clamp) out.wrapU = out.wrapV = Wrap::clamp;
    for (int r = 0; r < 2; ++r) {
      out.uvMatrix[r][r] = finite(option.scale[r], 1);
      out.uvMatrix[r][2] = finite(option.origin_offset[r], 0);
    }
    // v was flipped, so that its offset and scale start at the other end.
    out.uvMatrix[1][2] = 1 - out.uvMatrix[1][1] - out.uvMatrix[1][2];
    const auto [entry, isNew] = images_.try_emplace({path, raw});
    if (isNew) {
      try {
        scene_.images.push_back(readImage(path, {raw, 0}, {file_, 0, 0}));
        entry->second = {static_cast<uint32_t>(scene_.images.size() - 1)};
      } catch (const InputError& error) {
        addWarning(scene_.findings, {}, fmt::format("{}; the texture is left out", error.what()));
      }
    }
    if (!entry->second.valid()) return {};
    out.image = entry->second;
    return addTexture(out);
  }

  TextureHandle addTexture(Texture texture) {
    scene_.textures.push_back(std::move(texture));
    return {static_cast<uint32_t>(scene_.textures.size() - 1)};
  }
  MaterialHandle add(Material material) {
    scene_.materials.push_back(std::move(material));
    return {static_cast<uint32_t>(scene_.materials.size() - 1)};
  }
  MaterialHandle wrap(MaterialType type, MaterialHandle inner, TextureHandle map, float scale) {
    Material material;
    material.type = type;
    material.a = inner;
    material.map = map;
    material.scale = scale;
    return add(std::move(material));
  }

  std::string file_;
  float heightUnit_;
  Scene& scene_;
  std::map<std::pair<std::string, bool>, ImageHandle> images_;
};

}  // namespace

std::map<std::string, MtlMaterial> readMtl(const std::string& file, float heightUnit,
                                           Scene& scene) {
  std::map<std::string, MtlMaterial> out;
  std::istringstream stream;
  try {
    stream.str(readFileBytes(file, "material library", {scene.file, 0, 0}));
  } catch (const InputError& error) {
    addWarning(scene.findings, {}, fmt::format("{}; its materials are left out", error.what()));
    return out;
  }
  std::map<std::string, int> indices;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  tinyobj::LoadMtl(&indices, &materials, &stream, &warning, &error);
  MtlBuilder builder(file, heightUnit, scene);
  for (const tinyobj::material_t& material : materials)
    if (!material.name.empty()) out[material.name] = builder.build(material);
  return out;
}

}  // namespace lobelia::io
