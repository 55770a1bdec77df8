// Bounds of one pair of nodes in scalar code: for studies, and the twin of the registers'.
#include "lobelia/gather/by_class-inl.h"
#include "lobelia/gather/node_bounds-inl.h"
#include "lobelia/gather/node_bounds.h"

namespace lobelia::gather {
namespace {

core::BoundSide<float> unpacked(const trees::BoundNode& node) {
  float fields[core::kSideFields];
  core::unpack(node, fields, 1);
  return core::sideOf<float>([&](size_t i) { return fields[i]; });
}

}  // namespace

PairBounds boundPair(const NodePair& pair, LightClass lightClass, bool glossy, BoundForm form) {
  const core::BoundSide<float> p = unpacked(*pair.receivers), q = unpacked(*pair.lights);
  const core::Factor<float> f = core::byClass(lightClass, [&](auto c) {
    constexpr LightClass kClass = decltype(c)::value;
    return glossy ? core::pairBounds<kClass, true>(p, q, form)
                  : core::pairBounds<kClass, false>(p, q, form);
  });
  return {f.value, f.upper, f.lower};
}

}  // namespace lobelia::gather
