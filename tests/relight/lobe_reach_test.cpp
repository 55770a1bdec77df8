#include "lobelia/relight/lobe_reach.h"

#include <gtest/gtest.h>

#include "lobelia/base/sampling.h"
#include "lobelia/bsdf/bsdf.h"

namespace lobelia::relight {
namespace {

Lobe glossy(LobeType type, Distribution distribution, float alpha) {
  Lobe lobe;
  lobe.type = type;
  lobe.distribution = distribution;
  lobe.alphaX = lobe.alphaY = alpha;
  if (type == LobeType::phong) lobe.alphaX = 0.5f / (alpha * alpha);
  if (type == LobeType::ward) lobe.variant = 2;
  return lobe;
}

TEST(LobeReach, NarrowerLobesNeedFinerLightAndReachLessFar) {
  Lobe widened;
  int level = 15;
  float radius = kPi;
  for (const float alpha : {0.5f, 0.25f, 0.12f, 0.06f, 0.03f, 0.018f}) {
    const auto reach = lobeReach(glossy(LobeType::ward, Distribution::ggx, alpha), 15, &widened);
    ASSERT_TRUE(reach);
    EXPECT_LT(reach->level, level);
    EXPECT_LT(reach->radius, radius);
    EXPECT_EQ(widened.alphaX, alpha);
    level = reach->level, radius = reach->radius;
  }
  EXPECT_EQ(level, 0);
  EXPECT_FALSE(lobeReach(Lobe{}, 15, &widened)) << "a lobe without a highlight";
}

TEST(LobeReach, RoughnessIsRaisedToWhatSamplesResolve) {
  Lobe widened;
  for (const int levels : {9, 15}) {
    const auto reach = lobeReach(glossy(LobeType::microfacetReflection, Distribution::ggx, 0.01f),
                                 levels, &widened);
    EXPECT_EQ(reach->level, 0);
    EXPECT_NEAR(widened.alphaX, 2 / std::sqrt(std::ldexp(1.f, levels)) / 0.63f, 1e-5f);
  }
}

TEST(LobeReach, FewSamplesWidenNoLobeBeyondItsKind) {
  Lobe widened;
  for (int levels = 1; levels <= 6; ++levels)
    for (const float alpha : {0.01f, 0.5f}) {
      ASSERT_TRUE(lobeReach(glossy(LobeType::microfacetReflection, Distribution::ggx, alpha),
                            levels, &widened));
      EXPECT_LE(widened.alphaX, 1) << levels;
      EXPECT_LE(widened.alphaY, 1) << levels;
      ASSERT_TRUE(lobeReach(glossy(LobeType::phong, Distribution::ggx, alpha), levels, &widened));
      EXPECT_GE(widened.alphaX, 0) << levels;
    }
  // What is broader by itself stays so.
  lobeReach(glossy(LobeType::ward, Distribution::ggx, 1.5f), 2, &widened);
  EXPECT_EQ(widened.alphaX, 1.5f);
}

TEST(LobeReach, MirrorsAreLobesOfLessThanHalfADegree) {
  EXPECT_FALSE(isMirror(Lobe{}));
  EXPECT_FALSE(isMirror(glossy(LobeType::microfacetReflection, Distribution::ggx, 0.02f)));
  EXPECT_TRUE(isMirror(glossy(LobeType::microfacetReflection, Distribution::ggx, 0.005f)));
  EXPECT_TRUE(isMirror(glossy(LobeType::phong, Distribution::ggx, 0.005f)));
  Lobe delta;
  delta.type = LobeType::deltaReflection;
  EXPECT_TRUE(isMirror(delta));
}

// What ends has nearly all of its light before its end, as samples of it show.
TEST(LobeReach, LobesThatEndAreWithinTheirEnd) {
  for (const Lobe& lobe : {glossy(LobeType::phong, Distribution::ggx, 0.1f),
                           glossy(LobeType::ward, Distribution::ggx, 0.1f),
                           glossy(LobeType::microfacetReflection, Distribution::beckmann, 0.1f),
                           glossy(LobeType::microfacetReflection, Distribution::ggx, 0.1f)}) {
    Lobe widened;
    const auto reach = lobeReach(lobe, 15, &widened);
    const bool ends = reach->end < kPi;
    const float end = ends ? reach->end : 4 * std::sqrt(2.f) * lobe.alphaX;
    Bsdf bsdf;
    bsdf.add(lobe);
    const Vec3f wo = normalize(Vec3f(0.6f, 0, 0.8f)), mirror{-wo.x, -wo.y, wo.z};
    double inside = 0, all = 0;
    for (uint32_t i = 0; i < 20000; ++i) {
      Sampler random(1, 2, i);
      const float u = random.next1D();
      const auto s = sample(bsdf, wo, u, random.next2D());
      if (!s) continue;
      all += static_cast<double>(s->weight.y);
      if (dot(s->wi, mirror) > std::cos(end)) inside += static_cast<double>(s->weight.y);
    }
    const double outside = 1 - inside / all;
    if (ends) {
      EXPECT_LT(outside, 2e-3);
    } else {
      EXPECT_GT(outside, 0.02) << "its tail has to be looked at";
    }
  }
}

}  // namespace
}  // namespace lobelia::relight
