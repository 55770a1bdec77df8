// Images, textures and materials of the Mitsuba writer.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "lobelia/io/image_io.h"
#include "lobelia/io/image_pixels.h"
#include "lobelia/io/mitsuba/writer.h"

namespace lobelia::io::mitsuba {
namespace {

// The 8-bit image that decodes to exactly these values, if there is one.
std::optional<std::vector<uint8_t>> encode8(const Image& image, Transfer transfer) {
  const std::vector<float> color = decodingTable(8, transfer),
                           alpha = decodingTable(8, Transfer::linear);
  const auto channels = static_cast<size_t>(image.channels);
  std::vector<uint8_t> bytes;
  bytes.reserve(image.pixels.size());
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    const std::vector<float>& table = i % channels == 3 ? alpha : color;
    const auto at = std::lower_bound(table.begin(), table.end(), image.pixels[i]);
    if (at == table.end() || *at != image.pixels[i]) return {};
    bytes.push_back(static_cast<uint8_t>(at - table.begin()));
  }
  return bytes;
}

void writeImageExr(const std::string& file, const Image& image) {
  Film film;
  film.fullWidth = film.width = image.width;
  film.fullHeight = film.height = image.height;
  const bool hasAlpha = image.channels == 4;
  Layer& layer = film.layers[""];
  layer.channels = hasAlpha ? 3 : image.channels;
  for (size_t i = 0; i < image.pixels.size(); ++i)
    (hasAlpha && i % 4 == 3 ? film.alpha : layer.values).push_back(image.pixels[i]);
  writeExr(file, film);
}

bool isUvIdentity(const Texture& t) {
  const Texture identity;
  return std::equal(&t.uvMatrix[0][0], &t.uvMatrix[0][0] + 6, &identity.uvMatrix[0][0]);
}

void uvTransform(pugi::xml_node node, const Texture& t) {
  if (isUvIdentity(t)) return;
  const auto& m = t.uvMatrix;
  const Mat4 matrix{{{{m[0][0], m[0][1], 0, m[0][2]},
                      {m[1][0], m[1][1], 0, m[1][2]},
                      {0, 0, 1, 0},
                      {0, 0, 0, 1}}}};
  if (inverse(matrix)) return transform(node, "to_uv", matrix);
  // Readers refuse singular transforms. Stripes and the like can be said in the old way.
  property(node, "float", "uscale", text(m[0][0]));
  property(node, "float", "vscale", text(m[1][1]));
  property(node, "float", "uoffset", text(m[0][2]));
  property(node, "float", "voffset", text(m[1][2]));
}

// The name of the plugin, ours where Mitsuba has none.
const char* pluginName(MaterialType type) {
  switch (type) {
    case MaterialType::diffuse:
      return "diffuse";
    case MaterialType::conductor:
      return "conductor";
    case MaterialType::roughConductor:
      return "roughconductor";
    case MaterialType::dielectric:
      return "dielectric";
    case MaterialType::thinDielectric:
      return "thindielectric";
    case MaterialType::roughDielectric:
      return "roughdielectric";
    case MaterialType::plastic:
      return "plastic";
    case MaterialType::roughPlastic:
      return "roughplastic";
    case MaterialType::principled:
      return "principled";
    case MaterialType::phong:
      return "phong";
    case MaterialType::ward:
      return "ward";
    case MaterialType::diffuseTransmitter:
      return "difftrans";
    case MaterialType::metallicRoughness:
      return "metallicroughness";
    case MaterialType::coatedConductor:
      return "coatedconductor";
    case MaterialType::sphericalGaussians:
      return "sphericalgaussians";
    case MaterialType::twoSided:
      return "twosided";
    case MaterialType::mask:
      return "mask";
    case MaterialType::blend:
      return "blendbsdf";
    case MaterialType::bump:
      return "bumpmap";
    case MaterialType::normalMap:
      return "normalmap";
    case MaterialType::null:
      break;
  }
  return "null";
}

}  // namespace

