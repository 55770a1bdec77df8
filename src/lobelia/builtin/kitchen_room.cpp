// The kitchen's shell: walls with thickness that overlap at the corners, so that no light leaks;
// window, curtains, clock, picture. The window has no panes: light of a direction or a point would
// not find its way through them, and they would hardly be seen.
#include <cmath>

#include "lobelia/builtin/kitchen_kit.h"
#include "lobelia/builtin/noise.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin::kitchen {
namespace {

constexpr float kThickness = 0.25f;

void addShell(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const float t = kThickness;
  constexpr float kSharp = 1e-4f;
  const auto wall = [&](Vec3f low, Vec3f high, MaterialHandle material, const char* name) {
    kit.box(low, high, material, name, kSharp);
  };
  wall({-t, -t, -t}, {kWidth + t, 0, kDepth + t}, m.floor, "floor");
  wall({-t, kHeight, -t}, {kWidth + t, kHeight + t, kDepth + t}, m.ceiling, "ceiling");
  wall({-t, -t, -t}, {kWidth + t, kHeight + t, 0}, m.paint, "back wall");
  wall({-t, -t, kDepth}, {kWidth + t, kHeight + t, kDepth + t}, m.paint, "front wall");
  wall({kWidth, -t, -t}, {kWidth + t, kHeight + t, kDepth + t}, m.paint, "right wall");
  wall({-t, -t, -t}, {0, kWindowLow, kDepth + t}, m.paint, "left wall, below the window");
  wall({-t, kWindowHigh, -t}, {0, kHeight + t, kDepth + t}, m.paint, "left wall, above the window");
  wall({-t, kWindowLow - t, -t}, {0, kWindowHigh + t, kWindowBack}, m.paint,
       "left wall, behind the window");
  wall({-t, kWindowLow - t, kWindowFront}, {0, kWindowHigh + t, kDepth + t}, m.paint,
       "left wall, before the window");
  // Tiles behind the worktops; skirting boards where walls are bare.
  wall({0, 0.85f, -0.05f}, {3.66f, kHeight, 0.010f}, m.wallTiles, "tiles at the back");
  wall({-0.05f, 0.85f, 0}, {0.010f, kWindowLow - 0.02f, 3.54f}, m.wallTiles, "tiles on the left");
  kit.box({-0.01f, 0, 3.56f}, {0.018f, 0.10f, kDepth}, m.trim, "skirting board, left", 0.006f);
  kit.box({kWidth - 0.018f, 0, 0.72f}, {kWidth + 0.01f, 0.10f, kDepth}, m.trim,
          "skirting board, right", 0.006f);
  kit.box({0, 0, kDepth - 0.018f}, {kWidth, 0.10f, kDepth + 0.01f}, m.trim, "skirting board, front",
          0.006f);
}

void addWindow(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  constexpr float kOut = -0.17f, kIn = -0.10f;  // the frame's place in the wall
  constexpr float kBar = 0.045f, kThin = 0.014f;
  const auto bar = [&](float y0, float y1, float z0, float z1) {
    kit.box({kOut, y0, z0}, {kIn, y1, z1}, m.trim, "window bar", 0.006f);
  };
  const float middle = 0.5f * (kWindowBack + kWindowFront);
  bar(kWindowLow, kWindowLow + kBar, kWindowBack, kWindowFront);
  bar(kWindowHigh - kBar, kWindowHigh, kWindowBack, kWindowFront);
  for (const float z : {kWindowBack, middle - kBar / 2, kWindowFront - kBar})
    bar(kWindowLow, kWindowHigh, z, z + kBar);
  for (const float z : {0.5f * (kWindowBack + middle), 0.5f * (kWindowFront + middle)})
    bar(kWindowLow, kWindowHigh, z - kThin, z + kThin);
  const float third = (kWindowHigh - kWindowLow) * 0.66f + kWindowLow;
  bar(third - kThin, third + kThin, kWindowBack, kWindowFront);
  kit.box({-0.10f, kWindowLow - 0.03f, kWindowBack - 0.06f},
          {0.13f, kWindowLow + 0.005f, kWindowFront + 0.06f}, m.marble, "window sill", 0.006f);
  // Handles of the casements.
  const Mesh handle = tube(roundedPath({{0, 0, 0}, {0.035f, 0, 0}, {0.035f, -0.10f, 0}}, 0.015f),
                           0.006f, kit.segments(14, 6), kit.segments(10, 6));
  const double y = 0.5 * static_cast<double>(kWindowLow + kWindowHigh) - 0.1;
  const MeshHandle shape = kit.add(handle, "window handle");
  for (const double dz : {-0.045, 0.045})
    kit.put(shape, translation({static_cast<double>(kIn), y, static_cast<double>(middle) + dz}),
            m.brass, "window handle");
}

// A cloth that hangs in folds from y = 0 down, its folds wider towards the hem.
Mesh curtainMesh(const KitchenKit& kit, float width, float height, uint64_t seed) {
  Mesh mesh = heightfield(width, height, kit.segments(56, 12), kit.segments(14, 4), [&](Vec2f uv) {
    const float fold =
        std::sin(kTwoPi * 5.5f * uv.x + 1.5f * noise(Vec3f(uv.x * 3, uv.y, 0), seed));
    return (0.012f + 0.016f * uv.y) * fold + 0.010f * noise(Vec3f(uv.x * 4, uv.y * 2, 5), seed);
  });
  // (x, height, z) hangs as (x, -z, height).
  return transformed(std::move(mesh), translation({0, -0.5 * static_cast<double>(height), 0}) *
                                          rotation({1, 0, 0}, 90));
}

void addCurtains(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const double top = static_cast<double>(kWindowHigh) + 0.10;
  const Curve rod = roundedPath({{0.075f, static_cast<float>(top), kWindowBack - 0.28f},
                                 {0.075f, static_cast<float>(top), kWindowFront + 0.28f}},
                                0);
  kit.put(tube(rod, 0.010f, 1, kit.segments(16, 8)), Mat4(), m.brass, "curtain rod");
  const MeshHandle knob =
      kit.add(ball(0.02f, kit.segments(12, 6), kit.segments(20, 8)), "curtain knob");
  constexpr float kPanel = 0.36f, kLength = 1.18f;
  uint64_t seed = 1;
  for (const bool front : {false, true}) {
    const float z = front ? kWindowFront + 0.08f : kWindowBack - 0.08f;
    const double end = static_cast<double>(front ? kWindowFront + 0.29f : kWindowBack - 0.29f);
    kit.put(knob, translation({0.075, top, end}), m.brass, "curtain knob");
    // Facing the room: the cloth's normal, +z, becomes +x.
    kit.put(curtainMesh(kit, kPanel, kLength, ++seed),
            translation({0.075, top, static_cast<double>(z)}) * rotation({0, 1, 0}, 90), m.curtain,
            "curtain");
    kit.box({-0.01f, static_cast<float>(top) - 0.015f,
             static_cast<float>(end) - 0.012f * (front ? 3.f : -1.f)},
            {0.075f, static_cast<float>(top) + 0.005f,
             static_cast<float>(end) + 0.012f * (front ? -1.f : 3.f)},
            m.brass, "curtain bracket");
  }
}

// Facing +z around the origin.
void addClock(KitchenKit& kit, const Mat4& at) {
  const KitchenPalette& m = kit.palette();
  const Mat4 facing = at * rotation({1, 0, 0}, 90);
  constexpr float kRadius = 0.15f;
  const int around = kit.segments(72, 16);
  kit.put(lathe({{0, 0},
                 {kRadius, 0},
                 {kRadius, 0.035f},
                 {kRadius - 0.004f, 0.040f},
                 {kRadius - 0.012f, 0.038f},
                 {kRadius - 0.014f, 0.022f}},
                around),
          facing, m.brass, "clock case");
  kit.put(disc(kRadius - 0.013f, around), facing * translation({0, 0.022, 0}), m.porcelain,
          "clock face");
  const MeshHandle mark = kit.add(kit.boxMesh({0.0025f, 0.001f, 0.010f}, 0.0005f), "clock mark");
  for (int hour = 0; hour < 12; ++hour)
    kit.put(mark, facing * rotation({0, 1, 0}, 30.0 * hour) * translation({0, 0.023, -0.112}),
            m.black, "clock mark");
  const auto hand = [&](float length, double turn, double lift) {
    kit.put(kit.boxMesh({0.003f, 0.001f, length / 2}, 0.0008f),
            facing * rotation({0, 1, 0}, -turn) *
                translation({0, lift, -static_cast<double>(length) / 2 + 0.012}),
            m.black, "clock hand");
  };
  hand(0.080f, 305, 0.025);
  hand(0.115f, 60, 0.028);
}

void addPicture(KitchenKit& kit, const Mat4& at, float halfX, float halfY) {
  const KitchenPalette& m = kit.palette();
  const auto bar = [&](float hx, float hy, double x, double y) {
    kit.put(kit.boxMesh({hx, hy, 0.012f}, 0.003f), at * translation({x, y, 0.012}), m.walnut,
            "picture frame");
  };
  const double x = static_cast<double>(halfX), y = static_cast<double>(halfY);
  bar(halfX + 0.03f, 0.015f, 0, y + 0.015);
  bar(halfX + 0.03f, 0.015f, 0, -y - 0.015);
  bar(0.015f, halfY, x + 0.015, 0);
  bar(0.015f, halfY, -x - 0.015, 0);
  kit.put(kit.boxMesh({halfX, halfY, 0.004f}, 0.0005f), at * translation({0, 0, 0.004}), m.trim,
          "passe-partout");
  kit.put(kit.boxMesh({halfX * 0.72f, halfY * 0.76f, 0.003f}, 0.0005f),
          at * translation({0, 0, 0.006}), m.paper, "print");
}

}  // namespace

void addRoom(KitchenKit& kit) {
  addShell(kit);
  addWindow(kit);
  addCurtains(kit);
  addClock(kit, translation({0, 1.80, 3.32}) * rotation({0, 1, 0}, 90));
  const Mat4 right = rotation({0, 1, 0}, -90);
  addPicture(kit, translation({static_cast<double>(kWidth), 1.6, 1.6}) * right, 0.26f, 0.34f);
  addPicture(kit, translation({static_cast<double>(kWidth), 1.6, 2.35}) * right, 0.26f, 0.34f);
}

}  // namespace lobelia::builtin::kitchen
