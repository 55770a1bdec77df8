// The vertices around the pixels of a tile, each with its visible light: merged once, refined where
// a pixel asks for it. Small enough for a core's own cache. For one thread.
#pragma once

#include "lobelia/relight/frame_light.h"
#include "lobelia/relight/number_table.h"
#include "lobelia/relight/vertex_light.h"

namespace lobelia::relight {

class VertexCache {
 public:
  // Forgets all vertices. Keeps references. mostBytes: for the vertices' light, and as much again
  // for its refinements.
  void begin(const FrameLight& light, const CutSet& cuts, size_t mostBytes = size_t{64} << 20);
  // Forgets the vertices, so that pixels to come ask for them again; numbers begin at 0.
  void forget();
  // Is there no room for the vertices of one more pixel?
  bool full() const { return vertices_.size() + 3 > mostVertices_; }
  // Forgets refinements where they have become too many. Not between fineOf() and fineRows().
  void forgetFineIfMany();

  // Number of a vertex in this tile; its light is there after mergeNew().
  uint32_t slotOf(uint32_t vertex);
  void mergeNew();

  LightRows rows(uint32_t slot) {
    return {rows_.data() + slot * 3 * light_->cut.padded(), light_->cut.padded()};
  }
  // By chunk of the light cut, a bit for each node of which the vertex sees light.
  const uint16_t* lit(uint32_t slot) const {
    return lit_.data() + slot * (light_->cut.padded() / kChunk);
  }
  // Does the vertex see light of any of the cut's nodes [begin, end)?
  bool isLit(uint32_t slot, uint32_t begin, uint32_t end) const;
  // Visible light of a unit's fine nodes. Where the vertex sees all of them alike, as it mostly
  // does, it is all of their light times what it sees; else there is a number for fineRows(), whose
  // rows later calls may move.
  struct Fine {
    uint32_t number = NumberTable::kNone;
    float seen = 1;
  };
  Fine fineOf(uint32_t slot, const FineUnits& units, uint32_t unit);
  ConstLightRows fineRows(Fine fine, const FineUnits& units, uint32_t unit) const {
    const LightSums& sums = light_->sums;
    if (fine.number == NumberTable::kNone)
      return {sums.rows.data() + units.firstNode[unit], size_t{2} << sums.levels};
    return {fine_.data() + size_t{fine.number} * 3 * kChunk, units.chunkCount[unit] * kChunk};
  }
  // Visibility of a leaf, in [0, 1].
  float visibility(uint32_t slot, uint32_t leaf) const;

  size_t vertexCount() const { return vertices_.size(); }
  // Since begin(): vertices that were forgotten and asked for again count again.
  uint64_t mergedVertices() const { return forgotten_ + merged_; }
  uint64_t mergedNodes() const { return mergedNodes_; }

 private:
  const FrameLight* light_ = nullptr;
  const CutSet* cuts_ = nullptr;
  std::span<const uint16_t> starts(uint32_t slot) const {
    const size_t each = light_->cut.count + 1;
    return {starts_.data() + slot * each, each};
  }

  NumberTable slots_, fineNumbers_;
  std::vector<uint32_t> vertices_;          // by slot
  std::vector<uint16_t> starts_;            // by slot, of mergeVertexLight()
  std::vector<uint16_t> lit_;               // by slot
  size_t merged_ = 0;                       // slots
  uint64_t forgotten_ = 0;                  // vertices that were merged
  size_t mostVertices_ = 0, mostFine_ = 0;  // of vertices, of chunks of fine nodes
  uint64_t mergedNodes_ = 0;
  uint32_t fineCount_ = 0;  // chunks
  AlignedFloats rows_, fine_;
};

}  // namespace lobelia::relight
