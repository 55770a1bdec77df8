// Light that a vertex sees of every node of the light cut: its visibility cut merged with the light
// cut once, for all pixels around it [P004 section 3.2].
//
// Interpolation is linear and so is the sum over merged nodes: of a pixel between three vertices
//   sum_C |C| <L>_C (w1 V1 + w2 V2 + w3 V3)_C f(C)
// is the interpolation of sums that each vertex has by itself, if f is taken at the light cut's
// nodes. So each vertex merges two cuts where the paper merges four for each pixel, and a lobe is
// evaluated once for each node of the light cut. Within a node light and visibility are multiplied
// at the merged nodes.
#pragma once

#include <span>

#include "lobelia/relight/light_cut.h"

namespace lobelia::relight {

// Rows of floats: red, green and blue, `stride` apart.
template <class Float>
struct RowsOf {
  Float* values = nullptr;
  size_t stride = 0;
  Float* channel(size_t c) const { return values + c * stride; }
  operator RowsOf<const Float>() const { return {values, stride}; }
};
using LightRows = RowsOf<float>;
using ConstLightRows = RowsOf<const float>;

// Visible light of every node of the light cut; visibility: a cut of the same tree. rows: of
// cut.padded() floats at least, whose entries from cut.count on are not written. starts: of
// cut.count + 1 entries, for each node of the light cut the index of the visibility cut's node in
// which it begins (the last entry has no meaning). Returns the number of merged nodes.
size_t mergeVertexLight(const LightSums& sums, const LightCut& cut,
                        std::span<const CutNode> visibility, const LightRows& rows,
                        std::span<uint16_t> starts);

// Where to begin in a visibility cut: a node, and its first leaf.
struct CutPlace {
  size_t node = 0;
  uint32_t firstLeaf = 0;
};
// The node that holds `leaf`, from a node on that holds an earlier leaf (or this one).
CutPlace findLeaf(std::span<const CutNode> cut, size_t node, uint32_t earlier, uint32_t leaf);

// The same of `count` neighbouring nodes of one level, from heap index firstNode on; from: the
// visibility cut's node that holds the first leaf of them.
void mergeVertexNodes(const LightSums& sums, size_t firstNode, size_t count,
                      std::span<const CutNode> visibility, CutPlace from, const LightRows& rows);

}  // namespace lobelia::relight
