// The photon map against looking at every photon, and photons against the lights that the same
// particles leave.
#include "lobelia/lights/photon_map.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lobelia/base/random.h"
#include "lobelia/lights/light_pass.h"
#include "support/test_scenes.h"

namespace lobelia {
namespace {

std::vector<Photon> randomPhotons(size_t count) {
  Rng random(5);
  std::vector<Photon> photons;
  for (size_t i = 0; i < count; ++i) {
    const Vec2f u = random.next2D();
    const Vec3f n = random.next1D() < 0.5f ? Vec3f(0, 0, 1) : normalize(Vec3f(0.3f, 0, 1));
    photons.push_back({{u.x, u.y, 0.01f * random.next1D()},
                       Rgb(1.f),
                       encodeOctahedral({0, 0, 1}),
                       encodeOctahedral(n),
                       1 + random.nextUint() % 4});
  }
  return photons;
}

TEST(PhotonMap, FindsWhatLookingAtAllFinds) {
  const PhotonMap map(randomPhotons(3000));
  Rng random(6);
  PhotonsFound found;
  for (int trial = 0; trial < 200; ++trial) {
    const Vec2f u = random.next2D();
    PhotonQuery query{{u.x, u.y, 0.005f}, {0, 0, 1}, trial % 3 == 0 ? -1 : 2, 0, 0};
    query.count = 1 + random.nextUint() % 40;
    query.maxRadius = 0.02f + 0.3f * random.next1D();
    map.find(query, &found);
    std::vector<std::pair<float, uint32_t>> expected;
    for (uint32_t i = 0; i < map.photons().size(); ++i) {
      const Photon& photon = map.photons()[i];
      const Vec3f d = photon.p - query.p;
      const float d2 = lengthSquared(d);
      if (query.maxDepth >= 0 && photon.depth() > query.maxDepth) continue;
      if (d.z * d.z > 0.1f * d2 + 1e-12f || d2 >= query.maxRadius * query.maxRadius) continue;
      if (dot(decodeOctahedral(photon.normal), query.n) <= 0.9f) continue;
      expected.emplace_back(d2, i);
    }
    std::sort(expected.begin(), expected.end());
    const bool more = expected.size() > query.count;
    const float radius2 = more ? expected[query.count].first : query.maxRadius * query.maxRadius;
    expected.resize(std::min(expected.size(), query.count));
    ASSERT_EQ(found.entries.size(), expected.size()) << trial;
    for (size_t i = 0; i < expected.size(); ++i)
      EXPECT_EQ(found.entries[i].index, expected[i].second) << trial;
    EXPECT_NEAR(found.area, kPi * radius2, 1e-5f * kPi * radius2);
  }
}

// The count over the area that bounds it is an unbiased density.
TEST(PhotonMap, DensityIsUnbiased) {
  Rng random(9);
  double byCount = 0, byRadius = 0;
  constexpr int kMaps = 400, kPhotons = 2000;
  PhotonsFound found;
  for (int m = 0; m < kMaps; ++m) {
    std::vector<Photon> photons;
    for (int i = 0; i < kPhotons; ++i) {
      const Vec2f u = random.next2D();
      photons.push_back(
          {{u.x, u.y, 0}, Rgb(1.f), encodeOctahedral({0, 0, 1}), encodeOctahedral({0, 0, 1}), 1});
    }
    const PhotonMap map(std::move(photons));
    map.find({{0.5f, 0.5f, 0}, {0, 0, 1}, -1, 10, 0.5f}, &found);
    byCount += static_cast<double>(found.entries.size()) / double{found.area} / kMaps;
    map.find({{0.5f, 0.5f, 0}, {0, 0, 1}, -1, 1000, 0.05f}, &found);
    byRadius += static_cast<double>(found.entries.size()) / double{found.area} / kMaps;
  }
  // Relative standard deviations of one map: 1/sqrt(9), 1/sqrt(15.7).
  EXPECT_NEAR(byCount / kPhotons, 1, 4 / std::sqrt(9.0 * kMaps));
  EXPECT_NEAR(byRadius / kPhotons, 1, 4 / std::sqrt(15.7 * kMaps));
}

TEST(PhotonMap, OfNothingFindsNothing) {
  PhotonsFound found;
  PhotonMap({}).find({{0, 0, 0}, {0, 0, 1}, -1, 5, 1.f}, &found);
  EXPECT_TRUE(found.entries.empty());
  // More photons in one point than are wanted have no density.
  const Photon photon{{1, 2, 3}, Rgb(1.f), 0, encodeOctahedral({0, 0, 1}), 1};
  PhotonMap(std::vector<Photon>(100, photon)).find({{1, 2, 3}, {0, 0, 1}, -1, 5, 1.f}, &found);
  EXPECT_TRUE(found.entries.empty());
}

// In a diffuse room a light stands where a photon lies and shines what its surface reflects.
TEST(Photons, LieWhereDiffuseLightsStand) {
  const Scene scene = test::boxScene();
  Context context;
  const Tracer tracer(scene, context);
  const EmitterSampler emitters(scene, tracer.bounds());
  for (const int maxDepth : {-1, 4}) {
    LightSettings settings;
    settings.count = 3000;
    settings.maxDepth = maxDepth;
    const VirtualLights lights = makeLights(tracer, emitters, settings, context);
    const std::vector<Photon> photons = makePhotons(tracer, emitters, settings, context);
    ASSERT_GT(photons.size(), 2000u);
    std::vector<uint32_t> ends;
    size_t missing = 0;
    Rgb power{}, intensity{};
    for (const Photon& photon : photons) {
      const size_t depth = static_cast<size_t>(photon.depth());
      if (ends.size() <= depth) ends.resize(depth + 1);
      ++ends[depth];
      // The lamp's own surface reflects nothing.
      if (photon.p.y > 0.979f && photon.p.y < 0.981f)
        ++missing, --ends[depth];
      else
        power += photon.power;
    }
    for (size_t d = 1; d < ends.size(); ++d) ends[d] += ends[d - 1];
    for (const DiffuseLight& light : lights.diffuse) intensity += light.intensity;
    ASSERT_EQ(photons.size() - missing, lights.diffuse.size());
    EXPECT_EQ(ends, lights.diffuseDepthEnds);
    const Rgb albedo(0.6f, 0.5f, 0.4f);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(power[c] * albedo[c] * kInvPi / intensity[c], 1, 1e-4) << maxDepth;
    EXPECT_LE(ends.size(), maxDepth < 0 ? 1000u : 3u);
  }
}

}  // namespace
}  // namespace lobelia
