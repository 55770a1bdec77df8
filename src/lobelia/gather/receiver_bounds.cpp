#include "lobelia/gather/receiver_bounds.h"

#include <algorithm>

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/gather/receiver_bounds.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/base/simd-inl.h"
#include "lobelia/gather/by_class-inl.h"
#include "lobelia/gather/node_bounds-inl.h"

LOBELIA_CORE_BEGIN

inline BoundSide<Vf> broadcastSide(const trees::BoundNode& node) {
  float fields[kSideFields];
  unpack(node, fields, 1);
  return sideOf<Vf>([&](size_t i) { return Vf(fields[i]); });
}

template <g::LightClass kClass>
void boundNodesOf(const trees::BoundNode& cosine, const trees::BoundNode* gaussians,
                  std::span<const trees::BoundNode> tree, std::span<const uint32_t> nodes,
                  g::NodeBound* bounds) {
  constexpr g::BoundForm kForm = g::BoundForm::tight;
  const BoundSide<Vf> even = broadcastSide(cosine);
  const BoundSide<Vf> glossy = broadcastSide(gaussians != nullptr ? *gaussians : cosine);
  alignas(64) float fields[kSideFields][kLanes];
  alignas(64) float value[kLanes], upper[kLanes];
  for (size_t first = 0; first < nodes.size(); first += kLanes) {
    const size_t count = std::min(kLanes, nodes.size() - first);
    for (size_t i = 0; i < kLanes; ++i)  // the last one fills up
      unpack(tree[nodes[first + std::min(i, count - 1)]], &fields[0][i], kLanes);
    const BoundSide<Vf> lights = sideOf<Vf>([&](size_t i) { return Vf::load(fields[i]); });
    Factor<Vf> sum = pairBounds<kClass, false>(even, lights, kForm);
    if (gaussians != nullptr) {
      const Factor<Vf> more = pairBounds<kClass, true>(glossy, lights, kForm);
      sum.value += more.value;
      sum.upper += more.upper;
    }
    sum.value.store(value);
    min(sum.upper, Vf(kBoundInfinity)).store(upper);
    for (size_t i = 0; i < count; ++i) bounds[first + i] = {value[i], upper[i]};
  }
}

void boundNodes(const trees::BoundNode& cosine, const trees::BoundNode* gaussians,
                std::span<const trees::BoundNode> tree, std::span<const uint32_t> nodes,
                g::LightClass lightClass, g::NodeBound* bounds) {
  byClass(lightClass, [&](auto c) {
    boundNodesOf<decltype(c)::value>(cosine, gaussians, tree, nodes, bounds);
  });
}

LOBELIA_CORE_END

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(boundNodes);
}  // namespace lobelia

namespace lobelia::gather {

void boundNodes(const trees::BoundNode& cosine, const trees::BoundNode* gaussians,
                std::span<const trees::BoundNode> tree, std::span<const uint32_t> nodes,
                LightClass lightClass, NodeBound* bounds) {
  HWY_DYNAMIC_DISPATCH(lobelia::boundNodes)(cosine, gaussians, tree, nodes, lightClass, bounds);
}

}  // namespace lobelia::gather
#endif