void Writer::writeImages() {
  std::set<uint32_t> surroundings;  // envmaps know no raw images
  for (const Emitter& e : scene_.emitters)
    if (e.type == EmitterType::environment || e.type == EmitterType::goniometric)
      surroundings.insert(e.image.index);
  for (uint32_t i = 0; i < scene_.images.size(); ++i) {
    const std::string stem = std::filesystem::path(scene_.images[i].name).stem().string();
    imageFiles_.push_back(
        writeImage({i}, "textures/" + imageNames_.make(stem, "image"), !surroundings.contains(i)));
  }
}

std::string Writer::writeImage(ImageHandle handle, const std::string& base, bool mayBeRaw) {
  const Image& image = scene_[handle];
  std::error_code ignored;  // a folder that is not there makes the next lines fail
  const std::filesystem::path path = folder_ + "/" + base;
  std::filesystem::create_directories(path.parent_path(), ignored);
  const auto srgb = encode8(image, Transfer::srgb);
  const auto raw = srgb || !mayBeRaw ? std::nullopt : encode8(image, Transfer::linear);
  const std::string name = base + (srgb || raw ? ".png" : ".exr");
  if (raw) rawImages_.insert(handle.index);
  if (srgb || raw)
    writePng(folder_ + "/" + name, srgb ? *srgb : *raw, image.width, image.height, image.channels);
  else
    writeImageExr(folder_ + "/" + name, image);
  return name;
}

const std::string& Writer::imageFile(ImageHandle image) {
  std::string& file = imageFiles_[image.index];
  if (file.empty()) file = designImage(image);
  return file;
}

std::optional<Rgb> Writer::constantOf(TextureHandle handle) const {
  const Texture& t = scene_[handle];
  if (t.type == TextureType::constant) return t.value;
  if (t.type != TextureType::scale) return {};
  const std::optional<Rgb> inner = constantOf(t.a);
  return inner ? std::optional(*inner * t.scale) : std::nullopt;
}

void Writer::reference(Node parent, const std::string& id, const char* name) {
  Node node = parent.append_child("ref");
  if (name) node.append_attribute("name") = name;
  node.append_attribute("id") = id.c_str();
}

void Writer::color(Node parent, const char* name, const ColorParam& param) {
  const std::optional<Rgb> value = param.texture.valid() ? constantOf(param.texture) : param.value;
  if (value)
    property(parent, "rgb", name, text(*value));
  else
    reference(parent, textureId(param.texture, false), name);
}

void Writer::scalar(Node parent, const char* name, const FloatParam& param) {
  if (!param.texture.valid()) return property(parent, "float", name, text(param.value));
  if (const auto value = constantOf(param.texture))
    return property(parent, "rgb", name, text(*value));
  reference(parent, textureId(param.texture, true), name);
}

// Textures stand at the top of the file in the scene's order, so that handles stay as they are.
void Writer::writeTextures() {
  for (uint32_t i = 0; i < scene_.textures.size(); ++i)
    if (scene_.textures[i].type != TextureType::constant) textureId({i}, false);
}

std::string Writer::textureId(TextureHandle handle, bool asNumber) {
  // Mitsuba exchanges the colours of a checkerboard that is asked for a number.
  const bool exchange = asNumber && scene_[handle].type == TextureType::checkerboard;
  const auto key = std::pair(handle.index, exchange);
  if (const auto known = textureIds_.find(key); known != textureIds_.end()) return known->second;
  Texture texture = scene_[handle];
  if (exchange) std::swap(texture.a, texture.b);
  const std::string id = ids_.make("", exchange ? "texture_of_numbers" : "texture");
  textureIds_.emplace(key, id);
  // Nested textures first: they are written before this one.
  for (const TextureHandle inner : {texture.a, texture.b, texture.c})
    if (inner.valid() && !constantOf(inner)) textureId(inner, false);
  textureNode(root_, texture, id);
  return id;
}

