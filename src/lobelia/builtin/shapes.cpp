#include "lobelia/builtin/shapes.h"

#include <algorithm>
#include <cmath>

#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/spline.h"

namespace lobelia::builtin {
Mesh roundedBox(Vec3f halfExtent, float radius, int segments) {
  radius = std::min(radius, minComponent(halfExtent));
  const Vec3f inner = halfExtent - Vec3f(radius);
  const int n = 2 * segments + 1;  // cells along a side: bevel, flat, bevel
  // Slope and inner corner's sign of the i-th grid line.
  const auto line = [&](int i) {
    const bool low = i <= segments;
    const int k = low ? i - segments : i - segments - 1;
    return Vec2f{std::tan(kPi / 4 * fraction(k, segments)), low ? -1.f : 1.f};
  };
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.f, 1.f}) {
      // (u, v, axis) right-handed, mirrored on the negative side.
      const int u = (axis + (side > 0 ? 1 : 2)) % 3, v = (axis + (side > 0 ? 2 : 1)) % 3;
      const size_t base = mesh.positions.size();
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
          const Vec2f a = line(i), b = line(j);
          Vec3f direction, corner;
          direction[axis] = side, direction[u] = a.x, direction[v] = b.x;
          corner[axis] = side * inner[axis], corner[u] = a.y * inner[u], corner[v] = b.y * inner[v];
          direction = normalize(direction);
          const Vec3f p = corner + direction * radius;
          addVertex(mesh, p, direction,
                    {0.5f + 0.5f * p[u] / halfExtent[u], 0.5f + 0.5f * p[v] / halfExtent[v]});
        }
      addGrid(mesh, base, n, n);
    }
  return mesh;
}

Mesh revolve(const std::function<Vec2f(float)>& profile, int rows, int segments) {
  Mesh mesh;
  for (int i = 0; i <= rows; ++i) {
    const float t = fraction(i, rows);
    constexpr float kStep = 1e-3f;
    const Vec2f at = profile(t);
    const Vec2f d = profile(std::min(t + kStep, 1.f)) - profile(std::max(t - kStep, 0.f));
    const float len = std::hypot(d.x, d.y);
    const Vec2f normal = at.x <= 0 ? Vec2f(0, d.x > 0 ? -1.f : 1.f) : Vec2f(d.y / len, -d.x / len);
    const float radius = std::max(at.x, 0.f);
    for (int j = 0; j <= segments; ++j) {
      const Vec2f c = circle(j, segments);
      // z runs against the angle, so that (angle, profile) is right-handed seen from outside.
      addVertex(mesh, {radius * c.x, at.y, -radius * c.y},
                {normal.x * c.x, normal.y, -normal.x * c.y}, {fraction(j, segments), t});
    }
  }
  addGrid(mesh, 0, rows, segments);
  return mesh;
}

std::function<Vec2f(float)> smoothCurve(std::vector<Vec2f> points) {
  return [points = std::move(points)](float t) { return catmullRom(points, false, t); };
}

std::function<Vec2f(float)> centripetalCurve(std::vector<Vec2f> points) {
  return [points = std::move(points)](float t) { return centripetalCatmullRom(points, t); };
}

Mesh torusKnot(const TorusKnot& knot, int along, int around) {
  const auto p = static_cast<float>(knot.p), q = static_cast<float>(knot.q);
  Mesh mesh;
  for (int i = 0; i <= along; ++i) {
    const float t = kTwoPi * fraction(i % along, along);
    const float cp = std::cos(p * t), sp = std::sin(p * t), cq = std::cos(q * t),
                sq = std::sin(q * t);
    const float r = knot.ring + knot.wind * cq, dr = -knot.wind * q * sq;
    const Vec3f centre{r * cp, knot.wind * sq, r * sp};
    const Vec3f tangent =
        normalize(Vec3f(dr * cp - r * p * sp, knot.wind * q * cq, dr * sp + r * p * cp));
    // The direction from the ring, made orthogonal: smooth and the same after a full turn.
    const Vec3f away{cq * cp, sq, cq * sp};
    const Vec3f n = normalize(away - tangent * dot(away, tangent));
    const Vec3f b = cross(tangent, n);
    for (int j = 0; j <= around; ++j) {
      const Vec2f c = circle(j, around);
      const Vec3f out = n * c.x + b * c.y;
      addVertex(mesh, centre + out * knot.tube, out, {fraction(j, around), fraction(i, along)});
    }
  }
  addGrid(mesh, 0, along, around);
  return mesh;
}

}  // namespace lobelia::builtin
