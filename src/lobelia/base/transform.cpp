// 4x4 transforms in double precision; results are rounded to float only when applied.
#include "lobelia/base/transform.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace lobelia {
namespace {

// A matrix is taken for singular when its determinant is this small against the product of its
// columns' lengths: that ratio is 1 for any scaling and rotation, however small the scale.
constexpr double kSingular = 1e-13;

bool isAffine(const Mat4& a) {
  return a.m[3][0] == 0 && a.m[3][1] == 0 && a.m[3][2] == 0 && a.m[3][3] == 1;
}

Vec3d column(const Mat4& a, int c) {
  const auto i = static_cast<size_t>(c);
  return {a.m[0][i], a.m[1][i], a.m[2][i]};
}

std::optional<Mat4> inverseAffine(const Mat4& a) {
  const Vec3d c0 = column(a, 0), c1 = column(a, 1), c2 = column(a, 2), t = column(a, 3);
  const double l0 = length(c0), l1 = length(c1), l2 = length(c2);
  // Rows of the inverse of the matrix with unit columns: cross products over its determinant.
  const Vec3d n0 = c0 / l0, n1 = c1 / l1, n2 = c2 / l2;
  const double det = dot(n0, cross(n1, n2));
  if (!(std::abs(det) > kSingular)) return std::nullopt;  // also when a column is zero (NaN)
  const Vec3d rows[3] = {cross(n1, n2) / (det * l0), cross(n2, n0) / (det * l1),
                         cross(n0, n1) / (det * l2)};
  Mat4 r;
  for (size_t i = 0; i < 3; ++i) {
    r.m[i] = {rows[i].x, rows[i].y, rows[i].z, -dot(rows[i], t)};
  }
  if (!r.isFinite()) return std::nullopt;
  return r;
}

// Gauss-Jordan elimination with partial pivoting on rows scaled to unit maximum.
std::optional<Mat4> inverseGeneral(Mat4 a) {
  Mat4 r;
  for (size_t i = 0; i < 4; ++i) {
    double largest = 0;
    for (double v : a.m[i]) largest = std::max(largest, std::abs(v));
    if (!(largest > 0)) return std::nullopt;
    for (size_t j = 0; j < 4; ++j) a.m[i][j] /= largest, r.m[i][j] /= largest;
  }
  for (size_t c = 0; c < 4; ++c) {
    size_t pivot = c;
    for (size_t i = c + 1; i < 4; ++i) {
      if (std::abs(a.m[i][c]) > std::abs(a.m[pivot][c])) pivot = i;
    }
    if (!(std::abs(a.m[pivot][c]) > kSingular)) return std::nullopt;
    std::swap(a.m[pivot], a.m[c]);
    std::swap(r.m[pivot], r.m[c]);
    const double scale = 1 / a.m[c][c];
    for (size_t j = 0; j < 4; ++j) a.m[c][j] *= scale, r.m[c][j] *= scale;
    for (size_t i = 0; i < 4; ++i) {
      const double f = a.m[i][c];
      if (i == c || f == 0) continue;
      for (size_t j = 0; j < 4; ++j) a.m[i][j] -= f * a.m[c][j], r.m[i][j] -= f * r.m[c][j];
    }
  }
  if (!r.isFinite()) return std::nullopt;
  return r;
}

}  // namespace

Vec3f Mat4::point(Vec3f p) const {
  double r[4];
  for (size_t i = 0; i < 4; ++i) {
    r[i] = m[i][0] * double{p.x} + m[i][1] * double{p.y} + m[i][2] * double{p.z} + m[i][3];
  }
  const double w = isAffine(*this) ? 1 : 1 / r[3];
  return {static_cast<float>(r[0] * w), static_cast<float>(r[1] * w), static_cast<float>(r[2] * w)};
}

Vec3f Mat4::vector(Vec3f v) const {
  double r[3];
  for (size_t i = 0; i < 3; ++i) {
    r[i] = m[i][0] * double{v.x} + m[i][1] * double{v.y} + m[i][2] * double{v.z};
  }
  return {static_cast<float>(r[0]), static_cast<float>(r[1]), static_cast<float>(r[2])};
}

double Mat4::determinant3() const {
  return dot(column(*this, 0), cross(column(*this, 1), column(*this, 2)));
}

bool Mat4::isIdentity() const { return *this == Mat4{}; }

bool Mat4::isFinite() const {
  for (const auto& row : m) {
    for (double v : row) {
      if (!std::isfinite(v)) return false;
    }
  }
  return true;
}

Mat4 operator*(const Mat4& a, const Mat4& b) {
  Mat4 r;
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < 4; ++j) {
      double sum = 0;
      for (size_t k = 0; k < 4; ++k) sum += a.m[i][k] * b.m[k][j];
      r.m[i][j] = sum;
    }
  }
  return r;
}

std::optional<Mat4> inverse(const Mat4& a) {
  if (!a.isFinite()) return std::nullopt;
  return isAffine(a) ? inverseAffine(a) : inverseGeneral(a);
}

Mat4 transpose(const Mat4& a) {
  Mat4 r;
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < 4; ++j) r.m[i][j] = a.m[j][i];
  }
  return r;
}

Mat4 translation(Vec3d t) {
  Mat4 r;
  r.m[0][3] = t.x, r.m[1][3] = t.y, r.m[2][3] = t.z;
  return r;
}

Mat4 scaling(Vec3d s) {
  Mat4 r;
  r.m[0][0] = s.x, r.m[1][1] = s.y, r.m[2][2] = s.z;
  return r;
}

// Rodrigues' formula. A zero axis gives a matrix that is not finite, for the caller to report.
Mat4 rotation(Vec3d axis, double degrees) {
  const Vec3d a = normalize(axis);
  const double angle = degrees * (3.14159265358979323846 / 180);
  const double s = std::sin(angle), c = std::cos(angle), v = 1 - c;
  Mat4 r;
  r.m[0] = {a.x * a.x * v + c, a.x * a.y * v - a.z * s, a.x * a.z * v + a.y * s, 0};
  r.m[1] = {a.y * a.x * v + a.z * s, a.y * a.y * v + c, a.y * a.z * v - a.x * s, 0};
  r.m[2] = {a.z * a.x * v - a.y * s, a.z * a.y * v + a.x * s, a.z * a.z * v + c, 0};
  return r;
}

std::optional<Mat4> lookAt(Vec3d origin, Vec3d target, Vec3d up) {
  const Vec3d z = normalize(target - origin);
  const Vec3d side = cross(normalize(up), z);
  if (!(length(side) > 1e-9)) return std::nullopt;  // up along the view, or a zero vector (NaN)
  const Vec3d x = normalize(side);
  const Vec3d y = cross(z, x);
  Mat4 r;
  r.m[0] = {x.x, y.x, z.x, origin.x};
  r.m[1] = {x.y, y.y, z.y, origin.y};
  r.m[2] = {x.z, y.z, z.z, origin.z};
  if (!r.isFinite()) return std::nullopt;
  return r;
}

Transform::Transform(const Mat4& matrix) : to(matrix) {
  const std::optional<Mat4> inv = inverse(matrix);
  if (!inv) throw std::invalid_argument("transform is singular or not finite");
  from = *inv;
}

Vec3f Transform::normal(Vec3f n) const { return transpose(from).vector(n); }

Transform Transform::inverted() const {
  Transform r;
  r.to = from, r.from = to;
  return r;
}

}  // namespace lobelia
