// The reader of PBRT-v4 scenes: runs the directives of a file and its includes and fills a Scene.
// One class, one file per kind of object (transforms.cpp, attributes.cpp, cameras.cpp,
// textures.cpp, spectra.cpp, materials.cpp, shapes.cpp, lights.cpp, area_lights.cpp).
//
// What PBRT has and we have not is a warning (Finding) that says what stands in for it; parameters
// that nothing used are warnings; unknown directives, shapes, materials, lights are errors.
// Deviation: a named material must be defined before the first shape that uses it.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "lobelia/io/pbrt/state.h"
#include "lobelia/io/scene_io.h"

namespace lobelia::io::pbrt {

// How an image file is wanted.
struct ImageRequest {
  bool raw = false;
  float gamma = 0;        // 0: sRGB
  bool grey = false;      // one channel, as PBRT makes numbers of colours
  bool inverted = false;  // 1 - scale times the value
  float scale = 1;        // only when inverted
};

class Reader {
 public:
  Reader(Scene& scene, Findings& findings, Context& context, const std::string& file);

  void read();

 private:
  struct Directive {
    const char* name;
    enum Block : uint8_t { anywhere, options, world } block;
    void (Reader::*run)(const Token&);
  };
  static const std::vector<Directive>& directives();

  // reader.cpp
  void runFile(const std::string& file, const Location& from);
  void runDirective(const Token& token);
  void include(const Token& token);
  void import(const Token& token);
  void worldBegin(const Token& token);
  std::string resolve(const std::string& file, const std::string& what, const Location& from) const;
  std::string quoted(const Token& directive, const char* what);
  // Parameters of the directive, with the defaults that Attribute gave for its kind.
  Parameters parameters(const Token& directive, const std::string& kind = {});
  // A warning that is worth saying once however often its reason occurs.
  void warnOnce(const Location& where, const std::string& message);

  // transforms.cpp
  std::vector<double> numbers(const Token& directive, size_t count);
  void concatenate(const Token& directive, const Mat4& matrix, bool replace = false);
  void identity(const Token& token);
  void translate(const Token& token);
  void scale(const Token& token);
  void rotate(const Token& token);
  void lookAt(const Token& token);
  void transform(const Token& token);
  void concatTransform(const Token& token);
  void coordinateSystem(const Token& token);
  void coordSysTransform(const Token& token);
  void activeTransform(const Token& token);
  void transformTimes(const Token& token);
  Transform placement(const Mat4& matrix, const Location& where) const;

  // attributes.cpp
  void attributeBegin(const Token& token);
  void attributeEnd(const Token& token);
  void transformBegin(const Token& token);
  void transformEnd(const Token& token);
  void objectBegin(const Token& token);
  void objectEnd(const Token& token);
  void objectInstance(const Token& token);
  void push(const Token& token, const char* kind);
  void pop(const Token& token, const char* kind);
  void attribute(const Token& token);
  void colorSpace(const Token& token);
  void option(const Token& token);
  void reverseOrientation(const Token& token);
  void mediumInterface(const Token& token);
  void makeNamedMedium(const Token& token);

  // cameras.cpp
  void camera(const Token& token);
  void film(const Token& token);
  void pixelFilter(const Token& token);
  void sampler(const Token& token);
  void integrator(const Token& token);
  void accelerator(const Token& token);
  void makeCamera();

  // spectra.cpp
  // The value of a constant colour parameter.
  Rgb constantColor(const Parameter& parameter, SpectrumUse use);
  std::optional<Rgb> color(Parameters& in, const std::string& name, SpectrumUse use);
  Rgb namedSpectrum(const Parameter& parameter, SpectrumUse use);

  // textures.cpp
  void texture(const Token& token);
  ColorParam makeTexture(const std::string& type, bool isColor, Parameters& in);
  ColorParam imageMap(bool isColor, Parameters& in);
  ColorParam checkerboard(bool isColor, Parameters& in);
  void uvMapping(Parameters& in, Texture* out);
  ImageHandle image(const std::string& file, const ImageRequest& request, const Location& where);
  TextureHandle add(Texture texture);
  TextureHandle asTexture(const ColorParam& param);
  TextureHandle asTexture(const FloatParam& param);
  ColorParam product(const ColorParam& a, const ColorParam& b);
  ColorParam colorParam(Parameters& in, const std::string& name, Rgb otherwise,
                        SpectrumUse use = SpectrumUse::reflectance);
  std::optional<ColorParam> optionalColor(Parameters& in, const std::string& name, SpectrumUse use);
  FloatParam floatParam(Parameters& in, const std::string& name, float otherwise);
  std::optional<FloatParam> optionalFloat(Parameters& in, const std::string& name);
  // A colour or number parameter of a texture, by its kind.
  ColorParam value(Parameters& in, const std::string& name, float otherwise, bool isColor);

