#include "lobelia/relight/tile_vertices.h"

#include <algorithm>

namespace lobelia::relight {

void TileVertices::begin(const LightSums& sums, const LightCut& cut, const CutSet& cuts,
                         size_t mostBytes) {
  sums_ = &sums, cut_ = &cut, cuts_ = &cuts;
  // One pixel's three at least.
  mostVertices_ = std::max<size_t>(mostBytes / (3 * cut.padded() * sizeof(float)), 3);
  forget();
}

void TileVertices::forget() {
  slots_.clear();
  vertices_.clear();
  merged_ = 0;
}

uint32_t TileVertices::slotOf(uint32_t vertex) {
  uint32_t& slot = slots_[vertex];
  if (slot == NumberTable::kNone) {
    slot = static_cast<uint32_t>(vertices_.size());
    vertices_.push_back(vertex);
  }
  return slot;
}

void TileVertices::mergeNew() {
  const size_t needed = vertices_.size() * 3 * cut_->padded();
  if (rows_.size() < needed) rows_.resize(needed, 0.f);
  starts_.resize(cut_->count + 1);
  for (; merged_ < vertices_.size(); ++merged_) {
    const LightRows rows = this->rows(static_cast<uint32_t>(merged_));
    for (size_t c = 0; c < 3; ++c)  // what an earlier tile has left there
      std::fill(rows.channel(c) + cut_->count, rows.channel(c) + rows.stride, 0.f);
    mergedNodes += mergeVertexLight(*sums_, *cut_, cuts_->cut(vertices_[merged_]), rows, starts_);
    ++mergedVertices;
  }
}

}  // namespace lobelia::relight
