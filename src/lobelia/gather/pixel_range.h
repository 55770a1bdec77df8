// The pixels of some receivers, for tables by pixel: of a band of a picture no more than the band.
#pragma once

#include <algorithm>

#include "lobelia/path/receivers.h"

namespace lobelia::gather {

struct PixelRange {
  uint32_t first = 0;
  size_t size = 0;
  size_t at(uint32_t pixel) const { return pixel - first; }
};

inline PixelRange pixelRangeOf(const Receivers& receivers) {
  if (receivers.points.empty()) return {};
  const auto [least, most] = std::minmax_element(
      receivers.points.begin(), receivers.points.end(),
      [](const ReceiverPoint& a, const ReceiverPoint& b) { return a.pixel < b.pixel; });
  return {least->pixel, size_t{most->pixel} - least->pixel + 1};
}

}  // namespace lobelia::gather
