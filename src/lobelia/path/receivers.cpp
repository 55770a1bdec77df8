// The eye pass in parallel over tiles of 8 x 8 pixels [architecture.md, "Receivers"].
//
// A tile belongs to one thread, which alone writes to its pixels; receivers are put together in the
// order of the tiles. Inside a tile pixels go along a Morton curve, so that 16 receivers in a row
// lie in a square of 4 x 4 pixels, and receivers behind specular surfaces come after those that are
// seen at once: rays to one light from 16 neighbours in the array are coherent.
#include "lobelia/path/receivers.h"

#include <algorithm>
#include <array>

#include "lobelia/base/morton.h"
#include "lobelia/base/parallel.h"
#include "lobelia/path/receiver_walk.h"

namespace lobelia {
namespace {

constexpr int kTile = 8;

int compactBits(int morton) {  // bits 0, 2, 4 of a 6-bit index
  return (morton & 1) | ((morton >> 1) & 2) | ((morton >> 2) & 4);
}

constexpr uint32_t kNoPixel = 0xffffffffu;

struct Tile {
  std::vector<uint32_t> pixels;  // indices into the data window
  Receivers receivers;
  EyeCounts counts;
  uint32_t firstBad = kNoPixel;  // the smallest with a sample that was not finite
};

std::vector<Tile> allTiles(int width, int y0, int y1) {
  std::vector<Tile> tiles;
  for (int ty = y0; ty < y1; ty += kTile)
    for (int tx = 0; tx < width; tx += kTile) {
      Tile tile;
      for (int m = 0; m < kTile * kTile; ++m) {
        const int x = tx + compactBits(m), y = ty + compactBits(m >> 1);
        if (x >= width || y >= y1) continue;
        tile.pixels.push_back(static_cast<uint32_t>(y) * static_cast<uint32_t>(width) +
                              static_cast<uint32_t>(x));
      }
      tiles.push_back(std::move(tile));
    }
  return tiles;
}

// Chosen pixels may be far from one another: along a Morton curve, too.
std::vector<Tile> chosenTiles(const PixelSet& set, int width, int y0, int y1) {
  const auto columns = static_cast<uint32_t>(width);
  std::vector<uint32_t> pixels;
  for (const uint32_t pixel : set.pixels) {
    const int y = static_cast<int>(pixel / columns);
    if (y >= y0 && y < y1) pixels.push_back(pixel);
  }
  std::sort(pixels.begin(), pixels.end(), [&](uint32_t a, uint32_t b) {
    return morton(a % columns, a / columns) < morton(b % columns, b / columns);
  });
  std::vector<Tile> tiles;
  for (const uint32_t pixel : pixels) {
    if (tiles.empty() || tiles.back().pixels.size() == kTile * kTile) tiles.emplace_back();
    tiles.back().pixels.push_back(pixel);
  }
  return tiles;
}

// The film's layers that the pass adds to; null when absent.
struct Layers {
  Layers(Film& film, const LightGroups& lightGroups)
      : direct(find(film, "direct")),
        indirect(find(film, "indirect")),
        specular(find(film, "specular")),
        albedo(find(film, "albedo")),
        normal(find(film, "normal")),
        depth(find(film, "depth")),
        cost(find(film, "cost")) {
    for (size_t g = 0; g < lightGroups.size(); ++g) {
      groups.push_back(find(film, lightGroups.layer(g)));
      byGroup |= groups.back() != nullptr;
    }
  }

  void addCost(uint32_t pixel, float rays) const { add(cost, pixel, Rgb(rays)); }
  void add(uint32_t pixel, const EyeSample& s) const {
    add(direct, pixel, s.direct);
    add(indirect, pixel, s.indirect);
    add(specular, pixel, s.specular);
    for (size_t g = 0; g < s.groups.size(); ++g) add(groups[g], pixel, s.groups[g]);
    if (!s.hit) return;
    add(albedo, pixel, s.albedo * s.weight);
    add(normal, pixel, s.normal * s.weight);
    add(depth, pixel, Rgb(s.depth * s.weight));
  }

  bool byGroup = false;

