// The frame of the motorcycle, its fork and its shock absorbers.
#include <cmath>

#include "lobelia/builtin/machine.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/solids.h"

namespace lobelia::builtin {

void Machine::addFrame() {
  put(bar({{0.485f, 0.955f, 0}, {0.545f, 0.775f, 0}}, 0.032f, 0, 6, 24), black_, "steering head");
  put(bar({{0.50f, 0.86f, 0}, {0.10f, 0.715f, 0}, {-0.24f, 0.70f, 0}}, 0.024f, 0.08f, 24, 16),
      black_, "backbone");
  putPair(bar({{0.53f, 0.83f, 0.02f},
               {0.33f, 0.42f, 0.085f},
               {0.25f, 0.155f, 0.115f},
               {-0.25f, 0.155f, 0.115f},
               {-0.30f, 0.36f, 0.105f},
               {-0.22f, 0.70f, 0.055f}},
              0.0165f, 0.12f, 60),
          black_, "cradle");
  putPair(bar({{-0.20f, 0.695f, 0.05f}, {-0.40f, 0.70f, 0.085f}, {-0.80f, 0.75f, 0.08f}}, 0.0145f,
              0.08f, 24),
          black_, "seat rail");
  putPair(bar({{-0.28f, 0.40f, 0.10f}, {-0.56f, 0.725f, 0.085f}}, 0.013f, 0, 16), black_, "strut");
  putPair(bar({{-0.27f, 0.35f, 0.092f}, {-0.50f, 0.335f, 0.118f}, {-0.765f, 0.32f, 0.118f}}, 0.020f,
              0.06f, 20, 14),
          black_, "swingarm");
  put(bar({{-0.275f, 0.35f, -0.12f}, {-0.275f, 0.35f, 0.12f}}, 0.022f, 0, 8, 16), steel_, "pivot");
  putPair(bar({{-0.05f, 0.155f, 0.10f}, {-0.05f, 0.165f, 0.185f}}, 0.010f, 0, 4), steel_,
          "peg arm");
  putPair(bar({{-0.05f, 0.166f, 0.175f}, {-0.05f, 0.172f, 0.265f}}, 0.017f, 0, 8, 16), rubber_,
          "foot peg");
  put(bar({{-0.15f, 0.15f, -0.115f},
           {-0.20f, 0.10f, -0.16f},
           {-0.23f, 0.012f, -0.27f},
           {-0.28f, 0.010f, -0.30f}},
          0.010f, 0.04f, 22),
      steel_, "side stand");
}

void Machine::addSuspension() {
  // Fork: upper tubes in yokes, lower legs, both along one line down to the axle.
  const Vec3f top{0.478f, 0.985f, 0.088f}, foot{0.755f, 0.335f, 0.088f};
  const auto leg = [&](float t) { return lerp(top, foot, t); };
  putPair(bar({top, leg(0.62f)}, 0.019f, 0, 12, 20), chrome_, "fork tube");
  putPair(bar({leg(0.45f), leg(0.47f), leg(1.03f)}, 0.0275f, 0, 20, 22), aluminium_, "fork leg");
  putPair(bar({leg(0.40f), leg(0.46f)}, 0.031f, 0, 4, 22), rubber_, "fork seal");
  const Mat4 lean = rotation({0, 0, 1}, 23);
  for (const float t : {0.045f, 0.26f}) {
    const Vec3f c = leg(t);
    put(extrude(rounded(rectangle(0.042f, 0.125f), 0.035f, segments(6, 2)), 0.030f, 0.005f, 2),
        aluminium_, t < 0.1f ? "upper yoke" : "lower yoke", moving({c.x, c.y - 0.015f, 0}) * lean);
  }
  // Shock absorbers with their springs.
  const Vec3f low{-0.64f, 0.345f, 0.148f}, high{-0.555f, 0.70f, 0.125f};
  putPair(bar({low, high}, 0.011f, 0, 12), chrome_, "damper rod");
  putPair(bar({low, lerp(low, high, 0.42f)}, 0.020f, 0, 8, 18), black_, "damper");
  const Vec3f axis = normalize(high - low), side = normalize(cross(axis, Vec3f(0, 0, 1))),
              other = cross(axis, side);
  const auto helix = [=](float t) {
    const float angle = kTwoPi * 9 * t;
    return lerp(low, high, 0.12f + 0.76f * t) +
           (side * std::cos(angle) + other * std::sin(angle)) * 0.030f;
  };
  putPair(tube(helix, 0.0058f, segments(180, 60), segments(8, 5)), chrome_, "spring");
  for (const float t : {0.10f, 0.90f})
    putPair(bar({lerp(low, high, t - 0.015f), lerp(low, high, t + 0.015f)}, 0.036f, 0, 2, 24),
            black_, t < 0.5f ? "lower spring seat" : "upper spring seat");
}

}  // namespace lobelia::builtin
