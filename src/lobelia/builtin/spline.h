// Smooth curves through points (internal to this room).
#pragma once

#include <algorithm>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::builtin {

// Uniform Catmull-Rom spline at t in [0,1]: first point to last, or (closed) around and back to the
// first. Beyond the ends of an open curve the end's chord is continued.
template <class V>
V catmullRom(const std::vector<V>& points, bool closed, float t) {
  if (!closed && t >= 1) return points.back();  // exactly: profiles end on their axis
  const int n = static_cast<int>(points.size()), last = closed ? n : n - 1;
  const float s = t * static_cast<float>(last);
  const int i = std::clamp(static_cast<int>(s), 0, last - 1);
  const float f = s - static_cast<float>(i);
  const auto point = [&](int k) { return points[static_cast<size_t>(k)]; };
  const auto at = [&](int k) -> V {
    if (closed) return point((k + n) % n);
    if (k < 0) return point(0) * 2.f - point(1);
    if (k >= n) return point(n - 1) * 2.f - point(n - 2);
    return point(k);
  };
  const V a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
  return b + ((c - a) + ((a * 2.f - b * 5.f + c * 4.f - d) + (b * 3.f - a - c * 3.f + d) * f) * f) *
                 (0.5f * f);
}

}  // namespace lobelia::builtin
