// Rates of shadow rays in packets of 16 over a closed room, all threads: what the speed of the
// gather is judged by. Three patterns, from bad to good coherence:
//   RandomToRandom   random points to random lights
//   PointToSorted    one point to lights sorted along a Morton curve (another point every so often)
//   TileToLight      pixels in tile order to one light
// each as bare calls of Embree over prepared rays, and through Tracer::visible(). Paths: single
// rays that bounce about the room, as a bare loop without shading.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <functional>

#include "lobelia/app/bench_rays.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/builtin/closed_room.h"
#include "lobelia/trace/accel.h"
#include "lobelia/trace/tracer.h"

namespace lobelia {
namespace {

constexpr int kLanes = ShadowPacket::kSize;
constexpr size_t kPackets = 1 << 15;

using Point = app::PointNormal;

struct Room {
  Scene scene = builtin::closedRoom(builtin::RoomKind::diffuse);
  Context context;
  Tracer tracer{scene, context};
  embree::Accel accel{scene, context};
  std::vector<Point> points;  // what random rays inside the room hit
  std::vector<Point> pixels;  // what a camera sees, 4x4 pixels a packet, in 16x16 tiles

  Room() {
    Rng rng(1);
    while (points.size() < 4096) {
      const Vec3f o{6 * rng.next1D(), 4 * rng.next1D(), 1.5f + rng.next1D()};
      if (const auto p = hit({o, sampleSphereUniform(rng.next2D())})) points.push_back(*p);
    }
    constexpr int kWidth = 1024, kHeight = 512;
    for (int tile = 0; tile < kWidth * kHeight / 256; ++tile) {
      for (int i = 0; i < 256; ++i) {
        const int block = i / 16, pixel = i % 16;
        const int x = tile % (kWidth / 16) * 16 + block % 4 * 4 + pixel % 4;
        const int y = tile / (kWidth / 16) * 16 + block / 4 * 4 + pixel / 4;
        const Vec3f d{1, 1.2f * (static_cast<float>(x) + 0.5f) / kWidth - 0.6f,
                      0.6f * (static_cast<float>(y) + 0.5f) / kHeight - 0.3f};
        const auto p = hit({{0.3f, 2, 1.6f}, normalize(d)});
        pixels.push_back(p ? *p : points[0]);
      }
    }
  }

  std::optional<Point> hit(const Ray& ray) const {
    const auto h = tracer.intersect(ray);
    if (!h) return std::nullopt;
    const SurfacePoint at = surfacePoint(scene, *h);
    return Point{offsetOrigin(at, -ray.d), dot(at.ng, ray.d) < 0 ? at.ng : -at.ng};
  }
};

const Room& room() {
  static const Room r;
  return r;
}

std::vector<ShadowPacket> randomToRandom() {
  return app::randomToRandom(room().points, kPackets, 2);
}
std::vector<ShadowPacket> pointToSorted() { return app::pointToSorted(room().points, kPackets, 3); }

std::vector<ShadowPacket> tileToLight() {
  const auto& pixels = room().pixels;
  std::vector<ShadowPacket> packets(pixels.size() / kLanes);
  const Vec3f light{3.1f, 1.9f, 2.7f};
  for (size_t k = 0; k < packets.size(); ++k) {
    for (int i = 0; i < kLanes; ++i) {
      packets[k].set(i, pixels[k * kLanes + static_cast<size_t>(i)].p, light);
    }
  }
  return packets;
}

RTCRay16 toEmbree(const ShadowPacket& p) {
  RTCRay16 r{};
  for (int i = 0; i < kLanes; ++i) {
    r.org_x[i] = p.ox[i], r.org_y[i] = p.oy[i], r.org_z[i] = p.oz[i], r.tnear[i] = p.tMin[i];
    r.dir_x[i] = p.dx[i], r.dir_y[i] = p.dy[i], r.dir_z[i] = p.dz[i], r.tfar[i] = p.tMax[i];
    r.mask[i] = 0xffffffffu;
  }
  return r;
}

// Reports rays per second, and the fraction blocked as a check that patterns are comparable.
void run(benchmark::State& state, size_t packets, const std::function<int(size_t)>& visibleLanes) {
  uint64_t rays = 0, visible = 0;
  for (auto _ : state) {
    std::atomic<uint64_t> count{0};
    parallelRanges(packets, 64, [&](size_t begin, size_t end) {
      int sum = 0;
      for (size_t i = begin; i < end; ++i) sum += visibleLanes(i);
      count += static_cast<uint64_t>(sum);
    });
    rays += packets * kLanes, visible += count;
  }
  state.SetItemsProcessed(static_cast<int64_t>(rays));
  state.counters["blocked"] = 1 - static_cast<double>(visible) / static_cast<double>(rays);
}

using Pattern = std::vector<ShadowPacket> (*)();

void bare(benchmark::State& state, Pattern pattern, bool coherent) {
  std::vector<RTCRay16> rays;
  for (const ShadowPacket& p : pattern()) rays.push_back(toEmbree(p));
  alignas(64) static constexpr int kAll[kLanes] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                   -1, -1, -1, -1, -1, -1, -1, -1};
  run(state, rays.size(), [&](size_t k) {
    RTCRay16 r = rays[k];
    embree::QueryContext context;
    embree::occludedPacket(kAll, room().accel.top(), context, coherent, r);
    int visible = 0;
    for (float t : r.tfar) visible += t >= 0 ? 1 : 0;
    return visible;
  });
}

void tracer(benchmark::State& state, Pattern pattern, bool coherent) {
  std::vector<ShadowPacket> packets = pattern();
  run(state, packets.size(),
      [&](size_t k) { return std::popcount(room().tracer.visible(packets[k], coherent)); });
}

void paths(benchmark::State& state) {
  constexpr size_t kPaths = 1 << 14;
  constexpr int kBounces = 8;
  uint64_t rays = 0;
  for (auto _ : state) {
    parallelFor(kPaths, 64, [&](size_t k) {
      Rng rng(k);
      Point at = room().points[k % room().points.size()];
      for (int bounce = 0; bounce < kBounces; ++bounce) {
        const Vec3f d = frameFromNormal(at.n).toWorld(sampleHemisphereCosine(rng.next2D()));
        const auto next = room().hit({at.p, d});
        at = next ? *next : room().points[0];
      }
      benchmark::DoNotOptimize(at);
    });
    rays += kPaths * kBounces;
  }
  state.SetItemsProcessed(static_cast<int64_t>(rays));
}

BENCHMARK_CAPTURE(bare, RandomToRandom, randomToRandom, false)->UseRealTime();
BENCHMARK_CAPTURE(tracer, RandomToRandom, randomToRandom, false)->UseRealTime();
BENCHMARK_CAPTURE(bare, PointToSorted, pointToSorted, true)->UseRealTime();
BENCHMARK_CAPTURE(tracer, PointToSorted, pointToSorted, true)->UseRealTime();
BENCHMARK_CAPTURE(bare, TileToLight, tileToLight, true)->UseRealTime();
BENCHMARK_CAPTURE(tracer, TileToLight, tileToLight, true)->UseRealTime();
BENCHMARK(paths)->UseRealTime();

}  // namespace
}  // namespace lobelia
