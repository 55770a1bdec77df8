#include "lobelia/relight/local_tile.h"

#include <algorithm>
#include <cmath>

#include "lobelia/base/random.h"
#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/relight/local_mirror.h"
#include "lobelia/trace/flush_denormals.h"

namespace lobelia::relight {
namespace {

constexpr size_t kBlock = ShadowPacket::kSize;
constexpr uint64_t kStream = 0x6c6f63616cull;

constexpr float kBroad = 0.5f;  // roughness of lobes that nodes of a cut are narrower than

bool needsWidening(const Lobe& lobe) { return !isDiffuse(lobe.type) && roughness(lobe) < kBroad; }

// Of coats, which reflect some hundredths, all but a twentieth suffices; metals' tails are seen.
float reachOf(const Lobe& lobe) {
  return lobe.fresnel == Fresnel::dielectric ? 6 * std::sqrt(2.f) * roughness(lobe) : 2.f;
}

// Reads the clock and adds what has passed.
class Clock {
 public:
  void lap(int64_t* sum) {
    const int64_t now = nanosecondsNow();
    *sum += now - last_;
    last_ = now;
  }

 private:
  int64_t last_ = nanosecondsNow();
};

}  // namespace

void LocalCounts::add(const LocalCounts& o) {
  bufferNs += o.bufferNs, cutNs += o.cutNs, mergeNs += o.mergeNs, directNs += o.directNs;
  shadeNs += o.shadeNs;
  objectPixels += o.objectPixels, vertices += o.vertices, mergedNodes += o.mergedNodes;
  cutNodes += o.cutNodes, evaluations += o.evaluations, shadowRays += o.shadowRays;
  mirrorRays += o.mirrorRays, nonFinite += o.nonFinite;
  if (o.firstBad) firstBad = std::min(firstBad.value_or(*o.firstBad), *o.firstBad);
}

void LocalTile::makeSurfaces(const LocalInput& input, const TileArea& area, const Film& film,
                             int sample) {
  makeTileRays(input.camera, film, area, input.seed, sample, input.settings.spp, &pixels_);
  traceTileRays(input.tracer, &pixels_);
  surfaces_.clear();
  const Scene& scene = input.tracer.scene();
  for (uint32_t i = 0; i < pixels_.size(); ++i) {
    const TilePixel& pixel = pixels_[i];
    if (!pixel.hit) continue;
    LitPixel& lit = surfaces_.emplace_back();
    lit.at = surfacePoint(scene, *pixel.hit);
    lit.wo = -pixel.ray.d;
    lit.bsdf = makeBsdf(scene, lit.at, lit.wo, kSmoothest);
    lit.normal = dot(lit.at.ng, lit.wo) < 0 ? -lit.at.ng : lit.at.ng;
    lit.pixel = i;
    const int x = film.x0 + area.x0 + static_cast<int>(pixel.index) % kTileSize,
              y = film.y0 + area.y0 + static_cast<int>(pixel.index) / kTileSize;
    const uint64_t stream = (static_cast<uint64_t>(y) << 32) | static_cast<uint32_t>(x);
    if (!input.sources.hasAreas() && !hasLobes(lit.bsdf, LobeSet::sharp)) continue;
    Sampler random(hashCombine(input.seed, kStream), stream, static_cast<uint32_t>(sample));
    lit.places = random.next2D();
    lit.lobe = random.next1D();
    lit.mirrored = random.next2D();
  }
}

size_t LocalTile::placeVertices(const LocalInput& input, size_t first) {
  for (size_t i = first; i < surfaces_.size(); ++i) {
    if (vertices_.full()) {
      if (i > first) return i;
      vertices_.forget();
    }
    TilePixel& pixel = pixels_[surfaces_[i].pixel];
    const SurroundingVertices around =
        input.data.mesh.at(pixel.hit->instance, pixel.hit->triangle, pixel.hit->b1, pixel.hit->b2);
    for (size_t v = 0; v < 3; ++v) {
      pixel.place.slot[v] = vertices_.slotOf(around.vertex[v]);
      pixel.place.weight[v] = around.weight[v];
    }
  }
  return surfaces_.size();
}

void LocalTile::addDirect(const LocalInput& input, std::span<LitPixel> pixels) {
  LitPoint points[kBlock];
  Rgb sums[kBlock] = {};
  for (size_t i = 0; i < pixels.size(); ++i) {
    const LitPixel& pixel = pixels[i];
    points[i] = {pixel.at.p, pixel.at.ng, pixel.at.error, pixel.places, !onlyDelta(pixel.bsdf)};
  }
  counts_.shadowRays +=
      addLocalLight(input.tracer, input.sources, {points, pixels.size()}, input.settings.areaPlaces,
                    sums, [&](size_t i, Vec3f wi, Rgb value, bool point) {
                      // Rays that follow sharp lobes find areas, but no points.
                      const LobeSet lobes = point ? LobeSet::all : LobeSet::rough;
                      return evaluate(pixels[i].bsdf, pixels[i].wo, wi, lobes) * value;
                    });
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i].sum += sums[i];
}

