// A closed room full of spheres: the scene of the speed measurements, procedural and of any size.
#pragma once

#include <cmath>
#include <vector>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/lights/virtual_lights.h"
#include "lobelia/path/receivers.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::bench {

// [-1, 1]^3 with 60 spheres, together about `triangles` triangles in one mesh.
inline Scene roomScene(int triangles) {
  constexpr int kSpheres = 60;
  Mesh mesh;
  const auto addQuad = [&](Vec3f a, Vec3f b, Vec3f c, Vec3f d) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec3f& p : {a, b, c, d}) mesh.positions.push_back(p);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.f, 1.f}) {
      Vec3f n{}, u{}, v{};
      n[axis] = side, u[(axis + 1) % 3] = side, v[(axis + 2) % 3] = 1;
      addQuad(n + u + v, n + u - v, n - u - v, n - u + v);  // normals into the room
    }
  }
  Rng rng(1);
  // 2 triangles for each of rings x 2 rings quads.
  const int rings = std::max(4, static_cast<int>(std::sqrt(triangles / kSpheres / 4.0)));
  for (int s = 0; s < kSpheres; ++s) {
    const float radius = 0.06f + 0.12f * rng.next1D();
    const Vec2f xy = rng.next2D();
    const Vec3f centre = (Vec3f(xy.x, xy.y, rng.next1D()) - Vec3f(0.5f)) * (2 * (0.98f - radius));
    const auto at = [&](int ring, int step) {
      const float theta = kPi * static_cast<float>(ring) / static_cast<float>(rings);
      const float phi = kPi * static_cast<float>(step) / static_cast<float>(rings);
      return centre + Vec3f(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                            std::cos(theta)) *
                          radius;
    };
    for (int ring = 0; ring < rings; ++ring) {
      for (int step = 0; step < 2 * rings; ++step)
        addQuad(at(ring, step), at(ring + 1, step), at(ring + 1, step + 1), at(ring, step + 1));
    }
  }
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.materials.emplace_back();
  Instance instance;
  instance.mesh.index = 0;
  instance.material.index = 0;
  scene.instances.push_back(instance);
  return scene;
}

class Room {
 public:
  explicit Room(int triangles) : scene_(roomScene(triangles)), tracer_(scene_, context_) {}
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

  // `count` lights of each kind on the surfaces, found by rays from the middle of the room.
  VirtualLights lights(size_t count) const {
    VirtualLights lights;
    Rng rng(2);
    while (lights.diffuse.size() < count) {
      const Vec2f xy = rng.next2D();
      const Vec3f origin = (Vec3f(xy.x, xy.y, rng.next1D()) - Vec3f(0.5f)) * 1.9f;
      const Ray ray{origin, sampleSphereUniform(rng.next2D())};
      const auto hit = tracer_.intersect(ray);
      if (!hit) continue;
      const SurfacePoint at = surfacePoint(scene_, *hit);
      if (dot(at.ng, ray.d) >= 0) continue;  // from inside a sphere
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
    const Ray ray{
        {0.95f, 0.93f, 0.9f},
        normalize(frameFromNormal(normalize(Vec3f(-1, -1, -1))).toWorld({1.2f * x, 1.2f * y, 1}))};
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

}  // namespace lobelia::bench
