// Smooth curves through points (internal to this room).
#pragma once

#include <algorithm>
#include <cmath>
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

// The same through an open row of points, but with the tangents of the centripetal spline
// [Yuksel11]: where a long span meets a short one, as at a rim, the uniform one overshoots and
// makes loops. Neighbouring points must differ.
inline Vec2f centripetalCatmullRom(const std::vector<Vec2f>& points, float t) {
  if (t >= 1) return points.back();
  const int last = static_cast<int>(points.size()) - 1;
  const float s = t * static_cast<float>(last);
  const int i = std::clamp(static_cast<int>(s), 0, last - 1);
  const float f = s - static_cast<float>(i);
  const auto point = [&](int k) { return points[static_cast<size_t>(std::clamp(k, 0, last))]; };
  const Vec2f b = point(i), c = point(i + 1), chord = c - b;
  const auto knotInterval = [](Vec2f d) { return std::sqrt(std::hypot(d.x, d.y)); };
  const float span = knotInterval(chord);
  // The tangent, over this span, at the end that it shares with a span of chord `other`.
  const auto tangent = [&](Vec2f other) {
    const float next = knotInterval(other);
    if (next <= 0) return chord;  // the end of the row
    return (other * (span / next) + chord * (next / span)) * (span / (span + next));
  };
  const Vec2f m0 = tangent(b - point(i - 1)), m1 = tangent(point(i + 2) - c);
  return b + (m0 + (chord * 3.f - m0 * 2.f - m1 + (m0 + m1 - chord * 2.f) * f) * f) * f;
}

}  // namespace lobelia::builtin
