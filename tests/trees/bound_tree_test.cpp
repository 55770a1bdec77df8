// Nodes with bounds against all of their items.
#include "lobelia/trees/bound_tree.h"

#include <gtest/gtest.h>

#include <cstring>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/lights/virtual_lights.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::trees {
namespace {

std::vector<BoundItem> randomItems(uint32_t count) {
  Rng rng(3);
  std::vector<BoundItem> items(count);
  for (BoundItem& item : items) {
    item.p = Vec3f(rng.next1D(), rng.next1D(), rng.next1D()) * 5.f;
    item.radius = 0.1f * rng.next1D();
    item.n = sampleSphereUniform(rng.next2D());
    item.cosine = 0.1f + rng.next1D();
    item.gaussianCount = 1 + (rng.next1D() < 0.5f);
    for (int i = 0; i < item.gaussianCount; ++i)
      item.gaussians[i] = {sampleSphereUniform(rng.next2D()), std::pow(1000.f, rng.next1D()),
                           rng.next1D()};
  }
  return items;
}

class BoundTrees : public testing::TestWithParam<uint32_t> {
 protected:
  const std::vector<BoundItem> items_ = randomItems(517);
  BoundTree make(BoundTree::Side side) const {
    const auto item = [&](uint32_t i) { return items_[i]; };
    return BoundTree(static_cast<uint32_t>(items_.size()), item, side, 5.f, GetParam());
  }
  template <class Check>
  void forItems(const BoundTree& tree, const BoundNode& node, const Check& check) const {
    for (uint32_t i = 0; i < node.count; ++i) check(items_[tree.item(node.first + i)]);
  }
};

float energyOf(const BoundItem& item) {
  float sum = 0;
  for (int i = 0; i < item.gaussianCount; ++i)
    sum += item.gaussians[i].amplitude * lobes::integral(item.gaussians[i].sharpness);
  return sum;
}

void expectWithin(Vec3f v, uint32_t axis, uint16_t angle) {
  EXPECT_LE(angleBetween(v, decodeOctahedral(axis)), angleOfCode(angle) + 1e-6f);
}

TEST_P(BoundTrees, NodesHoldTheirItems) {
  const BoundTree tree = make(BoundTree::Side::lights);
  for (const BoundNode& node : tree.nodes()) {
    forItems(tree, node, [&](const BoundItem& item) {
      for (int d = 0; d < 3; ++d) {
        EXPECT_LE(node.lo[d], item.p[d] - item.radius);
        EXPECT_GE(node.hi[d], item.p[d] + item.radius);
      }
      EXPECT_LE(length(item.p - node.centre) + item.radius, node.radius * 1.00001f);
      expectWithin(item.n, node.normalAxis, node.normalAngle);
      for (int i = 0; i < item.gaussianCount; ++i) {
        expectWithin(item.gaussians[i].axis, node.lobeAxis, node.lobeAngle);
        EXPECT_LE(node.leastSharpness, item.gaussians[i].sharpness);
        EXPECT_GE(node.mostSharpness, item.gaussians[i].sharpness);
      }
    });
  }
}

TEST_P(BoundTrees, LightsAddUp) {
  const BoundTree tree = make(BoundTree::Side::lights);
  for (const BoundNode& node : tree.nodes()) {
    float cosine = 0, peak = 0, energy = 0;
    Vec3f place{}, moment{};
    forItems(tree, node, [&](const BoundItem& item) {
      cosine += item.cosine, energy += energyOf(item);
      place += item.p * (kPi * item.cosine + energyOf(item));
      for (int i = 0; i < item.gaussianCount; ++i) {
        const BoundItem::Gaussian& g = item.gaussians[i];
        peak += g.amplitude;
        moment += g.axis *
                  (g.amplitude * lobes::integral(g.sharpness) * lobes::meanResultant(g.sharpness));
      }
    });
    EXPECT_NEAR(node.cosine, cosine, 1e-4f * cosine);
    EXPECT_NEAR(node.peak, peak, 1e-4f * peak);
    EXPECT_NEAR(node.energy, energy, 1e-4f * energy);
    EXPECT_LT(length(node.centre - place / (kPi * cosine + energy)), 1e-4f);
    EXPECT_NEAR(lobes::meanResultant(node.sharpness), length(moment) / energy, 2e-3f);
  }
}

TEST_P(BoundTrees, OfReceiversTheStrongestAndTheWeakestCount) {
  const BoundTree tree = make(BoundTree::Side::receivers);
  for (const BoundNode& node : tree.nodes()) {
    float most = 0, least = 3e38f, mean = 0;
    Vec3f place{};
    forItems(tree, node, [&](const BoundItem& item) {
      const float energy = energyOf(item);
      most = std::max(most, energy), least = std::min(least, energy), mean += energy;
      place += item.p;
    });
    const float count = static_cast<float>(node.count);
    EXPECT_EQ(node.energy, most);
    EXPECT_EQ(node.leastEnergy, least);
    EXPECT_NEAR(node.amount, mean / count, 1e-4f * most);
    EXPECT_LT(length(node.centre - place / count), 1e-4f);
  }
}

TEST_P(BoundTrees, ChildrenShareWhatTheirParentHas) {
  const BoundTree tree = make(BoundTree::Side::lights);
  EXPECT_EQ(tree.nodes()[0].count, items_.size());
  size_t leaves = 0;
  for (uint32_t i = 0; i < tree.nodes().size(); ++i) {
    const BoundNode& node = tree.nodes()[i];
    if (node.leaf()) {
      ++leaves;
      continue;
    }
    const BoundNode &left = tree.nodes()[tree.left(i)], &right = tree.nodes()[tree.right(i)];
    EXPECT_EQ(left.first, node.first);
    EXPECT_EQ(right.first, node.first + left.count);
    EXPECT_EQ(left.count + right.count, node.count);
    if (node.count > GetParam()) {
      EXPECT_EQ(left.count % GetParam(), 0u);
    }
  }
  EXPECT_EQ(leaves, items_.size());
}

// More items than a thread takes at once.
TEST_P(BoundTrees, DoNotDependOnThreads) {
  const std::vector<BoundItem> items = randomItems(20000);
  const auto make = [&] {
    const auto item = [&](uint32_t i) { return items[i]; };
    return BoundTree(20000, item, BoundTree::Side::lights, 5.f, GetParam());
  };
  const BoundTree many = make();
  const ThreadLimit limit(1);
  const BoundTree one = make();
  ASSERT_EQ(one.nodes().size(), many.nodes().size());
  EXPECT_EQ(0, std::memcmp(one.nodes().data(), many.nodes().data(), one.nodes().size_bytes()));
}

INSTANTIATE_TEST_SUITE_P(Strips, BoundTrees, testing::Values(1u, 16u));

TEST(Cones, MergedHoldBoth) {
  Rng rng(7);
  for (int i = 0; i < 20000; ++i) {
    const Cone a{sampleSphereUniform(rng.next2D()), sqr(rng.next1D()) * kPi};
    const Cone b{i % 3 ? sampleSphereUniform(rng.next2D())
                       : normalize(a.axis + sampleSphereUniform(rng.next2D()) * 0.01f),
                 sqr(rng.next1D()) * kPi};
    const Cone both = merged(a, b);
    for (const Cone& c : {a, b})
      EXPECT_LE(std::min(kPi, angleBetween(c.axis, both.axis) + c.angle), both.angle + 2e-6f);
    const float apart = angleBetween(a.axis, b.axis);
    const float least = std::max({a.angle, b.angle, 0.5f * (a.angle + b.angle + apart)});
    EXPECT_LE(both.angle, std::min(kPi, least) + 2e-6f) << "no wider than need be";
  }
}

}  // namespace
}  // namespace lobelia::trees
