// What every gather strategy must keep to, whatever lights it picks.
#pragma once

#include <algorithm>
#include <memory>

#include "gather/random_input.h"
#include "gather/unbiased.h"
#include "lobelia/base/parallel.h"
#include "lobelia/gather/light_block.h"
#include "lobelia/gather/prepared_gather.h"
#include "lobelia/gather/tile.h"

namespace lobelia::test {

inline double sum(const std::vector<Rgb>& light) {
  double total = 0;
  for (const Rgb& value : light) total += double{value.x} + double{value.y} + double{value.z};
  return total;
}
// |a - b| / |b|
inline double relativeError(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  double error = 0, norm = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    error += double{lengthSquared(a[i] - b[i])};
    norm += double{lengthSquared(b[i])};
  }
  return std::sqrt(error / norm);
}
// But for the order of sums.
inline void expectEqual(const std::vector<Rgb>& light, const std::vector<Rgb>& exact) {
  ASSERT_EQ(light.size(), exact.size());
  EXPECT_GT(sum(exact), 0);
  for (size_t i = 0; i < exact.size(); ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(light[i][c], exact[i][c], 3e-5f * exact[i][c] + 1e-12f) << i;
}

// The light of all lights, or of what a strategy is prepared for.
inline std::vector<Rgb> lightOfAll(const Tracer& tracer, const Receivers& receivers,
                                   const VirtualLights& lights, const GatherSettings& settings,
                                   Context& context) {
  std::vector<Rgb> radiance(receivers.points.size());
  gatherAll(tracer, receivers, lights, settings, radiance, context);
  return radiance;
}
inline std::vector<Rgb> lightOf(const gather::PreparedGather& strategy, const Receivers& receivers,
                                Context& context, GatherParts* parts = nullptr,
                                uint32_t pixel = GatherSettings::kAllPixels) {
  std::vector<Rgb> radiance(receivers.points.size());
  strategy.gather(receivers, pixel, radiance, context, parts);
  return radiance;
}

// gather(parts): the light, and its parts where they are asked for. rays: the count of the
// receivers', among all that are counted.
template <class Gather>
void expectPartsAddUp(VirtualLights& lights, const Context& context, const Gather& gather,
                      const char* rays = "shadow_rays") {
  lights.groups = {"a", "b"};
  lights.omniGroups.assign(lights.omni.size(), 1);
  GatherParts parts;
  parts.groupCount = 2, parts.byType = true, parts.countRays = true;
  const uint64_t before = context.statistics.count(rays);
  const std::vector<Rgb> whole = gather(&parts);
  uint64_t counted = 0;
  const size_t n = whole.size();
  for (size_t i = 0; i < n; ++i) {
    Rgb types;
    for (size_t t = 0; t < GatherParts::kTypes; ++t) types += parts.types[t * n + i];
    const Rgb groups = parts.groups[i] + parts.groups[n + i];
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(types[c], whole[i][c], 1e-4f * whole[i][c] + 1e-9f);
      EXPECT_NEAR(groups[c], whole[i][c], 1e-4f * whole[i][c] + 1e-9f);
    }
    counted += parts.rays[i];
  }
  EXPECT_EQ(counted, context.statistics.count(rays) - before);
  EXPECT_EQ(gather(nullptr), whole) << "with and without parts";
}

class StrategyTest : public testing::Test {
 protected:
  static constexpr uint32_t kAll = GatherSettings::kAllPixels;

  StrategyTest() {
    gather_.direct = true;
    gather_.clamp = 3;
  }
  // The strategy with the test's settings, the lights and a seed.
  virtual std::unique_ptr<gather::PreparedGather> prepare(uint64_t seed) = 0;

  std::vector<Rgb> all() { return lightOfAll(*use_, receivers_, lights_, gather_, context_); }
  std::vector<Rgb> some(uint64_t seed = 0, GatherParts* parts = nullptr, uint32_t pixel = kAll) {
    return lightOf(*prepare(seed), receivers_, context_, parts, pixel);
  }
  // By how much f() lets a count grow.
  template <class F>
  uint64_t growth(const char* name, const F& f) {
    const uint64_t before = context_.statistics.count(name);
    f();
    return context_.statistics.count(name) - before;
  }
  // f(): with the lights of one class after the other.
  template <class F>
  void withEveryClassAlone(const F& f) {
    using gather::LightClass;
    const VirtualLights lights = lights_;
    for (const LightClass lightClass :
         {LightClass::omni, LightClass::directional, LightClass::diffuse, LightClass::glossy}) {
      SCOPED_TRACE(static_cast<int>(lightClass));
      lights_ = lights;
      if (lightClass != LightClass::omni) lights_.omni.clear();
      if (lightClass != LightClass::directional) lights_.directional.clear();
      if (lightClass != LightClass::diffuse)
        lights_.diffuse.clear(), lights_.diffuseDepthEnds.clear();
      if (lightClass != LightClass::glossy) lights_.glossy.clear(), lights_.glossyDepthEnds.clear();
      f();
    }
  }
  void expectSameForAnyThreads() {
    const std::vector<Rgb> many = some();
    const ThreadLimit limit(1);
    EXPECT_EQ(some(), many);
    EXPECT_NE(some(1), many) << "another seed";
  }
  void expectSameBitsForOnePixel() {
    const std::vector<Rgb> whole = some(), one = some(0, nullptr, 37);
    EXPECT_EQ(one[37], whole[37]);
    EXPECT_NE(one[37], Rgb{});
    EXPECT_LE(std::count_if(one.begin(), one.end(), [](Rgb v) { return v != Rgb{}; }),
              static_cast<ptrdiff_t>(gather::kMaxTilePoints));
  }
  void expectPartsAddUp(const char* rays = "shadow_rays") {
    test::expectPartsAddUp(
        lights_, context_, [&](GatherParts* parts) { return some(0, parts); }, rays);
  }

  Receivers receivers_ =
      randomReceivers(300, {LobeType::lambert, LobeType::phong, LobeType::ward}, 1, 3);
  Scene scene_ = randomTriangles(60, 11);
  Context context_;
  Tracer tracer_{scene_, context_};
  const Tracer* use_ = &tracer_;
  VirtualLights lights_ = randomLights(150, 100.f, 5);
  GatherSettings gather_;
};

}  // namespace lobelia::test
