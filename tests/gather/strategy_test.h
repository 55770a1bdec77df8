// What every gather strategy must keep to, whatever lights it picks.
#pragma once

#include <algorithm>
#include <memory>

#include "gather/random_input.h"
#include "gather/unbiased.h"
#include "lobelia/base/parallel.h"
#include "lobelia/gather/prepared_gather.h"
#include "lobelia/gather/tile.h"

namespace lobelia::test {

class StrategyTest : public testing::Test {
 protected:
  static constexpr uint32_t kAll = GatherSettings::kAllPixels;

  StrategyTest() {
    gather_.direct = true;
    gather_.clamp = 3;
  }
  // The strategy with the test's settings, the lights and a seed.
  virtual std::unique_ptr<gather::PreparedGather> prepare(uint64_t seed) = 0;

  std::vector<Rgb> all() {
    std::vector<Rgb> radiance(receivers_.points.size());
    gatherAll(tracer_, receivers_, lights_, gather_, radiance, context_);
    return radiance;
  }
  std::vector<Rgb> some(uint64_t seed = 0, GatherParts* parts = nullptr, uint32_t pixel = kAll) {
    std::vector<Rgb> radiance(receivers_.points.size());
    prepare(seed)->gather(receivers_, pixel, radiance, context_, parts);
    return radiance;
  }
  static double total(const std::vector<Rgb>& light) {
    double sum = 0;
    for (const Rgb& value : light) sum += double{value.x} + double{value.y} + double{value.z};
    return sum;
  }
  // |a - b| / |b|
  static double relativeError(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    double error = 0, norm = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      error += double{lengthSquared(a[i] - b[i])};
      norm += double{lengthSquared(b[i])};
    }
    return std::sqrt(error / norm);
  }

  void expectSum(const std::vector<Rgb>& light, const std::vector<Rgb>& exact) {
    EXPECT_GT(total(exact), 0);
    for (size_t i = 0; i < exact.size(); ++i)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(light[i][c], exact[i][c], 2e-5f * exact[i][c] + 1e-12f) << i;
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
  // rays: of the receivers, among all that are counted.
  void expectPartsAddUp(const char* rays = "shadow_rays") {
    lights_.groups = {"a", "b"};
    lights_.omniGroups.assign(lights_.omni.size(), 1);
    GatherParts parts;
    parts.groupCount = 2, parts.byType = true, parts.countRays = true;
    const uint64_t before = context_.statistics.count(rays);
    const std::vector<Rgb> whole = some(0, &parts);
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
    EXPECT_EQ(counted, context_.statistics.count(rays) - before);
    EXPECT_EQ(some(), whole) << "with and without parts";
  }

  Receivers receivers_ =
      randomReceivers(300, {LobeType::lambert, LobeType::phong, LobeType::ward}, 1, 3);
  Scene scene_ = randomTriangles(60, 11);
  Context context_;
  Tracer tracer_{scene_, context_};
  VirtualLights lights_ = randomLights(150, 100.f, 5);
  GatherSettings gather_;
};

}  // namespace lobelia::test
