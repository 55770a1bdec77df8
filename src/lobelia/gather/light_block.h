// A short run of virtual lights of one class, unpacked for the kernels.
#pragma once

#include <span>
#include <vector>

#include "lobelia/gather/aligned_floats.h"
#include "lobelia/gather/gaussian.h"
#include "lobelia/gather/near_field.h"
#include "lobelia/gather/sphere.h"
#include "lobelia/path/emission_pattern.h"

namespace lobelia::gather {

enum class LightClass : uint8_t { omni, directional, diffuse, glossy, spherical, gaussian };
inline constexpr LightClass kLightClasses[] = {LightClass::omni,      LightClass::directional,
                                               LightClass::diffuse,   LightClass::glossy,
                                               LightClass::spherical, LightClass::gaussian};

// Do receivers gather shares of the class' lights by their distance (ReceiverPoint::nearDistance)?
// Of spherical ones they do so point by point of their discs.
constexpr bool hasShares(LightClass lightClass) {
  return lightClass == LightClass::diffuse || lightClass == LightClass::glossy;
}

// One record for all classes; a class reads what it has (VirtualLights).
struct PreparedLight {
  Vec3f p;          // directional: unit direction to the light; gaussian: the mean of the places
  Vec3f end;        // of shadow rays: p moved off its surface; directional: direction; gaussian:
                    // the place nearest to the mean
  Vec3f endBehind;  // spherical: p moved off the other side
  Vec3f n;          // diffuse, glossy, gaussian; spherical: geometric normal of the lit side
  Vec3f axis;       // glossy
  float sharpness = 0;
  // Glossy: exp(sharpness (c - 1)) is exactly 0 in float where c |c| is below this; c is the
  // cosine to the axis. Gaussian: nothing leaves where it is, c the cosine to n.
  float cutoff = 0;
  float extent = 0;       // gaussian: of the places around p
  Rgb intensity;          // spherical: power over area; gaussian: a factor
  bool transmits = true;  // spherical: does it light the other side, too?
  SquaredRange reach;     // spherical: of squared distances
  static constexpr uint32_t kNoPattern = 0xffffffffu;
  uint32_t pattern = kNoPattern;  // omni: index into LightBlock::patterns
};

class DepthMaps;
class RichRadiance;

// Lights unpacked once for whoever needs them again and again; what is too much to keep is missing.
struct PreparedLights {
  std::vector<PreparedSphere> spheres;
  std::vector<PreparedGaussian> gaussians;
};

inline constexpr size_t kBlockLights = 32;
struct LightBlock {
  LightClass lightClass = LightClass::omni;
  int count = 0;
  uint32_t index[kBlockLights];  // of the lights in their class
  PreparedLight lights[kBlockLights];
  std::vector<EmissionPattern> patterns;        // of the lights that have one, in their order
  const PreparedSphere* spheres[kBlockLights];  // spherical: parallel to lights
  std::vector<PreparedSphere> ownSpheres;       // unless they are shared
  SphereShading sphereShading;
  PreparedGaussian gaussians[kBlockLights];  // parallel to lights
  GaussianShading gaussianShading;
  // Of Gaussian lights: looked up in place of shadow rays where it can be; null: rays alone.
  const DepthMaps* depthMaps = nullptr;
  // Of diffuse lights: what they send out in place of a cosine lobe; null: nothing else. Their
  // intensity is its peak (RichRadiance::unpack()).
  const RichRadiance* rich = nullptr;
  AlignedFloats richTexels;  // [light][channel][texel], a light's at multiples of richStride
  size_t richStride = 0;
};

// Where a shadow ray to a point of a surface ends.
Vec3f liftedEnd(Vec3f p, Vec3f n);
// PreparedLight::cutoff of a glossy light.
float glossyCutoff(float sharpness);
// Light group of light `index` of a class.
uint16_t groupOf(const VirtualLights& lights, LightClass lightClass, size_t index);
size_t lightCount(const VirtualLights& lights, LightClass lightClass);
// How many of the lights of a class have depth <= `depth`; omni and directional lights are emitters
// themselves (depth 0). depth < 0: none.
size_t lightsUpToDepth(const VirtualLights& lights, LightClass lightClass, int depth);
// How many of the lights of a class are on emitters themselves (depth 0); they come first.
size_t emitterLightCount(const VirtualLights& lights, LightClass lightClass);
// spheres: false: not those.
PreparedLights prepareLights(const VirtualLights& lights, const Scene& scene, bool spheres = true);
// The block's patterns keep references to the scene. shared: prepareLights(); it must outlive the
// block. wanted: bit per spherical light; the others reach nothing.
void prepare(const VirtualLights& lights, const Scene& scene, LightClass lightClass, size_t first,
             size_t count, LightBlock* block, const PreparedLights& shared = {},
             uint32_t wanted = ~0u);
// The same of any lights of a class, at most kBlockLights.
void prepareChosen(const VirtualLights& lights, const Scene& scene, LightClass lightClass,
                   std::span<const uint32_t> indices, LightBlock* block,
                   const PreparedLights& shared = {}, uint32_t wanted = ~0u);

}  // namespace lobelia::gather
