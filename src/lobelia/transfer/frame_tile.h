// One tile of a frame (frame.h): its hits, its vertices, its pixels. For one thread; keeps its
// memory from tile to tile, and what it knows of vertices, which depends on the frame alone.
#pragma once

#include "lobelia/relight/tile_rays.h"
#include "lobelia/transfer/frame.h"
#include "lobelia/transfer/frame_vertices.h"

namespace lobelia::transfer {

struct FrameInput {
  const Tracer& tracer;
  const EmitterSampler& emitters;
  const TransferData& data;
  const ReflectionTables& tables;
  const SliceLookup& lookup;
  const FrameLight& light;
  const EyeDirection& eye;
  const Camera& camera;
  const TransferFrameSettings& settings;
  uint64_t seed = 0;
  uint64_t frame = 0;  // another for every frame of a renderer, from 1
};

struct TileCounts {
  int64_t bufferNs = 0, mergeNs = 0, shadeNs = 0;
  uint64_t objectPixels = 0, vertices = 0, lightLookups = 0, nonFinite = 0;
  std::optional<uint32_t> firstBad;  // the smallest pixel of the film with a sample not finite
  void add(const TileCounts& o);
};

class FrameTile {
 public:
  TileCounts render(const FrameInput& input, const relight::TileArea& area, Film& film);

 private:
  void placePixels(const FrameInput& input);
  void shade(const FrameInput& input, TileCounts* counts);
  Rgb radiance(const FrameInput& input, const relight::TilePixel& pixel);
  // What comes by the glossy lobes straight from infinity, and over other surfaces.
  Rgb straight(const FrameLight& light, const Reflection& own, const relight::PixelPlace& place);
  Rgb reflected(const FrameLight& light, const Reflection& own, const relight::PixelPlace& place);

  std::vector<relight::TilePixel> pixels_;
  std::vector<Rgb> sums_;
  uint64_t frame_ = 0;  // of vertices_
  FrameVertices vertices_;
  uint64_t lightLookups_ = 0;
};

}  // namespace lobelia::transfer
