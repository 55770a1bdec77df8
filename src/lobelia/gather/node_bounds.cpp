#include "lobelia/gather/node_bounds.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/gather/node_bounds.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/base/simd-inl.h"
#include "lobelia/gather/by_class-inl.h"
#include "lobelia/gather/node_bounds-inl.h"

LOBELIA_CORE_BEGIN

// Fields of the nodes of a register of pairs.
struct alignas(64) SideLanes {
  float v[kSideFields][kLanes];
  BoundSide<Vf> side() const {
    return sideOf<Vf>([&](size_t i) { return Vf::load(v[i]); });
  }
};

template <g::LightClass kClass, bool kGlossy>
void boundPairsOf(std::span<const g::NodePair> pairs, g::BoundForm form, g::PairBounds* bounds) {
  SideLanes receivers, lights;
  alignas(64) float value[kLanes], upper[kLanes], lower[kLanes];
  for (size_t first = 0; first < pairs.size(); first += kLanes) {
    const size_t count = std::min(kLanes, pairs.size() - first);
    for (size_t i = 0; i < kLanes; ++i) {  // the last one fills up
      const g::NodePair& pair = pairs[first + std::min(i, count - 1)];
      unpack(*pair.receivers, &receivers.v[0][i], kLanes);
      unpack(*pair.lights, &lights.v[0][i], kLanes);
    }
    const Factor<Vf> f = pairBounds<kClass, kGlossy>(receivers.side(), lights.side(), form);
    f.value.store(value);
    f.upper.store(upper);
    f.lower.store(lower);
    for (size_t i = 0; i < count; ++i) bounds[first + i] = {value[i], upper[i], lower[i]};
  }
}

void boundPairs(std::span<const g::NodePair> pairs, g::LightClass lightClass, bool glossy,
                g::BoundForm form, g::PairBounds* bounds) {
  byClass(lightClass, [&](auto c) {
    constexpr g::LightClass kClass = decltype(c)::value;
    glossy ? boundPairsOf<kClass, true>(pairs, form, bounds)
           : boundPairsOf<kClass, false>(pairs, form, bounds);
  });
}

LOBELIA_CORE_END

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(boundPairs);
}  // namespace lobelia

namespace lobelia::gather {

void boundPairs(std::span<const NodePair> pairs, LightClass lightClass, bool glossyReceivers,
                BoundForm form, PairBounds* bounds) {
  HWY_DYNAMIC_DISPATCH(lobelia::boundPairs)(pairs, lightClass, glossyReceivers, form, bounds);
}

}  // namespace lobelia::gather
#endif
