// Receivers and virtual lights in the closed room, for benchmarks of gather strategies.
#pragma once

#include <vector>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/builtin/closed_room.h"
#include "lobelia/lights/virtual_lights.h"
#include "lobelia/path/receivers.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::benchmark_support {

class Room {
 public:
  Room() : scene_(builtin::closedRoom(builtin::RoomKind::diffuse)), tracer_(scene_, context_) {}
  const Scene& scene() const { return scene_; }
  const Tracer& tracer() const { return tracer_; }

  // What a camera near a corner sees in `tiles` tiles of 16 x 16 pixels, spread over a picture of
  // 1024 x 1024; each tile in Z order.
  Receivers receivers(int tiles, int lobes) const {
    constexpr int kTile = 16, kSize = 1024, kAcross = kSize / kTile;
    Receivers receivers;
    for (int t = 0; t < tiles; ++t) {
      const int place = static_cast<int>((t + 0.5) * kAcross * kAcross / tiles);
      const int tx = place % kAcross * kTile, ty = place / kAcross * kTile;
      for (int i = 0; i < kTile * kTile; ++i) {
        int x = 0, y = 0;
        for (int bit = 0; bit < 4; ++bit)
          x |= (i >> (2 * bit) & 1) << bit, y |= (i >> (2 * bit + 1) & 1) << bit;
        addReceiver(static_cast<float>(tx + x) / kSize - 0.5f,
                    static_cast<float>(ty + y) / kSize - 0.5f, lobes, &receivers);
      }
    }
    return receivers;
  }

  // `count` lights of each kind on the surfaces, found by rays from anywhere in the room.
  VirtualLights lights(size_t count) const {
    VirtualLights lights;
    Rng rng(2);
    while (lights.diffuse.size() < count) {
      const Vec2f xy = rng.next2D();
      const Vec3f origin = Vec3f(xy.x, xy.y, rng.next1D()) * Vec3f(6, 4, 3);
      const Ray ray{origin, sampleSphereUniform(rng.next2D())};
      const auto hit = tracer_.intersect(ray);
      if (!hit) continue;
      const SurfacePoint at = surfacePoint(scene_, *hit);
      if (dot(at.ng, ray.d) >= 0) continue;  // from inside a sphere or behind a wall
      const Vec3f p = offsetOrigin(at, at.ng);
      lights.diffuse.push_back({p, Rgb(1.f), encodeOctahedral(at.ng), 1});
      const Vec3f mirror = ray.d - at.ng * (2 * dot(at.ng, ray.d));
      lights.glossy.push_back({p, at.ng, normalize(mirror), Rgb(1.f), 20 + 80 * rng.next1D()});
    }
    lights.diffuseDepthEnds = {0, static_cast<uint32_t>(lights.diffuse.size())};
    lights.glossyDepthEnds = {0, static_cast<uint32_t>(lights.glossy.size())};
    return lights;
  }

 private:
  void addReceiver(float x, float y, int lobes, Receivers* receivers) const {
    const Frame view = frameFromNormal(normalize(Vec3f(2.6f, 1.6f, -0.6f)));
    const Ray ray{{0.4f, 0.4f, 1.9f}, normalize(view.toWorld({1.2f * x, 1.2f * y, 1}))};
    const auto hit = tracer_.intersect(ray);
    if (!hit) return;
    const SurfacePoint at = surfacePoint(scene_, *hit);
    ReceiverPoint point;
    point.p = at.p;
    point.ng = at.ng;
    point.frame = at.frame;
    point.wo = -ray.d;
    point.weight = Rgb(1.f);
    point.error = at.error;
    point.pixel = static_cast<uint32_t>(receivers->points.size());
    point.firstLobe = static_cast<uint32_t>(receivers->lobes.size());
    point.lobeCount = static_cast<uint8_t>(lobes);
    Lobe lambert;
    lambert.weight = Rgb(0.5f);
    receivers->lobes.push_back(lambert);
    if (lobes > 1) {
      Lobe ggx;
      ggx.type = LobeType::microfacetReflection;
      ggx.fresnel = Fresnel::conductor;
      ggx.alphaX = ggx.alphaY = 0.2f;
      ggx.eta = Rgb(0.2f, 0.9f, 1.1f);
      ggx.k = Rgb(3.9f, 2.4f, 2.2f);
      receivers->lobes.push_back(ggx);
    }
    receivers->points.push_back(point);
  }

  Scene scene_;
  Context context_;
  Tracer tracer_;
};

}  // namespace lobelia::benchmark_support
