// What Rich-VPLs send out, over directions [Simon15 section 3]: each stands for the light of many
// particles. Half of a cube map, of half floats (rich_cube-inl.h), or a mixture of a few Gaussians
// (von Mises-Fisher lobes), beside a cosine lobe that holds all diffuse light.
//
// Deviations from the paper: diffuse light has the cosine lobe, which is exact, and takes no
// texels; the half of the cube below the surface is left out. A lobe goes into a cube no sharper
// than texels can show it, scaled so that its energy is kept. Lobes are mixed by hard clusters of
// their moments, where expectation maximisation would have soft ones. The squared distance to a
// receiver counts as no less than that of the particles to their light, which spreads the light
// as they are spread, in place of one limit for all distances.
#pragma once

#include <span>
#include <vector>

#include "lobelia/base/frame.h"
#include "lobelia/gather/aligned_floats.h"
#include "lobelia/gather/light_block.h"

namespace lobelia::gather {

enum class RichForm : uint8_t { cube, vmf };

// Clipped at the surface: amplitude exp(sharpness (axis.w - 1)) where n.w > 0. W/sr.
struct RichLobe {
  Vec3f axis;
  float sharpness = 0;
  Rgb amplitude;
};
static_assert(sizeof(RichLobe) == 28);

class RichRadiance {
 public:
  struct Light {
    Vec3f n;
    Rgb cosine;              // W/sr along n, times [n.w]+
    float peak = 0;          // about the largest intensity of any channel, W/sr
    float leastSquared = 0;  // distance to a receiver, at least
    uint32_t lobeCount = 0;
    bool hasTexels = false;
  };

  // texels: along an edge of a cube, even, 4 to 128. lobes: of a mixture, at most.
  RichRadiance(RichForm form, size_t lights, int texels, int lobes);

  // Sets light i: what `cosine` and the particles' lobes send out together. normals: of the lobes'
  // own surfaces, at which they are clipped; a lobe keeps its energy above n. Lights may be set at
  // the same time.
  void set(size_t i, Vec3f n, Rgb cosine, std::span<const RichLobe> lobes,
           std::span<const Vec3f> normals, float leastSquared);

  size_t size() const { return lights_.size(); }
  RichForm form() const { return form_; }
  int texels() const { return texels_; }
  const Light& light(size_t i) const { return lights_[i]; }
  std::span<const RichLobe> lobes(size_t i) const {
    return {lobes_.data() + i * mostLobes_, lights_[i].lobeCount};
  }
  // Numbers of a light's texels in one channel.
  static size_t texelCount(int texels) { return 3 * static_cast<size_t>(texels * texels); }

  // Intensity, W/sr, along w, a unit vector that leaves the surface; the oracle of the kernels.
  Rgb intensity(size_t i, Vec3f w) const;
  // Power above the surface, W: the integral of intensity().
  Rgb power(size_t i) const;
  // All that a light takes.
  static uint64_t bytesPerLight(RichForm form, int texels, int lobes);

  // Whole paths are no longer than maxDepth edges: shares[i * depths + d] of light i's power are of
  // particles of depth <= d. A receiver that may not gather all depths gets the share of those it
  // may. None: all.
  void limitDepth(int maxDepth, size_t depths, std::vector<float> shares);
  float share(size_t i, int receiverDepth) const;
  bool limitsDepth() const { return !shares_.empty(); }

  // Makes diffuse lights of a block, with the indices of lights here, send this out. The block
  // keeps a reference.
  void unpack(LightBlock* block) const;

 private:
  void setTexels(size_t i, std::span<const RichLobe> lobes);
  void setLobes(size_t i, std::span<const RichLobe> lobes);

  RichForm form_;
  int texels_;
  size_t mostLobes_, stride_;  // stride: halves of a light, padded
  std::vector<Light> lights_;
  std::vector<uint16_t> halves_;   // [light][channel][texel], over peak
  std::vector<float> solidAngle_;  // of texels: integrals of what they weigh
  std::vector<RichLobe> lobes_;    // [light][lobe]
  int maxDepth_ = -1;
  size_t depths_ = 0;
  std::vector<float> shares_;
};

}  // namespace lobelia::gather
