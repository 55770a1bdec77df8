// Finite emitters made ready for sampling: emissive triangles in world space, emissive spheres and
// point-like emitters (point_lights.h), numbered in this order.
#pragma once

#include <optional>

#include "lobelia/base/prefetch.h"
#include "lobelia/path/emitter_sampling.h"
#include "lobelia/path/emitter_tree.h"
#include "lobelia/path/point_lights.h"

namespace lobelia {

// A cache line, which is what a sample of one among many waits for.
struct alignas(64) TriangleLight {
  Vec3f p0, e1, e2;       // world space
  Vec3f n;                // unit, on the side that emits
  float inverseArea = 0;  // 0: degenerate, never chosen
  float error = 0;        // SurfacePoint::error, the largest of its corners
  uint32_t instance = 0, triangle = 0;
  float area() const { return inverseArea > 0 ? 1 / inverseArea : 0.f; }
};
static_assert(sizeof(TriangleLight) == 64);

struct SphereLight {
  Vec3f centre;
  float radius = 0;
  float outer = 0;  // a sphere that contains the tessellation that rays meet
  uint32_t instance = 0;
};

// What a light sends towards a point.
struct LightSample {
  Vec3f wi, target;
  float distance = 0;
  Rgb value;      // area: radiance; point-like: intensity / distance^2
  float pdf = 0;  // solid angle; 0 for point-like
};

class FiniteLights {
 public:
  explicit FiniteLights(const Scene& scene);

  size_t size() const { return triangles_.size() + spheres_.size() + points_.size(); }
  size_t emitterCount() const { return emitterCount_; }  // an emissive instance counts one
  bool isPoint(uint32_t light) const { return light >= firstPoint(); }
  // Uniform over emitters, by area within one.
  std::vector<float> uniformWeights() const;
  std::vector<float> fluxes() const;  // luminance
  std::vector<TreeLight> treeLights() const;
  uint32_t emitter(uint32_t light) const;

  // Empty where the light sends nothing towards p.
  bool isTriangle(uint32_t light) const { return light < firstSphere(); }
  std::optional<LightSample> sampleTriangle(uint32_t light, Vec3f p, Vec2f u) const;
  std::optional<LightSample> sampleOther(uint32_t light, Vec3f p, Vec2f u) const;
  void prefetch(uint32_t light) const {
    if (light < firstSphere()) prefetchRead(&triangles_[light]);
  }
  // The light that a hit belongs to; empty when it emits nothing.
  std::optional<uint32_t> lightOf(const SurfacePoint& hit) const;
  // Density of sample(light, p) for the direction wi of the hit.
  float pdf(uint32_t light, Vec3f p, const SurfacePoint& hit, Vec3f wi) const;
  // A ray that leaves the light, its flux over the density of the ray (selection not included).
  EmittedRay sampleRay(uint32_t light, Vec2f uPosition, Vec2f uDirection) const;

 private:
  static constexpr uint32_t kNone = 0xffffffffu;
  uint32_t firstSphere() const { return static_cast<uint32_t>(triangles_.size()); }
  uint32_t firstPoint() const { return static_cast<uint32_t>(triangles_.size() + spheres_.size()); }
  // What the lights of an instance have in common.
  struct InstanceLights {
    uint32_t first = kNone;  // of its lights; kNone when it does not emit
    uint32_t emitter = 0;
    float area = 0;
    bool plain = false;  // radiance is one colour, without a mask
    Rgb radiance{};      // if so
  };
  void addInstance(uint32_t instance);
  Rgb radiance(const TriangleLight& light, float b1, float b2) const {
    const InstanceLights& instance = instances_[light.instance];
    return instance.plain ? instance.radiance : variedRadiance(light, b1, b2);
  }
  Rgb variedRadiance(const TriangleLight& light, float b1, float b2) const;
  Rgb radiance(const SphereLight& light) const;
  float meanRadiance(const TriangleLight& light) const;

  const Scene& scene_;
  std::vector<TriangleLight> triangles_;
  std::vector<SphereLight> spheres_;
  std::vector<PointLight> points_;
  std::vector<InstanceLights> instances_;
  size_t emitterCount_ = 0;
};

inline std::optional<LightSample> FiniteLights::sampleTriangle(uint32_t index, Vec3f p,
                                                               Vec2f u) const {
  const TriangleLight& light = triangles_[index];
  const Vec2f b = sampleTriangleUniform(u);
  const Vec3f at = light.p0 + light.e1 * b.x + light.e2 * b.y;
  const Vec3f to = at - p;
  const float d2 = lengthSquared(to), along = -dot(light.n, to);
  if (!(along > 0) || !(d2 > 0)) return std::nullopt;
  LightSample result;
  result.distance = std::sqrt(d2);
  result.wi = to / result.distance;
  result.target = offsetOrigin(at, light.n, light.error, -to);
  result.value = radiance(light, b.x, b.y);
  result.pdf = d2 * light.inverseArea * (result.distance / along);
  return result;
}

}  // namespace lobelia
