// Keys that glTF 2.0 does not know where they stand (misspelt ones, mostly): readers pass over them
// without a word, and the author wonders why nothing changes. Each is a warning that names the
// nearest known key. `extras` may hold anything; so may extensions that are not read.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <sstream>

#include "lobelia/io/gltf/import.h"

namespace lobelia::io::gltf {
namespace {

// Keys of a kind of object; "key:kind": an object, or an array of objects, of that kind.
struct Kind {
  const char* name;
  const char* keys;
};

constexpr Kind kKinds[] = {
    {"root",
     "asset:asset accessors:accessor animations:animation buffers:buffer bufferViews:bufferView "
     "cameras:camera images:image materials:material meshes:mesh nodes:node samplers:sampler scene "
     "scenes:scene skins:skin textures:texture extensionsUsed extensionsRequired "
     "extensions:extensions"},
    {"asset", "copyright generator version minVersion"},
    {"accessor",
     "name bufferView byteOffset componentType normalized count type max min sparse:sparse"},
    {"sparse", "count indices:sparseIndices values:sparseValues"},
    {"sparseIndices", "bufferView byteOffset componentType"},
    {"sparseValues", "bufferView byteOffset"},
    {"animation", "name channels:channel samplers:animationSampler"},
    {"channel", "sampler target:channelTarget"},
    {"channelTarget", "node path"},
    {"animationSampler", "input interpolation output"},
    {"buffer", "name uri byteLength extensions:extensions"},
    {"bufferView", "name buffer byteOffset byteLength byteStride target extensions:extensions"},
    {"camera", "name type orthographic:orthographic perspective:perspective"},
    {"orthographic", "xmag ymag zfar znear"},
    {"perspective", "aspectRatio yfov zfar znear"},
    {"image", "name uri mimeType bufferView"},
    {"material",
     "name pbrMetallicRoughness:metallicRoughness normalTexture:normalTexture "
     "occlusionTexture:occlusionTexture emissiveTexture:textureInfo emissiveFactor alphaMode "
     "alphaCutoff doubleSided extensions:extensions"},
    {"metallicRoughness",
     "baseColorFactor baseColorTexture:textureInfo metallicFactor roughnessFactor "
     "metallicRoughnessTexture:textureInfo"},
    {"textureInfo", "index texCoord extensions:textureExtensions"},
    {"normalTexture", "index texCoord scale extensions:textureExtensions"},
    {"occlusionTexture", "index texCoord strength extensions:textureExtensions"},
    {"mesh", "name primitives:primitive weights"},
    {"primitive",
     "attributes:attributes indices material mode targets:attributes extensions:extensions"},
    {"node",
     "name camera children skin matrix mesh rotation scale translation weights "
     "extensions:extensions"},
    {"sampler", "name magFilter minFilter wrapS wrapT"},
    {"scene", "name nodes"},
    {"skin", "name inverseBindMatrices skeleton joints"},
    {"texture", "name sampler source extensions:extensions"},
    // Extensions are looked up by name, wherever they stand.
    {"EXT_meshopt_compression",
     "buffer byteOffset byteLength byteStride count mode filter fallback"},
    {"EXT_texture_webp", "source"},
    {"KHR_draco_mesh_compression", "bufferView attributes:attributes"},
    {"KHR_lights_punctual", "light lights:light"},
    {"light", "name color intensity type range spot:spot"},
    {"spot", "innerConeAngle outerConeAngle"},
    {"KHR_materials_anisotropy",
     "anisotropyStrength anisotropyRotation anisotropyTexture:textureInfo"},
    {"KHR_materials_clearcoat",
     "clearcoatFactor clearcoatTexture:textureInfo clearcoatRoughnessFactor "
     "clearcoatRoughnessTexture:textureInfo clearcoatNormalTexture:normalTexture"},
    {"KHR_materials_emissive_strength", "emissiveStrength"},
    {"KHR_materials_ior", "ior"},
    {"KHR_materials_pbrSpecularGlossiness",
     "diffuseFactor diffuseTexture:textureInfo specularFactor glossinessFactor "
     "specularGlossinessTexture:textureInfo"},
    {"KHR_materials_sheen",
     "sheenColorFactor sheenColorTexture:textureInfo sheenRoughnessFactor "
     "sheenRoughnessTexture:textureInfo"},
    {"KHR_materials_specular",
     "specularFactor specularTexture:textureInfo specularColorFactor "
     "specularColorTexture:textureInfo"},
    {"KHR_materials_transmission", "transmissionFactor transmissionTexture:textureInfo"},
    {"KHR_materials_unlit", ""},
    {"KHR_materials_variants", "variants:variant mappings:mapping"},
    {"variant", "name"},
    {"mapping", "name variants material"},
    {"KHR_materials_volume",
     "thicknessFactor thicknessTexture:textureInfo attenuationDistance attenuationColor"},
    {"KHR_node_visibility", "visible"},
    {"KHR_texture_transform", "offset rotation scale texCoord"},
};

using Keys = std::map<std::string, std::string>;  // key to kind; "": not looked into

const std::map<std::string, Keys>& kinds() {
  static const std::map<std::string, Keys> table = [] {
    std::map<std::string, Keys> out;
    for (const Kind& kind : kKinds) {
      Keys& keys = out[kind.name];
      std::istringstream words(kind.keys);
      for (std::string word; words >> word;) {
        const size_t colon = std::min(word.find(':'), word.size());
        keys[word.substr(0, colon)] = word.substr(std::min(colon + 1, word.size()));
      }
    }
    return out;
  }();
  return table;
}

// POSITION, TEXCOORD_0...; those of applications begin with an underscore.
bool isAttribute(const std::string& name) {
  if (name.starts_with("_") || name == "POSITION" || name == "NORMAL" || name == "TANGENT")
    return true;
  const size_t line = name.find('_');
  if (line == std::string::npos || line + 1 == name.size()) return false;
  const std::string set = name.substr(0, line);
  return (set == "TEXCOORD" || set == "COLOR" || set == "JOINTS" || set == "WEIGHTS") &&
         std::all_of(name.begin() + static_cast<ptrdiff_t>(line) + 1, name.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

class KeyCheck {
 public:
  explicit KeyCheck(const Import& import) : import_(import) {
    const Json root = import.document.root();
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
      for (size_t i = 0; i < root[list].size(); ++i) listed_.insert(root[list].at(i).text());
    check(root, "root");
    for (const auto& [key, unknown] : unknown_)
      import_.warn(unknown.first,
                   unknown.message + (unknown.count > 1 ? fmt::format(" (here and {} times more)",
                                                                      unknown.count - 1)
                                                        : ""));
  }

 private:
  struct Unknown {
    Json first;
    std::string message;
    size_t count;
  };

  // The kinds refer to each other without cycles: the depth is bounded whatever the document holds.
  void check(const Json& json, const std::string& kind) {
    if (kind.empty()) return;
    if (json.isArray()) {
      for (size_t i = 0; i < json.size(); ++i)
        if (!json.at(i).isArray()) check(json.at(i), kind);
    } else if (!json.isObject()) {
      return;  // of the wrong type: the reader says so where it reads it
    } else if (kind == "attributes") {
      checkAttributes(json);
    } else if (kind == "extensions" || kind == "textureExtensions") {
      checkExtensions(json, kind);
    } else {
      checkKeys(json, kind);
    }
  }

  void checkKeys(const Json& json, const std::string& kind) {
    const Keys& keys = kinds().at(kind);
    for (const std::string& key : json.members()) {
      if (const auto found = keys.find(key); found != keys.end()) {
        check(json[key], found->second);
        continue;
      }
      if (key == "extras" || key == "extensions") continue;
      std::vector<std::string> names;
      for (const auto& [name, inner] : keys) names.push_back(name);
      report(json[key], kind + "." + key, "is not known here and is ignored", key, names);
    }
  }

  void checkAttributes(const Json& json) {
    static const std::vector<std::string> kNames{"POSITION", "NORMAL",   "TANGENT",  "TEXCOORD_0",
                                                 "COLOR_0",  "JOINTS_0", "WEIGHTS_0"};
    for (const std::string& key : json.members())
      if (!isAttribute(key))
        report(json[key], "attributes." + key, "is not an attribute of glTF and is ignored", key,
               kNames);
  }

  // What extensionsUsed lists has been judged there.
  void checkExtensions(const Json& json, const std::string& kind) {
    for (const std::string& key : json.members()) {
      const bool onTexture = kind == "textureExtensions" && key != "KHR_texture_transform";
      if (!onTexture && kinds().contains(key)) check(json[key], key);
      if (!isKnownExtension(key) && !listed_.contains(key))
        report(json[key], "extensions." + key, "is not an extension that is supported", key,
               knownExtensions());
    }
  }

  void report(const Json& where, const std::string& key, const std::string& what,
              const std::string& name, const std::vector<std::string>& names) {
    const auto [at, isNew] = unknown_.try_emplace(key, Unknown{where, "", 0});
    if (isNew) at->second.message = what + suggestion(name, names);
    ++at->second.count;
  }

  const Import& import_;
  std::set<std::string> listed_;
  std::map<std::string, Unknown> unknown_;  // by kind and key
};

}  // namespace

void warnOfUnknownKeys(const Import& import) { KeyCheck check(import); }

}  // namespace lobelia::io::gltf
