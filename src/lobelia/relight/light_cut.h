// The light cut of a frame: the nodes of the light tree by which light is summed
// [P004 section 3.2, "Algorithm for selecting a cut"].
//
// The node with the largest error is refined first, until all errors are below a threshold or half
// of the nodes are spent; the rest refines the node with the most light. Errors are sums of squared
// differences of the leaves' power (luminance) from their mean, the threshold is relative to all
// light: the paper gives neither it nor a limit of the first phase, which a noisy map would not
// leave anything.
#pragma once

#include <cstdint>

#include "lobelia/relight/light_values.h"
#include "lobelia/relight/visibility_cut.h"

namespace lobelia::relight {

inline constexpr size_t kChunk = 16;  // nodes that are shaded together; as many as lanes, or more

struct LightCut {
  size_t count = 0;              // of nodes
  std::vector<CutNode> nodes;    // levels in the order of leaves; values have no meaning
  std::vector<uint32_t> heap;    // index of each node
  std::vector<uint32_t> begin;   // first leaf of each node, and the number of leaves at last
  std::vector<uint32_t> atLeaf;  // [leaves + 1] the node that begins at or before a leaf
  // Powers and directions of the nodes, filled up to whole chunks with dark ones.
  AlignedFloats r, g, b, x, y, z;
  size_t padded() const { return r.size(); }
};

struct LightCutSettings {
  size_t nodeCount = 512;     // at most; at least 1
  double errorShare = 0.002;  // root of a node's error over all light that is refined first
};
// The cut of these nodes (heap indices that cover all leaves once; they are put in order). Keeps
// the memory of *out.
void makeLightCut(const LightSums& sums, std::vector<size_t>* nodes, LightCut* out);
LightCut selectLightCut(const LightSums& sums, const LightCutSettings& settings);

}  // namespace lobelia::relight
