#include "lobelia/transfer/frame_tile.h"

#include <algorithm>

#include "lobelia/trace/flush_denormals.h"
#include "lobelia/transfer/resultant.h"

namespace lobelia::transfer {
namespace {

using relight::kTileSize;
using relight::PixelPlace;
using relight::TilePixel;

// Vertices beyond which they are forgotten between samples; a sample adds at most three for each
// pixel.
constexpr size_t kMostVertices = 16384;

// False: nothing is known of this side.
bool reflectionAt(const FrameInput& input, const SurfacePoint& at, Vec3f wo, Reflection* out) {
  if (!at.material.valid()) return false;
  if (input.tables.has(at.material)) return input.tables.at(at.material, at.frame.n, wo, out);
  *out = reflectionOf(makeBsdf(input.tracer.scene(), at, wo, 0), wo);
  return true;
}

}  // namespace

void TileCounts::add(const TileCounts& o) {
  bufferNs += o.bufferNs, mergeNs += o.mergeNs, shadeNs += o.shadeNs;
  objectPixels += o.objectPixels, vertices += o.vertices;
  lightLookups += o.lightLookups, nonFinite += o.nonFinite;
  if (o.firstBad) firstBad = std::min(firstBad.value_or(*o.firstBad), *o.firstBad);
}

void FrameTile::placePixels(const FrameInput& input) {
  for (TilePixel& pixel : pixels_) {
    if (!pixel.hit) continue;
    const relight::SurroundingVertices around = input.data.mesh.around(*pixel.hit);
    const Side side = input.lookup.sideOf(*pixel.hit, -pixel.ray.d);
    for (size_t v = 0; v < 3; ++v) {
      pixel.place.slot[v] = vertices_.slotOf(around.vertex[v], side);
      pixel.place.weight[v] = around.weight[v];
    }
  }
}

void FrameTile::shade(const FrameInput& input, TileCounts* counts) {
  for (const TilePixel& pixel : pixels_) {
    const Rgb value = radiance(input, pixel) * pixel.weight;
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
  const FrameLight& light = input.light;
  if (!pixel.hit)
    return hidden ? Rgb{} : input.emitters.escaped(normalize(light.toLight * pixel.ray.d));
  const SurfacePoint at = surfacePoint(input.tracer.scene(), *pixel.hit);
  const Vec3f wo = aboveHorizon(-pixel.ray.d, at);
  Rgb sum = at.emitter.valid() && !hidden ? input.emitters.emitted(at, -pixel.ray.d) : Rgb{};
  Reflection own;
  if (!reflectionAt(input, at, wo, &own)) return sum;
  if (own.diffuse != Rgb{}) {
    Rgb arriving{};
    for (size_t v = 0; v < 3; ++v)
      arriving += vertices_.diffuse(pixel.place.slot[v]) * pixel.place.weight[v];
    sum += own.diffuse * arriving;
  }
  if (own.count == 0) return sum;
  if (light.firstPass == 0 && light.endPass > 0) sum += straight(light, own, pixel.place);
  return sum + reflected(light, own, pixel.place);
}

Rgb FrameTile::straight(const FrameLight& light, const Reflection& own, const PixelPlace& place) {
  VisibleSum visible(own.r);
  for (size_t v = 0; v < 3; ++v) visible.add(place.weight[v], vertices_.visible(place.slot[v]));
  const VisiblePart part = visible.part();
  if (!part.whole && part.share == Rgb{}) return {};
  Rgb sum{};
  for (size_t i = 0; i < static_cast<size_t>(own.count); ++i) {
    const ReflectedLobe lobe = visibleOf(own.lobes[i], part);
    sum += lobe.alpha * light.lookUp(lobe.axis, lobe.kappa);
  }
  lightLookups_ += static_cast<size_t>(own.count);
  return sum;
}

Rgb FrameTile::reflected(const FrameLight& light, const Reflection& own, const PixelPlace& place) {
  std::span<const TransferLobe> lobes[3];
  bool any = false;
  for (size_t v = 0; v < 3; ++v) {
    lobes[v] = vertices_.lobes(place.slot[v]);
    any = any || !lobes[v].empty();
  }
  if (!any) return {};
  Rgb sum{};
  for (size_t i = 0; i < vertices_.lobeCount(); ++i) {
    LobeSum between;
    for (size_t v = 0; v < 3; ++v)
      if (!lobes[v].empty() && lobes[v][i].share != Rgb{})
        between.add(place.weight[v], lobes[v][i], vertices_.mirror(place.slot[v]));
    if (between.empty()) continue;
    const TransferLobe lobe = between.lobe();
    const float size = length(lobe.r);
    const Vec3f axis = size > 0 ? lobe.r / size : own.mirror;
    sum += lobe.share * light.lookUp(axis, kappaOfResultant(size));
    ++lightLookups_;
  }
  return own.glossy * sum;
}

TileCounts FrameTile::render(const FrameInput& input, const relight::TileArea& area, Film& film) {
  const FlushDenormals flush;
  TileCounts counts;
  sums_.assign(kTileSize * kTileSize, Rgb{});
  if (frame_ != input.frame) vertices_.begin(input.lookup, input.data, input.light, input.eye);
  frame_ = input.frame;
  const uint64_t before = vertices_.merged, lookups = vertices_.lightLookups;
  lightLookups_ = 0;
  for (int sample = 0; sample < input.settings.spp; ++sample) {
    const int64_t start = nanosecondsNow();
    relight::makeTileRays(input.camera, film, area, input.seed, sample, input.settings.spp,
                          &pixels_);
    relight::traceTileRays(input.tracer, &pixels_);
    if (vertices_.count() > kMostVertices) vertices_.forget();
    placePixels(input);
    const int64_t placed = nanosecondsNow();
    vertices_.mergeNew();
    const int64_t merged = nanosecondsNow();
    shade(input, &counts);
    counts.bufferNs += placed - start;
    counts.mergeNs += merged - placed;
    counts.shadeNs += nanosecondsNow() - merged;
  }
  if (counts.firstBad) {  // it was the tile's
    const int pixel = static_cast<int>(*counts.firstBad);
    counts.firstBad = static_cast<uint32_t>((area.y0 + pixel / kTileSize) * film.width + area.x0 +
                                            pixel % kTileSize);
  }
  counts.vertices = vertices_.merged - before;
  counts.lightLookups = lightLookups_ + vertices_.lightLookups - lookups;
  relight::writeTile(sums_, 1 / static_cast<float>(input.settings.spp), false, area, &film);
  return counts;
}

}  // namespace lobelia::transfer
