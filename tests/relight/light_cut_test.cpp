#include "lobelia/relight/light_cut.h"

#include <gtest/gtest.h>

#include "relight/light_data.h"

namespace lobelia::relight {
namespace {

void expectCovers(const LightCut& cut, int levels) {
  uint32_t leaf = 0;
  for (size_t i = 0; i < cut.count; ++i) {
    EXPECT_EQ(cut.begin[i], leaf);
    EXPECT_EQ(leaf % (1u << cut.nodes[i].level), 0u);
    EXPECT_EQ(cut.heap[i], (1u << (levels - cut.nodes[i].level)) + (leaf >> cut.nodes[i].level));
    for (uint32_t l = leaf; l < leaf + (1u << cut.nodes[i].level); ++l) EXPECT_EQ(cut.atLeaf[l], i);
    leaf += 1u << cut.nodes[i].level;
  }
  EXPECT_EQ(leaf, 1u << levels);
  EXPECT_EQ(cut.begin[cut.count], leaf);
  EXPECT_EQ(cut.atLeaf[leaf], cut.count);
}

TEST(LightCut, CoversAllLeavesWithAllLight) {
  for (const size_t nodes : {size_t{1}, size_t{7}, size_t{128}, size_t{512}, size_t{5000}}) {
    const test::LitTree lit = test::litTree(10, test::spottedLight(40, nodes), nodes);
    const LightCut& cut = lit.light.cut;
    EXPECT_EQ(cut.count, std::min(nodes, size_t{1} << 10));
    EXPECT_EQ(cut.padded() % kChunk, 0u);
    expectCovers(cut, 10);
    double sum = 0;
    for (size_t i = 0; i < cut.padded(); ++i) sum += static_cast<double>(cut.g[i]);
    EXPECT_NEAR(sum / static_cast<double>(lit.light.sums.power(1).y), 1, 1e-5);
  }
}

// A bright place in the dark is found first, and what is left goes to where the light is.
TEST(LightCut, IsolatesTheSunThenDividesTheBrightest) {
  DistantLight light;
  light.everywhere = Rgb(0.01f);
  light.powers = {{normalize(Vec3f(1, 2, 3)), Rgb(5.f)}};
  const test::LitTree lit = test::litTree(12, light, 64);
  const LightCut& cut = lit.light.cut;
  size_t sunny = 0;
  for (size_t i = 0; i < cut.count; ++i)
    if (cut.g[i] > 1) {
      ++sunny;
      EXPECT_EQ(cut.nodes[i].level, 0);
    }
  EXPECT_EQ(sunny, 1u);
  // The even rest: no node has much more light than another, but for those beside the sun.
  const float mean = 0.01f * 4 * kPi / 64;
  for (size_t i = 0; i < cut.count; ++i)
    if (cut.g[i] < 1) {
      EXPECT_LT(cut.g[i], 3 * mean);
    }
}

TEST(LightCut, OfNoLightIsTheRoot) {
  const test::LitTree lit = test::litTree(6, {}, 100);
  EXPECT_EQ(lit.light.cut.count, 1u);
  expectCovers(lit.light.cut, 6);
}

}  // namespace
}  // namespace lobelia::relight
