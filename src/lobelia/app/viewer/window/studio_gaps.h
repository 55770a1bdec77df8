// temporary
#pragma once
#include "lobelia/app/studio/studio.h"
namespace lobelia::app {
struct PickGap {
  Vec3f point;
  uint32_t material = 0;
  Bounds3f bounds;
};
template <class S>
std::optional<PickGap> pickIn(const S&, Vec2f) {
  return {};
}
template <class S>
bool busyIn(const S& s, const UiState& ui) {
  const auto p = s.newestPicture();
  if (!p || p->quick || p != ui.picture || p->film.width != ui.view.width) return true;
  return p->method != "cuts" && p->samples < ui.view.spp;
}
}  // namespace lobelia::app
