// Affine and projective 4x4 transforms, row-major, column vectors: p' = M p.
#pragma once

#include <array>
#include <optional>

#include "lobelia/base/vec.h"

namespace lobelia {

struct Mat4 {
  std::array<std::array<double, 4>, 4> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

  Vec3f point(Vec3f p) const;   // affine: divides by w only when the last row is not (0,0,0,1)
  Vec3f vector(Vec3f v) const;  // ignores translation
  double determinant3() const;  // of the upper-left 3x3 part
  bool isIdentity() const;
  bool isFinite() const;
  friend bool operator==(const Mat4&, const Mat4&) = default;
};

Mat4 operator*(const Mat4& a, const Mat4& b);
std::optional<Mat4> inverse(const Mat4& a);  // empty when singular (relative to its entries)
Mat4 transpose(const Mat4& a);
Mat4 translation(Vec3d t);
Mat4 scaling(Vec3d s);
Mat4 rotation(Vec3d axis, double degrees);
// Camera to world: +z looks from origin to target, y is near up, x to the LEFT (Mitsuba's
// convention, so that the frame is right-handed).
std::optional<Mat4> lookAt(Vec3d origin, Vec3d target, Vec3d up);

// An affine transform with its inverse: transforms points, vectors and normals both ways.
struct Transform {
  Mat4 to, from;
  Transform() = default;
  explicit Transform(const Mat4& matrix);  // throws InputError-free std::invalid_argument if singular
  Vec3f point(Vec3f p) const { return to.point(p); }
  Vec3f vector(Vec3f v) const { return to.vector(v); }
  Vec3f normal(Vec3f n) const;  // by the inverse transpose; not normalised
  Transform inverted() const;
};

}  // namespace lobelia
