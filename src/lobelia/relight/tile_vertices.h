// The vertices around the pixels of a tile with the light that they see of the tile's own cut. For
// one thread.
#pragma once

#include "lobelia/relight/number_table.h"
#include "lobelia/relight/tile_cut.h"
#include "lobelia/relight/vertex_light.h"

namespace lobelia::relight {

class TileVertices {
 public:
  // Forgets all vertices. Keeps references. mostBytes: for the vertices' light.
  void begin(const LightSums& sums, const LightCut& cut, const CutSet& cuts, size_t mostBytes);
  void forget();
  // Is there no room for the vertices of one more pixel?
  bool full() const { return vertices_.size() + 3 > mostVertices_; }
  // Number of a vertex; its light is there after mergeNew().
  uint32_t slotOf(uint32_t vertex);
  void mergeNew();
  LightRows rows(uint32_t slot) {
    return {rows_.data() + slot * 3 * cut_->padded(), cut_->padded()};
  }
  uint64_t mergedVertices = 0, mergedNodes = 0;  // since they were made

 private:
  const LightSums* sums_ = nullptr;
  const LightCut* cut_ = nullptr;
  const CutSet* cuts_ = nullptr;
  NumberTable slots_;
  std::vector<uint32_t> vertices_;  // by slot
  size_t merged_ = 0, mostVertices_ = 0;
  std::vector<uint16_t> starts_;  // of the vertex being merged
  AlignedFloats rows_;
};

}  // namespace lobelia::relight
