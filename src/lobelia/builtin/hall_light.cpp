#include "lobelia/builtin/hall_light.h"

#include <cmath>

#include "lobelia/builtin/environment.h"
#include "lobelia/builtin/noise.h"

namespace lobelia::builtin {
namespace {

// Radiance seen from the middle of a room of 12 x 6 x 8 at a height of 1.6, in direction d.
Rgb hallRadiance(Vec3f d) {
  const Vec3f half{6, 0, 4};
  const float floor = -1.6f, ceiling = 4.4f;
  float t = 1e30f;
  int wall = 0;  // 0: x, 1: y, 2: z
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0) continue;
    const float plane =
        axis == 1 ? (d.y > 0 ? ceiling : floor) : std::copysign(half[axis], d[axis]);
    const float hit = plane / d[axis];
    if (hit < t) t = hit, wall = axis;
  }
  const Vec3f p = d * t;
  const float grain = 0.85f + 0.15f * noise(p * 2.3f, 5);
  if (wall == 1) {
    if (d.y < 0) return Rgb(0.16f, 0.11f, 0.07f) * grain;
    // Beams, and lamps in a grid.
    const float beam = std::abs(p.x / 1.5f - std::round(p.x / 1.5f)) < 0.14f ? 0.45f : 1.f;
    const float lampX = p.x - 3 * std::round(p.x / 3), lampZ = p.z - 2.6f * std::round(p.z / 2.6f);
    const float lamp = std::exp(-(sqr(lampX) + sqr(lampZ)) / 0.06f);
    return Rgb(0.50f, 0.38f, 0.25f) * (beam * grain) + Rgb(34, 22, 11) * lamp;
  }
  // Windows: arched, between posts, on one long and one short side.
  const float along = wall == 0 ? p.z : p.x;
  const bool hasWindows = wall == 2 ? p.z < 0 : p.x < 0;
  const float pitch = wall == 2 ? 2.4f : 2.7f;
  const float x = along - pitch * std::round(along / pitch), y = p.y - 2.0f;
  const float halfWidth = 0.72f;
  const bool inside =
      std::abs(x) < halfWidth && p.y > -0.4f && (y < 0 || x * x + y * y < sqr(halfWidth));
  if (hasWindows && inside) {
    const bool bar = std::abs(x) < 0.05f || std::abs(p.y - 0.4f) < 0.04f ||
                     std::abs(p.y - 1.2f) < 0.04f || std::abs(y) < 0.04f;
    const float sky = 0.6f + 0.4f * std::clamp((p.y + 0.4f) / 3, 0.f, 1.f);
    return bar ? Rgb(0.3f, 0.25f, 0.2f) : Rgb(9.0f, 9.6f, 10.5f) * sky;
  }
  const float panel = p.y < -0.5f ? 0.5f : 1.f;  // wainscot
  return Rgb(0.46f, 0.33f, 0.20f) * (panel * grain);
}

}  // namespace

void addHallLight(SceneBuilder& scene, double degrees) {
  addEnvironment(scene, environmentImage(256, hallRadiance, "hall-light"), degrees, "hall");
}

}  // namespace lobelia::builtin