void LocalTile::addBounced(const LocalInput& input, LitPixel& pixel) {
  if (!hasLobes(pixel.bsdf, LobeSet::rough)) return;
  const LightCut& cut = cut_.cut;
  const PixelPlace& place = pixels_[pixel.pixel].place;
  NearLights lights{{cut.x.data(), cut.y.data(), cut.z.data()},
                    {cut_.nx.data(), cut_.ny.data(), cut_.nz.data()},
                    cut_.variance.data(),
                    cut_.extent2.data(),
                    {},
                    {},
                    input.light.sampleArea * (1 / kPi)};
  for (size_t v = 0; v < 3; ++v) {
    lights.rows[v] = vertices_.rows(place.slot[v]);
    lights.weight[v] = place.weight[v];
  }
  const uint64_t evaluated = counts_.evaluations;
  gatherNearLight(lights, cut_.chunks, pixel.at.p, pixel.normal, &light_);
  for (int l = 0; l < pixel.bsdf.lobeCount; ++l) {
    const Lobe& lobe = pixel.bsdf.lobes[l];
    LobeQuery query{&lobe, &pixel.bsdf.frameOf(lobe), pixel.bsdf.baseNormal, pixel.wo};
    const bool seen = dot(query.frame->n, pixel.wo) > 0 || lobe.twoSided || lobe.interface;
    if (lobe.sharp || isTransmission(lobe.type) || !seen) continue;
    if (needsWidening(lobe)) {
      const Vec3f n = query.frame->n;
      query.mirror = n * (2 * dot(n, pixel.wo)) - pixel.wo;
      pixel.sum += sumWidenedLobe(query, light_, reachOf(lobe), &counts_.evaluations);
    } else {
      pixel.sum += sumLobe(query, light_, light_.lit.data(), &counts_.evaluations);
    }
  }
  evaluations_[pixels_[pixel.pixel].index] += counts_.evaluations - evaluated;
}

LocalCounts LocalTile::render(const LocalInput& input, const TileArea& area, Film& film) {
  const FlushDenormals flush;
  counts_ = {};
  vertices_.mergedVertices = vertices_.mergedNodes = 0;
  sums_.assign(kTileSize * kTileSize, Rgb{});
  evaluations_.assign(kTileSize * kTileSize, 0);
  for (int sample = 0; sample < input.settings.spp; ++sample) {
    Clock clock;
    makeSurfaces(input, area, film, sample);
    clock.lap(&counts_.bufferNs);
    if (input.settings.bounced && !surfaces_.empty()) {
      makePixelGroups(surfaces_, &groups_);
      selector_.select(input.light, groups_, input.settings.nodeCount, &cut_);
      vertices_.begin(input.light.sums, cut_.cut, input.data.cuts, input.settings.cacheBytes);
      light_.reserve(cut_.cut.padded() / kChunk);
      counts_.cutNodes += surfaces_.size() * cut_.cut.count;
    }
    clock.lap(&counts_.cutNs);
    for (size_t first = 0, end; first < surfaces_.size(); first = end) {
      end = input.settings.bounced ? placeVertices(input, first) : surfaces_.size();
      if (input.settings.bounced) vertices_.mergeNew();
      clock.lap(&counts_.mergeNs);
      for (size_t i = first; i < end; i += kBlock) {
        const std::span<LitPixel> block(&surfaces_[i], std::min(kBlock, end - i));
        if (input.settings.direct) addDirect(input, block);
        counts_.mirrorRays += addMirrored(input, block);
      }
      clock.lap(&counts_.directNs);
      if (input.settings.bounced)
        for (size_t i = first; i < end; ++i) addBounced(input, surfaces_[i]);
      clock.lap(&counts_.shadeNs);
    }
    counts_.objectPixels += surfaces_.size();
    finish(input);
  }
  counts_.vertices = vertices_.mergedVertices, counts_.mergedNodes = vertices_.mergedNodes;
  if (counts_.firstBad) {  // it was the tile's
    const int pixel = static_cast<int>(*counts_.firstBad);
    counts_.firstBad = static_cast<uint32_t>((area.y0 + pixel / kTileSize) * film.width + area.x0 +
                                             pixel % kTileSize);
  }
  const float scale = 1 / static_cast<float>(input.settings.spp);
  writeTile(sums_, scale, input.settings.add, area, &film);
  writeTileCost(evaluations_, scale, input.settings.add, area, &film);
  return counts_;
}

void LocalTile::finish(const LocalInput& input) {
  const auto add = [&](const TilePixel& pixel, Rgb value) {
    if (isFinite(value)) {
      sums_[pixel.index] += value * pixel.weight;
    } else {
      ++counts_.nonFinite;
      counts_.firstBad = std::min(counts_.firstBad.value_or(pixel.index), pixel.index);
    }
  };
  const bool emission = !input.settings.add && !input.settings.hideEmitters;
  for (const LitPixel& lit : surfaces_) {
    const bool lamp = emission && lit.at.emitter.valid();
    add(pixels_[lit.pixel], lamp ? lit.sum + input.emitters.emitted(lit.at, lit.wo) : lit.sum);
  }
  if (!emission) return;
  for (const TilePixel& pixel : pixels_)
    if (!pixel.hit) add(pixel, escaped(input, pixel.ray.d));
}

}  // namespace lobelia::relight
