#include "lobelia/relight/tile_rays.h"

#include <algorithm>

#include "lobelia/base/random.h"

namespace lobelia::relight {
namespace {

// f(index in the tile, index in the film).
template <class F>
void forPixels(const TileArea& area, const Film& film, const F& f) {
  for (int y = area.y0; y < area.y1; ++y)
    for (int x = area.x0; x < area.x1; ++x)
      f(static_cast<size_t>((y - area.y0) * kTileSize + x - area.x0),
        static_cast<size_t>(y) * static_cast<size_t>(film.width) + static_cast<size_t>(x));
}

}  // namespace

std::vector<TileArea> tileAreas(const Film& film, int size) {
  std::vector<TileArea> areas;
  for (int y = 0; y < film.height; y += size)
    for (int x = 0; x < film.width; x += size)
      areas.push_back({x, y, std::min(x + size, film.width), std::min(y + size, film.height)});
  return areas;
}

void makeTileRays(const Camera& camera, const Film& film, const TileArea& area, uint64_t seed,
                  int sample, int spp, std::vector<TilePixel>* pixels) {
  constexpr int kBlock = 4;
  pixels->clear();
  for (int by = area.y0; by < area.y1; by += kBlock)
    for (int bx = area.x0; bx < area.x1; bx += kBlock)
      for (int y = by; y < std::min(by + kBlock, area.y1); ++y)
        for (int x = bx; x < std::min(bx + kBlock, area.x1); ++x) {
          TilePixel& pixel = pixels->emplace_back();
          pixel.index = static_cast<uint32_t>((y - area.y0) * kTileSize + x - area.x0);
          const int fullX = film.x0 + x, fullY = film.y0 + y;
          Vec2f offset{}, lens{0.5f, 0.5f};
          if (spp > 1) {
            const uint64_t stream =
                (static_cast<uint64_t>(fullY) << 32) | static_cast<uint32_t>(fullX);
            Sampler random(seed, stream, static_cast<uint32_t>(sample));
            offset =
                sampleFilter(camera.filter, camera.filterRadius, random.next2D(), &pixel.weight);
            lens = random.next2D();
          }
          pixel.ray = generateRay(camera,
                                  {static_cast<float>(fullX) + 0.5f + offset.x,
                                   static_cast<float>(fullY) + 0.5f + offset.y},
                                  lens);
        }
}

void traceTileRays(const Tracer& tracer, std::vector<TilePixel>* pixels) {
  for (size_t first = 0; first < pixels->size(); first += ShadowPacket::kSize) {
    ShadowPacket packet{};
    const size_t count = std::min<size_t>(ShadowPacket::kSize, pixels->size() - first);
    for (size_t i = 0; i < count; ++i) packet.set(static_cast<int>(i), (*pixels)[first + i].ray);
    std::optional<Hit> hits[ShadowPacket::kSize];
    tracer.intersect(packet, true, hits);
    for (size_t i = 0; i < count; ++i) (*pixels)[first + i].hit = hits[i];
  }
}

void writeTile(const std::vector<Rgb>& values, float scale, bool add, const TileArea& area,
               Film* film) {
  std::vector<float>& picture = film->layers.at("").values;
  forPixels(area, *film, [&](size_t inTile, size_t pixel) {
    const Rgb value = values[inTile] * scale;
    for (size_t c = 0; c < 3; ++c) {
      float& out = picture[3 * pixel + c];
      out = add ? out + value[static_cast<int>(c)] : value[static_cast<int>(c)];
    }
  });
}

void writeTileCost(const std::vector<uint64_t>& evaluations, float scale, bool add,
                   const TileArea& area, Film* film) {
  const auto cost = film->layers.find("cost");
  if (cost == film->layers.end()) return;
  forPixels(area, *film, [&](size_t inTile, size_t pixel) {
    float& out = cost->second.values[pixel];
    const float value = static_cast<float>(evaluations[inTile]) * scale;
    out = add ? out + value : value;
  });
}

}  // namespace lobelia::relight
