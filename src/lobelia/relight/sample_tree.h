// The light tree: a complete binary tree over light samples in the order of its leaves.
//
// Node (level, place): level 0 are the leaves, and a node covers the leaves
// [place << level, (place + 1) << level). Nodes are numbered by heap index, (1 << (levels - level))
// + place: the root is 1, the children of i are 2 i and 2 i + 1. The paper numbers nodes in
// post-order and keeps the post-order index of each node's leftmost leaf [P004 section 3.2]; in a
// complete tree both follow from level and place (postOrder(), leftLeaf()).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/relight/light_samples.h"

namespace lobelia::relight {

struct SampleTree {
  int levels = 0;  // 2^levels leaves
  // By heap index, 2 << levels entries, the first of no meaning. Means of the leaves' p and n;
  // those of directions are NOT normalised; meanN is empty for an environment.
  std::vector<Vec3f> meanP, meanN;
  // How far leaves lie from meanP. environment: cosine of the half angle of a cone about meanP that
  // holds all directions (-1: all of them, where the mean has no direction); surfaces: radius of a
  // sphere about meanP that holds all places.
  std::vector<float> spread;

  size_t leafCount() const { return size_t{1} << levels; }
  size_t heapIndex(int level, size_t place) const {
    return (size_t{1} << (levels - level)) + place;
  }
};

// The nodes of samples that are in the order of the leaves.
SampleTree makeSampleTree(const LightSamples& samples);

// Means over the leaves below each node, by heap index [2 * leaves.size()], of values at the leaves
// (a power of two of them). Entry 0 has no meaning.
std::vector<float> nodeMeans(std::span<const float> leaves);
std::vector<Rgb> nodeMeans(std::span<const Rgb> leaves);

// The paper's numbers of node (level, place) in a complete tree.
uint32_t postOrder(int level, uint32_t place);
uint32_t leftLeaf(int level, uint32_t place);  // post-order index of the leftmost leaf below
// Level and place of the node of a post-order index, in a tree of `levels`.
struct NodePlace {
  int level = 0;
  uint32_t place = 0;
  friend bool operator==(NodePlace, NodePlace) = default;
};
NodePlace nodeOfPostOrder(int levels, uint32_t index);

}  // namespace lobelia::relight
