#include "lobelia/relight/frame_tile.h"

#include <algorithm>

#include "lobelia/trace/flush_denormals.h"

namespace lobelia::relight {

void TileCounts::add(const TileCounts& o) {
  bufferNs += o.bufferNs, mergeNs += o.mergeNs, shadeNs += o.shadeNs;
  objectPixels += o.objectPixels, vertices += o.vertices, mergedNodes += o.mergedNodes;
  nonFinite += o.nonFinite;
  if (o.firstBad) firstBad = std::min(firstBad.value_or(*o.firstBad), *o.firstBad);
  pixels.evaluations += o.pixels.evaluations, pixels.fineChunks += o.pixels.fineChunks;
}

size_t FrameTile::placePixels(const VisibilityData& data, size_t first) {
  for (size_t i = first; i < pixels_.size(); ++i) {
    TilePixel& pixel = pixels_[i];
    if (!pixel.hit) continue;
    if (vertices_.full()) {
      if (i > first) return i;
      vertices_.forget();
    }
    const SurroundingVertices around =
        data.mesh.at(pixel.hit->instance, pixel.hit->triangle, pixel.hit->b1, pixel.hit->b2);
    for (size_t v = 0; v < 3; ++v) {
      pixel.place.slot[v] = vertices_.slotOf(around.vertex[v]);
      pixel.place.weight[v] = around.weight[v];
    }
  }
  return pixels_.size();
}

void FrameTile::shade(const FrameInput& input, size_t first, size_t end, TileCounts* counts) {
  for (size_t i = first; i < end; ++i) {
    const TilePixel& pixel = pixels_[i];
    vertices_.forgetFineIfMany();
    const uint64_t evaluated = shader_.counts.evaluations;
    const Rgb value = radiance(input, pixel) * pixel.weight;
    evaluations_[pixel.index] += shader_.counts.evaluations - evaluated;
    counts->objectPixels += pixel.hit ? 1 : 0;
    if (isFinite(value)) {
      sums_[pixel.index] += value;
    } else {
      ++counts->nonFinite;
      counts->firstBad = std::min(counts->firstBad.value_or(pixel.index), pixel.index);
    }
  }
}

Rgb FrameTile::radiance(const FrameInput& input, const TilePixel& pixel) {
  const bool hidden = input.settings.hideEmitters;
  if (!pixel.hit) {
    if (hidden) return {};
    return input.emitters.escaped(normalize(input.light.toScene.vector(pixel.ray.d)));
  }
  const Scene& scene = input.tracer.scene();
  const SurfacePoint at = surfacePoint(scene, *pixel.hit);
  const Vec3f wo = -pixel.ray.d;
  const Rgb own = at.emitter.valid() && !hidden ? input.emitters.emitted(at, wo) : Rgb{};
  return own + shader_.reflected(makeBsdf(scene, at, wo, 0), wo, pixel.place);
}

TileCounts FrameTile::render(const FrameInput& input, const TileArea& area, Film& film) {
  const FlushDenormals flush;  // tails of narrow lobes are full of them
  TileCounts counts;
  sums_.assign(kTileSize * kTileSize, Rgb{});
  evaluations_.assign(kTileSize * kTileSize, 0);
  vertices_.begin(input.light, input.data.cuts, input.settings.cacheBytes);
  shader_.begin(input.light, input.emitters, input.lookup, input.settings.refined, &vertices_);
  shader_.counts = {};
  for (int sample = 0; sample < input.settings.spp; ++sample) {
    const int64_t start = nanosecondsNow();
    makeTileRays(input.camera, film, area, input.seed, sample, input.settings.spp, &pixels_);
    traceTileRays(input.tracer, &pixels_);
    int64_t done = nanosecondsNow();
    counts.bufferNs += done - start;
    for (size_t first = 0, end; first < pixels_.size(); first = end) {
      end = placePixels(input.data, first);
      const int64_t placed = nanosecondsNow();
      vertices_.mergeNew();
      const int64_t merged = nanosecondsNow();
      shade(input, first, end, &counts);
      counts.bufferNs += placed - done;
      counts.mergeNs += merged - placed;
      done = nanosecondsNow();
      counts.shadeNs += done - merged;
    }
  }
  if (counts.firstBad) {  // it was the tile's
    const int pixel = static_cast<int>(*counts.firstBad);
    counts.firstBad = static_cast<uint32_t>((area.y0 + pixel / kTileSize) * film.width + area.x0 +
                                            pixel % kTileSize);
  }
  counts.vertices = vertices_.mergedVertices();
  counts.mergedNodes = vertices_.mergedNodes();
  counts.pixels = shader_.counts;
  const float scale = 1 / static_cast<float>(input.settings.spp);
  writeTile(sums_, scale, false, area, &film);
  writeTileCost(evaluations_, scale, false, area, &film);
  return counts;
}

}  // namespace lobelia::relight
