#include "lobelia/gather/sampled_visibility.h"

#include <algorithm>
#include <bit>

#include "lobelia/base/random.h"
#include "lobelia/gather/facing_pairs.h"

namespace lobelia::gather {
namespace {

// Calls f(strip, lanes) for places [begin, end) of a tile.
template <class F>
void forStrips(uint32_t begin, uint32_t end, const F& f) {
  for (uint32_t s = begin / kStrip; s * kStrip < end; ++s) {
    const uint32_t from = std::max(begin, s * kStrip) - s * kStrip;
    const uint32_t to = std::min(end - s * kStrip, uint32_t{kStrip});
    f(s, static_cast<uint16_t>((1u << to) - (1u << from)));
  }
}

}  // namespace

size_t SampledVisibility::keep(const Tile& tile, const LightBlock& block, const Tracer& tracer,
                               const trees::BoundTree& tree, uint32_t first,
                               std::span<const LitNode> nodes, uint64_t seed, PairMasks* pairs) {
  keepFacing(tile, block, pairs);
  facing_ = *pairs;
  for (PairMasks* masks : {&known_, &lit_, &taken_, &rays_}) {
    masks->reset(static_cast<size_t>(block.count), tile.strips.size());
    std::fill(masks->bits.begin(), masks->bits.end(), uint16_t{0});
  }
  rays_.traced = pairs->traced;
  size_t traced = 0;
  next_.assign(nodes.begin(), nodes.end());
  while (!next_.empty()) {
    asked_ = std::move(next_);
    next_.clear();
    std::fill(rays_.bits.begin(), rays_.bits.end(), uint16_t{0});
    for (LitNode& node : asked_) ask(tree, first, seed, &node);
    for (size_t i = 0; i < rays_.bits.size(); ++i) {
      rays_.bits[i] &= static_cast<uint16_t>(~known_.bits[i]);
      known_.bits[i] |= rays_.bits[i];
    }
    traced += keepVisible(tile, block, tracer, &rays_);
    for (size_t i = 0; i < rays_.bits.size(); ++i) lit_.bits[i] |= rays_.bits[i];
    for (const LitNode& node : asked_) judge(tree, first, node);
  }
  for (size_t i = 0; i < taken_.bits.size(); ++i)
    pairs->bits[i] = static_cast<uint16_t>(taken_.bits[i] | lit_.bits[i]);
  return traced;
}

void SampledVisibility::ask(const trees::BoundTree& tree, uint32_t first, uint64_t seed,
                            LitNode* asked) {
  const trees::BoundNode& node = tree.nodes()[asked->node];
  const uint32_t light = asked->light;
  uint32_t facing = 0;
  const auto count = [&](uint32_t s, uint16_t lanes) {
    facing += static_cast<uint32_t>(std::popcount<uint16_t>(facing_.at(light, s) & lanes));
  };
  forStrips(node.first - first, node.first - first + node.count, count);
  asked->all = asked->all || facing <= kAskedAll;
  const uint32_t wanted = asked->all ? facing : std::max(facing / kShare, kLeast);
  // In each of as many runs of those that face the light one, at the same place of it.
  const uint64_t random = hashCombine(hashCombine(seed, asked->node), light) >> 32;
  const auto place = [&](uint32_t i) {
    return static_cast<uint32_t>(((uint64_t{i} << 32) + random) * facing / wanted >> 32);
  };
  uint32_t seen = 0, found = 0;
  const auto choose = [&](uint32_t s, uint16_t lanes) {
    for (uint32_t bits = facing_.at(light, s) & lanes; bits != 0; bits &= bits - 1) {
      const uint32_t lowest = bits & (~bits + 1);
      if (found < wanted && (asked->all || seen == place(found))) {
        rays_.at(light, s) |= static_cast<uint16_t>(lowest);
        ++found;
      }
      ++seen;
    }
  };
  forStrips(node.first - first, node.first - first + node.count, choose);
}

void SampledVisibility::judge(const trees::BoundTree& tree, uint32_t first, const LitNode& asked) {
  if (asked.all) return;
  const trees::BoundNode& node = tree.nodes()[asked.node];
  const uint32_t begin = node.first - first, end = begin + node.count, light = asked.light;
  bool anyLit = false, anyDark = false;
  forStrips(begin, end, [&](uint32_t s, uint16_t lanes) {
    const uint32_t known = known_.at(light, s) & lanes, lit = lit_.at(light, s) & lanes;
    anyLit = anyLit || lit != 0;
    anyDark = anyDark || (known & ~lit) != 0;
  });
  if (anyLit && anyDark) {
    next_.push_back({light, tree.left(asked.node)});
    next_.push_back({light, tree.right(asked.node)});
  } else if (anyLit) {
    forStrips(begin, end, [&](uint32_t s, uint16_t lanes) {
      taken_.at(light, s) |= static_cast<uint16_t>(facing_.at(light, s) & lanes);
    });
  }
}

}  // namespace lobelia::gather
