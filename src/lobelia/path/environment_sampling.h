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
  // And pdf(n, d), which reads the same texels.
  Rgb radiance(Vec3f d, Vec3f n, float* pdf) const;
  // Direction towards the environment and its density per solid angle; empty (pdf 0) by chance only
  // on rounding. n: cosine-weighted around it where the environment is constant, unless zero.
  // radiance: from the direction, unless null. It and the density are those of the direction before
  // it was rounded: radiance(d) and pdf(n, d) differ in the last digits.
  Vec3f sample(Vec3f n, Vec2f u, float* pdf, Rgb* radiance = nullptr) const;
  // Asks memory for what sample() will read for these numbers.
  void prefetch(std::span<const Vec2f> u) const;
  float pdf(Vec3f n, Vec3f d) const;
  // Luminance integrated over the sphere.
  double integral() const { return integral_; }

 private:
  using Cell = SphericalImage::Cell;
  struct Corners {  // weights at a cell's corners: x0 y0, x1 y0, x0 y1, x1 y1
    float w00, w10, w01, w11;
  };

  float nodeWeight(Rgb texel, int y) const;
  Corners corners(const Cell& cell, const SphericalImage::Texels& texels) const;
  // With respect to solid angle, at the cell's position.
  float density(const Cell& cell, const Corners& corners, Vec3f local, float jacobian) const;
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
