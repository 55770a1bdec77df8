#include "lobelia/scene/emitter_frame.h"

#include <algorithm>
#include <cmath>

namespace lobelia {
namespace {

struct Column {
  Vec3f direction;  // over the largest entry: squares of entries like 1e30 overflow floats
  double size = 0;  // length
};

Column column(const Mat4& m, size_t c) {
  double largest = 0;
  for (size_t r = 0; r < 3; ++r) largest = std::max(largest, std::abs(m.m[r][c]));
  if (!(largest > 0) || !std::isfinite(largest)) return {};  // validate() refuses the transform
  const Vec3d v = Vec3d(m.m[0][c], m.m[1][c], m.m[2][c]) / largest;
  return {{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)},
          largest * length(v)};
}

}  // namespace

Frame emitterFrame(const Emitter& emitter) {
  const Mat4& m = emitter.toWorld.to;
  const Vec3f z = column(m, 2).direction;
  if (z == Vec3f{}) return {};
  Frame frame = frameFromNormalTangent(normalize(z), column(m, 0).direction);
  if (dot(frame.t, column(m, 1).direction) < 0) frame.t = -frame.t;
  return frame;
}

bool keepsAngles(const Emitter& emitter) {
  constexpr double kTolerance = 1e-4;  // of scenes whose matrices have few digits
  const Frame frame = emitterFrame(emitter);
  const Vec3f axes[] = {frame.s, frame.t, frame.n};
  const double size = column(emitter.toWorld.to, 2).size;
  for (size_t c = 0; c < 3; ++c) {
    const Column of = column(emitter.toWorld.to, c);
    if (!(std::abs(of.size - size) <= kTolerance * size)) return false;
    if (!(length(normalize(of.direction) - axes[c]) <= static_cast<float>(kTolerance)))
      return false;
  }
  return true;
}

}  // namespace lobelia
