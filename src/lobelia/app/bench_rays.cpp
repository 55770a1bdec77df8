#include "lobelia/app/bench_rays.h"

#include <algorithm>

#include "lobelia/base/morton.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/path/path_walk-inl.h"

namespace lobelia::app {
namespace {

constexpr size_t kLanes = ShadowPacket::kSize;
constexpr int kTries = 1000;  // to find points that face each other

// Answers as Tracer does and keeps what it was asked.
struct Recorder {
  const Tracer& tracer;
  mutable TracedRays asked;

  std::optional<Hit> intersect(const Ray& ray) const {
    record(ray, false);
    return tracer.intersect(ray);
  }
  bool occluded(const Ray& ray) const {
    record(ray, true);
    return tracer.occluded(ray);
  }
  void intersect(ShadowPacket& packet, bool coherent,
                 std::span<std::optional<Hit>, kLanes> hits) const {
    record(packet, false);
    tracer.intersect(packet, coherent, hits);
  }
  uint32_t visible(ShadowPacket& packet, bool coherent) const {
    record(packet, true);
    return tracer.visible(packet, coherent);
  }

 private:
  void record(const Ray& ray, bool shadow) const {
    asked.queries.push_back({static_cast<uint32_t>(asked.rays.size()), false, shadow});
    asked.rays.push_back({ray, shadow});
  }
  void record(const ShadowPacket& p, bool shadow) const {
    asked.queries.push_back({static_cast<uint32_t>(asked.packets.size()), true, shadow});
    asked.packets.push_back(p);
    for (size_t i = 0; i < kLanes; ++i) {
      if (p.active[i] == 0) continue;
      const Vec3f o{p.ox[i], p.oy[i], p.oz[i]}, d{p.dx[i], p.dy[i], p.dz[i]};
      asked.rays.push_back({{o, d, p.tMin[i], p.tMax[i]}, shadow});
    }
  }
};

// Pairs that do not face each other need no shadow ray.
bool face(const PointNormal& a, const PointNormal& b) {
  return dot(a.n, b.p - a.p) > 0 && dot(b.n, a.p - b.p) > 0;
}

// Shadow rays of pairs that face each other; those that fill no packet are left out.
struct FullPackets {
  Packets packets;
  ShadowPacket packet{};
  int filled = 0;

