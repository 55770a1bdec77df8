#include "lobelia/relight/vertex_cache.h"

#include <algorithm>

#include "lobelia/relight/pixel_kernels.h"

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
  mostFine_ = mostBytes / (3 * kChunk * sizeof(float));
}

void VertexCache::forget() {
  slots_.clear();
  fineNumbers_.clear();
  vertices_.clear();
  forgotten_ += merged_;
  merged_ = 0, fineCount_ = 0;
}

void VertexCache::forgetFineIfMany() {
  if (fineCount_ <= mostFine_) return;
  fineNumbers_.clear();
  fineCount_ = 0;
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
  const LightCut& light = light_->cut;
  const size_t each = 3 * light.padded(), chunks = light.padded() / kChunk;
  growTo(vertices_.size() * each, mostVertices_ * each, &rows_);
  starts_.resize(std::max(starts_.size(), vertices_.size() * (light.count + 1)));
  lit_.resize(std::max(lit_.size(), vertices_.size() * chunks));
  for (; merged_ < vertices_.size(); ++merged_) {
    const auto slot = static_cast<uint32_t>(merged_);
    const LightRows rows = this->rows(slot);
    // What an earlier tile with another cut has left there.
    for (size_t c = 0; c < 3; ++c)
      std::fill(rows.channel(c) + light.count, rows.channel(c) + rows.stride, 0.f);
    const std::span<uint16_t> starts{starts_.data() + merged_ * (light.count + 1), light.count + 1};
    mergedNodes_ +=
        mergeVertexLight(light_->sums, light, cuts_->cut(vertices_[slot]), rows, starts);
    findLit(rows, chunks, lit_.data() + merged_ * chunks);
  }
}

bool VertexCache::isLit(uint32_t slot, uint32_t begin, uint32_t end) const {
  const uint16_t* const bits = lit(slot);
  for (uint32_t i = begin / kChunk; i * kChunk < end; ++i)
    if ((bits[i] & chunkMask(i, begin, end)) != 0) return true;
  return false;
}

VertexCache::Fine VertexCache::fineOf(uint32_t slot, const FineUnits& units, uint32_t unit) {
  const std::span<const CutNode> cut = cuts_->cut(vertices_[slot]);
  const uint32_t node = units.cutBegin[unit], leaf = light_->cut.begin[node];
  const CutPlace at = findLeaf(cut, starts(slot)[node], leaf, leaf);
  if (cut[at.node].level >= units.unitLevel[unit])
    return {NumberTable::kNone, static_cast<float>(cut[at.node].value) / 255.f};
  uint32_t& number = fineNumbers_[(uint64_t{slot} << 32) | units.firstNode[unit]];
  if (number != NumberTable::kNone) return {number};
  number = fineCount_;
  fineCount_ += units.chunkCount[unit];
  growTo(size_t{fineCount_} * 3 * kChunk, mostFine_ * 3 * kChunk, &fine_);
  const size_t count = units.chunkCount[unit] * kChunk;
  mergeVertexNodes(light_->sums, units.firstNode[unit], count, cut, at,
                   {fine_.data() + size_t{number} * 3 * kChunk, count});
  return {number};
}

float VertexCache::visibility(uint32_t slot, uint32_t leaf) const {
  const std::span<const CutNode> cut = cuts_->cut(vertices_[slot]);
  const uint32_t node = light_->cut.atLeaf[leaf];
  const CutPlace at = findLeaf(cut, starts(slot)[node], light_->cut.begin[node], leaf);
  return static_cast<float>(cut[at.node].value) / 255.f;
}

}  // namespace lobelia::relight
