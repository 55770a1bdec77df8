// The kitchen's island with a marble top, and its stools.
#include <cmath>

#include "lobelia/builtin/kitchen_kit.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin::kitchen {
namespace {

void addStool(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const int around = kit.segments(48, 12), fine = kit.segments(14, 6), along = kit.segments(12, 3);
  constexpr float kSeat = 0.66f;
  // A seat turned from one piece, a little hollow.
  std::vector<Vec2f> profile{{0, kSeat - 0.035f}, {0.13f, kSeat - 0.035f}};
  for (int i = 0; i <= fine; ++i) {
    const float a = kPi * fraction(i, fine);
    profile.push_back({0.155f + 0.0175f * std::sin(a), kSeat - 0.0175f - 0.0175f * std::cos(a)});
  }
  for (int i = 1; i <= fine; ++i) {
    const float r = 0.155f * (1 - fraction(i, fine));
    profile.push_back({r, kSeat - 0.014f * (1 - sqr(r / 0.155f))});
  }
  const MeshHandle seat = kit.add(withProjectedUvs(lathe(profile, around)), "stool seat");
  std::vector<Mesh> legs;
  const SweepOptions taper{.scale = [](float t) { return 1.15f - 0.4f * t; }};
  for (int i = 0; i < 4; ++i) {
    const Vec2f d = circle(2 * i + 1, 8);
    legs.push_back(
        tube(roundedPath(
                 {{0.105f * d.x, kSeat - 0.03f, 0.105f * d.y}, {0.195f * d.x, 0, 0.195f * d.y}}, 0),
             0.015f, along, kit.segments(16, 6), taper));
  }
  const MeshHandle leg = kit.add(merged(legs), "stool legs");
  SweepOptions closed;
  closed.closed = true;
  constexpr float kRing = 0.105f + 0.09f * 0.62f;
  const MeshHandle ring =
      kit.add(tube(
                  [](float t) {
                    return Vec3f(kRing * std::cos(kTwoPi * t), 0.25f, kRing * std::sin(kTwoPi * t));
                  },
                  0.007f, kit.segments(64, 16), kit.segments(12, 6), closed),
              "foot ring");
  const double z = static_cast<double>(kIsland.z + kIslandHalfZ);
  struct Place {
    double x, z, turn;
  };
  for (const Place p :
       {Place{1.86, z + 0.16, 10}, Place{2.50, z + 0.12, 38}, Place{3.10, z + 0.22, -14}}) {
    const Mat4 at = translation({p.x, 0, p.z}) * rotation({0, 1, 0}, p.turn);
    kit.put(seat, at, m.walnut, "stool seat");
    kit.put(leg, at, m.walnut, "stool legs");
    kit.put(ring, at, m.brass, "foot ring");
  }
}

}  // namespace

void addIsland(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const auto top =
      extrude(rounded(rectangle(kIslandHalfX, kIslandHalfZ), 0.02f, kit.segments(4, 2)), 0.035f,
              0.005f, kit.segments(4, 2));
  kit.put(top,
          translation({static_cast<double>(kIsland.x), static_cast<double>(kIsland.y) - 0.035,
                       static_cast<double>(kIsland.z)}),
          m.marble, "island top");
  const float x0 = kIsland.x - kIslandHalfX + 0.04f, x1 = kIsland.x + kIslandHalfX - 0.04f;
  const float z0 = kIsland.z - kIslandHalfZ + 0.03f, z1 = kIsland.z + kIslandHalfZ - 0.24f;
  const float high = kIsland.y - 0.035f;
  kit.box({x0, 0.10f, z0}, {x1, high, z1}, m.lacquer, "island", 0.003f);
  kit.box({x0 + 0.05f, -0.01f, z0 + 0.05f}, {x1 - 0.05f, 0.10f, z1 - 0.05f}, m.steelDark,
          "island plinth");
  // Panelled: frames on the back and on the ends.
  const auto frame = [&](const Mat4& at, float width) {
    const float y0 = 0.10f, rail = 0.07f, h = (high - y0) / 2;
    const auto part = [&](float hx, float hy, float x, float y) {
      return translated(kit.boxMesh({hx, hy, 0.009f}, 0.003f), {x, y0 + h + y, 0});
    };
    kit.put(merged({part(width / 2, rail / 2, 0, h - rail / 2),
                    part(width / 2, rail / 2, 0, -h + rail / 2),
                    part(rail / 2, h - rail, width / 2 - rail / 2, 0),
                    part(rail / 2, h - rail, -width / 2 + rail / 2, 0),
                    part(rail / 2, h - rail, 0, 0)}),
            at, m.lacquer, "island frame");
  };
  const auto d = [](float v) { return static_cast<double>(v); };
  frame(translation({d(kIsland.x), 0, d(z1) + 0.007}), x1 - x0);
  frame(translation({d(kIsland.x), 0, d(z0) - 0.007}), x1 - x0);
  frame(translation({d(x1) + 0.007, 0, 0.5 * d(z0 + z1)}) * rotation({0, 1, 0}, 90), z1 - z0);
  frame(translation({d(x0) - 0.007, 0, 0.5 * d(z0 + z1)}) * rotation({0, 1, 0}, 90), z1 - z0);
  addStool(kit);
}

}  // namespace lobelia::builtin::kitchen
