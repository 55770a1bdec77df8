// The light tree: what its nodes say of their lights.
#include "lobelia/trees/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia {
namespace {

using namespace trees;

std::vector<TreeLight> randomTreeLights(size_t count, uint64_t seed) {
  Rng rng(seed);
  std::vector<TreeLight> lights(count);
  for (TreeLight& light : lights) {
    const Vec2f xy = rng.next2D();
    light.p = {10 * xy.x, 4 * xy.y, rng.next1D()};
    light.variance = 0.01f * rng.next1D();
    if (rng.next1D() < 0.8f) light.n = sampleSphereUniform(rng.next2D());
    if (rng.next1D() < 0.7f) light.diffuse = rng.next1D();
    if (rng.next1D() < 0.6f) {
      light.axis = sampleSphereUniform(rng.next2D());
      light.sharpness = std::pow(1000.f, rng.next1D());
      light.glossy = 3 * rng.next1D();
    }
  }
  return lights;
}

LightTree treeOf(const std::vector<TreeLight>& lights) {
  std::vector<uint32_t> numbers(lights.size());
  for (uint32_t i = 0; i < lights.size(); ++i) numbers[i] = 5 + i;
  return LightTree(lights, numbers, 10);
}

TEST(LightTree, EveryLightIsInOneLeaf) {
  for (const size_t count : {1, 2, 3, 7, 1000, 1025}) {
    const LightTree tree = treeOf(randomTreeLights(count, count));
    ASSERT_EQ(tree.nodes().size(), 2 * count - 1);
    std::vector<int> seen(count, 0);
    size_t leaves = 0;
    std::vector<uint32_t> todo{0};
    while (!todo.empty()) {
      const uint32_t i = todo.back();
      todo.pop_back();
      const LightNode& node = tree.nodes()[i];
      if (node.leaf()) {
        ++leaves;
        ++seen[tree.light(node.link) - 5];
        EXPECT_EQ(node.link, leaves - 1) << "in the order of the leaves";
        continue;
      }
      const LightNode &a = tree.nodes()[tree.left(i)], &b = tree.nodes()[tree.right(i)];
      EXPECT_EQ(a.count + b.count, node.count);
      todo.push_back(tree.right(i));
      todo.push_back(tree.left(i));
    }
    EXPECT_EQ(leaves, count);
    for (const int n : seen) EXPECT_EQ(n, 1);
  }
  EXPECT_TRUE(treeOf({}).empty());
}

TEST(LightTree, NodesHoldTheMomentsOfTheirLights) {
  const std::vector<TreeLight> lights = randomTreeLights(600, 3);
  const LightTree tree = treeOf(lights);
  for (uint32_t index = 0; index < tree.nodes().size(); ++index) {
    const LightNode& node = tree.nodes()[index];
    uint32_t leftmost = index;
    while (!tree.nodes()[leftmost].leaf()) leftmost = tree.left(leftmost);
    const uint32_t begin = tree.nodes()[leftmost].link;
    double power = 0, diffuse = 0, glossy = 0, square = 0;
    Vec3d centre, n, first;
    const auto at = [&](uint32_t i) -> const TreeLight& {
      return lights[tree.light(begin + i) - 5];
    };
    for (uint32_t i = 0; i < node.count; ++i) {
      const double w = double{kPi} * double{at(i).diffuse} + double{at(i).glossy};
      power += w, diffuse += double{at(i).diffuse}, glossy += double{at(i).glossy};
      for (int c = 0; c < 3; ++c) {
        centre[c] += w * double{at(i).p[c]}, n[c] += w * double{at(i).n[c]};
        first[c] += double{at(i).glossy} * double{lobes::meanResultant(at(i).sharpness)} *
                    double{at(i).axis[c]};
      }
    }
    ASSERT_GE(power, 0);
    EXPECT_NEAR(node.diffuse, diffuse, 1e-4 * diffuse);
    EXPECT_NEAR(node.glossy, glossy, 1e-4 * glossy);
    if (glossy > 0) {
      const double kept = double{node.glossy} * double{lobes::meanResultant(node.sharpness)};
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(kept * double{node.axis[c]}, first[c], 1e-3 * glossy) << node.count;
    }
    for (uint32_t i = 0; i < node.count; ++i) {
      EXPECT_LE(length(at(i).p - node.centre), node.radius * 1.0001f + 1e-6f);
      const Vec3f apart = at(i).p - node.centre;
      square += (double{kPi} * double{at(i).diffuse} + double{at(i).glossy}) *
                double{dot(apart, apart) + at(i).variance};
    }
    if (!(power > 0)) continue;
    EXPECT_NEAR(node.variance, square / power, 2e-3 * square / power);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(node.centre[c], centre[c] / power, 1e-4);
      EXPECT_NEAR(node.n[c], n[c] / power, 1e-4);
    }
  }
}

