// Light from infinity, convolved with vMF lobes of a range of widths [P002 section 7.1;
// methods.md 3.3].
#pragma once

#include <vector>

#include "lobelia/base/context.h"
#include "lobelia/relight/distant_light.h"

namespace lobelia::transfer {

// For registers of lobes (packet_kernels.h).
struct LightLevels {
  const float* const* texels =
      nullptr;                   // by level: r, g, b and nothing of each texel, face after face
  const float* sizes = nullptr;  // by level: texels along an edge of a face, with the border
  float sharpest = 0;            // kappa of level 0
  float last = 0;                // number of the last level
};

class PrefilteredLight {
 public:
  // Between levels of factor 4 light from one direction would err by 25 % of its peak, of factor 2
  // by 6 %, so by 1.5 %; light as wide as the lobe by 0.2 %.
  static constexpr float kLevelsPerOctave = 2;
  // Level l is the light convolved with a vMF lobe of kappa kappa0 / 2^(l / 2) at the texels of a
  // cube map as fine as its lobe needs. O(levels * texels), in parallel.
  explicit PrefilteredLight(const relight::DistantLight& light);
  PrefilteredLight(PrefilteredLight&&) = default;
  PrefilteredLight& operator=(PrefilteredLight&&) = default;

  // Integral of radiance times a vMF lobe (of integral 1); axis: unit, in the frame of the light.
  // Linear between texels and, in log kappa, between levels; kappa is taken to lie between those of
  // the last and the first level.
  Rgb lookUp(Vec3f axis, float kappa) const { return lookUpAt(axis, levelOf(kappa)); }
  // In two steps, where many axes have one kappa.
  float levelOf(float kappa) const;
  Rgb lookUpAt(Vec3f axis, float level) const;

  LightLevels levels() const;
  float sharpest() const { return levels_[0].kappa; }  // kappa of level 0
  size_t levelCount() const { return levels_.size(); }
  float kappaOf(size_t level) const { return levels_[level].kappa; }

 private:
  // Alpha is not used: registers of four.
  struct alignas(16) Texel {
    float value[4] = {};
  };
  struct Level {
    int size = 0;  // texels along an edge of a face, with a border of one beyond each
    float kappa = 1;
    std::vector<Texel> texels;  // 6 size^2
  };
  void fill(const relight::DistantLight& light, Level* level) const;
  std::vector<Level> levels_;
  std::vector<const float*> texels_;  // of levels_, as LightLevels has them
  std::vector<float> sizes_;
};

}  // namespace lobelia::transfer
