#include "lobelia/lights/light_order.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lobelia/base/random.h"

namespace lobelia {
namespace {

constexpr uint32_t kLights = 3000, kFirstDepth = 1000;
constexpr size_t kBlock = 32;

// What is parallel to a light, or in it, is the light's number.
VirtualLights numbered() {
  VirtualLights lights;
  Rng rng(1);
  for (uint32_t i = 0; i < kLights; ++i) {
    const Vec3f p{rng.next1D(), 3 * rng.next1D(), rng.next1D()};
    const Rgb number(static_cast<float>(i));
    lights.diffuse.push_back({p, number, 0, i});
    lights.glossy.push_back({p, {0, 0, 1}, {0, 0, 1}, number, 1});
    lights.glossyGroups.push_back(static_cast<uint16_t>(i));
    SphericalLight& spherical = lights.spherical.emplace_back();
    spherical.p = p, spherical.power = number, spherical.group = static_cast<uint16_t>(i);
  }
  lights.diffuseDepthEnds = lights.glossyDepthEnds =
      lights.sphericalDepthEnds = {0, kFirstDepth, kLights};
  return lights;
}

Bounds3f boundsOf(const std::vector<Vec3f>& places, size_t begin, size_t end) {
  Bounds3f bounds;
  for (size_t i = begin; i < end; ++i) bounds.add(places[i]);
  return bounds;
}

// places and numbers: of the lights in their new order.
void expectOrder(const std::vector<Vec3f>& places, const std::vector<uint32_t>& numbers) {
  const VirtualLights before = numbered();
  ASSERT_EQ(numbers.size(), kLights);
  for (size_t i = 0; i < kLights; ++i) {
    EXPECT_EQ(places[i], before.diffuse[numbers[i]].p);
    EXPECT_EQ(numbers[i] < kFirstDepth, i < kFirstDepth) << "depths stay apart";
  }
  std::vector<uint32_t> sorted = numbers;
  std::sort(sorted.begin(), sorted.end());
  for (uint32_t i = 0; i < kLights; ++i) EXPECT_EQ(sorted[i], i) << "none is lost";
  const float all = boundsOf(places, 0, kFirstDepth).radius();
  double mean = 0;
  for (size_t i = 0; i + kBlock <= kFirstDepth; i += kBlock)
    mean += double{boundsOf(places, i, i + kBlock).radius()} * kBlock / kFirstDepth;
  EXPECT_LT(mean, 0.6 * double{all}) << "blocks are compact";
}

TEST(LightOrder, KeepsDepthsGroupsAndLightsOfEveryClass) {
  VirtualLights lights = numbered();
  sortByPlace(Bounds3f{{0, 0, 0}, {1, 3, 1}}, &lights);
  std::vector<Vec3f> places[3];
  std::vector<uint32_t> numbers[3];
  for (const DiffuseLight& light : lights.diffuse) {
    places[0].push_back(light.p), numbers[0].push_back(light.tag);
    EXPECT_EQ(light.intensity.x, static_cast<float>(light.tag));
  }
  ASSERT_EQ(lights.glossyGroups.size(), lights.glossy.size());
  for (size_t i = 0; i < lights.glossy.size(); ++i) {
    places[1].push_back(lights.glossy[i].p), numbers[1].push_back(lights.glossyGroups[i]);
    EXPECT_EQ(lights.glossy[i].intensity.x, static_cast<float>(lights.glossyGroups[i]));
  }
  for (const SphericalLight& light : lights.spherical) {
    places[2].push_back(light.p), numbers[2].push_back(light.group);
    EXPECT_EQ(light.power.x, static_cast<float>(light.group));
  }
  for (int i = 0; i < 3; ++i) expectOrder(places[i], numbers[i]);
}

}  // namespace
}  // namespace lobelia
