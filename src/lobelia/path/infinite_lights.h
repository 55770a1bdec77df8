// Emitters at infinity made ready for sampling: directions, discs (suns) and environments.
//
// What a direction shows is the sum of all discs and environments there, and so is the density with
// which it is drawn: the direction counts, not which emitter it was drawn from. A sun is sampled
// uniformly over the cone of its disc, whose radiance is the same everywhere (no limb darkening):
// irradiance / (pi sin^2 radius).
#pragma once

#include <optional>

#include "lobelia/path/emitter_sampling.h"
#include "lobelia/path/environment_sampling.h"

namespace lobelia {

struct InfiniteLight {
  enum class Kind : uint8_t { direction, disc, environment };
  Kind kind = Kind::direction;
  uint32_t emitter = 0;
  Vec3f direction;         // direction, disc: towards the light
  Rgb value;               // direction: irradiance; disc: radiance
  float oneMinusCos = 0;   // disc
  size_t environment = 0;  // index among the environments
  double flux = 0;         // luminance of what enters the scene's bounding sphere
  float probability = 0;   // of being chosen by EmitterSampler
};

class InfiniteLights {
 public:
  // centre, radius: bounding sphere of the scene. Keeps references to the scene.
  InfiniteLights(const Scene& scene, Vec3f centre, float radius);

  bool empty() const { return lights_.empty(); }
  size_t size() const { return lights_.size(); }
  const InfiniteLight& operator[](size_t i) const { return lights_[i]; }
  void setProbability(size_t i, float probability) { lights_[i].probability = probability; }

  Rgb environment(Vec3f d) const;  // radiance from direction d, without the discs of suns
  Rgb escaped(Vec3f d) const;      // and with them
  // And pdfEscaped(n, d) at once.
  Rgb escaped(Vec3f d, Vec3f n, float* pdf) const;
  // The emitters that rays which escape see, and the part of escaped() that is one's.
  const std::vector<uint32_t>& seen() const { return seen_; }
  Rgb escaped(Vec3f d, uint32_t emitter) const;
  float pdfEscaped(Vec3f n, Vec3f d) const;
  std::optional<EmitterDirection> sample(const InfiniteLight& light, Vec3f n, Vec2f u) const;
  // Asks memory for what sample() will read for these numbers.
  void prefetch(const InfiniteLight& light, std::span<const Vec2f> u) const {
    if (light.kind == InfiniteLight::Kind::environment)
      environments_[light.environment].prefetch(u);
  }
  bool hasEnvironments() const { return !environments_.empty(); }
  // A ray into the scene, its flux over the density of the ray (selection not included).
  std::optional<EmittedRay> sampleRay(const InfiniteLight& light, Vec2f uPosition,
                                      Vec2f uDirection) const;

 private:
  void add(const Scene& scene, uint32_t emitter);
  double disk() const { return static_cast<double>(kPi * radius_ * radius_); }

  Vec3f centre_;
  float radius_ = 1;
  std::vector<EnvironmentSampler> environments_;
  std::vector<uint32_t> environmentEmitters_, seen_;
  std::vector<InfiniteLight> discs_;   // those seen; they need not be among the lights
  std::vector<InfiniteLight> lights_;  // those sampled
};

// Luminous discs smaller than this are sampled as a direction and not seen: floats cannot say
// whether a direction lies within.
inline constexpr float kSmallestDisc = 2e-5f;  // radians

}  // namespace lobelia
