#include "lobelia/builtin/sculpture.h"

#include <algorithm>
#include <cmath>

#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin {
namespace {

float clamp01(float x) { return std::clamp(x, 0.f, 1.f); }

// Minimum rounded over a width k where the two are about the same.
float smoothMin(float a, float b, float k) {
  if (k <= 0) return std::min(a, b);
  const float h = std::max(k - std::abs(a - b), 0.f) / k;
  return std::min(a, b) - h * h * k / 4;
}

// Overlapping rows of round scales, 0 to 1: each rises towards its tip, every other row is shifted
// by half a scale. u: row, v: scale along the row.
float scalePattern(float u, float v) {
  const float row = std::floor(u);
  float height = 0;
  for (int k = 0; k < 2; ++k) {  // this row's scales and the tips of those before
    const float r = row - static_cast<float>(k);
    const float along = u - r;  // 0 to 2
    const float w = v + (static_cast<int>(r) % 2 == 0 ? 0.f : 0.5f);
    const float across = w - std::floor(w) - 0.5f;
    // Parallel sides, then a round tip.
    const float tip = std::max(along - 0.75f, 0.f) / 0.75f;
    const float edge = 1 - std::sqrt(sqr(across / 0.5f) * 0.9f + tip * tip);
    if (edge > 0) height = std::max(height, (0.35f + 0.45f * along) * std::min(1.f, 4 * edge));
  }
  return std::min(height, 1.f);
}

float coneDistance(const Part& part, Vec3f p) {
  const Vec3f axis = part.b - part.a, q = p - part.a;
  const float len2 = lengthSquared(axis);
  if (len2 <= 0) return length(q) - part.ra;
  // The ball that touches a cone of balls at p lies further towards the thin end than p's foot.
  const float len = std::sqrt(len2), along = dot(q, axis) / len,
              away = std::sqrt(std::max(lengthSquared(q) - along * along, 0.f));
  const float slope = std::clamp((part.ra - part.rb) / len, -0.95f, 0.95f);
  const float t = clamp01((along + away * slope / std::sqrt(1 - slope * slope)) / len);
  float d = std::hypot(along - t * len, away) - (part.ra * (1 - t) + part.rb * t);
  const Scales& scales = part.scales;
  if (scales.height > 0 && std::abs(d) < 4 * scales.height) {
    const float angle = std::atan2(dot(q, part.frame.t), dot(q, part.frame.s));
    const float f = clamp01(along / len);
    d -= scales.height * scalePattern(scales.rowFrom * (1 - f) + scales.rowTo * f + 64,
                                      (angle / kTwoPi + 0.5f) * static_cast<float>(scales.around));
  }
  return d;
}

// To first order: |p / r| - 1 over the length of its gradient.
float ellipsoidDistance(const Part& part, Vec3f p) {
  const Vec3f q = part.frame.toLocal(p - part.a), r = part.b;
  const Vec3f scaled{q.x / r.x, q.y / r.y, q.z / r.z};
  const float k0 = length(scaled);
  const float k1 = length(Vec3f(scaled.x / r.x, scaled.y / r.y, scaled.z / r.z));
  return k0 < 1e-4f ? -minComponent(r) : k0 * (k0 - 1) / k1;
}

float segmentDistance(Vec3f p, Vec3f a, Vec3f b) {
  const Vec3f axis = b - a;
  return length(p - a - axis * clamp01(dot(p - a, axis) / lengthSquared(axis)));
}

float sheetDistance(const Part& part, Vec3f p) {
  const Vec3f n = cross(part.b - part.a, part.c - part.a);
  const auto within = [&](Vec3f from, Vec3f to) { return dot(cross(to - from, p - from), n) >= 0; };
  float d = 0;
  if (within(part.a, part.b) && within(part.b, part.c) && within(part.c, part.a)) {
    d = std::abs(dot(p - part.a, n)) / length(n);
  } else {
    d = std::min({segmentDistance(p, part.a, part.b), segmentDistance(p, part.b, part.c),
                  segmentDistance(p, part.c, part.a)});
  }
  return d - part.ra;
}

}  // namespace

