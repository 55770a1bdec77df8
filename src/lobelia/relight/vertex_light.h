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

#include <array>
#include <span>

#include "lobelia/relight/light_cut.h"

namespace lobelia::relight {

// Rows of floats: red, green and blue, `stride` apart.
struct LightRows {
  float* values = nullptr;
  size_t stride = 0;
  float* channel(size_t c) const { return values + c * stride; }
};

// Where a cut's nodes begin, so that any leaf's is found in a few steps.
class CutIndex {
 public:
  static constexpr int kEntryBits = 7;
  void set(std::span<const CutNode> cut, int levels);
  // The node that holds a leaf.
  struct Place {
    size_t node = 0;
    uint32_t firstLeaf = 0;
  };
  Place find(std::span<const CutNode> cut, uint32_t leaf) const;

 private:
  int shift_ = 0;
  std::array<uint16_t, size_t{1} << kEntryBits> node_{};  // that holds the first leaf of each part
};

// Visible light of every node of the light cut; visibility: a cut of the same tree. rows: of
// cut.padded() floats at least, whose entries from cut.count on are not written. Returns the number
// of merged nodes.
size_t mergeVertexLight(const LightSums& sums, const LightCut& cut,
                        std::span<const CutNode> visibility, const LightRows& rows);

// The same of kChunk neighbouring nodes of one level, from heap index firstNode (a multiple of
// kChunk) on.
void mergeVertexChunk(const LightSums& sums, size_t firstNode, std::span<const CutNode> visibility,
                      const CutIndex& index, const LightRows& rows);

}  // namespace lobelia::relight