  // materials.cpp
  void material(const Token& token);
  void makeNamedMaterial(const Token& token);
  void namedMaterial(const Token& token);
  MaterialHandle add(Material material);
  MaterialHandle makeMaterial(const std::string& type, const std::string& name, Parameters& in);
  Material coatedDiffuse(Parameters& in);
  Material conductor(Parameters& in, const std::string& prefix);
  Material coatedConductor(Parameters& in);
  Material dielectric(Parameters& in, bool thin);
  Material diffuseTransmission(Parameters& in);
  MaterialHandle mixture(Parameters& in);
  Material standIn(const std::string& type, Parameters& in);
  struct Roughness {
    FloatParam u, v;
    bool smooth = false;
  };
  Roughness roughness(Parameters& in, const std::string& prefix);
  float indexOfRefraction(Parameters& in, const std::string& name, float otherwise);
  MaterialHandle perturbed(MaterialHandle base, Parameters& in);
  MaterialHandle find(const std::string& name, const Location& where) const;
  // The state's material with the shape's opacity and medium.
  MaterialHandle surfaceMaterial(const Location& where, const std::optional<FloatParam>& alpha);
  MaterialHandle withMedium(MaterialHandle material, const Location& where);

  // shapes.cpp
  void shape(const Token& token);
  MeshHandle triangleMesh(Parameters& in);
  MeshHandle bilinearMesh(Parameters& in);
  MeshHandle plyMesh(Parameters& in);
  MeshHandle loopSubdivision(Parameters& in);
  MeshHandle sphere(Parameters& in, Mat4* toWorld);
  MeshHandle disk(Parameters& in);
  MeshHandle cylinder(Parameters& in);
  MeshHandle add(Mesh mesh);
  void loadMeshes();

  // lights.cpp
  void lightSource(const Token& token);
  Rgb lightColor(Parameters& in, const std::string& name);
  Emitter pointLight(Parameters& in);
  Emitter distantLight(Parameters& in);
  Emitter spotLight(Parameters& in);
  Emitter goniometricLight(Parameters& in);
  Emitter projectionLight(Parameters& in);
  void infiniteLight(Parameters& in);
  void addEnvironment(Emitter emitter, const Location& where);
  EmitterHandle add(Emitter emitter);
  Image squareImage(const std::string& file, const Location& where);

  // area_lights.cpp
  void areaLightSource(const Token& token);
  // parts: PBRT's shapes that the mesh consists of, 0: its triangles.
  EmitterHandle areaEmitter(size_t parts);
  void finishAreaLights();
  void makeTwoSided(size_t instance);
  void applySensor();

  struct Saved {
    State state;
    const char* kind;
    Location where;
  };
  // A mesh file that is read when all of them are known, in parallel with the others.
  struct PendingMesh {
    MeshHandle mesh;
    std::string file;
    Location where;
  };
  // What has to wait for the meshes: powers and second sides of area lights.
  struct PendingArea {
    EmitterHandle emitter;
    double power = 0;        // <= 0: not given
    double textureMean = 1;  // mean luminance of the light's image
    size_t parts = 0;        // as given to areaEmitter()
    Location where;
    bool twoSided = false;
  };

  Scene& scene_;
  Findings& findings_;
  Context& context_;
  std::string mainFile_, folder_;
  std::vector<std::string> openFiles_;  // being read; finds those that include themselves
  Tokenizer* in_ = nullptr;
  State state_;
  std::vector<Saved> saved_;
  bool inWorld_ = false;
  std::map<std::string, Mat4> coordinateSystems_;
  std::set<std::string> warned_;

  std::map<std::string, std::vector<Instance>> objects_;
  std::string openObject_;
  bool inObject_ = false;

  // The options block; the camera is made when it ends.
  std::string cameraType_;
  Parameters cameraParameters_, filmParameters_;
  Mat4 cameraFromWorld_;
  bool hasFilm_ = false;
  Camera camera_;
  float imagingRatio_ = 1;

  std::map<std::string, ColorParam> colorTextures_;
  std::map<std::string, FloatParam> floatTextures_;
  std::map<std::string, ImageHandle> images_;
  std::map<std::string, MaterialHandle> namedMaterials_;
  std::map<std::string, MaterialHandle> variants_;  // of materials, with opacity or medium
  MaterialHandle defaultMaterial_;
  std::map<std::string, Medium> media_;
  std::map<std::string, MeshHandle> meshes_;
  std::vector<PendingMesh> pendingMeshes_;
  std::vector<PendingArea> pendingAreas_;
  EmitterHandle environment_;
};

}  // namespace lobelia::io::pbrt
