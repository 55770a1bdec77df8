// One tile of a frame (relight/frame.h): its hits, its vertices, its pixels. For one thread; keeps
// its memory from tile to tile.
#pragma once

#include "lobelia/relight/frame.h"
#include "lobelia/relight/pixel_shader.h"

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
  static constexpr int kSize = 32;  // pixels along an edge
  // Renders the pixels [x0, x1) x [y0, y1) of the data window.
  TileCounts render(const FrameInput& input, int x0, int y0, int x1, int y1, Film& film);

 private:
  struct Pixel {
    Ray ray;
    float weight = 1;    // of the filter
    uint32_t index = 0;  // in the tile
    std::optional<Hit> hit;
    PixelPlace place{};
  };
  void makeRays(const FrameInput& input, const Film& film, int x0, int y0, int x1, int y1,
                int sample);
  void trace(const Tracer& tracer);
  // From pixel `first` on, as many as the cache has room for; returns the end of them.
  size_t placePixels(const VisibilityData& data, size_t first);
  // Adds the pixels [first, end), which are placed.
  void shade(const FrameInput& input, size_t first, size_t end, TileCounts* counts);
  Rgb radiance(const FrameInput& input, const Pixel& pixel);

  std::vector<Pixel> pixels_;  // blocks of 4 x 4, one after the other
  std::vector<Rgb> sums_;
  std::vector<uint64_t> evaluations_;  // by pixel
  VertexCache vertices_;
  PixelShader shader_;
};

}  // namespace lobelia::relight
