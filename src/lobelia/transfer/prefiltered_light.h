// Light from infinity, convolved with vMF lobes of a range of widths [P002 section 7.1;
// methods.md 3.3].
#pragma once

#include <vector>

#include "lobelia/base/context.h"
#include "lobelia/relight/distant_light.h"

namespace lobelia::transfer {

class PrefilteredLight {
 public:
  // Level l is the light convolved with a vMF lobe of kappa kappa0 / 4^l, exactly, at the texels of
  // an octahedral map as fine as its lobe needs. O(levels * cells), in parallel.
  explicit PrefilteredLight(const relight::DistantLight& light);

  // Integral of radiance times a vMF lobe (of integral 1); axis: unit, in the frame of the light.
  // Linear between texels and, in log kappa, between levels; kappa is taken to lie between those of
  // the last and the first level.
  Rgb lookUp(Vec3f axis, float kappa) const;
  float sharpest() const;  // kappa of level 0
  size_t byteCount() const;

 private:
  struct Level {
    int size = 0;  // texels along an edge, without the border of one
    float kappa = 1;
    std::vector<float> texels;  // (size + 2)^2 x 4
  };
  Rgb lookUpLevel(const Level& level, Vec3f axis) const;
  std::vector<Level> levels_;
};

}  // namespace lobelia::transfer