TEST(LightTree, ThreadsDoNotMatter) {
  const std::vector<TreeLight> lights = randomTreeLights(30'000, 7);
  const LightTree many = treeOf(lights);
  const ThreadLimit limit(1);
  const LightTree one = treeOf(lights);
  ASSERT_EQ(one.nodes().size(), many.nodes().size());
  for (size_t i = 0; i < one.nodes().size(); ++i) {
    EXPECT_EQ(one.nodes()[i].centre, many.nodes()[i].centre);
    EXPECT_EQ(one.nodes()[i].sharpness, many.nodes()[i].sharpness);
  }
  for (uint32_t i = 0; i < lights.size(); ++i) ASSERT_EQ(one.light(i), many.light(i));
}

// A few lights elsewhere soon have nodes of their own.
TEST(LightTree, StragglersLeaveTheCrowd) {
  std::vector<TreeLight> lights = randomTreeLights(4000, 9);
  for (size_t i = 0; i < lights.size(); ++i)
    lights[i].p = i % 200 == 0 ? lights[i].p + Vec3f(20.f) : lights[i].p;
  const LightTree tree = treeOf(lights);
  size_t mixed = 0;
  for (const LightNode& node : tree.nodes()) mixed += node.radius > 15;
  EXPECT_LE(mixed, 2u);
}

// Lights at one place, or of no power, are split in halves.
TEST(LightTree, LightsAlikeMakeNoChain) {
  for (const bool dark : {false, true}) {
    std::vector<TreeLight> lights(3000, randomTreeLights(1, 2)[0]);
    for (size_t i = 0; dark && i < lights.size(); ++i)
      lights[i].diffuse = lights[i].glossy = 0,
      lights[i].p.x = std::ldexp(1.f, static_cast<int>(i % 100));
    const LightTree tree = treeOf(lights);
    size_t deepest = 0;
    std::vector<std::pair<uint32_t, size_t>> todo{{0, 1}};
    while (!todo.empty()) {
      const auto [i, depth] = todo.back();
      todo.pop_back();
      deepest = std::max(deepest, depth);
      if (tree.nodes()[i].leaf()) continue;
      todo.emplace_back(tree.left(i), depth + 1);
      todo.emplace_back(tree.right(i), depth + 1);
    }
    EXPECT_LE(deepest, dark ? 64u : 13u);
  }
}

// Places that differ by less than the inverse of a number can say.
TEST(LightTree, LightsNearlyAtOnePlaceAreSplit) {
  std::vector<TreeLight> lights(40, randomTreeLights(1, 2)[0]);
  for (size_t i = 0; i < lights.size(); ++i) {
    lights[i].p = {1e-39f * static_cast<float>(i % 3), 0, 0};
    lights[i].n = lights[i].axis = {0, 0, 1};
  }
  const LightTree tree = treeOf(lights);
  std::vector<int> seen(lights.size(), 0);
  for (const LightNode& node : tree.nodes())
    if (node.leaf()) ++seen[tree.light(node.link) - 5];
  for (const int n : seen) EXPECT_EQ(n, 1);
}

// Neighbours first: a node of few lights is small.
TEST(LightTree, NodesAreCompact) {
  const LightTree tree = treeOf(randomTreeLights(4096, 5));
  double small = 0;
  size_t count = 0;
  for (const LightNode& node : tree.nodes()) {
    if (node.count < 12 || node.count > 20) continue;
    small += double{node.radius};
    ++count;
  }
  ASSERT_GT(count, 100u);
  EXPECT_LT(small / static_cast<double>(count), 0.15 * double{tree.nodes()[0].radius});
}

}  // namespace
}  // namespace lobelia