pugi::xml_node Writer::textureNode(Node parent, const Texture& t, const std::string& id) {
  constexpr const char* kWraps[] = {"repeat", "mirror", "clamp", "zero", "one"};
  const auto channel = [&](Node node) {
    if (t.channel >= 0) property(node, "integer", "channel", std::to_string(t.channel));
  };
  switch (t.type) {
    case TextureType::bitmap: {
      Node node = object(parent, "texture", "bitmap", id);
      property(node, "string", "filename", imageFile(t.image));
      property(node, "string", "filter_type", t.filter == Filter::nearest ? "nearest" : "bilinear");
      property(node, "string", t.wrapU == t.wrapV ? "wrap_mode" : "wrap_mode_u",
               kWraps[static_cast<size_t>(t.wrapU)]);
      // As Mitsuba 0.6 has it (wrapModeU, wrapModeV); Mitsuba 3 has one mode for both.
      if (t.wrapU != t.wrapV)
        property(node, "string", "wrap_mode_v", kWraps[static_cast<size_t>(t.wrapV)]);
      if (t.alphaChannel) property(node, "string", "channel", "a");
      channel(node);
      if (!t.attribute.empty()) property(node, "string", "attribute", t.attribute);
      if (isRaw(t.image)) property(node, "boolean", "raw", "true");
      uvTransform(node, t);
      return node;
    }
    case TextureType::checkerboard: {
      Node node = object(parent, "texture", "checkerboard", id);
      color(node, "color0", t.a);
      color(node, "color1", t.b);
      uvTransform(node, t);
      return node;
    }
    case TextureType::scale:
      if (!constantOf(t.a)) {
        Node node = object(parent, "texture", "scale", id);
        property(node, "float", "scale", text(t.scale));
        reference(node, textureId(t.a, false));
        return node;
      }
      [[fallthrough]];
    case TextureType::constant: {
      // Where only a texture may stand, a constant is a checkerboard of one colour.
      const Rgb value = t.type == TextureType::constant ? t.value : *constantOf(t.a) * t.scale;
      Node node = object(parent, "texture", "checkerboard", id);
      property(node, "rgb", "color0", text(value));
      property(node, "rgb", "color1", text(value));
      return node;
    }
    case TextureType::meshAttribute: {
      Node node = object(parent, "texture", "mesh_attribute", id);
      property(node, "string", "name", t.attribute);
      if (t.scale != 1) property(node, "float", "scale", text(t.scale));
      channel(node);
      return node;
    }
    case TextureType::product:
    case TextureType::mix:
    case TextureType::power: {
      const bool isMix = t.type == TextureType::mix, isPower = t.type == TextureType::power;
      const char* const type = isPower ? "power" : isMix ? "mix" : "product";
      Node node = object(parent, "texture", type, id);
      color(node, "a", t.a);
      if (!isPower) color(node, "b", t.b);
      if (isMix) color(node, "amount", t.c);
      if (isPower) property(node, "float", "exponent", text(t.scale));
      return node;
    }
  }
  return {};
}

void Writer::writeMaterials() {
  for (const Material& material : scene_.materials)
    materialIds_.push_back(ids_.make(material.name, "material"));
  for (size_t i = 0; i < scene_.materials.size(); ++i) {
    writeMaterial(root_, scene_.materials[i], materialIds_[i]);
  }
}

void Writer::writeMaterial(Node parent, const Material& material, const std::string& id) {
  materialProperties(object(parent, "bsdf", pluginName(material.type), id), material);
}

void Writer::nested(Node node, MaterialHandle material) {
  if (isDesign_ && material.index >= materialIds_.size())
    return writeMaterial(node, scene_[material], {});
  reference(node, materialIds_[material.index]);
}

void Writer::roughness(Node node, const Material& m) {
  constexpr const char* kDistributions[] = {"ggx", "beckmann", "phong", "ggx"};
  property(node, "string", "distribution", kDistributions[static_cast<size_t>(m.distribution)]);
  const bool isotropic = m.alphaU.texture == m.alphaV.texture &&
                         (m.alphaU.texture.valid() || m.alphaU.value == m.alphaV.value);
  scalar(node, isotropic ? "alpha" : "alpha_u", m.alphaU);
  if (!isotropic) scalar(node, "alpha_v", m.alphaV);
}

