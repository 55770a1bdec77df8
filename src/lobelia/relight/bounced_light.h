// Light that surfaces send on, as if they were diffuse: the first bounce of a frame's light, at the
// light samples and wherever a mirror shows a surface [P004 section 3, assumption 3].
//
// Deviation: the paper takes the diffuse radiance of samples; here glossy lobes count, too, with
// their albedo for light at a mean angle (cosine 2/3), so that metals light a room. Mirrors send
// nothing: their light goes where it is seen or not at all, not everywhere.
#pragma once

#include <span>
#include <vector>

#include "lobelia/base/context.h"
#include "lobelia/relight/light_samples.h"
#include "lobelia/relight/local_rays.h"

namespace lobelia::relight {

// A place of a surface with the side that is lit.
struct BouncePoint {
  LitPoint at;
  Vec3f n;       // shading normal on the side that is lit
  Rgb albedo{};  // of the side
};
// side: a direction on the side that is lit. numbers: LitPoint. followed: roughness below which
// rays follow lobes, which then do not count here; 0: none but mirrors.
BouncePoint bouncePoint(const Scene& scene, const SurfacePoint& at, Vec3f side, Vec2f numbers,
                        float followed);

// Radiance that up to 16 points send on. Returns the rays traced.
uint64_t bouncedLight(const Tracer& tracer, const LocalSources& sources,
                      std::span<const BouncePoint> points, int areaPlaces, std::span<Rgb> radiance);

// The samples' places on the scene's surfaces, found by rays from where they are kept.
class SampleSurfaces {
 public:
  // samples: of surfaces of the tracer's scene.
  SampleSurfaces(const Tracer& tracer, const LightSamples& samples);
  // Radiance that the samples send on, by the scene's materials as they are now. A sample whose
  // place a mask has taken away sends nothing. Counts: "light_rays".
  std::vector<Rgb> radiance(const Tracer& tracer, const LocalSources& sources, int areaPlaces,
                            Context& context) const;
  size_t lost() const { return lost_; }  // samples without a place

 private:
  std::vector<Hit> hits_;  // instance 0xffffffff: none
  std::vector<Vec3f> normals_;
  size_t lost_ = 0;
};

}  // namespace lobelia::relight
