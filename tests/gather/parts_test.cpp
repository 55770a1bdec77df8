// What is gathered taken apart by light group, kinds of light and lobe, and rays.
#include <gtest/gtest.h>

#include <cstring>

#include "gather/random_input.h"
#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/gather/gather.h"

namespace lobelia {
namespace {

using namespace test;

class Parts : public testing::Test {
 protected:
  static VirtualLights grouped(size_t groups) {
    VirtualLights lights = randomLights(70, 50, 5);
    lights.groups.resize(groups, "g");
    for (size_t i = 0; i < lights.omni.size(); ++i)
      lights.omniGroups.push_back(static_cast<uint16_t>(i % groups));
    for (size_t i = 0; i < lights.directional.size(); ++i)
      lights.directionalGroups.push_back(static_cast<uint16_t>(i % groups));
    for (size_t i = 0; i < lights.glossy.size(); ++i)
      lights.glossyGroups.push_back(static_cast<uint16_t>(i / 3 % groups));
    for (size_t i = 0; i < lights.diffuse.size(); ++i)
      lights.diffuse[i].tag |= static_cast<uint32_t>(i / 5 % groups) << 8;
    return lights;
  }
  std::vector<Rgb> gather(const VirtualLights& lights, float clamp, GatherParts* parts) {
    std::vector<Rgb> radiance(receivers_.points.size());
    GatherSettings settings;
    settings.direct = true;
    settings.clamp = clamp;
    gatherAll(tracer_, receivers_, lights, settings, radiance, context_, parts);
    return radiance;
  }
  void expectSum(const std::vector<Rgb>& parts, const std::vector<Rgb>& whole) const {
    const size_t points = whole.size();
    for (size_t i = 0; i < points; ++i) {
      Rgb sum{};
      for (size_t k = 0; k < parts.size() / points; ++k) sum += parts[k * points + i];
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c], whole[i][c], 1e-5f * maxComponent(whole[i])) << "point " << i;
    }
  }

  Scene scene_ = randomTriangles(60, 11);
  Context context_;
  Tracer tracer_{scene_, context_};
  Receivers receivers_ =
      randomReceivers(300, {LobeType::lambert, LobeType::microfacetReflection}, 2, 3);
};

TEST_F(Parts, GroupsSumToTheWholeWhoseBitsTheyLeaveAlone) {
  const VirtualLights lights = grouped(3);
  for (const float clamp : {0.f, 0.05f}) {
    GatherParts parts;
    parts.groupCount = 3;
    parts.byType = parts.countRays = true;
    const std::vector<Rgb> whole = gather(lights, clamp, &parts), alone = gather(lights, clamp, {});
    EXPECT_EQ(std::memcmp(whole.data(), alone.data(), whole.size() * sizeof(Rgb)), 0);
    expectSum(parts.groups, whole);
    expectSum(parts.types, whole);
  }
}

TEST_F(Parts, AGroupIsWhatItsLightsGiveAlone) {
  const VirtualLights lights = grouped(2);
  GatherParts parts;
  parts.groupCount = 2;
  gather(lights, 0, &parts);
  VirtualLights second = lights;  // the others shine black
  for (size_t i = 0; i < second.omni.size(); ++i)
    if (lights.omniGroups[i] == 0) second.omni[i].intensity = Rgb{};
  for (size_t i = 0; i < second.directional.size(); ++i)
    if (lights.directionalGroups[i] == 0) second.directional[i].irradiance = Rgb{};
  for (size_t i = 0; i < second.glossy.size(); ++i)
    if (lights.glossyGroups[i] == 0) second.glossy[i].intensity = Rgb{};
  for (DiffuseLight& light : second.diffuse)
    if (light.tag >> 8 == 0) light.intensity = Rgb{};
  const std::vector<Rgb> alone = gather(second, 0, {});
  size_t lit = 0;
  for (size_t i = 0; i < alone.size(); ++i) {
    lit += maxComponent(alone[i]) > 0;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(parts.groups[alone.size() + i][c], alone[i][c], 1e-5f * maxComponent(alone[i]));
  }
  EXPECT_GT(lit, alone.size() / 15);
}

TEST_F(Parts, TypesAreTheLobesAlone) {
  const VirtualLights lights = grouped(1);
  GatherParts parts;
  parts.byType = true;
  gather(lights, 0, &parts);
  const size_t points = receivers_.points.size();
  for (Lobe& lobe : receivers_.lobes)
    if (!isDiffuse(lobe.type)) lobe.weight = Rgb{};
  for (size_t lightClass = 0; lightClass < 4; ++lightClass) {
    VirtualLights some = lights;
    if (lightClass != 0) some.omni.clear(), some.omniGroups.clear();
    if (lightClass != 1) some.directional.clear(), some.directionalGroups.clear();
    if (lightClass != 2) some.diffuse.clear(), some.diffuseDepthEnds.clear();
    if (lightClass != 3)
      some.glossy.clear(), some.glossyGroups.clear(), some.glossyDepthEnds.clear();
    const std::vector<Rgb> diffuse = gather(some, 0, {});
    for (size_t i = 0; i < points; ++i)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(parts.types[2 * lightClass * points + i][c], diffuse[i][c],
                    2e-5f * maxComponent(diffuse[i]) + 1e-9f);
  }
}

TEST_F(Parts, RaysOfThePointsAreTheRaysTraced) {
  GatherParts parts;
  parts.countRays = true;
  gather(grouped(1), 0, &parts);
  uint64_t sum = 0;
  for (const uint32_t rays : parts.rays) sum += rays;
  EXPECT_EQ(sum, context_.statistics.count("shadow_rays"));
  EXPECT_GT(sum, 0u);
}

}  // namespace
}  // namespace lobelia
