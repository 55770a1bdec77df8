// Every light and receiver is in exactly one of the pairs that a traversal gives out.
#include "lobelia/gather/pair_traversal.h"

#include <gtest/gtest.h>

#include "gather/random_input.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;
using trees::BoundItem;
using trees::BoundTree;

BoundTree randomTree(uint32_t count, BoundTree::Side side, Vec3f centre, uint64_t seed) {
  Rng rng(seed);
  std::vector<BoundItem> items(count);
  for (BoundItem& item : items) {
    item.p = centre + randomPoint(&rng, 1);
    item.n = randomDirection(&rng);
    item.cosine = rng.next1D();
  }
  return BoundTree(
      count, [&](uint32_t i) { return items[i]; }, side, 2, 1);
}

class Traversal : public testing::TestWithParam<TraversalSettings::ChildRule> {
 protected:
  static constexpr uint32_t kReceivers = 77, kLights = 130;
  Traversal() {
    lights_.lightClass = LightClass::diffuse;
    lights_.tree = randomTree(kLights, BoundTree::Side::lights, {0.5f, 0, 0}, 2);
    settings_.children = GetParam();
  }
  // How often each pair is covered, and how many pairs of nodes did it.
  std::vector<int> cover(float threshold, size_t* nodes) const {
    std::vector<int> covered(kReceivers * kLights, 0);
    PairTraversal traversal(receivers_, false, lights_, settings_);
    *nodes = 0;
    traversal.run(0, std::vector<float>(receivers_.nodes().size(), threshold),
                  [&](std::vector<TreePair>* pairs) {
                    *nodes += pairs->size();
                    for (const TreePair& pair : *pairs) mark(pair, &covered);
                    return true;
                  });
    return covered;
  }
  void mark(const TreePair& pair, std::vector<int>* covered) const {
    const trees::BoundNode& p = receivers_.nodes()[pair.receivers];
    const trees::BoundNode& q = lights_.tree.nodes()[pair.lights];
    for (uint32_t i = p.first; i < p.first + p.count; ++i)
      for (uint32_t j = q.first; j < q.first + q.count; ++j) ++(*covered)[i * kLights + j];
  }
  const BoundTree receivers_ = randomTree(kReceivers, BoundTree::Side::receivers, {}, 1);
  LightForest::Tree lights_;
  TraversalSettings settings_;
};

TEST_P(Traversal, CoversEveryPairOnce) {
  const std::vector<int> once(kReceivers * kLights, 1);
  size_t fewer = 0, nodes = kReceivers * kLights + 1;
  for (const float threshold : {0.f, 0.01f, 1.f, 100.f}) {
    EXPECT_EQ(cover(threshold, &fewer), once) << threshold;
    EXPECT_LT(fewer, nodes) << threshold;
    nodes = fewer;
  }
}

TEST_P(Traversal, LightsApartAreNeverMerged) {
  lights_.apart = true;
  size_t nodes = 0;
  cover(100.f, &nodes);
  EXPECT_EQ(nodes, kReceivers * kLights);
}

TEST_P(Traversal, ErrorsStayBelowTheThreshold) {
  settings_.error = TraversalSettings::Error::conservative;
  PairTraversal traversal(receivers_, false, lights_, settings_);
  const float threshold = 0.5f;
  size_t merged = 0;
  traversal.run(0, std::vector<float>(receivers_.nodes().size(), threshold),
                [&](std::vector<TreePair>* pairs) {
                  for (const TreePair& pair : *pairs) {
                    const NodePair nodes{&receivers_.nodes()[pair.receivers],
                                         &lights_.tree.nodes()[pair.lights]};
                    if (nodes.receivers->leaf() && nodes.lights->leaf()) continue;
                    ++merged;
                    EXPECT_LT(boundPair(nodes, LightClass::diffuse, false, BoundForm::tight).upper,
                              1.001f * threshold);
                  }
                  return true;
                });
  EXPECT_GT(merged, 100u);
}

// Pairs whose places meet have no bound but the clamp's.
TEST_P(Traversal, ClampsLimitErrors) {
  settings_.error = TraversalSettings::Error::conservative;
  const std::vector<ClampedLight> receivers(receivers_.nodes().size(), {0.5f, 0.4f, 0.1f});
  const float clamp = 2;
  const auto nodes = [&](float threshold, const ErrorClamp& errorClamp) {
    PairTraversal traversal(receivers_, false, lights_, settings_, errorClamp);
    size_t count = 0;
    traversal.run(0, std::vector<float>(receivers_.nodes().size(), threshold),
                  [&](std::vector<TreePair>* pairs) {
                    count += pairs->size();
                    return true;
                  });
    return count;
  };
  const float most = clamp * 0.5f * lights_.tree.nodes()[0].cosine;
  EXPECT_EQ(nodes(1.001f * most, {clamp, receivers}), 16u) << "nodes of the fourth level";
  EXPECT_GT(nodes(1.001f * most, {}), 100u);
  EXPECT_GT(nodes(0.01f * most, {clamp, receivers}), 16u);
  lights_.lightClass = LightClass::spherical;
  EXPECT_GT(nodes(1.001f * most, {clamp, receivers}), 100u) << "powers are not intensities";
}

TEST_P(Traversal, StopsWhenToldTo) {
  lights_.tree = randomTree(1000, BoundTree::Side::lights, {0.5f, 0, 0}, 3);
  PairTraversal traversal(receivers_, false, lights_, settings_);
  int calls = 0;
  traversal.run(0, std::vector<float>(receivers_.nodes().size(), 0.f), [&](auto*) {
    ++calls;
    return false;
  });
  EXPECT_EQ(calls, 1);
}

INSTANTIATE_TEST_SUITE_P(Rules, Traversal,
                         testing::Values(TraversalSettings::ChildRule::extent,
                                         TraversalSettings::ChildRule::paper));

}  // namespace
}  // namespace lobelia
