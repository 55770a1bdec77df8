#include "lobelia/builtin/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lobelia/builtin/mesh_edit.h"

namespace lobelia::builtin {
namespace {

float cross2(Vec2f a, Vec2f b) { return a.x * b.y - a.y * b.x; }
float norm(Vec2f a) { return std::hypot(a.x, a.y); }
Vec2f unit(Vec2f a) { return a * (1 / norm(a)); }

bool inside(Vec2f p, Vec2f a, Vec2f b, Vec2f c) {
  return cross2(b - a, p - a) >= 0 && cross2(c - b, p - b) >= 0 && cross2(a - c, p - c) >= 0;
}

}  // namespace

Polygon rectangle(float halfX, float halfY) {
  return {{-halfX, -halfY}, {halfX, -halfY}, {halfX, halfY}, {-halfX, halfY}};
}

Polygon ellipse(float radiusX, float radiusY, int corners) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) polygon.push_back(circle(i, corners) * Vec2f(radiusX, radiusY));
  return polygon;
}

Polygon rounded(const Polygon& polygon, float radius, int segments) {
  Polygon result;
  const size_t n = polygon.size();
  for (size_t i = 0; i < n; ++i) {
    const Vec2f p = polygon[i], before = polygon[(i + n - 1) % n] - p,
                after = polygon[(i + 1) % n] - p;
    const Vec2f a = unit(before), b = unit(after);
    const float half = 0.5f * std::acos(std::clamp(a.x * b.x + a.y * b.y, -1.f, 1.f));
    const float reach =
        std::min({radius / std::tan(half), 0.49f * norm(before), 0.49f * norm(after)});
    if (!(half > 0) || half > 0.499f * kPi) {  // no corner to speak of
      result.push_back(p);
      continue;
    }
    const float r = reach * std::tan(half);
    const Vec2f centre = p + unit(a + b) * (r / std::sin(half));
    // From the tangent point on the edge before to that on the edge after.
    const Vec2f from = p + a * reach - centre, to = p + b * reach - centre;
    const float sweep = std::atan2(cross2(from, to), from.x * to.x + from.y * to.y);
    for (int k = 0; k <= segments; ++k) {
      const float angle = sweep * fraction(k, segments), c = std::cos(angle), s = std::sin(angle);
      result.push_back(centre + Vec2f(c * from.x - s * from.y, s * from.x + c * from.y));
    }
  }
  return result;
}

Polygon inset(const Polygon& polygon, float distance) {
  Polygon result;
  const size_t n = polygon.size();
  for (size_t i = 0; i < n; ++i) {
    const Vec2f p = polygon[i];
    const Vec2f in = unit(p - polygon[(i + n - 1) % n]), out = unit(polygon[(i + 1) % n] - p);
    const Vec2f inNormal{-in.y, in.x}, outNormal{-out.y, out.x};
    const Vec2f sum = inNormal + outNormal;
    const float scale = 2 / std::max(sum.x * sum.x + sum.y * sum.y, 0.3f);
    result.push_back(p + sum * (distance * scale));
  }
  return result;
}

std::vector<Vec3u> triangulate(const Polygon& polygon) {
  std::vector<uint32_t> left(polygon.size());
  std::iota(left.begin(), left.end(), 0u);
  std::vector<Vec3u> triangles;
  while (left.size() > 3) {
    // The ear of the best shape keeps slivers away.
    size_t best = left.size();
    float bestShape = 0;
    for (size_t i = 0; i < left.size(); ++i) {
      const uint32_t ia = left[(i + left.size() - 1) % left.size()], ib = left[i],
                     ic = left[(i + 1) % left.size()];
      const Vec2f a = polygon[ia], b = polygon[ib], c = polygon[ic];
      const float doubleArea = cross2(b - a, c - b);
      const float longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
      const float shape = doubleArea / (longest * longest);
      if (!(shape > bestShape)) continue;
      const bool empty = std::none_of(left.begin(), left.end(), [&](uint32_t k) {
        return k != ia && k != ib && k != ic && inside(polygon[k], a, b, c);
      });
      if (empty) best = i, bestShape = shape;
    }
    if (best == left.size()) break;  // what is left has no area
    triangles.push_back(
        {left[(best + left.size() - 1) % left.size()], left[best], left[(best + 1) % left.size()]});
    left.erase(left.begin() + static_cast<ptrdiff_t>(best));
  }
  if (left.size() == 3) triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace lobelia::builtin
