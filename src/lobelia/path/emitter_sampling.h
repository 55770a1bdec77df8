// Sampling of emitters: for next-event estimation (a direction towards light) and for particles
// (a ray of light).
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "lobelia/base/sampling.h"
#include "lobelia/scene/light_groups.h"
#include "lobelia/trace/tracer.h"

namespace lobelia {

struct EmitterDirection {  // light that may arrive at a point
  Vec3f wi;                // towards the emitter
  float distance = 0;      // infinite (3e38) for environments and directional emitters
  Vec3f target;            // end of the shadow ray (offset from the emitter's surface); finite only
  Rgb weight;              // radiance / pdf, or intensity / (d^2 pmf): multiply by f |cos|
  float pdf = 0;           // solid angle, selection included; 0 for delta
  bool delta = false;
  uint32_t emitter = 0;
};

struct EmittedRay {  // a particle
  Ray ray;           // offset from its surface
  Rgb power;         // flux of the particle: Le |cos| / pdf
  Vec3f ng;          // normal of the emitting surface; direction for the others
  uint32_t emitter = 0;
  bool infinite = false;  // environment and directional emitters
};

// Towards a point, finite emitters (each triangle of an area emitter for itself) are chosen through
// a tree, so that 10^6 emissive triangles cost O(log n) and near ones are preferred (Conty Estevez
// and Kulla 2018), mixed with a uniform choice; particles leave in proportion to flux. Spheres are
// sampled by the cone they subtend, suns by their disc, environments by luminance. All functions
// are thread-safe.
class EmitterSampler {
 public:
  EmitterSampler(const Scene& scene, Bounds3f sceneBounds);
  ~EmitterSampler();

  bool empty() const;
  // n: unit normal on the side that light counts from, or zero when it counts from both sides.
  // select, u.x: selects the emitter; place, (u.y, u.z): where on it. False or empty: nothing
  // arrives (a sample of value 0).
  bool sampleDirection(Vec3f p, Vec3f n, float select, Vec2f place, EmitterDirection& out) const;
  std::optional<EmitterDirection> sampleDirection(Vec3f p, Vec3f n, Vec3f u) const {
    EmitterDirection out;
    return sampleDirection(p, n, u.x, {u.y, u.z}, out) ? std::optional(out) : std::nullopt;
  }
  // Are there environments or many lights, where one sample reads far from another? Asks memory for
  // what sampleDirection() will read for these numbers, wherever p is.
  bool scattered() const;
  void prefetch(std::span<const Vec3f> u) const;
  // Density with which sampleDirection(p, n) returns the direction of this hit on an emitter.
  float pdfHit(Vec3f p, Vec3f n, const SurfacePoint& hit, Vec3f wi) const;
  float pdfEscaped(Vec3f p, Vec3f n, Vec3f wi) const;
  // Emitted radiance of a hit towards wo; 0 from the back.
  Rgb emitted(const SurfacePoint& hit, Vec3f wo) const;
  // Radiance from environments and the discs of suns along an escaping ray of direction d; of
  // environments alone.
  Rgb escaped(Vec3f d) const;
  // And pdfEscaped(p, n, d) at once, wherever p is.
  Rgb escaped(Vec3f d, Vec3f n, float* pdf) const;
  Rgb environment(Vec3f d) const;
  // The same of the environments of one light group.
  Rgb environment(Vec3f d, size_t group) const;

  const LightGroups& groups() const;
  // Adds `value`, light that an emitter sends along d (towards it), to its group's sum:
  // sums[groups().size()]. kEscaped: what a ray that escapes sees; of several emitters there
  // (environments, suns; a sample of one of them holds all) each group gets its share.
  static constexpr uint32_t kEscaped = 0xffffffffu;
  void addByGroup(uint32_t emitter, Vec3f d, Rgb value, Rgb* sums) const;

  std::optional<EmittedRay> sampleRay(float uSelect, Vec2f uPosition, Vec2f uDirection) const;
  double power() const;  // total flux (luminance) of what sampleRay draws from

  const Scene& scene() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobelia
