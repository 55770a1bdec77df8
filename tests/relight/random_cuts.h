// Random functions on a complete tree and cuts of them, with means not quantised.
#pragma once

#include <vector>

#include "lobelia/base/random.h"
#include "lobelia/relight/sample_tree.h"

namespace lobelia::test {

struct ValueNode {
  uint8_t level = 0;
  float value = 0;  // mean over the leaves
};
using ValueCut = std::vector<ValueNode>;

// Smooth in parts, with jumps; in [0, 1].
inline std::vector<float> randomLeaves(int levels, uint64_t seed) {
  Rng rng(seed, 7);
  std::vector<float> leaves(size_t{1} << levels);
  float value = rng.next1D();
  for (float& leaf : leaves) {
    if (rng.next1D() < 0.15f) value = rng.next1D();
    leaf = std::min(1.f, value * (0.9f + 0.1f * rng.next1D()));
  }
  return leaves;
}

// Nodes are divided by chance, or as long as they are not constant.
inline void appendCut(const std::vector<float>& means, int levels, int level, size_t place,
                      float chance, Rng& rng, ValueCut* cut) {
  const size_t heap = (size_t{1} << (levels - level)) + place;
  const size_t leaves = size_t{1} << level, first = (size_t{1} << levels) + (place << level);
  bool constant = true;
  for (size_t i = first; i < first + leaves; ++i) constant &= means[i] == means[first];
  const bool divide = chance < 0 ? !constant : rng.next1D() < chance;
  if (level == 0 || !divide) {
    cut->push_back({static_cast<uint8_t>(level), means[heap]});
    return;
  }
  appendCut(means, levels, level - 1, 2 * place, chance, rng, cut);
  appendCut(means, levels, level - 1, 2 * place + 1, chance, rng, cut);
}
// chance: of a node to be divided; below 0: until the cut is the function itself (sigma = 0).
inline ValueCut randomCut(const std::vector<float>& leaves, int levels, float chance,
                          uint64_t seed) {
  Rng rng(seed, 11);
  ValueCut cut;
  appendCut(relight::nodeMeans(std::span<const float>(leaves)), levels, levels, 0, chance, rng,
            &cut);
  return cut;
}

// The cut's value at every leaf.
inline std::vector<float> atLeaves(const ValueCut& cut) {
  std::vector<float> out;
  for (const ValueNode& node : cut) out.insert(out.end(), size_t{1} << node.level, node.value);
  return out;
}

}  // namespace lobelia::test
