// The camera's rays of a tile of a frame and what they meet: the deferred buffer of one sample.
#pragma once

#include <optional>
#include <vector>

#include "lobelia/film/film.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::relight {

inline constexpr int kTileSize = 32;  // pixels along an edge, at most

// Pixels [x0, x1) x [y0, y1) of the film's data window.
struct TileArea {
  int x0, y0, x1, y1;
};
// The tiles of a film, row by row; size: pixels along an edge, at most kTileSize.
std::vector<TileArea> tileAreas(const Film& film, int size = kTileSize);

// Where a pixel lies among the vertices of a cache.
struct PixelPlace {
  uint32_t slot[3];
  float weight[3];
};

struct TilePixel {
  Ray ray;
  float weight = 1;    // of the filter
  uint32_t index = 0;  // in the tile: row times kTileSize and column
  std::optional<Hit> hit;
  PixelPlace place{};
};

// Of one sample of `spp`: of a single one through the middle of the pixel, else by the camera's
// filter. Blocks of 4 x 4 pixels, one after the other.
void makeTileRays(const Camera& camera, const Film& film, const TileArea& area, uint64_t seed,
                  int sample, int spp, std::vector<TilePixel>* pixels);
// In packets.
void traceTileRays(const Tracer& tracer, std::vector<TilePixel>* pixels);

// Writes the tile's pixels, by their index, to the film's picture (layer ""), or adds them to it.
void writeTile(const std::vector<Rgb>& values, float scale, bool add, const TileArea& area,
               Film* film);
// The same of lobes evaluated for each pixel, to the layer "cost", where the film has it.
void writeTileCost(const std::vector<uint64_t>& evaluations, float scale, bool add,
                   const TileArea& area, Film* film);

}  // namespace lobelia::relight
