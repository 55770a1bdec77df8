// Samples of incident light: directions of an environment, or places on the scene's surfaces that
// send on the light of emitters (one bounce of local light). [P004 section 4.1]
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lobelia/scene/scene.h"

namespace lobelia::relight {

// In the order of the light tree's leaves once there is one (sample_tree.h). Count: a power of two.
struct LightSamples {
  enum class Kind : uint8_t { environment, surfaces };
  Kind kind = Kind::environment;
  // environment: unit directions towards the light, in the world; surfaces: places, moved off the
  // surface to the side of n as far as a ray's end has to be.
  std::vector<Vec3f> p;
  std::vector<Vec3f> n;        // surfaces: unit geometric normals; environment: empty
  std::vector<float> measure;  // environment: solid angle (sr), sums to 4 pi; surfaces: area
  size_t count() const { return p.size(); }
};

// Throws std::invalid_argument unless count is a power of two from 2 to 2^15.
void requireSampleCount(size_t count);

// Evenly spread by relaxation; all stand for the same solid angle.
LightSamples environmentSamples(size_t count, uint64_t seed);

// Evenly spread by area over all instances; all stand for the same area. Surfaces whose material
// scatters on both sides count twice, once for each side. Throws InputError for a scene without
// area.
LightSamples surfaceSamples(const Scene& scene, size_t count, uint64_t seed);

// Sample i becomes the one at order[i].
LightSamples reordered(const LightSamples& samples, const std::vector<uint32_t>& order);

}  // namespace lobelia::relight
