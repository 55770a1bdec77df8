// Octahedral coding of unit vectors, 2 x 16 bits (Meyer et al. 2010, "On Floating-Point Normal
// Vectors"; survey: Cigolle et al. 2014, JCGT 3(2)).
//
// Coordinates are signed and scaled by 32767, so that the six axis directions are exact. Plain
// rounding errs by up to 6.5e-5 rad in the middle of a face, where the map stretches most; the
// best of the four surrounding codes ("oct32P" of Cigolle et al.) stays below 4.4e-5: there the
// grid is made of equilateral triangles of side 7.5e-5, whose centre is side / sqrt(3) from the
// corners.
#include "lobelia/lights/virtual_lights.h"

namespace lobelia {
namespace {

constexpr float kScale = 32767.f;

float signOf(float x) { return std::copysign(1.f, x); }

uint32_t pack(int u, int v) {
  return static_cast<uint32_t>(static_cast<uint16_t>(static_cast<int16_t>(u))) |
         static_cast<uint32_t>(static_cast<uint16_t>(static_cast<int16_t>(v))) << 16;
}

}  // namespace

Vec3f decodeOctahedral(uint32_t code) {
  const float u = static_cast<float>(static_cast<int16_t>(code & 0xffff)) / kScale;
  const float v = static_cast<float>(static_cast<int16_t>(code >> 16)) / kScale;
  const float z = 1 - std::abs(u) - std::abs(v);
  const float fold = std::max(-z, 0.f);  // the lower half is folded over the edges
  return normalize(Vec3f(u - signOf(u) * fold, v - signOf(v) * fold, z));
}

uint32_t encodeOctahedral(Vec3f unit) {
  const float inverse = 1 / (std::abs(unit.x) + std::abs(unit.y) + std::abs(unit.z));
  float u = unit.x * inverse, v = unit.y * inverse;
  if (unit.z < 0) {
    const float folded = (1 - std::abs(v)) * signOf(u);
    v = (1 - std::abs(u)) * signOf(v);
    u = folded;
  }
  const int u0 = static_cast<int>(std::floor(std::clamp(u, -1.f, 1.f) * kScale));
  const int v0 = static_cast<int>(std::floor(std::clamp(v, -1.f, 1.f) * kScale));
  uint32_t best = 0;
  float least = 1e30f;
  for (int corner = 0; corner < 4; ++corner) {
    const uint32_t code =
        pack(std::min(u0 + (corner & 1), 32767), std::min(v0 + (corner >> 1), 32767));
    const float distance = lengthSquared(decodeOctahedral(code) - unit);
    if (distance < least) {
      least = distance;
      best = code;
    }
  }
  return best;
}

}  // namespace lobelia
