#include "lobelia/relight/cut_merge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relight/random_cuts.h"

namespace lobelia::relight {
namespace {

using test::ValueCut;
using test::ValueNode;

struct Example {
  int levels = 0;
  std::vector<std::vector<float>> leaves;
  std::vector<ValueCut> cuts;
};

// Of 1 to 5 functions on a tree of 2 to 512 leaves.
Example example(uint64_t i, bool exact) {
  Rng rng(i, 3);
  Example out;
  out.levels = 1 + static_cast<int>(rng.nextUint() % 9);
  const size_t count = 1 + rng.nextUint() % 5;
  for (size_t c = 0; c < count; ++c) {
    out.leaves.push_back(test::randomLeaves(out.levels, 10 * i + c));
    const float chance = exact ? -1.f : 0.5f + 0.45f * rng.next1D();
    out.cuts.push_back(test::randomCut(out.leaves.back(), out.levels, chance, 10 * i + c));
  }
  return out;
}

std::vector<CutCursor<ValueNode>> cursors(const std::vector<ValueCut>& cuts) {
  std::vector<CutCursor<ValueNode>> out;
  for (const ValueCut& cut : cuts) out.emplace_back(std::span<const ValueNode>(cut));
  return out;
}

// Sum over the merged cut of |C| op(values).
template <class Op>
double merged(const std::vector<ValueCut>& cuts, const Op& op) {
  auto at = cursors(cuts);
  double sum = 0;
  mergeCuts<ValueNode>(at, [&](MergedNode node) {
    std::vector<double> values;
    for (const auto& cursor : at) values.push_back(static_cast<double>(cursor.node().value));
    sum += node.leafCount() * op(values);
  });
  return sum;
}
template <class Op>
double bruteForce(const std::vector<std::vector<float>>& functions, const Op& op) {
  double sum = 0;
  for (size_t i = 0; i < functions[0].size(); ++i) {
    std::vector<double> values;
    for (const std::vector<float>& f : functions) values.push_back(static_cast<double>(f[i]));
    sum += op(values);
  }
  return sum;
}
double product(const std::vector<double>& values) {
  double p = 1;
  for (const double v : values) p *= v;
  return p;
}
// An interpolation, times the last function.
double weightedSum(const std::vector<double>& values) {
  double sum = 0;
  for (size_t i = 0; i < values.size(); ++i) sum += static_cast<double>(i + 1) * values[i];
  return sum * values.back();
}

TEST(CutMerge, OfCutsThatAreTheirFunctionsIsBruteForceOverLeaves) {
  for (uint64_t i = 0; i < 300; ++i) {
    const Example e = example(i, true);
    const double p = bruteForce(e.leaves, product), s = bruteForce(e.leaves, weightedSum);
    EXPECT_NEAR(merged(e.cuts, product), p, 1e-12 * (1 + p)) << i;
    EXPECT_NEAR(merged(e.cuts, weightedSum), s, 1e-12 * (1 + s)) << i;
  }
}

TEST(CutMerge, IsBruteForceOverTheCutsValues) {
  for (uint64_t i = 0; i < 300; ++i) {
    const Example e = example(i, false);
    std::vector<std::vector<float>> steps;
    for (const ValueCut& cut : e.cuts) steps.push_back(test::atLeaves(cut));
    const double p = bruteForce(steps, product);
    EXPECT_NEAR(merged(e.cuts, product), p, 1e-12 * (1 + p)) << i;
  }
}

// The paper's pseudocode, literally: post-order indices and leftmost leaves.
std::vector<uint32_t> paperNodes(const std::vector<ValueCut>& cuts) {
  struct Numbered {
    uint32_t index, leftLeaf;
  };
  std::vector<std::vector<Numbered>> numbered;
  for (const ValueCut& cut : cuts) {
    numbered.emplace_back();
    uint32_t leaf = 0;
    for (const ValueNode& node : cut) {
      numbered.back().push_back(
          {postOrder(node.level, leaf >> node.level), leftLeaf(node.level, leaf >> node.level)});
      leaf += 1u << node.level;
    }
  }
  std::vector<size_t> at(cuts.size(), 0);
  std::vector<uint32_t> out;
  for (;;) {
    uint32_t minIndex = ~0u, maxLeftLeaf = 0;
    for (size_t j = 0; j < at.size(); ++j) {
      minIndex = std::min(minIndex, numbered[j][at[j]].index);
      maxLeftLeaf = std::max(maxLeftLeaf, numbered[j][at[j]].leftLeaf);
    }
    if (maxLeftLeaf <= minIndex) out.push_back(minIndex);
    for (size_t j = 0; j < at.size(); ++j)
      if (numbered[j][at[j]].index == minIndex && ++at[j] == numbered[j].size()) return out;
  }
}

TEST(CutMerge, VisitsTheNodesOfThePapersFormulation) {
  for (uint64_t i = 0; i < 300; ++i) {
    const Example e = example(i, false);
    auto at = cursors(e.cuts);
    std::vector<uint32_t> nodes;
    size_t steps = 0;
    mergeCuts<ValueNode>(at, [&](MergedNode node) {
      nodes.push_back(postOrder(node.level, node.firstLeaf >> node.level));
      ++steps;
    });
    EXPECT_EQ(nodes, paperNodes(e.cuts)) << i;
    size_t all = 0;
    for (const ValueCut& cut : e.cuts) all += cut.size();
    EXPECT_LE(steps, all);
  }
}

TEST(CutMerge, EndsWithTheFirstCutThatEnds) {
  const ValueCut whole(1, ValueNode{2, 1.f}), half(1, ValueNode{1, 1.f}), none;
  size_t leaves = 0;
  const std::vector<ValueCut> two{half, whole}, empty{whole, none};
  auto at = cursors(two);
  mergeCuts<ValueNode>(at, [&](MergedNode node) { leaves += node.leafCount(); });
  EXPECT_EQ(leaves, 2u);
  at = cursors(empty);
  mergeCuts<ValueNode>(at, [&](MergedNode) { FAIL(); });
}

struct Moments {
  double mean = 0, deviation = 0;  // root of the sum of squared differences
};
Moments momentsOf(const std::vector<float>& leaves, MergedNode node) {
  Moments m;
  for (uint32_t i = 0; i < node.leafCount(); ++i)
    m.mean += static_cast<double>(leaves[node.firstLeaf + i]);
  m.mean /= node.leafCount();
  for (uint32_t i = 0; i < node.leafCount(); ++i)
    m.deviation += std::pow(static_cast<double>(leaves[node.firstLeaf + i]) - m.mean, 2);
  m.deviation = std::sqrt(m.deviation);
  return m;
}

// Of products of two functions a, b at a merged node C, a's value being that of a larger node:
// the error is at most s_a s_b + sqrt(|C|) s |<b>|, s the deviation of a at the node of its own
// cut. With both means taken at C it is at most s_a s_b (equation 8).
TEST(CutMerge, ErrorsOfProductsKeepToTheCorrectedBound) {
  size_t nodes = 0, beyondThePapers = 0;
  for (uint64_t i = 0; i < 300; ++i) {
    Example e = example(i, false);
    if (e.cuts.size() < 2) continue;
    e.cuts.resize(2);
    auto at = cursors(e.cuts);
    mergeCuts<ValueNode>(at, [&](MergedNode node) {
      const Moments a = momentsOf(e.leaves[0], node), b = momentsOf(e.leaves[1], node);
      double exact = 0;
      for (uint32_t l = node.firstLeaf; l < node.firstLeaf + node.leafCount(); ++l)
        exact += static_cast<double>(e.leaves[0][l]) * static_cast<double>(e.leaves[1][l]);
      const auto ownNode = [&](size_t c) {
        const int level = at[c].level();
        return MergedNode{level, at[c].endLeaf() - (1u << level)};
      };
      const double ownA = momentsOf(e.leaves[0], ownNode(0)).deviation;
      const double count = node.leafCount();
      const double plain = a.deviation * b.deviation;
      const double rounding = 1e-6 * count;
      EXPECT_LE(std::abs(exact - count * a.mean * b.mean), plain + rounding);
      // b's mean at the merged node, as the renderer has the light's; a's from its cut.
      const double error =
          std::abs(exact - count * static_cast<double>(at[0].node().value) * b.mean);
      const double coarser = at[0].level() > node.level ? std::sqrt(count) * ownA * b.mean : 0;
      EXPECT_LE(error, plain + coarser + rounding);
      ++nodes;
      beyondThePapers += error > plain + rounding ? 1 : 0;
    });
  }
  EXPECT_GT(nodes, 1000u);
  EXPECT_GT(beyondThePapers, 0u) << "the paper's bound would do";
}

}  // namespace
}  // namespace lobelia::relight
