// Cuts against sums over all leaves.
#include "lobelia/relight/visibility_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lobelia/base/random.h"

namespace lobelia::relight {
namespace {

constexpr int kLevels = 9;
constexpr uint32_t kLeaves = 1 << kLevels;

bool get(const std::vector<uint64_t>& bits, uint32_t leaf) {
  return bits[leaf / 64] >> (leaf % 64) & 1;
}

// Runs of random lengths, every eighth leaf of random value.
LeafBits randomBits(uint64_t seed, bool allMatter) {
  Rng rng(seed);
  LeafBits bits(kLevels);
  bool visible = false;
  for (uint32_t leaf = 0; leaf < kLeaves; ++leaf) {
    if (rng.next1D() < 0.03f) visible = !visible;
    const bool value = rng.next1D() < 0.1f ? rng.next1D() < 0.5f : visible;
    const bool matters = allMatter || (leaf / 37 % 3 != 0 && leaf % 5 != 0);
    bits.visible[leaf / 64] |= uint64_t{value && matters} << (leaf % 64);
    bits.matters[leaf / 64] |= uint64_t{matters} << (leaf % 64);
  }
  return bits;
}

struct Selected {
  std::vector<CutNode> nodes;
  CutReport report;
};
Selected select(const LeafBits& bits, float sigma, size_t mostNodes = kLeaves) {
  Selected out;
  CutSelector selector(sigma, mostNodes);
  selector.select(bits, &out.nodes, &out.report);
  return out;
}

// Error of the leaves [begin, end) about their mean.
double squaredError(const LeafBits& bits, uint32_t begin, uint32_t end) {
  double n = 0, k = 0;
  for (uint32_t leaf = begin; leaf < end; ++leaf) {
    if (!get(bits.matters, leaf)) continue;
    n += 1, k += get(bits.visible, leaf) ? 1 : 0;
  }
  if (n == 0) return 0;
  double sum = 0;
  for (uint32_t leaf = begin; leaf < end; ++leaf)
    if (get(bits.matters, leaf)) sum += std::pow((get(bits.visible, leaf) ? 1 : 0) - k / n, 2);
  return sum;
}

// use(node, begin, end); expects that the nodes cover all leaves, each in its place.
template <class Use>
void forNodes(const std::vector<CutNode>& nodes, const Use& use) {
  uint32_t leaf = 0;
  for (const CutNode& n : nodes) {
    EXPECT_EQ(leaf % (1u << n.level), 0u);
    use(n, leaf, leaf + (1u << n.level));
    leaf += 1u << n.level;
  }
  EXPECT_EQ(leaf, kLeaves);
}

TEST(VisibilityCut, KeepsTheErrorOfEachNode) {
  for (uint64_t seed = 0; seed < 20; ++seed)
    for (const float sigma : {0.7f, 1.5f, 3.f}) {
      const LeafBits bits = randomBits(seed, seed % 2 == 0);
      const Selected cut = select(bits, sigma);
      EXPECT_EQ(cut.report.nodes, cut.nodes.size());
      EXPECT_EQ(cut.report.capped, 0u);
      double error = 0;
      uint64_t samples = 0;
      forNodes(cut.nodes, [&](CutNode n, uint32_t begin, uint32_t end) {
        const double bound = double{sigma} * double{sigma};
        EXPECT_LE(squaredError(bits, begin, end), bound * (1 + 1e-9));
        // And no finer than it has to be: the node above passes the bound.
        const uint32_t size = 2u << n.level, parent = begin / size * size;
        if (n.level < kLevels) {
          EXPECT_GT(squaredError(bits, parent, parent + size), bound * (1 - 1e-9));
        }
        for (uint32_t leaf = begin; leaf < end; ++leaf) {
          if (!get(bits.matters, leaf)) continue;
          error += std::pow((get(bits.visible, leaf) ? 1 : 0) - n.value / 255.0, 2), ++samples;
        }
      });
      EXPECT_NEAR(cut.report.squaredError, error, 1e-9 * (1 + error));
      EXPECT_EQ(cut.report.samples, samples);
    }
}

TEST(VisibilityCut, WithoutErrorIsTheFunction) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const LeafBits bits = randomBits(seed, false);
    forNodes(select(bits, 0).nodes, [&](CutNode n, uint32_t begin, uint32_t end) {
      for (uint32_t leaf = begin; leaf < end; ++leaf)
        if (get(bits.matters, leaf)) {
          EXPECT_NEAR(n.value / 255.0, get(bits.visible, leaf) ? 1 : 0, 1.0 / 510);
        }
    });
  }
}

