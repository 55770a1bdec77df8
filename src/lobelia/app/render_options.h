// What `lobelia render` can be told; defaults give a good image.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/app/console.h"

namespace CLI {
class App;
}

namespace lobelia::app {

struct SceneOptions {
  std::string scene;                     // file, or the name of a built-in scene
  std::vector<std::string> definitions;  // -D name=value
  std::string environment, sky, variant, design;
  float time = 0;
  bool strict = false;
  float detail = 1;    // built-in scenes
  std::string meshes;  // built-in scenes: folder of real meshes
};

struct RenderOptions {
  SceneOptions scene;
  std::vector<std::string> outputs;  // .exr and .png
  std::string lights = "glossy", gather = "all";
  int spp = 0;  // 0: the method's default
  std::string size, crop, camera;
  uint64_t pixels = 0;
  std::optional<uint64_t> pixelsSeed;
  int passes = 0;    // independent light sets; 0: one per sample, unless lights are saved or loaded
  int maxDepth = 0;  // 0: the scene's
  uint64_t lightCount = 0, environmentLights = 1024;  // lightCount 0: the model's default
  uint64_t photonsNearest = 50;
  double photonRadius = 0;  // 0: a tenth of the scene's
  int gatherRays = 4;       // of --lights photon
  size_t rows = 0;          // of --gather mrcs; 0: the method's default
  size_t columns = 0;       // of mrcs and lightslice; 0: the method's default
  size_t slices = 0;        // of lightslice; 0: the default
  double error = 0;         // relative error aimed at; 0: the method's default
  std::string sketch;       // numbers kept of each column, "off"; "": the method's default
  std::string columnScale = "scalar";
  float nearField = -1;   // of spherical lights, in radii; below 0: the default
  uint64_t memory = 0;    // bytes for columns or Rich-VPLs; 0: the default
  std::string cutMode;    // of --gather sglc; "": the default
  size_t cutSize = 0;     // of cuts of light trees; 0: the strategy's default
  double threshold = -1;  // of bounds, over all light; below 0: the default
  std::string bound, boundForm, shared, children;  // of --sglc-mode paper; "": the default
  std::string illumcutRays;                        // of --gather illumcut; "": the default
  size_t richLights = 0;     // of --lights richvpl, from here on; 0, "": the default
  std::string richRadiance;  // "cube", "vmf"
  int richTexels = 0, richLobes = 0;
  std::string direct = "nee";
  float radius = 0;  // of spherical lights, over the tenth neighbour's distance; 0: automatic
  std::string sphereIndicator = "planar", sphereSampling = "product";
  int sphereSamples = 16;
  // Of --lights vsgl (vsgl_options.h); "", 0: the default.
  std::string vsglClusters, vsglShading, vsglVariance, vsglMerging, vsglShadows;
  size_t vsglPoints = 0, vsglViews = 0;
  int vsglMapSize = 0;
  double vsglOverlap = 0;
  float vsglSpread = 0;
  float specularLimit = 0.08f;
  float nearLights = -1;  // that lie where receivers find light by rays; below 0: the default
  std::string clamp;      // "": the method's default
  bool compensate = false;
  std::string component = "all";
  uint64_t seed = 0;
  double timeLimit = 0;
  std::string checkpoint, resume;  // files; at most one of them is named
  double checkpointInterval = 20;  // seconds
  std::string replay;              // X,Y
  std::string saveLights, loadLights, stats, aovs, exportTrees;
  float exposure = 0;
  int frames = 0;     // of a camera path or turntable; 0: one picture
  std::string frame;  // K or A-B: only these of them
  bool turntable = false;
  std::string display;             // HOST:PORT of a viewer
  std::vector<std::string> given;  // long names of what stands on the command line
};

struct GlobalOptions {
  int threads = 0;
  bool quiet = false, verbose = false;
  Verbosity verbosity() const {
    return quiet ? Verbosity::quiet : verbose ? Verbosity::verbose : Verbosity::normal;
  }
};

void addSceneOptions(CLI::App& command, SceneOptions& options);
// Size, crop, camera and frames.
void addPictureOptions(CLI::App& command, RenderOptions& options);
void addRenderOptions(CLI::App& command, RenderOptions& options);
void addGlobalOptions(CLI::App& command, GlobalOptions& options);
// Makes an empty value ('--crop ""', perhaps of a script's unset variable) an error for every
// option and argument of a command; to be called after all of them are added.
void refuseEmptyValues(CLI::App& command);

}  // namespace lobelia::app
