// Finite emitters made ready for sampling: emissive triangles in world space, emissive spheres and
// point-like emitters (point_lights.h), numbered in this order.
#pragma once

#include <optional>

#include "lobelia/path/emitter_sampling.h"
#include "lobelia/path/emitter_tree.h"
#include "lobelia/path/point_lights.h"

namespace lobelia {

struct TriangleLight {
  Vec3f p0, e1, e2;  // world space
  uint32_t instance = 0, triangle = 0;
  // 1 / |e1 x e2|, negative when e1 x e2 points away from the side that emits; 0: degenerate, never
  // chosen.
  float scale = 0;
  float error = 0;  // SurfacePoint::error, the largest of its corners
  Vec3f normal() const { return cross(e1, e2) * scale; }
  float inverseArea() const { return 2 * std::abs(scale); }
  float area() const { return scale != 0 ? 1 / inverseArea() : 0.f; }
};
static_assert(sizeof(TriangleLight) == 52);

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
  std::optional<LightSample> sample(uint32_t light, Vec3f p, Vec2f u) const;
  // The light that a hit belongs to; empty when it emits nothing.
  std::optional<uint32_t> lightOf(const SurfacePoint& hit) const;
  // Density of sample(light, p) for the direction wi of the hit.
  float pdf(uint32_t light, Vec3f p, const SurfacePoint& hit, Vec3f wi) const;
  // A ray that leaves the light, its flux over the density of the ray (selection not included).
  EmittedRay sampleRay(uint32_t light, Vec2f uPosition, Vec2f uDirection) const;

 private:
  uint32_t firstSphere() const { return static_cast<uint32_t>(triangles_.size()); }
  uint32_t firstPoint() const { return static_cast<uint32_t>(triangles_.size() + spheres_.size()); }
  void addInstance(uint32_t instance);
  Rgb radiance(const TriangleLight& light, float b1, float b2) const;
  Rgb radiance(const SphereLight& light) const;
  float meanRadiance(const TriangleLight& light) const;

  const Scene& scene_;
  std::vector<TriangleLight> triangles_;
  std::vector<SphereLight> spheres_;
  std::vector<PointLight> points_;
  std::vector<uint32_t> firstLight_;  // per instance; kNone when it does not emit
  std::vector<float> instanceArea_;
  std::vector<uint8_t> plain_;  // per instance: radiance is one colour, without a mask
  size_t emitterCount_ = 0;
  static constexpr uint32_t kNone = 0xffffffffu;
};

}  // namespace lobelia
