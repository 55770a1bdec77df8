// Reference path tracer: next-event estimation and BSDF sampling combined by the power heuristic.
#pragma once

#include "lobelia/film/film.h"
#include "lobelia/film/film_preview.h"
#include "lobelia/path/emitter_sampling.h"

namespace lobelia {

class Checkpoints;
class PathObserver;

enum class Component : uint8_t { all, direct, indirect };

struct PixelSet {                // which pixels of the data window are computed; empty: all
  std::vector<uint32_t> pixels;  // sorted indices y * width + x into the data window
};
// N pixels spread over the data window by the seed (blue-noise-like: one per stratum).
PixelSet spreadPixels(int width, int height, size_t count, uint64_t seed);
// The film's alpha: 1 at the pixels of a set, 0 elsewhere; opaque when all are computed.
void markPixels(Film& film, const PixelSet& pixels);

// Sums of light by light group, when asked for; adds nothing otherwise.
struct GroupSums {
  const EmitterSampler* emitters = nullptr;
  Component component = Component::all;  // what the sums hold
  Rgb* sums = nullptr;                   // emitters->groups().size() of them

  // Light that an emitter (or EmitterSampler::kEscaped) sends along d.
  void add(uint32_t emitter, Vec3f d, Rgb direct, Rgb indirect) const {
    if (sums == nullptr) return;
    const Rgb value = component == Component::all      ? direct + indirect
                      : component == Component::direct ? direct
                                                       : indirect;
    emitters->addByGroup(emitter, d, value, sums);
  }
};

struct PathSettings {
  int spp = 64;
  int maxDepth = -1;  // Mitsuba's count; -1 unlimited
  int rouletteDepth = 5;
  int directSamples = 4;  // emitter samples at vertices seen directly or by sharp lobes
  float specularLimit = 0.08f;
  Component component = Component::all;
  double timeLimit = 0;  // seconds; 0: none. Samples are added in passes over the image.
  bool hideEmitters = false;
  PixelSet pixels;
  Checkpoints* checkpoints = nullptr;  // where to save the state and to go on from; null: nowhere
  PathObserver* observer = nullptr;    // who is told what paths do (path/path_observer.h)
  FilmPreview* preview = nullptr;      // who looks on; null: nobody
};

// Adds the picture and the layers "direct", "indirect", "albedo", "normal", "depth", "variance"
// (variance of the mean), LightGroups::layer() of every group (their sum is the picture) and "cost"
// (rays traced per sample) that film already has to film. Counts "path_rays", "shadow_rays",
// "nonfinite" in the context's statistics. Same seed, same pixels for any number of threads. False
// when stopped before all samples were added. Sets "first_nonfinite_pixel" to 1 + the smallest
// pixel with such a path.
bool renderPath(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                const PathSettings& settings, Film& film, Context& context);

// Light tracing: particles connected to the camera. Finds caustics that a path tracer cannot, but
// nothing seen through specular surfaces. spp: particles per pixel.
bool renderLight(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                 const PathSettings& settings, Film& film, Context& context);

}  // namespace lobelia