  void add(const ReceiverPoint& point, const PointNormal& light) {
    const Vec3f to = light.p - point.p;
    if (dot(light.n, to) >= 0 || dot(point.frame.n, to) <= 0) return;
    packet.set(filled, offsetOrigin(point.p, point.ng, point.error, to), light.p);
    packet.tMax[filled] = 1;
    if (++filled == ShadowPacket::kSize) packets.push_back(packet), filled = 0;
  }
};

}  // namespace

std::vector<PointNormal> places(const VirtualLights& lights) {
  std::vector<PointNormal> result;
  for (const DiffuseLight& light : lights.diffuse)
    result.push_back({light.p, decodeOctahedral(light.normal)});
  for (const GlossyLight& light : lights.glossy) result.push_back({light.p, light.n});
  return result;
}

Receivers spreadReceivers(const Receivers& receivers, size_t count) {
  constexpr size_t kRun = 256;
  const size_t all = receivers.points.size();
  if (all <= count) return receivers;
  const size_t runs = std::max<size_t>(1, count / kRun), stride = all / runs;
  Receivers result;
  for (size_t run = 0; run < runs; ++run) {
    for (size_t i = run * stride; i < std::min(all, run * stride + std::min(kRun, stride)); ++i) {
      ReceiverPoint point = receivers.points[i];
      const auto lobe = receivers.lobes.begin() + point.firstLobe;
      point.firstLobe = static_cast<uint32_t>(result.lobes.size());
      result.lobes.insert(result.lobes.end(), lobe, lobe + point.lobeCount);
      result.points.push_back(point);
    }
  }
  return result;
}

Packets randomToRandom(const std::vector<PointNormal>& places, size_t packets, uint64_t seed) {
  Rng rng(seed);
  Packets result(packets);
  const auto any = [&] { return places[rng.nextUint() % places.size()]; };
  for (ShadowPacket& packet : result) {
    for (size_t i = 0; i < kLanes; ++i) {
      PointNormal a = any(), b = any();
      for (int tries = 0; tries < kTries && !face(a, b); ++tries) a = any(), b = any();
      packet.set(static_cast<int>(i), a.p, b.p);
    }
  }
  return result;
}

Packets pointToSorted(std::vector<PointNormal> places, size_t packets, uint64_t seed) {
  Bounds3f box;
  for (const PointNormal& place : places) box.add(place.p);
  const Vec3f extent = max(box.extent(), Vec3f(1e-30f));
  std::sort(places.begin(), places.end(), [&](const PointNormal& a, const PointNormal& b) {
    return morton((a.p - box.lo) / extent) < morton((b.p - box.lo) / extent);
  });
  Rng rng(seed);
  Packets result;
  for (int tries = 0; tries < kTries || !result.empty(); ++tries) {
    const PointNormal from = places[rng.nextUint() % places.size()];
    ShadowPacket packet{};
    int filled = 0;
    for (const PointNormal& to : places) {
      if (!face(from, to)) continue;
      packet.set(filled, from.p, to.p);
      if (++filled < ShadowPacket::kSize) continue;
      result.push_back(packet), filled = 0;
      if (result.size() == packets) return result;
    }
  }
  return result;
}

Packets tileToLights(std::span<const ReceiverPoint> tile, std::span<const PointNormal> lights) {
  FullPackets rays;
  for (const PointNormal& light : lights)
    for (const ReceiverPoint& point : tile) rays.add(point, light);
  return rays.packets;
}

Packets oneToEachLight(std::span<const ReceiverPoint> tile, std::span<const PointNormal> lights,
                       uint64_t seed) {
  FullPackets rays;
  Rng rng(seed);
  for (const PointNormal& light : lights) rays.add(tile[rng.nextUint() % tile.size()], light);
  return rays.packets;
}

std::vector<TracedRays> recordPathRays(const Tracer& tracer, const EmitterSampler& emitters,
                                       const Camera& camera, const PathSettings& settings,
                                       uint64_t seed) {
  constexpr int kTile = 16;
  constexpr size_t kSideBySide = 64;
  const int across = (camera.width + kTile - 1) / kTile, down = (camera.height + kTile - 1) / kTile;
  std::vector<TracedRays> tiles(static_cast<size_t>(across * down));
  parallelFor(tiles.size(), 1, [&](size_t t) {
    const Recorder recorder{tracer, {}};
    const PathWalk<Recorder> walk(recorder, emitters, settings, false);
    PathCounts counts;
    std::vector<PathState> paths;
    const int x0 = static_cast<int>(t) % across * kTile, y0 = static_cast<int>(t) / across * kTile;
    for (int y = y0; y < std::min(y0 + kTile, camera.height); ++y) {
      for (int x = x0; x < std::min(x0 + kTile, camera.width); ++x) {
        const uint32_t pixel = static_cast<uint32_t>(y * camera.width + x);
        for (int s = 0; s < settings.spp; ++s) {
          PathRandom random(seed, pixel, static_cast<uint32_t>(s));
          const Vec2f u = random.next2D();
          const Vec2f film{static_cast<float>(x) + u.x, static_cast<float>(y) + u.y};
          const Ray ray = generateRay(camera, film, random.next2D());
          paths.emplace_back(ray, random, pixel);
        }
        if (paths.size() < kSideBySide) continue;
        walk.trace(paths, counts);
        paths.clear();
      }
    }
    walk.trace(paths, counts);
    tiles[t] = std::move(recorder.asked);
  });
  return tiles;
}

}  // namespace lobelia::app
