// One particle's way through the scene and the virtual lights that it leaves (inner loop of the
// light pass).
#pragma once

#include "lobelia/base/random.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/bsdf/gaussians.h"
#include "lobelia/lights/light_pass.h"

namespace lobelia {

// No path is longer, whatever the settings: a record holds its depth in 8 bits.
inline constexpr int kMaxLightDepth = 250;

// What a Gaussian's intensity is multiplied by, since it leaves the surface by the geometric normal
// n on its side: the head of particle_walk.cpp says why.
float geometricRatio(const GaussianLobe& lobe, Vec3f n);

// What a range of particles leaves, in the order of the particles.
struct ParticleBatch {
  std::vector<DiffuseLight> diffuse;
  std::vector<GlossyLight> glossy;
  std::vector<uint8_t> glossyDepth;  // parallel to glossy; diffuse lights carry theirs
  std::vector<uint16_t> glossyGroup;
  std::vector<SphericalLight> spherical;
  std::vector<Photon> photons;
  std::vector<LightPoint> points;
  size_t lightCount() const {
    return diffuse.size() + glossy.size() + spherical.size() + photons.size() + points.size();
  }
  uint64_t rays = 0, cut = 0, dropped = 0, nonFinite = 0;
  void addCounts(const ParticleBatch& other);
  void book(Context& context) const;  // the counts, as LightSettings' passes name them
};

// Of the settings' set of lights.
uint64_t seedOf(const LightSettings& settings, const Context& context);

class ParticleWalk {
 public:
  // stream: which of the seed's independent sets of particles; scale multiplies every power.
  ParticleWalk(const Tracer& tracer, const EmitterSampler& emitters, const LightSettings& settings,
               uint64_t seed, uint64_t stream, float scale);

  void trace(uint32_t particle, ParticleBatch* out) const;
  // The same from a given ray on, whose power is multiplied by the scale, without a light on the
  // emitter; random: of what comes after the emission.
  void traceFrom(const EmittedRay& emitted, Sampler random, ParticleBatch* out) const;
  // Light of depth 0, where the ray leaves an area emitter.
  void leaveOnEmitter(const EmittedRay& emitted, Rgb power, ParticleBatch* out) const;
  // Deepest light that the settings allow; < 1: none but those on emitters.
  int lastDepth() const { return lastDepth_; }

 private:
  struct Place {  // of a light among the others
    int depth;
    uint16_t group;
  };
  static uint32_t tagOf(Place place) {
    return static_cast<uint32_t>(place.depth) | static_cast<uint32_t>(place.group) << 8;
  }
  void leavePhoton(const SurfacePoint& at, Vec3f wi, Rgb power, Place place,
                   ParticleBatch* out) const;
  void leaveLights(const Hit& hit, const SurfacePoint& at, const Bsdf& bsdf, Vec3f wi, Rgb power,
                   Place place, float u, ParticleBatch* out) const;
  void leaveGlossy(const SurfacePoint& at, const Bsdf& bsdf, const LobeExpansion& lobes, Rgb power,
                   Place place, float u, ParticleBatch* out) const;
  void leavePoints(const SurfacePoint& at, const Bsdf& bsdf, const LobeExpansion& lobes, Vec3f side,
                   Rgb power, Place place, float u, ParticleBatch* out) const;
  void addSpherical(const Hit& hit, const SurfacePoint& at, Vec3f wi, Rgb power, Place place,
                    ParticleBatch* out) const;
  void addDiffuse(Vec3f p, Vec3f n, Rgb intensity, Place place, ParticleBatch* out) const;
  void addGlossy(const SurfacePoint& at, const Bsdf& bsdf, const GaussianLobe& lobe, Rgb power,
                 Place place, ParticleBatch* out) const;
  void addPoint(const LightPoint& point, Place place, ParticleBatch* out) const;

  const Tracer& tracer_;
  const EmitterSampler& emitters_;
  const LightSettings& settings_;
  uint64_t seed_, stream_;
  float scale_;
  int lastDepth_;
};

}  // namespace lobelia