float Part::distance(Vec3f p) const {
  switch (shape) {
    case Shape::cone:
      return coneDistance(*this, p);
    case Shape::ellipsoid:
      return ellipsoidDistance(*this, p);
    case Shape::sheet:
      return sheetDistance(*this, p);
  }
  return 0;
}

Part& Sculpture::cone(Vec3f a, Vec3f b, float ra, float rb, float blend) {
  Part part;
  part.a = a, part.b = b, part.ra = ra, part.rb = rb, part.blend = blend;
  parts_.push_back(part);
  return parts_.back();
}

Part& Sculpture::ball(Vec3f centre, float radius, float blend) {
  return cone(centre, centre, radius, radius, blend);
}

Part& Sculpture::ellipsoid(Vec3f centre, Vec3f radii, float blend, Vec3f turn) {
  const Mat4 m = rotation({1, 0, 0}, static_cast<double>(turn.x)) *
                 rotation({0, 1, 0}, static_cast<double>(turn.y)) *
                 rotation({0, 0, 1}, static_cast<double>(turn.z));
  Part part;
  part.shape = Part::Shape::ellipsoid;
  part.a = centre, part.b = radii, part.blend = blend;
  part.frame = {m.vector({1, 0, 0}), m.vector({0, 1, 0}), m.vector({0, 0, 1})};
  parts_.push_back(part);
  return parts_.back();
}

Part& Sculpture::sheet(Vec3f a, Vec3f b, Vec3f c, float thickness, float blend) {
  Part part;
  part.shape = Part::Shape::sheet;
  part.a = a, part.b = b, part.c = c, part.ra = thickness / 2, part.blend = blend;
  parts_.push_back(part);
  return parts_.back();
}

void Sculpture::chain(const std::vector<Vec3f>& points, const std::vector<float>& radii, int steps,
                      float blend, int around, float height) {
  const int count = steps * (static_cast<int>(points.size()) - 1);
  const auto radius = [&](float t) {
    const float s = t * static_cast<float>(radii.size() - 1);
    const auto i = std::min(static_cast<size_t>(s), radii.size() - 2);
    const float f = s - static_cast<float>(i), smooth = f * f * (3 - 2 * f);
    return radii[i] * (1 - smooth) + radii[i + 1] * smooth;
  };
  const Curve curve = smoothCurve3(points);
  Vec3f a = points[0], side;
  float ra = radii[0], row = 0;
  for (int i = 1; i <= count; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(count);
    const Vec3f b = curve(t);
    const float rb = radius(t);
    Part& part = cone(a, b, ra, rb, i == 1 ? blend : 0.f);
    // The frame is carried along the chain, so that the pattern does not twist.
    part.frame = frameFromNormalTangent(normalize(b - a), i == 1 ? Vec3f(0, -1, 0) : side);
    side = part.frame.s;
    if (height > 0) {
      part.scales.around = around;
      part.scales.height = height * rb;
      part.scales.rowFrom = row;
      row += length(b - a) * static_cast<float>(around) / (kTwoPi * 0.5f * (ra + rb));
      part.scales.rowTo = row;
    }
    a = b, ra = rb;
  }
}

void Sculpture::mirror(size_t first, int axis) {
  const size_t end = parts_.size();
  for (size_t i = first; i < end; ++i) {
    Part part = parts_[i];
    for (Vec3f* v : {&part.a, &part.c, &part.frame.s, &part.frame.t, &part.frame.n})
      (*v)[axis] = -(*v)[axis];
    if (part.shape != Part::Shape::ellipsoid) part.b[axis] = -part.b[axis];
    if (part.shape == Part::Shape::sheet) std::swap(part.b, part.c);
    parts_.push_back(part);
  }
}

float Sculpture::distance(Vec3f p, const std::vector<uint32_t>& parts) const {
  float d = 1e4f;
  for (const uint32_t i : parts) {
    const Part& part = parts_[i];
    const float own = part.distance(p);
    d = part.carved ? -smoothMin(-d, own, part.blend) : smoothMin(d, own, part.blend);
  }
  return floor_ ? std::max(d, *floor_ - p.y) : d;
}

}  // namespace lobelia::builtin
