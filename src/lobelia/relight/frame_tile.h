// One tile of a frame (relight/frame.h): its hits, its vertices, its pixels. For one thread; keeps
// its memory from tile to tile.
#pragma once

#include "lobelia/relight/frame.h"
#include "lobelia/relight/pixel_shader.h"
#include "lobelia/relight/tile_rays.h"

namespace lobelia::relight {

struct FrameInput {
  const Tracer& tracer;
  const EmitterSampler& emitters;
  const VisibilityData& data;
  const DirectionLookup& lookup;
  const FrameLight& light;
  const Camera& camera;
  const FrameSettings& settings;
  uint64_t seed = 0;
};

struct TileCounts {
  int64_t bufferNs = 0, mergeNs = 0, shadeNs = 0;
  uint64_t objectPixels = 0, vertices = 0, mergedNodes = 0, nonFinite = 0;
  std::optional<uint32_t> firstBad;  // the smallest pixel of the film with a sample not finite
  PixelCounts pixels;
  void add(const TileCounts& o);
};

class FrameTile {
 public:
  TileCounts render(const FrameInput& input, const TileArea& area, Film& film);

 private:
  // From pixel `first` on, as many as the cache has room for; returns the end of them.
  size_t placePixels(const VisibilityData& data, size_t first);
  // Adds the pixels [first, end), which are placed.
  void shade(const FrameInput& input, size_t first, size_t end, TileCounts* counts);
  Rgb radiance(const FrameInput& input, const TilePixel& pixel);

  std::vector<TilePixel> pixels_;
  std::vector<Rgb> sums_;
  std::vector<uint64_t> evaluations_;  // by pixel
  VertexCache vertices_;
  PixelShader shader_;
};

}  // namespace lobelia::relight
