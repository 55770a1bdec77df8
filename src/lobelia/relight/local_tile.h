// One tile of a frame lit by local sources (relight/local_frame.h): its hits, its light cut, its
// vertices, its pixels. For one thread; keeps its memory from tile to tile.
#pragma once

#include "lobelia/path/emitter_sampling.h"
#include "lobelia/relight/bounced_light.h"
#include "lobelia/relight/local_frame.h"
#include "lobelia/relight/local_kernels.h"
#include "lobelia/relight/pixel_groups.h"
#include "lobelia/relight/tile_rays.h"
#include "lobelia/relight/tile_vertices.h"

namespace lobelia::relight {

struct LocalInput {
  const Tracer& tracer;
  const EmitterSampler& emitters;
  const LocalSources& sources;
  const VisibilityData& data;
  const SurfaceLight& light;
  const Camera& camera;
  const LocalSettings& settings;
  uint64_t seed = 0;
};

// Light from infinity as a ray in this direction meets it.
inline Rgb escaped(const LocalInput& input, Vec3f direction) {
  return input.emitters.escaped(normalize(input.settings.toScene.vector(direction)));
}

struct LocalCounts {
  int64_t bufferNs = 0, cutNs = 0, mergeNs = 0, directNs = 0, shadeNs = 0;
  uint64_t objectPixels = 0, vertices = 0, mergedNodes = 0, cutNodes = 0, evaluations = 0,
           shadowRays = 0, mirrorRays = 0, nonFinite = 0;
  std::optional<uint32_t> firstBad;  // the smallest pixel of the film with a sample not finite
  void add(const LocalCounts& o);
};

class LocalTile {
 public:
  // Pixels along an edge: as many as GroupLanes holds.
  static constexpr int kSize = 16;
  static_assert(kSize * kSize <= GroupLanes::kMost * kGroupPixels);
  LocalCounts render(const LocalInput& input, const TileArea& area, Film& film);

 private:
  void makeSurfaces(const LocalInput& input, const TileArea& area, const Film& film, int sample);
  // From surface `first` on, as many as there is room for the vertices of; returns the end.
  size_t placeVertices(const LocalInput& input, size_t first);
  void addDirect(const LocalInput& input, std::span<LitPixel> pixels);
  void addBounced(const LocalInput& input, LitPixel& pixel);
  // Adds a sample of all pixels, emission and background included, to the tile's.
  void finish(const LocalInput& input);

  std::vector<TilePixel> pixels_;
  std::vector<LitPixel> surfaces_;  // of the pixels that meet one
  std::vector<PixelGroup> groups_;
  std::vector<Rgb> sums_;              // of the samples, by pixel
  std::vector<uint64_t> evaluations_;  // the same
  TileCutSelector selector_;
  TileCut cut_;
  TileVertices vertices_;
  NearLight light_;
  LocalCounts counts_;
};

}  // namespace lobelia::relight
