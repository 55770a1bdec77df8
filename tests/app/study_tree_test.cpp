// Trees of studies, and the cost of their cuts against the program's own cuts and against sums.
#include "lobelia/app/study_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lobelia/base/random.h"
#include "lobelia/relight/visibility_cut.h"

namespace lobelia::app {
namespace {

std::vector<uint64_t> randomBits(size_t count, uint64_t seed, float change) {
  Rng rng(seed);
  std::vector<uint64_t> bits((count + 63) / 64, 0);
  bool on = false;
  for (size_t i = 0; i < count; ++i) {
    if (rng.next1D() < change) on = !on;
    bits[i / 64] |= uint64_t{on} << (i % 64);
  }
  return bits;
}
bool get(const std::vector<uint64_t>& bits, size_t i) { return bits[i / 64] >> (i % 64) & 1; }

// Every item once; children divide their parent; leaves have one item each.
void expectTree(const StudyTree& tree, size_t count) {
  std::vector<uint32_t> items = tree.order;
  std::sort(items.begin(), items.end());
  std::vector<uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  ASSERT_EQ(items, all);
  ASSERT_EQ(tree.nodes.front().begin, 0u);
  ASSERT_EQ(tree.nodes.front().end, count);
  size_t leaves = 0;
  for (const StudyTree::Node& node : tree.nodes) {
    uint32_t at = node.begin;
    for (uint32_t i = 0; i < node.childCount; ++i) {
      ASSERT_EQ(tree.nodes[node.firstChild + i].begin, at);
      at = tree.nodes[node.firstChild + i].end;
    }
    if (node.childCount > 0) {
      ASSERT_EQ(at, node.end);
    } else {
      ASSERT_EQ(node.end, node.begin + 1);
      ++leaves;
    }
  }
  EXPECT_EQ(leaves, count);
}

TEST(StudyTree, TreesHaveEveryItemOnce) {
  expectTree(cubeQuadTree(8), 384);
  expectTree(cubeBinaryTree(8), 384);
  std::vector<uint32_t> order(200);
  std::iota(order.rbegin(), order.rend(), 0u);
  expectTree(halvedTree(order), 200);
}

// Nodes of cube maps: squares of a face, and halves of squares.
TEST(StudyTree, NodesOfCubeMapsAreSquaresAndHalvesOfThem) {
  constexpr uint32_t kSide = 8;
  for (const bool quad : {true, false}) {
    const StudyTree tree = quad ? cubeQuadTree(kSide) : cubeBinaryTree(kSide);
    for (const StudyTree::Node& node : tree.nodes) {
      if (node.end - node.begin > kSide * kSide) continue;
      uint32_t x0 = kSide, x1 = 0, y0 = kSide, y1 = 0;
      for (uint32_t i = node.begin; i < node.end; ++i) {
        const uint32_t texel = tree.order[i], x = texel % kSide, y = texel / kSide % kSide;
        EXPECT_EQ(texel / (kSide * kSide), tree.order[node.begin] / (kSide * kSide)) << "face";
        x0 = std::min(x0, x), x1 = std::max(x1, x + 1);
        y0 = std::min(y0, y), y1 = std::max(y1, y + 1);
      }
      EXPECT_EQ((x1 - x0) * (y1 - y0), node.end - node.begin);
      EXPECT_TRUE(x1 - x0 == y1 - y0 || (!quad && x1 - x0 == 2 * (y1 - y0))) << quad;
    }
  }
}

TEST(StudyTree, CutsAreThoseOfTheProgram) {
  constexpr int kLevels = 9;
  constexpr size_t kLeaves = 1 << kLevels;
  std::vector<uint32_t> order(kLeaves);
  std::iota(order.begin(), order.end(), 0u);
  const StudyTree tree = halvedTree(order);
  CutCounter counter(tree);
  for (uint64_t seed = 0; seed < 20; ++seed) {
    relight::LeafBits bits(kLevels);
    bits.visible = randomBits(kLeaves, seed, 0.05f);
    bits.matters = randomBits(kLeaves, seed + 100, 0.1f);
    for (size_t w = 0; w < bits.wordCount(); ++w) bits.visible[w] &= bits.matters[w];
    counter.set(bits.visible, bits.matters);
    for (const float sigma : {0.f, 0.5f, 1.f, 3.f}) {
      std::vector<relight::CutNode> nodes;
      relight::CutReport report;
      relight::CutSelector(sigma, kLeaves).select(bits, &nodes, &report);
      const CutCost cost = counter.cost(double{sigma});
      EXPECT_EQ(cost.nodes, nodes.size()) << seed << ", " << sigma;
      // The program's means are rounded to 1/255.
      EXPECT_NEAR(cost.squaredError, report.squaredError, kLeaves / (4 * 255.0 * 255) + 1e-9);
    }
  }
}

TEST(StudyTree, ErrorsAreThoseOfTheNodesMeans) {
  const StudyTree tree = cubeQuadTree(8);
  const std::vector<uint64_t> visible = randomBits(384, 1, 0.2f),
                              matters = randomBits(384, 2, 0.3f);
  CutCounter counter(tree);
  counter.set(visible, matters);
  for (const StudyTree::Node& node : tree.nodes) {
    std::vector<double> values;
    for (uint32_t i = node.begin; i < node.end; ++i)
      if (get(matters, tree.order[i])) values.push_back(get(visible, tree.order[i]) ? 1 : 0);
    const double n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / std::max(n, 1.0);
    double sum = 0;
    for (const double v : values) sum += (v - mean) * (v - mean);
    EXPECT_NEAR(counter.squaredError(node.begin, node.end), sum, 1e-9);
  }
  EXPECT_EQ(counter.cost(0).squaredError, 0);
  EXPECT_EQ(counter.cost(1e9).nodes, 1u);
}

}  // namespace
}  // namespace lobelia::app
