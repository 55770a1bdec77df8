#include "lobelia/lights/light_spacing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lobelia/base/random.h"

namespace lobelia {
namespace {

// On a square of side 2, of all classes.
VirtualLights onSquare(size_t count) {
  VirtualLights lights;
  Rng rng(1);
  for (size_t i = 0; i < count; ++i) {
    const Vec3f p{2 * rng.next1D(), 2 * rng.next1D(), 0};
    if (i % 3 == 0) lights.diffuse.push_back({p, Rgb(1.f), 0, 1});
    if (i % 3 == 1) lights.glossy.push_back({p, {0, 0, 1}, {0, 0, 1}, Rgb(1.f), 1});
    if (i % 3 == 2) lights.spherical.emplace_back().p = p;
  }
  return lights;
}

TEST(LightSpacing, HasAboutAsManyLights) {
  const VirtualLights lights = onSquare(30000);
  const LightSpacing spacing({&lights});
  constexpr float kPi = 3.14159265f;
  Rng rng(2);
  for (const float count : {4.f, 30.f, 200.f}) {
    double mean = 0;
    constexpr int kPlaces = 400;
    for (int i = 0; i < kPlaces; ++i) {
      const Vec3f p{0.5f + rng.next1D(), 0.5f + rng.next1D(), 0};
      const float distance = spacing.distance(p, count);
      mean += double{kPi * distance * distance} * (30000 / 4.0) / kPlaces;
    }
    EXPECT_NEAR(mean, double{count}, 0.15 * double{count});
  }
}

TEST(LightSpacing, OfFewLightsAndOfNone) {
  EXPECT_TRUE(std::isinf(LightSpacing({}).distance({0, 0, 0}, 1)));
  VirtualLights lights;
  lights.diffuse.push_back({{3, 0, 4}, Rgb(1.f), 0, 1});
  // One light, which stands for sixteen.
  EXPECT_FLOAT_EQ(LightSpacing({&lights}).distance({0, 0, 0}, 4), 2.5f);
}

}  // namespace
}  // namespace lobelia
