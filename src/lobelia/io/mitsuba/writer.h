// The writer of Mitsuba 3 scenes (internal to io). One class; a file for textures and materials,
// one for the rest.
#pragma once

#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <string>

#include "lobelia/scene/scene.h"

namespace lobelia::io::mitsuba {

// Without characters that mean something to XML readers, shells or file systems; may be empty.
std::string cleanName(const std::string& wanted);

// Gives each object of a file its own clean name.
class Names {
 public:
  // `wanted` made clean (or `otherwise` when nothing is left), with a number when it is taken.
  std::string make(const std::string& wanted, const std::string& otherwise);

 private:
  std::set<std::string> taken_;
};

class Writer {
 public:
  Writer(const Scene& scene, std::string folder);
  // Meshes and images first, scene.xml last. Throws RuntimeError.
  void write();
  // design_writer.cpp: what the scene has that `before` has otherwise, as a design (io/design.h).
  void writeDesign(const std::string& file, const Scene& before);

 private:
  using Node = pugi::xml_node;

  // writer_materials.cpp
  void writeTextures();
  void writeMaterials();
  Node textureNode(Node parent, const Texture& texture, const std::string& id);
  void writeImages();
  // Beside the scene; returns the name in it.
  std::string writeImage(ImageHandle image, const std::string& base, bool mayBeRaw);
  const std::string& imageFile(ImageHandle image);
  bool isRaw(ImageHandle image) const { return rawImages_.contains(image.index); }
  // Whether a texture is the same everywhere, and its value.
  std::optional<Rgb> constantOf(TextureHandle texture) const;
  // The name of the texture element that readers see as `texture`.
  std::string textureId(TextureHandle texture, bool asNumber);
  void reference(Node parent, const std::string& id, const char* name = nullptr);
  void color(Node parent, const char* name, const ColorParam& param);
  void scalar(Node parent, const char* name, const FloatParam& param);
  void roughness(Node node, const Material& material);
  void writeMaterial(Node parent, const Material& material, const std::string& id);
  void materialProperties(Node node, const Material& material);
  void nested(Node node, MaterialHandle material);
  void principled(Node node, const Material& material);
  // writer_extensions.cpp
  void metallicRoughness(Node node, const Material& material);
  void coatedConductor(Node node, const Material& material);

  // captured.cpp
  void sphericalGaussians(Node node, const Material& material);
  void absorption(Node node, const Material& material);

  // writer.cpp
  void writeIntegrator();
  void writeCameras();
  void writeCamera(const Camera& camera, const std::string& id);
  void writeFilm(Node sensor, const Camera& camera);
  void writeMeshes();
  void writeInstances();
  void writeEmitters();
  void writeEmitter(const Emitter& emitter, const std::string& id);
  void emitterProperties(Node node, const Emitter& emitter);

  // design_writer.cpp
  void writeChangedMaterials(const Scene& before);
  void writeChangedEmitters(const Scene& before);
  void writeChangedCameras(const Scene& before);
  std::string designImage(ImageHandle image);

  const Scene& scene_;
  std::string folder_;
  pugi::xml_document document_;
  Node root_;
  Names ids_, imageNames_;
  // Designs: materials stand within those that they are part of, images where they came from; the
  // folder for those that came from nowhere.
  bool isDesign_ = false;
  std::string designFile_, designImages_;
  std::vector<std::string> imageFiles_, meshTypes_, meshFiles_, materialIds_, emitterIds_;
  std::map<std::pair<uint32_t, bool>, std::string> textureIds_;  // by handle and use as a number
  std::set<uint32_t> rawImages_;  // PNG images whose numbers are the values
};

// Shortest text that reads back as the same number.
std::string text(float value);
std::string text(double value);
std::string text(Rgb value);
pugi::xml_node object(pugi::xml_node parent, const char* tag, const char* type,
                      const std::string& id = {});
void property(pugi::xml_node parent, const char* tag, const char* name, const std::string& value);
void transform(pugi::xml_node parent, const char* name, const Mat4& matrix);

}  // namespace lobelia::io::mitsuba
