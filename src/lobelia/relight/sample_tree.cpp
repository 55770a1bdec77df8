#include "lobelia/relight/sample_tree.h"

#include <bit>

#include "lobelia/base/parallel.h"

namespace lobelia::relight {
namespace {

template <class T>
std::vector<T> means(std::span<const T> leaves) {
  const size_t count = leaves.size();
  std::vector<T> nodes(2 * count);
  std::copy(leaves.begin(), leaves.end(), nodes.begin() + static_cast<std::ptrdiff_t>(count));
  for (size_t i = count - 1; i > 0; --i) nodes[i] = (nodes[2 * i] + nodes[2 * i + 1]) * 0.5f;
  return nodes;
}

// Of the leaves of node i about its mean.
float coneCosine(const SampleTree& tree, size_t begin, size_t end, size_t i) {
  const Vec3f mean = tree.meanP[i];
  const float size = length(mean);
  if (!(size > 1e-4f)) return -1;
  const Vec3f* const leaves = tree.meanP.data() + tree.leafCount();
  float least = 1;
  for (size_t l = begin; l < end; ++l) least = std::min(least, dot(mean, leaves[l]) / size);
  return std::max(-1.f, least - 1e-6f);  // of rounding
}

float sphereRadius(const SampleTree& tree, size_t begin, size_t end, size_t i) {
  const Vec3f* const leaves = tree.meanP.data() + tree.leafCount();
  float most = 0;
  for (size_t l = begin; l < end; ++l)
    most = std::max(most, lengthSquared(leaves[l] - tree.meanP[i]));
  return std::sqrt(most) * (1 + 1e-6f);
}

}  // namespace

std::vector<float> nodeMeans(std::span<const float> leaves) { return means(leaves); }
std::vector<Rgb> nodeMeans(std::span<const Rgb> leaves) { return means(leaves); }

SampleTree makeSampleTree(const LightSamples& samples) {
  SampleTree tree;
  tree.levels = std::countr_zero(samples.count());
  tree.meanP = nodeMeans(samples.p);
  const bool directions = samples.kind == LightSamples::Kind::environment;
  if (!directions) tree.meanN = nodeMeans(samples.n);
  tree.spread.resize(tree.meanP.size());
  parallelFor(tree.meanP.size(), 256, [&](size_t i) {
    if (i == 0) return;
    const int depth = static_cast<int>(std::bit_width(i)) - 1;
    const int level = tree.levels - depth;
    const size_t begin = (i - (size_t{1} << depth)) << level, end = begin + (size_t{1} << level);
    tree.spread[i] =
        directions ? coneCosine(tree, begin, end, i) : sphereRadius(tree, begin, end, i);
  });
  return tree;
}

// Before a node come the subtrees to its left and its own but for itself. Left of leaf l there are
// l leaves and, of inner nodes that end left of it, l - popcount(l): each full subtree of 2^k
// leaves has 2^(k+1) - 1 nodes, and l leaves are one full subtree for every bit of l.
uint32_t leftLeaf(int level, uint32_t place) {
  const uint32_t leaf = place << level;
  return 2 * leaf - static_cast<uint32_t>(std::popcount(leaf));
}

uint32_t postOrder(int level, uint32_t place) { return leftLeaf(level, place) + (2u << level) - 2; }

NodePlace nodeOfPostOrder(int levels, uint32_t index) {
  NodePlace at{levels, 0};
  uint32_t first = 0;  // index of the leftmost leaf of the node that is looked at
  for (;;) {
    const uint32_t half = (1u << at.level) - 1;  // nodes of a child's subtree
    if (index == first + 2 * half) return at;
    const bool right = index >= first + half;
    if (right) first += half;
    at = {at.level - 1, 2 * at.place + (right ? 1 : 0)};
  }
}

}  // namespace lobelia::relight
