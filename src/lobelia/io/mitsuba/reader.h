// The reader of Mitsuba scenes: turns the elements of a document into a Scene. One class, one file
// per kind of object (textures.cpp, _bsdfs, _emitters, _sensors, _shapes).
//
// Both dialects are read: 0.x files (camelCase) get the defaults of Mitsuba 0.6, others those of
// Mitsuba 3. What nothing used is a warning (Object::finish); unknown types of shapes, materials,
// textures, emitters and sensors are errors.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "lobelia/io/design.h"
#include "lobelia/io/mitsuba/object.h"
#include "lobelia/io/scene_io.h"
#include "lobelia/io/spectrum.h"

namespace lobelia::io::mitsuba {

class Reader {
 public:
  // time: when to look at what moves (cameras only).
  Reader(const Document& document, Scene& scene, float time, Findings& findings, Context& context)
      : document_(document), scene_(scene), time_(time), findings_(findings), context_(context) {}

  void read();
  DesignParts change();  // design.cpp: a scene that has been read
  // An element that stands for a material of the scene.
  void know(const Element& element, MaterialHandle material) {
    materials_.emplace(&element, material);
  }

 private:
  Object open(const Element& element) const { return {element, document_, findings_}; }

  // textures.cpp
  TextureHandle texture(const Element& element);
  TextureHandle bitmap(Object& object);
  TextureHandle checkerboard(Object& object);
  TextureHandle scaleTexture(Object& object);
  TextureHandle combination(Object& object);
  TextureHandle part(Object& object, const char* name, float otherwise);
  void channel(Object& object, Texture* out);
  void uvTransform(Object& object, Texture* out);
  ImageHandle image(const std::string& file, bool raw, float gamma, const Location& where);
  TextureHandle add(Texture texture);
  // A constant (any way of writing a colour or spectrum) or a texture.
  ColorParam color(const Element& element, SpectrumUse use);
  ColorParam color(Object& object, const std::string& name, Rgb otherwise,
                   SpectrumUse use = SpectrumUse::reflectance);
  Rgb constantColor(Object& object, const std::string& name, Rgb otherwise, SpectrumUse use);
  Rgb rgb(const Element& element) const;
  Rgb inlineSpectrum(const Element& element, SpectrumUse use);
  Rgb spectrumPlugin(const Element& element, SpectrumUse use);
  Rgb sampledSpectrum(const Spectrum& spectrum, SpectrumUse use, const Location& where);
  FloatParam scalar(Object& object, const std::string& name, float otherwise);
  TextureHandle scalarTexture(TextureHandle handle);

  // bsdfs.cpp
  MaterialHandle material(const Element& element);
  MaterialHandle add(Material material);
  Material simpleMaterial(Object& object);
  MaterialHandle wrapper(Object& object);
  Material principled(Object& object);
  MaterialHandle mixture(Object& object);
  // extension_bsdfs.cpp
  Material metallicRoughness(Object& object);
  Material coatedConductor(Object& object);

  // captured.cpp
  Material sphericalGaussians(Object& object);
  Material measured(Object& object);
  Rgb absorption(Object& object);
  TextureHandle textureOnly(Object& object, const std::string& name);
  void indexOfRefraction(Object& object, const std::string& defaultInside, Material* out);
  float namedOrNumber(Object& object, const std::string& name, const std::string& otherwise);
  void conductor(Object& object, Material* out);
  void roughness(Object& object, Material* out);

  // design.cpp
  void changeMaterials(const std::vector<const Element*>& elements);
  void changeEmitter(const Element& element);
  void changeSensor(const Element& element);

  // two_sided.cpp
  void assumeTwoSided();
  MaterialHandle twoSided(MaterialHandle handle);

  // emitters.cpp
  void emitter(const Element& element);  // not attached to a shape
  EmitterHandle areaEmitter(const Element& element);
  Emitter environment(Object& object);
  Emitter projector(Object& object);
  Vec3f direction(Object& object);
  EmitterHandle add(Emitter emitter, const Location& where);
  // sky_emitters.cpp
  static bool isComputedSky(Object& object);
  void sunAndSky(Object& object);
  Emitter goniometric(Object& object);
  ImageHandle photometry(const std::string& file, const Location& where);

  // sensors.cpp
  void sensor(const Element& element);
  std::vector<CameraKey> cameraKeys(const Element& animation) const;
  void film(const Element& element, Camera* out);
  void crop(Object& object, Camera* out);
  void reconstructionFilter(const Element& element, Camera* out);
  void sampler(const Element& element, Camera* out);
  void integrator(const Element& element);
  void defaultSensor();
  // A hint that uses a parameter without a value: reported, and true.
  bool isUndefinedHint(const Element& element);

  // shapes.cpp
  void shape(const Element& element);
  void instance(Object& object);
  const std::vector<Instance>& group(const Element& element);
  Instance simpleShape(Object& object);
  MeshHandle fileMesh(Object& object, const std::string& type);
  MeshHandle unitMesh(const std::string& type);
  void surface(Object& object, Instance* out);
  MaterialHandle defaultMaterial(const std::string& kind);

  const Document& document_;
  Scene& scene_;
  const float time_;
  Camera film_;  // whose film is that of sensors without one
  Findings& findings_;
  Context& context_;
  std::map<const Element*, TextureHandle> textures_;
  std::map<uint32_t, TextureHandle> exchanged_;  // checkerboards for numbers, by the original
  std::map<const Element*, MaterialHandle> materials_;
  std::map<std::string, MaterialHandle> defaultMaterials_;
  std::map<uint32_t, MaterialHandle> twoSided_;  // by what they wrap
  std::map<const Element*, EmitterHandle> areaEmitters_;
  std::map<const Element*, std::vector<Instance>> groups_;
  std::map<std::string, MeshHandle> meshes_;
  std::map<std::string, ImageHandle> images_;
  std::set<const Element*> open_;  // being read: finds objects that refer to themselves
};

// Keeps an element in the set of those being read; throws InputError when it is there already.
class ReadingGuard {
 public:
  ReadingGuard(std::set<const Element*>& open, const Element& element);
  ~ReadingGuard() { open_.erase(&element_); }
  ReadingGuard(const ReadingGuard&) = delete;
  ReadingGuard& operator=(const ReadingGuard&) = delete;

 private:
  std::set<const Element*>& open_;
  const Element& element_;
};

// Throws InputError when the matrix has no inverse.
Transform makeTransform(const Mat4& matrix, const Location& where);
// Horizontal field of view in radians of a perspective sensor or projector: fov with fov_axis, or
// focal_length. aspect: width / height. Throws InputError.
float fieldOfView(Object& object, double aspect);

}  // namespace lobelia::io::mitsuba
