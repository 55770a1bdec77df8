#include "lobelia/relight/frame_tile.h"

#include <algorithm>

#include "lobelia/base/random.h"
#include "lobelia/trace/flush_denormals.h"

namespace lobelia::relight {

void TileCounts::add(const TileCounts& o) {
  bufferNs += o.bufferNs, mergeNs += o.mergeNs, shadeNs += o.shadeNs;
  objectPixels += o.objectPixels, vertices += o.vertices, mergedNodes += o.mergedNodes;
  nonFinite += o.nonFinite;
  if (o.firstBad) firstBad = std::min(firstBad.value_or(*o.firstBad), *o.firstBad);
  pixels.evaluations += o.pixels.evaluations, pixels.fineChunks += o.pixels.fineChunks;
}

void FrameTile::makeRays(const FrameInput& input, const Film& film, int x0, int y0, int x1, int y1,
                         int sample) {
  constexpr int kBlock = 4;
  pixels_.clear();
  for (int by = y0; by < y1; by += kBlock)
    for (int bx = x0; bx < x1; bx += kBlock)
      for (int y = by; y < std::min(by + kBlock, y1); ++y)
        for (int x = bx; x < std::min(bx + kBlock, x1); ++x) {
          Pixel& pixel = pixels_.emplace_back();
          pixel.index = static_cast<uint32_t>((y - y0) * kSize + x - x0);
          const int fullX = film.x0 + x, fullY = film.y0 + y;
          Vec2f offset{}, lens{0.5f, 0.5f};
          if (input.settings.spp > 1) {
            const uint64_t stream =
                (static_cast<uint64_t>(fullY) << 32) | static_cast<uint32_t>(fullX);
            Sampler random(input.seed, stream, static_cast<uint32_t>(sample));
            offset = sampleFilter(input.camera.filter, input.camera.filterRadius, random.next2D(),
                                  &pixel.weight);
            lens = random.next2D();
          }
          pixel.ray = generateRay(input.camera,
                                  {static_cast<float>(fullX) + 0.5f + offset.x,
                                   static_cast<float>(fullY) + 0.5f + offset.y},
                                  lens);
        }
}

void FrameTile::trace(const Tracer& tracer) {
  for (size_t first = 0; first < pixels_.size(); first += ShadowPacket::kSize) {
    ShadowPacket packet{};
    const size_t count = std::min<size_t>(ShadowPacket::kSize, pixels_.size() - first);
    for (size_t i = 0; i < count; ++i) packet.set(static_cast<int>(i), pixels_[first + i].ray);
    std::optional<Hit> hits[ShadowPacket::kSize];
    tracer.intersect(packet, true, hits);
    for (size_t i = 0; i < count; ++i) pixels_[first + i].hit = hits[i];
  }
}

size_t FrameTile::placePixels(const VisibilityData& data, size_t first) {
  for (size_t i = first; i < pixels_.size(); ++i) {
    Pixel& pixel = pixels_[i];
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
    const Pixel& pixel = pixels_[i];
    vertices_.forgetChunksIfMany();
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

Rgb FrameTile::radiance(const FrameInput& input, const Pixel& pixel) {
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

TileCounts FrameTile::render(const FrameInput& input, int x0, int y0, int x1, int y1, Film& film) {
  const FlushDenormals flush;  // tails of narrow lobes are full of them
  TileCounts counts;
  sums_.assign(kSize * kSize, Rgb{});
  evaluations_.assign(kSize * kSize, 0);
  vertices_.begin(input.light, input.data.cuts, input.settings.cacheBytes);
  shader_.begin(input.light, input.emitters, input.lookup, input.settings.refined, &vertices_);
  shader_.counts = {};
  for (int sample = 0; sample < input.settings.spp; ++sample) {
    const int64_t start = nanosecondsNow();
    makeRays(input, film, x0, y0, x1, y1, sample);
    trace(input.tracer);
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
    counts.firstBad = static_cast<uint32_t>((y0 + pixel / kSize) * film.width + x0 + pixel % kSize);
  }
  counts.vertices = vertices_.mergedVertices();
  counts.mergedNodes = vertices_.mergedNodes();
  counts.pixels = shader_.counts;

  std::vector<float>& picture = film.layers.at("").values;
  const auto cost = film.layers.find("cost");
  const float scale = 1 / static_cast<float>(input.settings.spp);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const size_t inTile = static_cast<size_t>((y - y0) * kSize + x - x0);
      const Rgb value = sums_[inTile] * scale;
      const size_t pixel =
          static_cast<size_t>(y) * static_cast<size_t>(film.width) + static_cast<size_t>(x);
      const size_t at = 3 * pixel;
      picture[at] = value.x, picture[at + 1] = value.y, picture[at + 2] = value.z;
      if (cost != film.layers.end())
        cost->second.values[pixel] = static_cast<float>(evaluations_[inTile]) * scale;
    }
  return counts;
}

}  // namespace lobelia::relight
