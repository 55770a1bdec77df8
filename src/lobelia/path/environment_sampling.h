// Infinite emitters with extent: constant ones and equirectangular images.
//
// Orientation and interpolation are Mitsuba 3's, so that images agree: u = atan2(x, -z) / 2 pi,
// v = acos(y) / pi; texel centres lie at u = (i + 1/2) / width, periodic, and at v = j /
// (height-1), so that the first and last rows are the poles. The density is bilinear between the
// texels too, luminance times sin(theta); inside a cell it is drawn exactly.
#pragma once

#include "lobelia/base/sampling.h"
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
  struct Cell {  // four neighbouring texels and the position between them
    int x0, x1, y0, y1;
    float fx, fy;
  };
  Cell cellAt(Vec2f s) const;
  Rgb texel(int x, int y) const;
  float nodeWeight(int x, int y) const;
  float density(Vec2f s) const;  // with respect to the unit square of s
  Vec2f toSquare(Vec3f local) const;
  Vec3f fromSquare(Vec2f s) const;
  Vec3f toLocal(Vec3f d, float* jacobian) const;

  bool constant_ = true;
  Rgb value_{};  // constant radiance, or the factor of the image
  const Image* image_ = nullptr;
  Transform toWorld_;
  float inverseDeterminant_ = 1;
  Vec3f inverseRows_[3];        // world to local
  Vec3f rows_[3];               // local to world
  std::vector<float> rowSine_;  // sin(theta) of each row of texels
  Distribution2D cells_;
  double mean_ = 0;  // of the cells' weights
  double integral_ = 0;
};

}  // namespace lobelia
