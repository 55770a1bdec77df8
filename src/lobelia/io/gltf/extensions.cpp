// Which extensions are read. Those that only describe (metadata) are known too: they change no
// picture.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "lobelia/io/gltf/import.h"

namespace lobelia::io::gltf {
namespace {

// Major version, or -1.
int majorVersion(const std::string& text) {
  int major = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), major);
  const bool good = error == std::errc() && (end == text.data() + text.size() || *end == '.');
  return good ? major : -1;
}

}  // namespace

const std::vector<std::string>& knownExtensions() {
  static const std::vector<std::string> known{"EXT_mesh_gpu_instancing",
                                              "EXT_meshopt_compression",
                                              "EXT_texture_webp",
                                              "KHR_draco_mesh_compression",
                                              "KHR_lights_punctual",
                                              "KHR_materials_anisotropy",
                                              "KHR_materials_clearcoat",
                                              "KHR_materials_emissive_strength",
                                              "KHR_materials_ior",
                                              "KHR_materials_pbrSpecularGlossiness",
                                              "KHR_materials_sheen",
                                              "KHR_materials_specular",
                                              "KHR_materials_transmission",
                                              "KHR_materials_unlit",
                                              "KHR_materials_variants",
                                              "KHR_materials_volume",
                                              "KHR_mesh_quantization",
                                              "KHR_node_visibility",
                                              "KHR_texture_transform",
                                              "KHR_xmp",
                                              "KHR_xmp_json_ld"};
  return known;
}

bool isKnownExtension(const std::string& name) {
  const std::vector<std::string>& known = knownExtensions();
  return std::find(known.begin(), known.end(), name) != known.end();
}

void checkAsset(const Import& import) {
  const Json root = import.document.root();
  const Json asset = root["asset"];
  if (!asset.exists()) asset.fail("is missing; a glTF file states asset.version \"2.0\"");
  const std::string version = asset["version"].text();
  const std::string least = asset["minVersion"].text(version);
  if (majorVersion(least) != 2 || (majorVersion(version) != 2 && !asset["minVersion"].exists()))
    asset["version"].fail(fmt::format("'{}' is not read; only glTF 2.x is", version));
  const Json requiredItems = root["extensionsRequired"], usedItems = root["extensionsUsed"];
  for (size_t i = 0; i < requiredItems.size(); ++i) {
    const std::string name = requiredItems.at(i).text();
    if (!isKnownExtension(name))
      requiredItems.at(i).fail(
          fmt::format("the file cannot be read without extension '{}', which is not supported{}",
                      name, suggestion(name, knownExtensions())));
  }
  for (size_t i = 0; i < usedItems.size(); ++i) {
    const std::string name = usedItems.at(i).text();
    if (!isKnownExtension(name))
      import.warn(usedItems.at(i), fmt::format("extension '{}' is not supported; what it adds is "
                                               "left out",
                                               name));
  }
}

}  // namespace lobelia::io::gltf
