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
  // Forgets refinements where they have become too many. Not between chunkOf() and chunkRows().
  void forgetChunksIfMany();

  // Number of a vertex in this tile; its light is there after mergeNew().
  uint32_t slotOf(uint32_t vertex);
  void mergeNew();

  LightRows rows(uint32_t slot) {
    return {rows_.data() + slot * 3 * light_->cut.padded(), light_->cut.padded()};
  }
  // Light of kChunk nodes of the tree, from heap index firstNode on: a number for chunkRows(),
  // which later calls may move.
  uint32_t chunkOf(uint32_t slot, uint32_t firstNode);
  LightRows chunkRows(uint32_t chunk) {
    return {chunks_.data() + size_t{chunk} * 3 * kChunk, kChunk};
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
  NumberTable slots_, chunkNumbers_;
  std::vector<uint32_t> vertices_;  // by slot
  std::vector<CutIndex> indices_;   // by slot
  size_t merged_ = 0;               // slots
  uint64_t forgotten_ = 0;          // vertices that were merged
  size_t mostVertices_ = 0, mostChunks_ = 0;
  uint64_t mergedNodes_ = 0;
  uint32_t chunkCount_ = 0;
  AlignedFloats rows_, chunks_;
};

}  // namespace lobelia::relight
