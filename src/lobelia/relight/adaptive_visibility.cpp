// The adaptive half of VertexTracer: what vertices nearby agree on is probed, the rest traced.
#include <algorithm>
#include <bit>

#include "lobelia/base/random.h"
#include "lobelia/relight/leaf_words.h"
#include "lobelia/relight/vertex_visibility.h"

namespace lobelia::relight {
namespace {

// Nodes that are expected to be alike have from 2^kLeastLevel to 2^kMostLevel leaves.
constexpr int kMostLevel = 10, kLeastLevel = 5;
// Probes of a node of 2^level leaves.
uint32_t probeCount(int level) { return level >= 8 ? 8 : 4; }

enum class Agreement { none, blocked, visible };

// Do all vertices nearby see all leaves of a node that matter here, or none? Those to which less
// than half of these leaves matter are not asked.
Agreement agreement(std::span<const LeafBits* const> nearby, const LeafBits& bits, int level,
                    uint32_t place) {
  bool anyVisible = false, anyBlocked = false;
  for (const LeafBits* other : nearby) {
    uint64_t visible = 0, blocked = 0;
    int here = 0, both = 0;
    forWords(level, place, [&](uint32_t w, uint64_t mask) {
      const uint64_t own = bits.matters[w] & mask, common = own & other->matters[w];
      here += std::popcount(own), both += std::popcount(common);
      visible |= common & other->visible[w], blocked |= common & ~other->visible[w];
    });
    if (2 * both < here) continue;
    anyVisible |= visible != 0, anyBlocked |= blocked != 0;
  }
  if (anyVisible == anyBlocked) return Agreement::none;
  return anyVisible ? Agreement::visible : Agreement::blocked;
}

}  // namespace

// Puts a node among those expected to be alike, or looks at its children.
void VertexTracer::visit(int level, uint32_t place, LeafBits* bits) {
  const Agreement agreed = agreement(nearby_, *bits, level, place);
  if (agreed != Agreement::none) {
    expected_.push_back({level, place, agreed == Agreement::visible});
  } else if (level > kLeastLevel) {
    visit(level - 1, 2 * place, bits);
    visit(level - 1, 2 * place + 1, bits);
  } else {
    forWords(level, place,
             [&](uint32_t w, uint64_t mask) { pushAll(bits->matters[w] & mask, w, bits); });
  }
}

// use(leaf) for one leaf that matters, at random, in each of equal parts of a node that has any.
template <class Use>
void VertexTracer::forProbes(const Node& node, uint64_t key, const LeafBits& bits,
                             const Use& use) const {
  const uint32_t count = probeCount(node.level), size = (1u << node.level) / count;
  const uint32_t begin = node.place << node.level;
  const uint64_t random = hashCombine(key, node.place * 64 + static_cast<uint32_t>(node.level));
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t start = static_cast<uint32_t>(hashCombine(random, i)) % size;
    for (uint32_t k = 0; k < size; ++k) {
      const uint32_t leaf = begin + i * size + (start + k) % size;
      if ((bits.matters[leaf / 64] & bit(leaf)) == 0) continue;
      use(leaf);
      break;
    }
  }
}

// Is no leaf of a node known to be otherwise?
bool VertexTracer::confirmed(const Node& node, const LeafBits& bits) const {
  uint64_t unlike = 0;
  const uint64_t expected = node.visible ? ~uint64_t{0} : 0;
  forWords(node.level, node.place, [&](uint32_t w, uint64_t mask) {
    unlike |= (bits.visible[w] ^ expected) & traced_[w] & mask;
  });
  return unlike == 0;
}

// Traces the leaves next to a traced one that are supposed to be what it is not.
void VertexTracer::pushUnlike(uint32_t leaf, LeafBits* bits) {
  const uint64_t visible = bits->visible[leaf / 64] >> (leaf % 64) & 1;
  for (const uint16_t other : neighbours_->at(leaf)) {
    const uint32_t w = other / 64, shift = other % 64;
    if ((bits->matters[w] & ~traced_[w]) >> shift & 1 && (bits->visible[w] >> shift & 1) != visible)
      fresh_.push_back(other), traced_[w] |= bit(other);
  }
}

void VertexTracer::followEdges(LeafBits* bits) {
  next_.clear();
  for (uint32_t w = 0; w < bits->wordCount(); ++w)
    for (uint64_t left = traced_[w]; left != 0; left &= left - 1)
      next_.push_back(w * 64 + static_cast<uint32_t>(std::countr_zero(left)));
  while (!next_.empty()) {
    fresh_.clear();
    for (const uint32_t leaf : next_) pushUnlike(leaf, bits);
    for (const uint32_t leaf : fresh_) {
      bits->visible[leaf / 64] &= ~bit(leaf);
      queue(leaf, bits);
    }
    flush(bits);
    next_.swap(fresh_);
  }
}

void VertexTracer::traceAdaptively(std::span<const LeafBits* const> nearby, uint64_t key,
                                   LeafBits* bits) {
  const int level = std::min(kMostLevel, bits->levels);
  if (nearby.empty() || level < kLeastLevel) return traceAll(bits);
  nearby_ = nearby;
  expected_.clear();
  for (uint32_t place = 0; place < 1u << (bits->levels - level); ++place) visit(level, place, bits);
  while (!expected_.empty()) {
    for (const Node& node : expected_)
      forProbes(node, key, *bits, [&](uint32_t leaf) { push(leaf, bits); });
    flush(bits);
    failed_.clear();
    for (const Node& node : expected_) {
      if (!confirmed(node, *bits)) {
        failed_.push_back(node);
      } else if (node.visible) {
        forWords(node.level, node.place,
                 [&](uint32_t w, uint64_t mask) { bits->visible[w] |= bits->matters[w] & mask; });
      }
    }
    expected_.clear();
    for (const Node& node : failed_) {
      if (node.level > kLeastLevel) {
        visit(node.level - 1, 2 * node.place, bits);
        visit(node.level - 1, 2 * node.place + 1, bits);
      } else {
        forWords(node.level, node.place,
                 [&](uint32_t w, uint64_t mask) { pushAll(bits->matters[w] & mask, w, bits); });
      }
    }
  }
  flush(bits);
  followEdges(bits);
}

}  // namespace lobelia::relight
