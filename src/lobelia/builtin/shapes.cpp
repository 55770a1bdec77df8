#include "lobelia/builtin/shapes.h"

#include <algorithm>
#include <cmath>

namespace lobelia::builtin {
namespace {

void addVertex(Mesh& mesh, Vec3f p, Vec3f n, Vec2f uv) {
  mesh.positions.push_back(p);
  mesh.normals.push_back(n);
  mesh.uvs.push_back(uv);
}

// Two triangles per cell of a grid of (rows + 1) x (columns + 1) vertices that starts at `base`.
// Cells that are pressed into a point at a row's end lose the triangle without area.
void addGrid(Mesh& mesh, size_t base, int rows, int columns) {
  const auto vertex = [&](int i, int j) {
    return static_cast<uint32_t>(base) + static_cast<uint32_t>(i * (columns + 1) + j);
  };
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    const auto same = [&](uint32_t i, uint32_t j) {
      return mesh.positions[i] == mesh.positions[j];
    };
    if (!same(a, b) && !same(b, c) && !same(c, a)) mesh.triangles.push_back({a, b, c});
  };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      add(vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1));
      add(vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j));
    }
}

float fraction(int i, int n) { return static_cast<float>(i) / static_cast<float>(n); }

// cos and sin of the i-th of n parts of the circle; the last is the first, bit for bit.
Vec2f circle(int i, int n) {
  const float phi = kTwoPi * fraction(i % n, n);
  return {std::cos(phi), std::sin(phi)};
}

}  // namespace

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
  return [points = std::move(points)](float t) {
    const int last = static_cast<int>(points.size()) - 1;
    const float s = t * static_cast<float>(last);
    const int i = std::clamp(static_cast<int>(s), 0, last - 1);
    const float f = s - static_cast<float>(i);
    const auto at = [&](int k) {
      if (k < 0) return points[0] * 2.f - points[1];
      if (k > last)
        return points[static_cast<size_t>(last)] * 2.f - points[static_cast<size_t>(last - 1)];
      return points[static_cast<size_t>(k)];
    };
    const Vec2f a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
    return b +
           ((c - a) + ((a * 2.f - b * 5.f + c * 4.f - d) + (b * 3.f - a - c * 3.f + d) * f) * f) *
               (0.5f * f);
  };
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
