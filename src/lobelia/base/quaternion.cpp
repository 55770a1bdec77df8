// Matrix to quaternion by Shepperd 1978: the largest of the four components first, so that none
// of the divisions cancels.
#include "lobelia/base/quaternion.h"

#include <cmath>

namespace lobelia {
namespace {

double dot(const Quaternion& a, const Quaternion& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

Quaternion combine(const Quaternion& a, double wa, const Quaternion& b, double wb) {
  const Quaternion q{wa * a.x + wb * b.x, wa * a.y + wb * b.y, wa * a.z + wb * b.z,
                     wa * a.w + wb * b.w};
  const double scale = 1 / std::sqrt(dot(q, q));
  return {q.x * scale, q.y * scale, q.z * scale, q.w * scale};
}

// Half the angle of the rotation from a to b, which are in one hemisphere. acos of a number near 1
// would lose half of the digits.
double halfAngle(const Quaternion& a, const Quaternion& b) {
  const double c = dot(a, b);
  const Quaternion across{b.x - c * a.x, b.y - c * a.y, b.z - c * a.z, b.w - c * a.w};
  return std::atan2(std::sqrt(dot(across, across)), c);
}

Quaternion sameHemisphere(const Quaternion& a, const Quaternion& b) {
  return dot(a, b) < 0 ? Quaternion{-b.x, -b.y, -b.z, -b.w} : b;
}

}  // namespace

Quaternion quaternion(const Mat4& rotation) {
  const auto& m = rotation.m;
  const double trace = m[0][0] + m[1][1] + m[2][2];
  Quaternion q;
  if (trace >= std::max({m[0][0], m[1][1], m[2][2]})) {
    q = {m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], 1 + trace};
  } else if (m[0][0] >= m[1][1] && m[0][0] >= m[2][2]) {
    q = {1 + m[0][0] - m[1][1] - m[2][2], m[0][1] + m[1][0], m[0][2] + m[2][0], m[2][1] - m[1][2]};
  } else if (m[1][1] >= m[2][2]) {
    q = {m[0][1] + m[1][0], 1 + m[1][1] - m[0][0] - m[2][2], m[1][2] + m[2][1], m[0][2] - m[2][0]};
  } else {
    q = {m[0][2] + m[2][0], m[1][2] + m[2][1], 1 + m[2][2] - m[0][0] - m[1][1], m[1][0] - m[0][1]};
  }
  return combine(q, 1, q, 0);
}

Mat4 rotation(const Quaternion& q) {
  Mat4 r;
  r.m[0] = {1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.z * q.w),
            2 * (q.x * q.z + q.y * q.w), 0};
  r.m[1] = {2 * (q.x * q.y + q.z * q.w), 1 - 2 * (q.x * q.x + q.z * q.z),
            2 * (q.y * q.z - q.x * q.w), 0};
  r.m[2] = {2 * (q.x * q.z - q.y * q.w), 2 * (q.y * q.z + q.x * q.w),
            1 - 2 * (q.x * q.x + q.y * q.y), 0};
  return r;
}

Quaternion slerp(const Quaternion& a, const Quaternion& b, double t) {
  const Quaternion c = sameHemisphere(a, b);
  const double angle = halfAngle(a, c);
  const double s = std::sin(angle);
  if (s < 1e-9) return combine(a, 1 - t, c, t);  // the sines over s are then 1 - t and t
  return combine(a, std::sin((1 - t) * angle) / s, c, std::sin(t * angle) / s);
}

double angleBetween(const Quaternion& a, const Quaternion& b) {
  return 2 * halfAngle(a, sameHemisphere(a, b));
}

}  // namespace lobelia
