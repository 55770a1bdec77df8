// Virtual lights of every class as the light tree takes them.
#pragma once

#include <array>

#include "lobelia/gather/light_choice.h"
#include "lobelia/gather/sphere.h"
#include "lobelia/trees/light_tree.h"

namespace lobelia::gather {

// Lights that are mostly diffuse, those that are mostly glossy, and directional ones, which stand
// far outside of the scene: a node of several kinds would be told very wrongly. prepared:
// prepareLights(), which may be empty.
inline constexpr size_t kLightTrees = 3, kDirectionalTree = 2;
struct TreeLights {
  std::vector<trees::TreeLight> lights;
  std::vector<uint32_t> numbers;  // of the lights
};
std::array<TreeLights, kLightTrees> treeLights(const VirtualLights& lights,
                                               const LightNumbers& numbers, const Scene& scene,
                                               const Bounds3f& bounds,
                                               const PreparedLights& prepared);

}  // namespace lobelia::gather
