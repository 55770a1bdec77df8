// Where a light cut is too coarse for a lobe: finer nodes of the light tree, pixel by pixel.
//
// The paper evaluates a BRDF at the centre of each node and relies on the light cut to be fine
// where it matters [P004 section 4.2]; a highlight narrower than a node is missed or comes out as
// blocks, which it leaves open. Here each lobe gets the level of the tree at which it is smooth
// (lobe_reach.h). Within the lobe's reach, nodes of that level stand in for those of the cut: whole
// chunks of them, so that registers are full. Elsewhere the cut remains.
//
// A unit is what is replaced as a whole: a node of the cut, or where these are smaller than a chunk
// of fine nodes, the node of the tree over such a chunk with all of the cut's nodes in it.
#pragma once

#include "lobelia/relight/light_cut.h"

namespace lobelia::relight {

// Units of one level whose light is coarser than it; others have no need.
struct FineUnits {
  int level = 0;  // of the fine nodes
  size_t count = 0;
  // A cone about a unit direction that holds a unit's samples: cosine and sine of the half angle.
  // The light that samples stand for reaches half their distance farther; it is where they are.
  // Filled up to whole chunks.
  AlignedFloats x, y, z, cosine, sine;
  std::vector<uint32_t> firstNode, chunkCount;  // the fine nodes: heap index, number of chunks
  std::vector<uint32_t> cutBegin, cutEnd;       // the nodes of the cut
  std::vector<uint8_t> unitLevel;               // of a node that holds the unit
};

// level: from 0 to levels - log2(kChunk). tree, sums, cut: of one tree over directions.
FineUnits makeFineUnits(const SampleTree& tree, const LightSums& sums, const LightCut& cut,
                        int level);

}  // namespace lobelia::relight
