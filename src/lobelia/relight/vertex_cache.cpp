#include "lobelia/relight/vertex_cache.h"

#include <algorithm>

namespace lobelia::relight {

namespace {

// Twice what is needed, so that growing stays cheap, but no more than `most` unless it is needed.
void growTo(size_t needed, size_t most, AlignedFloats* values) {
  if (values->size() < needed) values->resize(std::max(needed, std::min(2 * needed, most)), 0.f);
}

}  // namespace

void VertexCache::begin(const FrameLight& light, const CutSet& cuts, size_t mostBytes) {
  light_ = &light;
  cuts_ = &cuts;
  forget();
  forgotten_ = 0, mergedNodes_ = 0;
  // One pixel's three at least.
  mostVertices_ = std::max<size_t>(mostBytes / (3 * light.cut.padded() * sizeof(float)), 3);
  mostChunks_ = mostBytes / (3 * kChunk * sizeof(float));
}

void VertexCache::forget() {
  slots_.clear();
  chunkNumbers_.clear();
  vertices_.clear();
  indices_.clear();
  forgotten_ += merged_;
  merged_ = 0, chunkCount_ = 0;
}

void VertexCache::forgetChunksIfMany() {
  if (chunkCount_ <= mostChunks_) return;
  chunkNumbers_.clear();
  chunkCount_ = 0;
}

uint32_t VertexCache::slotOf(uint32_t vertex) {
  uint32_t& slot = slots_[vertex];
  if (slot == NumberTable::kNone) {
    slot = static_cast<uint32_t>(vertices_.size());
    vertices_.push_back(vertex);
  }
  return slot;
}

void VertexCache::mergeNew() {
  const size_t each = 3 * light_->cut.padded();
  growTo(vertices_.size() * each, mostVertices_ * each, &rows_);
  indices_.resize(vertices_.size());
  for (; merged_ < vertices_.size(); ++merged_) {
    const std::span<const CutNode> cut = cuts_->cut(vertices_[merged_]);
    const LightRows rows = this->rows(static_cast<uint32_t>(merged_));
    // What an earlier tile with another cut has left there.
    for (size_t c = 0; c < 3; ++c)
      std::fill(rows.channel(c) + light_->cut.count, rows.channel(c) + rows.stride, 0.f);
    mergedNodes_ += mergeVertexLight(light_->sums, light_->cut, cut, rows);
    indices_[merged_].set(cut, light_->sums.levels);
  }
}

uint32_t VertexCache::chunkOf(uint32_t slot, uint32_t firstNode) {
  uint32_t& number = chunkNumbers_[(uint64_t{slot} << 32) | firstNode];
  if (number != NumberTable::kNone) return number;
  number = chunkCount_++;
  growTo(size_t{chunkCount_} * 3 * kChunk, mostChunks_ * 3 * kChunk, &chunks_);
  mergeVertexChunk(light_->sums, firstNode, cuts_->cut(vertices_[slot]), indices_[slot],
                   chunkRows(number));
  return number;
}

float VertexCache::visibility(uint32_t slot, uint32_t leaf) const {
  const std::span<const CutNode> cut = cuts_->cut(vertices_[slot]);
  return static_cast<float>(cut[indices_[slot].find(cut, leaf).node].value) / 255.f;
}

}  // namespace lobelia::relight
