#include "lobelia/gather/tree_lights.h"

#include <algorithm>

#include "lobelia/base/parallel.h"
#include "lobelia/gather/light_forest.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::gather {
namespace {

using trees::TreeLight;

// Where directional lights stand, in radii of the scene.
constexpr float kFar = 100;

TreeLight farLight(const DirectionalLight& light, const Bounds3f& bounds) {
  const float distance = kFar * std::max(bounds.radius(), 1e-6f);
  TreeLight out;
  out.p = bounds.centre() + light.direction * distance;
  out.radius = 1.001f * bounds.radius();  // from wherever in the scene it is seen
  out.diffuse = 4 * luminance(light.irradiance) * distance * distance;
  return out;
}

// Of finite lights. On all sides: four times what a cosine lobe has of intensity.
TreeLight asTreeLight(const trees::BoundItem& item, bool omni) {
  TreeLight out;
  out.p = item.p;
  out.n = item.n;
  out.diffuse = (omni ? 4 : 1) * item.cosine;
  if (item.gaussianCount == 0) return out;
  lobes::Moment moment;
  for (int i = 0; i < item.gaussianCount; ++i) {
    const auto& g = item.gaussians[i];
    moment.add(lobes::momentOf(g.axis, g.sharpness, g.amplitude * lobes::integral(g.sharpness)));
  }
  if (!(moment.weight > 0)) return out;
  out.axis = item.gaussians[0].axis;
  out.sharpness = item.gaussians[0].sharpness;
  out.glossy = moment.weight;
  if (item.gaussianCount == 1) return out;
  const lobes::SphericalGaussian lobe = lobes::lobeOf(moment);
  out.axis = lobe.axis;
  out.sharpness = lobe.sharpness;
  return out;
}

// By the extent of a cluster. Cosine lobes whose normals disagree are told by the length of their
// mean.
void widen(const GaussianLight& light, float spread, TreeLight* out) {
  out->variance = light.covariance[0] + light.covariance[1] + light.covariance[2];
  out->radius = 3 * std::sqrt(std::max(1.f, 0.5f * spread) * out->variance);
  const bool oneSided = isFlat(light);
  out->n =
      light.normal *
      (oneSided ? 1 : std::min(lobes::meanResultant(light.normalSharpness), trees::kSpreadNormal));
}

}  // namespace

std::array<TreeLights, kLightTrees> treeLights(const VirtualLights& lights,
                                               const LightNumbers& numbers, const Scene& scene,
                                               const Bounds3f& bounds,
                                               const PreparedLights& prepared) {
  const auto sphereOf = [&](size_t index, PreparedSphere* own) -> const PreparedSphere& {
    if (!prepared.spheres.empty()) return prepared.spheres[index];
    prepareSphere(scene, lights.spherical[index], lights.specularLimit, own);
    return *own;
  };
  TreeLights all;
  all.lights.resize(numbers.count()), all.numbers.resize(numbers.count());
  std::vector<size_t> places;  // where a block's lights go: behind those of the blocks before it
  size_t end = 0;
  for (size_t b = 0; b < numbers.blockCount(); ++b) {
    places.push_back(end);
    end += numbers.block(b).count;
  }
  std::vector<uint8_t> trees(all.lights.size());
  parallelFor(places.size(), 16, [&](size_t b) {
    const LightNumbers::Block block = numbers.block(b);
    PreparedSphere own;
    for (size_t i = 0; i < block.count; ++i) {
      const size_t index = block.first + i, place = places[b] + i;
      all.numbers[place] = static_cast<uint32_t>(block.number + i);
      TreeLight& light = all.lights[place];
      const bool spherical = block.lightClass == LightClass::spherical;
      const PreparedSphere* sphere = spherical ? &sphereOf(index, &own) : nullptr;
      light = block.lightClass == LightClass::directional
                  ? farLight(lights.directional[index], bounds)
                  : asTreeLight(boundItemOf(lights, block.lightClass, index, sphere),
                                block.lightClass == LightClass::omni);
      if (spherical) light.variance = 0.5f * sphere->squaredRadius;
      if (block.lightClass == LightClass::gaussian)
        widen(lights.gaussian[index], lights.gaussianShading.spread, &light);
      trees[place] = block.lightClass == LightClass::directional ? kDirectionalTree
                     : light.mostlyGlossy()                      ? 1
                                                                 : 0;
    }
  });
  std::array<TreeLights, kLightTrees> out;
  for (size_t t = 0; t < kLightTrees; ++t) {
    const size_t count = static_cast<size_t>(std::count(trees.begin(), trees.end(), t));
    out[t].lights.reserve(count), out[t].numbers.reserve(count);
  }
  for (size_t i = 0; i < trees.size(); ++i) {
    out[trees[i]].lights.push_back(all.lights[i]);
    out[trees[i]].numbers.push_back(all.numbers[i]);
  }
  return out;
}

}  // namespace lobelia::gather
