#include "lobelia/relight/vertex_light.h"

#include <gtest/gtest.h>

#include "lobelia/relight/cut_merge.h"
#include "relight/light_data.h"
#include "relight/random_cuts.h"

namespace lobelia::relight {
namespace {

constexpr int kLevels = 10;

std::vector<CutNode> visibilityCut(uint64_t seed, float chance) {
  std::vector<CutNode> out;
  const std::vector<float> leaves = test::randomLeaves(kLevels, seed);
  for (const test::ValueNode& node : test::randomCut(leaves, kLevels, chance, seed))
    out.push_back({node.level, static_cast<uint8_t>(node.value * 255)});
  return out;
}

// Light times visibility at every leaf.
std::vector<Vec3d> visibleLeaves(const LightSums& sums, const std::vector<CutNode>& cut) {
  std::vector<Vec3d> out;
  for (const CutNode node : cut)
    for (uint32_t i = 0; i < 1u << node.level; ++i) {
      const Rgb p = sums.power((size_t{1} << kLevels) + out.size()) *
                    (static_cast<float>(node.value) / 255.f);
      out.push_back({double{p.x}, double{p.y}, double{p.z}});
    }
  return out;
}
Vec3d sumOf(const std::vector<Vec3d>& leaves, size_t begin, size_t end) {
  Vec3d sum{};
  for (size_t i = begin; i < end; ++i) sum += leaves[i];
  return sum;
}

struct Rows {
  AlignedFloats values;
  LightRows rows;
  explicit Rows(size_t stride) : values(3 * stride, -1.f), rows{values.data(), stride} {}
  void expectNear(size_t i, Vec3d value) const {
    for (size_t c = 0; c < 3; ++c) {
      const double v = value[static_cast<int>(c)];
      EXPECT_NEAR(static_cast<double>(rows.channel(c)[i]), v, 1e-5 * v + 1e-9) << i;
    }
  }
};

void expectStarts(const LightCut& cut, const std::vector<CutNode>& seen,
                  const std::vector<uint16_t>& starts) {
  size_t node = 0;
  uint32_t end = 1u << seen[0].level;
  for (size_t k = 0; k < cut.count; ++k) {
    while (end <= cut.begin[k]) end += 1u << seen[++node].level;
    EXPECT_EQ(starts[k], node);
  }
}

// Of light cuts from one node to all leaves, and visibility cuts from coarse to fine.
TEST(VertexLight, IsLightTimesVisibilityOverTheLeavesOfEveryNode) {
  for (const size_t nodes : {size_t{1}, size_t{20}, size_t{128}, size_t{1} << kLevels})
    for (uint64_t seed = 0; seed < 12; ++seed) {
      const test::LitTree lit = test::litTree(kLevels, test::spottedLight(30, seed), nodes);
      const LightCut& cut = lit.light.cut;
      const std::vector<CutNode> seen = visibilityCut(seed, seed % 3 == 0 ? -1.f : 0.9f);
      const std::vector<Vec3d> leaves = visibleLeaves(lit.light.sums, seen);
      Rows rows(cut.padded());
      std::vector<uint16_t> starts(cut.count + 1);
      const size_t merged = mergeVertexLight(lit.light.sums, cut, seen, rows.rows, starts);
      expectStarts(cut, seen, starts);
      for (size_t k = 0; k < cut.count; ++k)
        rows.expectNear(k, sumOf(leaves, cut.begin[k], cut.begin[k + 1]));
      // It visits what the general algorithm does.
      std::vector<CutCursor<CutNode>> at{CutCursor<CutNode>(seen), CutCursor<CutNode>(cut.nodes)};
      size_t steps = 0;
      mergeCuts<CutNode>(at, [&](MergedNode) { ++steps; });
      EXPECT_EQ(merged, steps);
    }
}

TEST(VertexLight, OfFineNodesIsTheSame) {
  const test::LitTree lit = test::litTree(kLevels, test::spottedLight(30, 1), 64);
  for (uint64_t seed = 0; seed < 12; ++seed) {
    const std::vector<CutNode> seen = visibilityCut(seed, seed % 3 == 0 ? -1.f : 0.85f);
    const std::vector<Vec3d> leaves = visibleLeaves(lit.light.sums, seen);
    for (const size_t count : {kChunk, 2 * kChunk})
      for (int level = 0; level <= kLevels - 5; ++level)
        for (size_t place = 0; place < size_t{1} << (kLevels - level); place += count) {
          Rows rows(count);
          const auto first = static_cast<uint32_t>(place << level);
          mergeVertexNodes(lit.light.sums, lit.tree.heapIndex(level, place), count, seen,
                           findLeaf(seen, 0, 0, first), rows.rows);
          for (size_t i = 0; i < count; ++i)
            rows.expectNear(i, sumOf(leaves, (place + i) << level, (place + i + 1) << level));
        }
  }
}

TEST(CutPlace, IsOfTheNodeOfEveryLeafFromEveryEarlierOne) {
  for (uint64_t seed = 0; seed < 6; ++seed) {
    const std::vector<CutNode> cut = visibilityCut(seed, 0.9f);
    std::vector<CutPlace> places;  // by leaf
    for (size_t i = 0; i < cut.size(); ++i)
      places.insert(places.end(), size_t{1} << cut[i].level,
                    {i, static_cast<uint32_t>(places.size())});
    for (uint32_t earlier = 0; earlier < places.size(); earlier += 37)
      for (uint32_t leaf = earlier; leaf < places.size(); leaf += 5) {
        const CutPlace found = findLeaf(cut, places[earlier].node, earlier, leaf);
        EXPECT_EQ(found.node, places[leaf].node);
        EXPECT_EQ(found.firstLeaf, places[leaf].firstLeaf);
      }
  }
}

}  // namespace
}  // namespace lobelia::relight
