// Infinite emitters with extent: constant ones and equirectangular images.
//
// Orientation and interpolation are those of spherical_image.h. The density is bilinear between the
// texels too, luminance times sin(theta); inside a cell it is drawn exactly.
#pragma once

#include "lobelia/base/sampling.h"
#include "lobelia/path/direction_rows.h"
#include "lobelia/path/spherical_image.h"
#include "lobelia/scene/scene.h"

namespace lobelia {

class EnvironmentSampler {
 public:
  // emitter: of type constant or environment; keeps references to the scene.
  EnvironmentSampler(const Scene& scene, const Emitter& emitter);

  // Radiance that arrives along -d; d is a unit world direction towards the environment.
  Rgb radiance(Vec3f d) const;
  // Direction towards the environment and its density per solid angle; empty (pdf 0) by chance only
  // on rounding. n: cosine-weighted around it where the environment is constant, unless zero.
  Vec3f sample(Vec3f n, Vec2f u, float* pdf) const;
  float pdf(Vec3f n, Vec3f d) const;
  // Luminance integrated over the sphere.
  double integral() const { return integral_; }

 private:
  float nodeWeight(int x, int y) const;
  float density(Vec2f s) const;  // with respect to the unit square of s
  Vec3f toLocal(Vec3f d, float* jacobian) const;

  bool constant_ = true;
  Rgb value_{};  // constant radiance, or the factor of the image
  SphericalImage image_;
  DirectionRows toLocal_, toWorld_;
  std::vector<float> rowSine_;  // sin(theta) of each row of texels
  Distribution2D cells_;
  double mean_ = 0;  // of the cells' weights
  double integral_ = 0;
};

}  // namespace lobelia
