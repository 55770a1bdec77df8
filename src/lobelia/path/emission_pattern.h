// Emitters at a point: how much they send where. The one place that path tracing, particles and
// virtual lights ask.
//
// Spots (linear in the angle, picture over the tangent plane of the cutoff) and projectors
// (irradiance pi times the picture on the plane at distance one, square pixels) are Mitsuba 3's.
// Goniometric emitters: an image over directions, spherical_image.h says how it lies. The pattern
// stands in the world by emitterFrame(): rigidly, so that densities per solid angle are the same in
// local and in world space.
#pragma once

#include "lobelia/base/frame.h"
#include "lobelia/scene/scene.h"

namespace lobelia {

// Radiant intensity towards a direction is base() times at(). Cheap to make; keeps references.
class EmissionPattern {
 public:
  // emitter: of type point, spot, projector or goniometric.
  EmissionPattern(const Scene& scene, const Emitter& emitter);

  // What does not vary: the intensity of points and spots, a goniometric emitter's factor; pi times
  // its scale for a projector, whose picture is wholly in at().
  Rgb base() const { return base_; }
  Rgb at(Vec3f local) const;  // local direction away from the emitter, of any length
  Vec3f toLocal(Vec3f world) const { return frame_.toLocal(world); }
  Vec3f toWorld(Vec3f local) const { return normalize(frame_.toWorld(local)); }

  // The cone that holds all light, and the one in which a spot's is undiminished.
  float cosCutoff() const { return cosCutoff_; }
  float cosBeam() const { return cosBeam_; }
  // Spot, projector: half the extent of the picture on the plane at distance one.
  float tanX() const { return tanX_; }
  float tanY() const { return tanY_; }
  // Projector: the image that it shows, or null.
  const Image* picture() const { return picture_; }

 private:
  Rgb spot(Vec3f local) const;
  Rgb projector(Vec3f local) const;

  const Scene& scene_;
  const Emitter& emitter_;
  Rgb base_{};
  Frame frame_;
  const Image* picture_ = nullptr;
  float cosCutoff_ = -1, cosBeam_ = -1, tanX_ = 1, tanY_ = 1;
};

}  // namespace lobelia
