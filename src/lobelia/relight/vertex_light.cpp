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

}  // namespace

CutPlace findLeaf(std::span<const CutNode> cut, size_t node, uint32_t earlier, uint32_t leaf) {
  // Nodes begin at multiples of their size.
  CutPlace at{node, earlier >> cut[node].level << cut[node].level};
  while (at.firstLeaf + (1u << cut[at.node].level) <= leaf)
    at.firstLeaf += 1u << cut[at.node++].level;
  return at;
}

// Which of the cuts is finer changes from node to node, unpredictably: whatever a branch would
// choose between is computed or added up in place instead.
size_t mergeVertexLight(const LightSums& sums, const LightCut& cut,
                        std::span<const CutNode> visibility, const LightRows& rows,
                        std::span<uint16_t> starts) {
  float* const out[3] = {rows.channel(0), rows.channel(1), rows.channel(2)};
  for (float* channel : out) std::fill_n(channel, cut.count, 0.f);
  const auto add = [&](size_t k, Rgb power, float seen) {
    out[0][k] += power.x * seen, out[1][k] += power.y * seen, out[2][k] += power.z * seen;
  };
  size_t k = 0;  // of the light cut
  size_t merged = 0;
  uint32_t leaf = 0;
  starts[0] = 0;
  for (size_t i = 0; k < cut.count; ++i) {
    const CutNode node = visibility[i];
    const uint32_t end = leaf + (1u << node.level);
    const float seen = visibilityOf(node);
    const bool inside = node.level < cut.nodes[k].level;
    const size_t own = (size_t{1} << (sums.levels - node.level)) + (leaf >> node.level);
    add(k, sums.power(inside ? own : cut.heap[k]), seen);
    ++merged;
    const bool ends = end >= cut.begin[k + 1];
    k += ends ? 1 : 0;
    for (const uint32_t stop = ends ? end : 0; cut.begin[k] < stop; ++k, ++merged) {
      add(k, sums.power(cut.heap[k]), seen);
      starts[k] = static_cast<uint16_t>(i);
    }
    starts[k] = ends ? static_cast<uint16_t>(i + 1) : starts[k];
    leaf = end;
  }
  return merged;
}

void mergeVertexNodes(const LightSums& sums, size_t firstNode, size_t count,
                      std::span<const CutNode> visibility, CutPlace from, const LightRows& rows) {
  const int depth = static_cast<int>(std::bit_width(firstNode)) - 1, level = sums.levels - depth;
  const uint32_t first = static_cast<uint32_t>((firstNode - (size_t{1} << depth)) << level);
  for (size_t i = 0; i < count;) {
    const CutNode node = visibility[from.node];
    const uint32_t begin = first + static_cast<uint32_t>(i << level), end = begin + (1u << level);
    const uint32_t nodeEnd = from.firstLeaf + (1u << node.level);
    if (node.level >= level) {
      const size_t stop = std::min<size_t>(count, (nodeEnd - first) >> level);
      const float seen = visibilityOf(node);
      for (; i < stop; ++i) store(rows, i, sums.power(firstNode + i) * seen);
    } else {
      Rgb inside{};
      for (; from.firstLeaf < end; from.firstLeaf += 1u << visibility[from.node++].level) {
        const CutNode finer = visibility[from.node];
        const size_t heap =
            (size_t{1} << (sums.levels - finer.level)) + (from.firstLeaf >> finer.level);
        inside += sums.power(heap) * visibilityOf(finer);
      }
      store(rows, i++, inside);
      continue;
    }
    from.firstLeaf = nodeEnd, ++from.node;
  }
}

}  // namespace lobelia::relight
