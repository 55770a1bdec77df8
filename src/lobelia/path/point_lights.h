// Emitters at a point (point, spot, projector, goniometric) made ready for sampling.
#pragma once

#include <optional>

#include "lobelia/path/emission_pattern.h"
#include "lobelia/path/emitter_sampling.h"
#include "lobelia/path/emitter_tree.h"
#include "lobelia/path/environment_sampling.h"

namespace lobelia {

inline bool isPointLike(EmitterType type) {
  return type == EmitterType::point || type == EmitterType::spot ||
         type == EmitterType::projector || type == EmitterType::goniometric;
}

class PointLight {
 public:
  PointLight(const Scene& scene, uint32_t emitter);  // keeps references to the scene

  uint32_t emitter() const { return emitter_; }
  Vec3f position() const { return position_; }
  Rgb intensity(Vec3f local) const { return pattern_.base() * pattern_.at(local); }
  Rgb intensityTowards(Vec3f world) const { return intensity(pattern_.toLocal(world)); }
  float flux() const;  // luminance; an estimate for spots and pictures
  TreeLight treeLight() const;
  // A ray that leaves the light, its flux over the density of the ray.
  EmittedRay sampleRay(Vec2f u) const;

 private:
  uint32_t emitter_;
  EmitterType type_;
  Vec3f position_;
  EmissionPattern pattern_;
  float peak_ = 0;                            // largest intensity (luminance)
  Distribution2D film_;                       // projector: its picture
  std::optional<EnvironmentSampler> sphere_;  // goniometric: its image, in local space
};

}  // namespace lobelia