void Writer::materialProperties(Node node, const Material& m) {
  const auto ior = [&] {
    property(node, "float", "int_ior", text(m.ior));
    property(node, "float", "ext_ior", "1");
  };
  const auto wrapped = [&] {
    nested(node, m.a);
    if (m.b.valid()) nested(node, m.b);
  };
  switch (m.type) {
    case MaterialType::diffuse:
      color(node, "reflectance", m.diffuse);
      break;
    case MaterialType::conductor:
    case MaterialType::roughConductor:
      color(node, "eta", m.eta);
      color(node, "k", m.k);
      color(node, "specular_reflectance", m.specular);
      if (m.type == MaterialType::roughConductor) roughness(node, m);
      break;
    case MaterialType::dielectric:
    case MaterialType::thinDielectric:
    case MaterialType::roughDielectric:
      ior();
      color(node, "specular_reflectance", m.specular);
      color(node, "specular_transmittance", m.transmittance);
      if (m.type == MaterialType::roughDielectric) roughness(node, m);
      if (m.type != MaterialType::thinDielectric) absorption(node, m);
      break;
    case MaterialType::plastic:
    case MaterialType::roughPlastic:
      ior();
      color(node, "diffuse_reflectance", m.diffuse);
      color(node, "specular_reflectance", m.specular);
      property(node, "boolean", "nonlinear", m.nonlinear ? "true" : "false");
      if (m.type == MaterialType::roughPlastic) roughness(node, m);
      break;
    case MaterialType::principled:
      principled(node, m);
      break;
    case MaterialType::phong:
      scalar(node, "exponent", m.alphaU);
      color(node, "diffuse_reflectance", m.diffuse);
      color(node, "specular_reflectance", m.specular);
      break;
    case MaterialType::ward: {
      constexpr const char* kVariants[] = {"ward", "ward-duer", "balanced"};
      property(node, "string", "variant", kVariants[std::clamp(m.wardVariant, 0, 2)]);
      scalar(node, "alpha_u", m.alphaU);
      scalar(node, "alpha_v", m.alphaV);
      color(node, "diffuse_reflectance", m.diffuse);
      color(node, "specular_reflectance", m.specular);
      break;
    }
    case MaterialType::diffuseTransmitter:
      color(node, "transmittance", m.transmittance);
      color(node, "reflectance", m.diffuse);
      break;
    case MaterialType::metallicRoughness:
      metallicRoughness(node, m);
      break;
    case MaterialType::coatedConductor:
      coatedConductor(node, m);
      break;
    case MaterialType::sphericalGaussians:
      sphericalGaussians(node, m);
      break;
    case MaterialType::twoSided:
      wrapped();
      break;
    case MaterialType::mask:
      scalar(node, "opacity", m.opacity);
      wrapped();
      break;
    case MaterialType::blend:
      scalar(node, "weight", m.weight);
      wrapped();
      break;
    case MaterialType::bump:
      property(node, "float", "scale", text(m.scale));
      reference(node, textureId(m.map, false), "map");
      wrapped();
      break;
    case MaterialType::normalMap:
      reference(node, textureId(m.map, false), "normalmap");
      wrapped();
      break;
    case MaterialType::null:
      break;
  }
}

void Writer::principled(Node node, const Material& m) {
  color(node, "base_color", m.diffuse);
  scalar(node, "roughness", m.roughness);
  scalar(node, "anisotropic", m.anisotropic);
  scalar(node, "metallic", m.metallic);
  scalar(node, "spec_trans", m.specTrans);
  scalar(node, "spec_tint", m.specTint);
  scalar(node, "sheen", m.sheen);
  scalar(node, "sheen_tint", m.sheenTint);
  scalar(node, "flatness", m.flatness);
  scalar(node, "clearcoat", m.clearcoat);
  scalar(node, "clearcoat_gloss", m.clearcoatGloss);
  property(node, "float", "eta", text(m.ior));
}

}  // namespace lobelia::io::mitsuba