 private:
  static Layer* find(Film& film, const std::string& name) {
    const auto it = film.layers.find(name);
    return it == film.layers.end() ? nullptr : &it->second;
  }
  static void add(Layer* layer, uint32_t pixel, Rgb value) {
    if (!layer) return;
    for (int c = 0; c < layer->channels && c < 3; ++c)
      layer->values[static_cast<size_t>(pixel) * static_cast<size_t>(layer->channels) +
                    static_cast<size_t>(c)] += value[c];
  }
  Layer *direct, *indirect, *specular, *albedo, *normal, *depth, *cost;
  std::vector<Layer*> groups;
};

Receivers concatenate(std::vector<Tile>& tiles) {
  std::vector<std::array<size_t, 2>> starts(tiles.size() + 1);
  for (size_t i = 0; i < tiles.size(); ++i) {
    starts[i + 1][0] = starts[i][0] + tiles[i].receivers.points.size();
    starts[i + 1][1] = starts[i][1] + tiles[i].receivers.lobes.size();
  }
  Receivers all;
  all.points.resize(starts.back()[0]);
  all.lobes.resize(starts.back()[1]);
  parallelFor(tiles.size(), 64, [&](size_t i) {
    const auto [firstPoint, firstLobe] = starts[i];
    Receivers& part = tiles[i].receivers;
    for (ReceiverPoint& r : part.points) r.firstLobe += static_cast<uint32_t>(firstLobe);
    std::copy(part.points.begin(), part.points.end(),
              all.points.begin() + static_cast<ptrdiff_t>(firstPoint));
    std::copy(part.lobes.begin(), part.lobes.end(),
              all.lobes.begin() + static_cast<ptrdiff_t>(firstLobe));
    part = {};
  });
  return all;
}

}  // namespace

Bsdf receiverBsdf(const Receivers& receivers, const ReceiverPoint& point) {
  Bsdf bsdf;
  bsdf.frames[0] = point.frame;
  bsdf.frames[0].perturbed = point.bumpAlpha2 > 0;
  bsdf.frames[0].bumpAlpha2 = point.bumpAlpha2;
  bsdf.ng = point.ng;
  bsdf.baseNormal = point.bumpAlpha2 > 0 ? point.baseNormal : point.frame.n;
  for (uint32_t i = 0; i < point.lobeCount; ++i) bsdf.add(receivers.lobes[point.firstLobe + i]);
  return bsdf;
}

Receivers traceReceivers(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                         const EyeSettings& settings, int y0, int y1, Film& film,
                         Context& context) {
  const StageTimer timer(context, "receivers");
  const Layers layers(film, emitters.groups());
  const EyeWalk walk(tracer, emitters, camera, settings, context.seed, layers.byGroup);
  const auto width = static_cast<uint32_t>(film.width);
  std::vector<Tile> tiles = settings.pixels.pixels.empty()
                                ? allTiles(film.width, y0, y1)
                                : chosenTiles(settings.pixels, film.width, y0, y1);
  parallelFor(tiles.size(), 1, [&](size_t i) {
    if (context.cancelled()) return;
    Tile& tile = tiles[i];
    for (const uint32_t pixel : tile.pixels) {
      const int x = film.x0 + static_cast<int>(pixel % width),
                y = film.y0 + static_cast<int>(pixel / width);
      const uint64_t before = tile.counts.pathRays + tile.counts.shadowRays;
      const uint64_t good = tile.counts.nonFinite;
      layers.add(pixel, walk.trace(x, y, pixel, &tile.receivers, &tile.counts));
      const uint64_t rays = tile.counts.pathRays + tile.counts.shadowRays - before;
      if (tile.counts.nonFinite > good) tile.firstBad = std::min(tile.firstBad, pixel);
      layers.addCost(pixel, static_cast<float>(rays) / static_cast<float>(settings.sampleCount));
    }
    std::stable_sort(
        tile.receivers.points.begin(), tile.receivers.points.end(),
        [](const ReceiverPoint& a, const ReceiverPoint& b) { return a.depth < b.depth; });
  });
  EyeCounts total;
  uint32_t firstBad = kNoPixel;
  for (const Tile& tile : tiles) {
    total.pathRays += tile.counts.pathRays, total.shadowRays += tile.counts.shadowRays;
    total.specularConnections += tile.counts.specularConnections;
    total.nearReceivers += tile.counts.nearReceivers;
    total.cut += tile.counts.cut, total.nonFinite += tile.counts.nonFinite;
    firstBad = std::min(firstBad, tile.firstBad);
  }
  context.statistics.addCount("path_rays", total.pathRays);
  context.statistics.addCount("shadow_rays", total.shadowRays);
  context.statistics.addCount("specular_connections", total.specularConnections);
  context.statistics.addCount("near_receivers", total.nearReceivers);
  context.statistics.addCount("paths_cut", total.cut);
  context.statistics.addCount("nonfinite", total.nonFinite);
  if (firstBad != kNoPixel) noteNonFinitePixel(firstBad, context);
  return concatenate(tiles);
}

void noteNonFinitePixel(uint32_t pixel, Context& context) {
  const double known = context.statistics.value("first_nonfinite_pixel");  // 0: none
  if (known == 0 || 1.0 + pixel < known)
    context.statistics.setValue("first_nonfinite_pixel", 1.0 + pixel);
}

}  // namespace lobelia
