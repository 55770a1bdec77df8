// Ray queries over a scene (Embree 3.13 or 4 behind it).
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "lobelia/scene/shading.h"

namespace lobelia {

// Where a shadow ray that is as long as its direction ends. The intersector's error grows with the
// length of the ray, which the offset of the far end from its surface does not know.
inline constexpr float kShadowEnd = 1 - 0x1p-15f;

// Up to 16 rays as structure of arrays, ready for Embree's packets; shadow rays for the most part.
// Fill lanes [0, 16); active[i] = -1 for lanes to trace, 0 for others. Directions need not be unit.
struct alignas(64) ShadowPacket {
  static constexpr int kSize = 16;
  float ox[kSize], oy[kSize], oz[kSize], tMin[kSize];
  float dx[kSize], dy[kSize], dz[kSize], tMax[kSize];
  int32_t active[kSize];

  // A lane from a to b, both already offset from their surfaces.
  void set(int lane, Vec3f a, Vec3f b) {
    ox[lane] = a.x, oy[lane] = a.y, oz[lane] = a.z, tMin[lane] = 0;
    dx[lane] = b.x - a.x, dy[lane] = b.y - a.y, dz[lane] = b.z - a.z, tMax[lane] = kShadowEnd;
    active[lane] = -1;
  }
  void set(int lane, const Ray& ray) {
    ox[lane] = ray.o.x, oy[lane] = ray.o.y, oz[lane] = ray.o.z, tMin[lane] = ray.tMin;
    dx[lane] = ray.d.x, dy[lane] = ray.d.y, dz[lane] = ray.d.z, tMax[lane] = ray.tMax;
    active[lane] = -1;
  }
};

class Tracer {
 public:
  // Keeps a reference to the scene, which must not change. Throws InputError for a scene too large
  // for 32-bit ids or with indices out of range, RuntimeError with Embree's message, Cancelled with
  // the context. Adds its time to the stage "accel" and sets the value "embree_bytes".
  Tracer(const Scene& scene, Context& context);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  // Nearest hit in (tMin, tMax]. Masks (opacity < 1) are passed stochastically by a hash of the
  // ray and the triangle: same ray, same answer.
  std::optional<Hit> intersect(const Ray& ray) const;
  bool occluded(const Ray& ray) const;
  // Nearest hits of the active lanes, empty for the others. Which rays share a packet may change a
  // hit's last bits.
  void intersect(ShadowPacket& packet, bool coherent,
                 std::span<std::optional<Hit>, ShadowPacket::kSize> hits) const;
  // Bit i of the result is set when lane i is active and NOT blocked. coherent: the rays share an
  // end or lie close together (Embree's COHERENT flag; wrong use only costs speed).
  uint32_t visible(ShadowPacket& packet, bool coherent) const;
  // Is there nothing between the two points? Both already offset from their surfaces.
  bool visible(Vec3f a, Vec3f b) const;

  const Scene& scene() const { return scene_; }
  Bounds3f bounds() const { return bounds_; }

 private:
  struct Impl;
  const Scene& scene_;
  Bounds3f bounds_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobelia
