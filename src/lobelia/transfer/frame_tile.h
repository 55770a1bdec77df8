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
  void shade(const FrameInput& input);
  void addPixel(const FrameInput& input, size_t number);
  // The packet of pixels that one table serves, or of those without any, with room for a pixel.
  PixelPacket& packetFor(size_t table);
  void finish(const FrameInput& input, size_t table);
  void addTo(const relight::TilePixel& pixel, Rgb value);

  std::vector<relight::TilePixel> pixels_;
  std::vector<SurfaceNormals> normals_;                // of pixels_
  std::vector<std::unique_ptr<PixelPacket>> packets_;  // by table; the last one's have none
  std::vector<Rgb> sums_;
  uint64_t frame_ = 0;  // of vertices_
  FrameVertices vertices_;
  uint64_t lightLookups_ = 0;
  TileCounts counts_;
};

}  // namespace lobelia::transfer
