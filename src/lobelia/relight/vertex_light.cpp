#include "lobelia/relight/vertex_light.h"

#include <algorithm>
#include <bit>

namespace lobelia::relight {
namespace {

constexpr float kValueScale = 1 / 255.f;

float visibilityOf(CutNode node) { return static_cast<float>(node.value) * kValueScale; }

void store(const LightRows& rows, size_t i, Rgb value) {
  rows.values[i] = value.x;
  rows.values[rows.stride + i] = value.y;
  rows.values[2 * rows.stride + i] = value.z;
}

// [begin, end) of the cut's nodes, which are seen alike.
void scaleRange(const LightCut& cut, size_t begin, size_t end, float visibility,
                const LightRows& rows) {
  const float* const from[3] = {cut.r.data(), cut.g.data(), cut.b.data()};
  for (size_t c = 0; c < 3; ++c) {
    float* const to = rows.channel(c);
    for (size_t i = begin; i < end; ++i) to[i] = from[c][i] * visibility;
  }
}

}  // namespace

void CutIndex::set(std::span<const CutNode> cut, int levels) {
  shift_ = std::max(levels - kEntryBits, 0);
  uint32_t begin = 0;
  size_t entry = 0;
  for (size_t i = 0; i < cut.size(); ++i) {
    const uint32_t end = begin + (1u << cut[i].level);
    for (; entry < node_.size() && (entry << shift_) < end; ++entry)
      node_[entry] = static_cast<uint16_t>(i);
    begin = end;
  }
}

CutIndex::Place CutIndex::find(std::span<const CutNode> cut, uint32_t leaf) const {
  const size_t entry = leaf >> shift_;
  Place at{node_[entry], 0};
  // Nodes begin at multiples of their size.
  const uint32_t known = static_cast<uint32_t>(entry << shift_);
  at.firstLeaf = known >> cut[at.node].level << cut[at.node].level;
  while (at.firstLeaf + (1u << cut[at.node].level) <= leaf)
    at.firstLeaf += 1u << cut[at.node++].level;
  return at;
}

size_t mergeVertexLight(const LightSums& sums, const LightCut& cut,
                        std::span<const CutNode> visibility, const LightRows& rows) {
  size_t k = 0;  // of the light cut
  size_t merged = 0;
  uint32_t leaf = 0;
  Rgb inside{};  // of the light cut's node that the visibility cut divides
  for (const CutNode node : visibility) {
    const uint32_t end = leaf + (1u << node.level);
    const float seen = visibilityOf(node);
    if (node.level >= cut.nodes[k].level) {  // holds this one, and perhaps more
      const size_t stop = cut.atLeaf[end];
      scaleRange(cut, k, stop, seen, rows);
      merged += stop - k;
      k = stop;
    } else {
      const size_t heap = (size_t{1} << (sums.levels - node.level)) + (leaf >> node.level);
      if (node.value != 0) inside += sums.power(heap) * seen;
      ++merged;
      if (end == cut.begin[k + 1]) {
        store(rows, k++, inside);
        inside = {};
      }
    }
    leaf = end;
    if (k == cut.count) break;
  }
  return merged;
}

void mergeVertexChunk(const LightSums& sums, size_t firstNode, std::span<const CutNode> visibility,
                      const CutIndex& index, const LightRows& rows) {
  const int depth = static_cast<int>(std::bit_width(firstNode)) - 1, level = sums.levels - depth;
  const uint32_t first = static_cast<uint32_t>((firstNode - (size_t{1} << depth)) << level);
  CutIndex::Place at = index.find(visibility, first);
  for (size_t i = 0; i < kChunk;) {
    const CutNode node = visibility[at.node];
    const uint32_t begin = first + static_cast<uint32_t>(i << level), end = begin + (1u << level);
    const uint32_t nodeEnd = at.firstLeaf + (1u << node.level);
    if (node.level >= level) {
      const size_t stop = std::min<size_t>(kChunk, (nodeEnd - first) >> level);
      const float seen = visibilityOf(node);
      for (; i < stop; ++i) store(rows, i, sums.power(firstNode + i) * seen);
    } else {
      Rgb inside{};
      for (; at.firstLeaf < end; at.firstLeaf += 1u << visibility[at.node++].level) {
        const CutNode finer = visibility[at.node];
        const size_t heap =
            (size_t{1} << (sums.levels - finer.level)) + (at.firstLeaf >> finer.level);
        if (finer.value != 0) inside += sums.power(heap) * visibilityOf(finer);
      }
      store(rows, i++, inside);
      continue;
    }
    at.firstLeaf = nodeEnd, ++at.node;
  }
}

}  // namespace lobelia::relight
