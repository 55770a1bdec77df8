// The light tree's numbers and means, and the order of its leaves.
#include "lobelia/relight/sample_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/relight/median_clusters.h"
#include "lobelia/relight/pilot_visibility.h"
#include "relight/scenes.h"

namespace lobelia::relight {
namespace {

TEST(SampleTree, PostOrderIsThatOfATraversal) {
  constexpr int kLevels = 5;
  uint32_t next = 0;
  const std::function<uint32_t(int, uint32_t)> visit = [&](int level, uint32_t place) -> uint32_t {
    uint32_t first = next;  // of a leaf: itself
    if (level > 0) {
      first = visit(level - 1, 2 * place);
      visit(level - 1, 2 * place + 1);
    }
    EXPECT_EQ(leftLeaf(level, place), first);
    EXPECT_EQ(postOrder(level, place), next);
    EXPECT_EQ(nodeOfPostOrder(kLevels, next), (NodePlace{level, place}));
    ++next;
    return first;
  };
  visit(kLevels, 0);
  EXPECT_EQ(next, 63u);
  EXPECT_EQ(postOrder(15, 0), 65534u) << "the paper's tree fits 16 bits";
}

TEST(SampleTree, MeansAreThoseOfTheLeavesBelow) {
  Rng rng(1);
  std::vector<float> leaves(64);
  for (float& v : leaves) v = rng.next1D();
  const std::vector<float> nodes = nodeMeans(leaves);
  SampleTree tree;
  tree.levels = 6;
  for (int level = 0; level <= 6; ++level)
    for (size_t place = 0; place < size_t{64} >> level; ++place) {
      const auto begin = leaves.begin() + static_cast<std::ptrdiff_t>(place << level);
      const float mean =
          std::accumulate(begin, begin + (1 << level), 0.f) / static_cast<float>(1 << level);
      EXPECT_NEAR(nodes[tree.heapIndex(level, place)], mean, 1e-6f);
    }
}

TEST(SampleTree, ConesAndSpheresHoldTheirLeaves) {
  for (const bool surfaces : {false, true}) {
    const LightSamples samples =
        surfaces ? surfaceSamples(test::boxScene(false), 256, 1) : environmentSamples(256, 1);
    const SampleTree tree = makeSampleTree(samples);
    ASSERT_EQ(tree.levels, 8);
    EXPECT_EQ(tree.meanN.empty(), !surfaces);
    for (int level = 0; level <= 8; ++level)
      for (size_t leaf = 0; leaf < 256; ++leaf) {
        const size_t node = tree.heapIndex(level, leaf >> level);
        const Vec3f mean = tree.meanP[node];
        if (surfaces) {
          EXPECT_LE(length(samples.p[leaf] - mean), tree.spread[node] + 1e-6f);
        } else {
          EXPECT_GE(dot(samples.p[leaf], mean), tree.spread[node] * length(mean) - 1e-6f);
        }
      }
    EXPECT_EQ(surfaces ? 0 : tree.spread[tree.heapIndex(0, 3)] > 0.9999f, surfaces ? 0 : 1);
  }
}

TEST(ClusterOrder, IsAPermutationOfWholeClusters) {
  // Four clouds, far apart: the first two halvings find them.
  Rng rng(2);
  std::vector<Vec3f> points;
  for (int i = 0; i < 400; ++i) {
    const Vec3f noise{rng.next1D(), rng.next1D(), rng.next1D()};
    points.push_back(noise + Vec3f{i % 2 == 0 ? 0.f : 10.f, i / 2 % 2 == 0 ? 0.f : 30.f, 0});
  }
  Features features;
  features.p = points;
  const std::vector<uint32_t> order = clusterOrder(features, 4);
  std::vector<uint32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (uint32_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);
  for (size_t i = 0; i < 400; ++i) EXPECT_EQ(order[i] % 4, order[i / 100 * 100] % 4) << i;
}

TEST(ClusterOrder, GoesByRowsWhereTheyWeighMore) {
  Rng rng(3);
  std::vector<Vec3f> points;
  std::vector<uint8_t> rows;
  for (int i = 0; i < 64; ++i) {
    points.emplace_back(rng.next1D(), rng.next1D(), rng.next1D());
    for (int c = 0; c < 5; ++c) rows.push_back(i % 2 == 0 ? 2 : 0);
  }
  Features features;
  features.p = points, features.rows = rows, features.rowLength = 5;
  features.placeWeight = 0.01f, features.rowWeight = 1;
  const std::vector<uint32_t> order = clusterOrder(features, 6);
  for (size_t i = 0; i < 64; ++i) EXPECT_EQ(order[i] % 2, order[i / 32 * 32] % 2);
}

TEST(ClusterOrder, IsTheSameForAnyNumberOfThreads) {
  const LightSamples samples = environmentSamples(4096, 1);
  std::vector<uint8_t> rows;
  for (size_t i = 0; i < 4096 * 8; ++i) rows.push_back(static_cast<uint8_t>(mixBits(i) % 3));
  const std::vector<uint32_t> many = treeOrder(samples, rows, 8, 0.5f, 1);
  const ThreadLimit one(1);
  EXPECT_EQ(treeOrder(samples, rows, 8, 0.5f, 1), many);
}

// Nodes of few samples lie close together: that is what the order is for.
TEST(TreeOrder, PutsDirectionsNextToTheirLike) {
  const LightSamples samples = environmentSamples(1024, 1);
  const SampleTree tree = makeSampleTree(reordered(samples, treeOrder(samples, {}, 0, 1, 1)));
  double sum = 0;
  for (size_t place = 0; place < 64; ++place)
    sum += double{tree.spread[tree.heapIndex(4, place)]} / 64;
  // A disc of a 64th of the sphere has 0.969; the clusters are not round.
  EXPECT_GT(sum, 0.93);
}

}  // namespace
}  // namespace lobelia::relight
