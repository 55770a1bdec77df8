#include "lobelia/builtin/sweep.h"

#include <algorithm>
#include <cmath>

#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/polygon.h"
#include "lobelia/builtin/spline.h"

namespace lobelia::builtin {
namespace {

Vec3f direction(const Curve& curve, float t, bool closed) {
  constexpr float kStep = 1e-3f;
  if (closed) {
    const auto wrap = [](float s) { return s - std::floor(s); };
    return normalize(curve(wrap(t + kStep)) - curve(wrap(t - kStep)));
  }
  return normalize(curve(std::min(t + kStep, 1.f)) - curve(std::max(t - kStep, 0.f)));
}

Vec3f orthogonal(Vec3f v, Vec3f to) {
  const Vec3f rest = v - to * dot(v, to);
  if (lengthSquared(rest) > 1e-6f) return normalize(rest);
  return orthogonal(std::abs(to.y) < 0.9f ? Vec3f(0, 1, 0) : Vec3f(1, 0, 0), to);
}

void addCap(Mesh& mesh, const std::vector<Vec2f>& profile, const std::vector<Vec3f>& ring,
            bool start) {
  const auto base = static_cast<uint32_t>(mesh.positions.size());
  for (size_t i = 0; i < ring.size(); ++i) {
    mesh.positions.push_back(ring[i]);
    mesh.uvs.push_back(profile[i]);
  }
  for (const Vec3u t : triangulate(profile)) {
    mesh.triangles.push_back(start ? Vec3u(base + t.x, base + t.z, base + t.y)
                                   : Vec3u(base + t.x, base + t.y, base + t.z));
  }
}

}  // namespace

Curve smoothCurve3(std::vector<Vec3f> points, bool closed) {
  return [points = std::move(points), closed](float t) { return catmullRom(points, closed, t); };
}

Curve roundedPath(const std::vector<Vec3f>& points, float radius) {
  // Corners become quadratic Bezier arcs; then all is sampled and run through by length.
  std::vector<Vec3f> fine{points.front()};
  for (size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec3f p = points[i], before = points[i - 1] - p, after = points[i + 1] - p;
    const float r = std::min({radius, 0.49f * length(before), 0.49f * length(after)});
    const Vec3f a = p + normalize(before) * r, b = p + normalize(after) * r;
    constexpr int kArc = 12;
    for (int k = 0; k <= kArc; ++k) {
      const float t = fraction(k, kArc);
      fine.push_back(lerp(lerp(a, p, t), lerp(p, b, t), t));
    }
  }
  fine.push_back(points.back());
  std::vector<float> lengths{0};
  for (size_t i = 1; i < fine.size(); ++i)
    lengths.push_back(lengths.back() + length(fine[i] - fine[i - 1]));
  return [fine = std::move(fine), lengths = std::move(lengths)](float t) {
    const float s = std::clamp(t, 0.f, 1.f) * lengths.back();
    const auto above = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, s);
    const auto i = static_cast<size_t>(above - lengths.begin());
    const float span = lengths[i] - lengths[i - 1];
    return lerp(fine[i - 1], fine[i], span > 0 ? (s - lengths[i - 1]) / span : 0.f);
  };
}

Mesh sweep(const std::vector<Vec2f>& profile, const Curve& curve, int along,
           const SweepOptions& options) {
  const int around = static_cast<int>(profile.size());
  std::vector<Vec3f> sides;
  Vec3f side = options.sideHint;
  for (int i = 0; i <= along; ++i) {
    side = orthogonal(side, direction(curve, fraction(i, along), options.closed));
    sides.push_back(side);
  }
  // On a closed curve the frame comes back turned: the difference is spread over the curve.
  float twist = 0;
  if (options.closed) {
    const Vec3f d = direction(curve, 0, true);
    twist =
        std::atan2(dot(cross(sides.back(), sides.front()), d), dot(sides.back(), sides.front()));
  }
  Mesh mesh;
  std::vector<Vec3f> first, last;
  for (int i = 0; i <= along; ++i) {
    const float t = fraction(i, along);
    const int k = options.closed ? i % along : i;
    const float at = fraction(k, along), angle = twist * at;
    const Vec3f d = direction(curve, at, options.closed), s = sides[static_cast<size_t>(k)];
    const Vec3f x = s * std::cos(angle) + cross(d, s) * std::sin(angle), y = cross(d, x);
    const float scale = options.scale ? options.scale(t) : 1.f;
    const Vec3f centre = curve(at);
    for (int j = 0; j <= around; ++j) {
      const Vec2f q = profile[static_cast<size_t>(j % around)] * scale;
      const Vec3f p = centre + x * q.x + y * q.y;
      mesh.positions.push_back(p);
      mesh.uvs.push_back({fraction(j, around), t});
      if (j < around && i == 0) first.push_back(p);
      if (j < around && i == along) last.push_back(p);
    }
  }
  addGrid(mesh, 0, along, around);
  if (options.capped && !options.closed) {
    const auto hasArea = [&](float t) { return !options.scale || options.scale(t) > 0; };
    if (hasArea(0)) addCap(mesh, profile, first, true);
    if (hasArea(1)) addCap(mesh, profile, last, false);
  }
  return creased(std::move(mesh), options.creaseDegrees);
}

Mesh tube(const Curve& curve, float radius, int along, int around, const SweepOptions& options) {
  std::vector<Vec2f> profile;
  for (int i = 0; i < around; ++i) profile.push_back(circle(i, around) * radius);
  SweepOptions smooth = options;
  smooth.creaseDegrees = std::max(options.creaseDegrees, 1.1f * 360 / static_cast<float>(around));
  return sweep(profile, curve, along, smooth);
}

}  // namespace lobelia::builtin
