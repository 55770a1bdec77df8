// Bounds of one pair of nodes in scalar code: for studies, and the twin of the registers'.
#include "lobelia/gather/node_bounds-inl.h"
#include "lobelia/gather/node_bounds.h"

namespace lobelia::gather {
namespace {

core::BoundSide<float> unpacked(const trees::BoundNode& node) {
  float fields[core::kSideFields];
  core::unpack(node, fields, 1);
  return core::sideOf<float>([&](size_t i) { return fields[i]; });
}

template <LightClass kClass>
PairBounds boundPairOf(const NodePair& pair, bool glossy, BoundForm form) {
  const core::BoundSide<float> p = unpacked(*pair.receivers), q = unpacked(*pair.lights);
  const core::Factor<float> f = glossy ? core::pairBounds<kClass, true>(p, q, form)
                                       : core::pairBounds<kClass, false>(p, q, form);
  return {f.value, f.upper, f.lower};
}

}  // namespace

PairBounds boundPair(const NodePair& pair, LightClass lightClass, bool glossy, BoundForm form) {
  switch (lightClass) {
    case LightClass::omni:
      return boundPairOf<LightClass::omni>(pair, glossy, form);
    case LightClass::directional:
      return boundPairOf<LightClass::directional>(pair, glossy, form);
    case LightClass::diffuse:
      return boundPairOf<LightClass::diffuse>(pair, glossy, form);
    case LightClass::spherical:
      return boundPairOf<LightClass::spherical>(pair, glossy, form);
    case LightClass::glossy:
      break;
  }
  return boundPairOf<LightClass::glossy>(pair, glossy, form);
}

}  // namespace lobelia::gather
