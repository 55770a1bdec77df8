// Virtual spherical Gaussian lights unpacked for the kernels.
#pragma once

#include "lobelia/lights/virtual_lights.h"

namespace lobelia::gather {

struct PreparedGaussian {
  Vec3f mean;
  // Variance of the places across a view along the unit vector w: halfTrace - wᵀ Q w, spread
  // included; Q as GaussianLight::covariance.
  float halfTrace = 0;
  float q[6] = {};
  float covariance[6] = {};  // without the spread
  float extent = 0;          // beyond this distance of the mean the places count for nothing
  // A part of the light: what leaves by a Gaussian. peak: its amplitude, W/sr.
  struct Part {
    Vec3f axis{0, 0, 1};
    float sharpness = 0;
    Rgb peak{};
    bool any = false;
  };
  // diffuse: with Form::accurate `peak` is power / pi, and `sharpness` that of the normals.
  Part diffuse, glossy;
  float normalSharpness = 0;
  float facingSine = 1;  // light leaves up to this sine below the plane across the mean normal
  Vec3f ends[GaussianLight::kPlaces];
};

// Does a cluster send light to one side only?
inline bool isFlat(const GaussianLight& light) { return light.normalSharpness > 1e5f; }

PreparedGaussian prepareGaussian(const GaussianLight& light, const GaussianShading& shading);

}  // namespace lobelia::gather