TEST(VisibilityCut, OfAMeanIsQuantisedToTheNearest) {
  const LeafBits bits = randomBits(3, true);
  forNodes(select(bits, 4).nodes, [&](CutNode n, uint32_t begin, uint32_t end) {
    double visible = 0;
    for (uint32_t leaf = begin; leaf < end; ++leaf) visible += get(bits.visible, leaf) ? 1 : 0;
    EXPECT_NEAR(n.value / 255.0, visible / (end - begin), 1.0 / 510 + 1e-12);
  });
}

TEST(VisibilityCut, RefinesTheWorstUpToTheLargestSize) {
  const LeafBits bits = randomBits(8, true);
  const size_t whole = select(bits, 0.5f).nodes.size();
  double before = 1e9;
  for (const size_t most : {size_t{1}, size_t{7}, size_t{30}, whole - 1}) {
    const Selected cut = select(bits, 0.5f, most);
    EXPECT_EQ(cut.nodes.size(), most);
    EXPECT_EQ(cut.report.capped, 1u);
    double worst = 0, least = 1e9;
    forNodes(cut.nodes, [&](CutNode n, uint32_t begin, uint32_t end) {
      worst = std::max(worst, squaredError(bits, begin, end));
      const uint32_t size = 2u << n.level, parent = begin / size * size;
      if (most > 1) least = std::min(least, squaredError(bits, parent, parent + size));
    });
    // Whatever was split was worse than whatever was not.
    EXPECT_GE(least, worst - 1e-9);
    EXPECT_LT(worst, before);
    before = worst;
  }
}

// What does not matter costs nothing: half of the leaves at random, the rest all seen.
TEST(VisibilityCut, LeavesOutWhatDoesNotMatter) {
  Rng rng(1);
  LeafBits bits(kLevels);
  for (size_t w = 0; w < bits.wordCount(); ++w) {
    bits.matters[w] = uint64_t{rng.nextUint()} << 32 | rng.nextUint();
    bits.visible[w] = bits.matters[w];
  }
  const Selected cut = select(bits, 0);
  ASSERT_EQ(cut.nodes.size(), 1u);
  EXPECT_EQ(cut.nodes[0].level, kLevels);
  EXPECT_EQ(cut.nodes[0].value, 255);
}

TEST(VisibilityCut, JudgesOnlyWhereAsked) {
  LeafBits bits = randomBits(5, true);
  bits.judged = randomBits(5, false).matters;
  const Selected cut = select(bits, 2);
  double error = 0;
  forNodes(cut.nodes, [&](CutNode n, uint32_t begin, uint32_t end) {
    for (uint32_t leaf = begin; leaf < end; ++leaf)
      if (get(bits.judged, leaf))
        error += std::pow((get(bits.visible, leaf) ? 1 : 0) - n.value / 255.0, 2);
  });
  EXPECT_NEAR(cut.report.squaredError, error, 1e-9 * error);
}

TEST(VisibilityCut, OfSmallTrees) {
  LeafBits bits(3);  // less than a word
  bits.matters[0] = 0xff, bits.visible[0] = 0x0f;
  std::vector<CutNode> nodes;
  CutReport report;
  CutSelector(0, 100).select(bits, &nodes, &report);
  ASSERT_EQ(nodes.size(), 2u);
  EXPECT_EQ(nodes[0].value, 255);
  EXPECT_EQ(nodes[1].value, 0);
  EXPECT_EQ(nodes[1].level, 2);
}

}  // namespace
}  // namespace lobelia::relight
