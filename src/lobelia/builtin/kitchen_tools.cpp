// Tools on the kitchen's worktops: knife block, boards, mills, toaster, scales, a pot of spoons,
// towel.
#include <cmath>

#include "lobelia/base/random.h"
#include "lobelia/builtin/kitchen_kit.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin::kitchen {
namespace {

const double kTop = static_cast<double>(kWorktop);

void addKnifeBlock(KitchenKit& kit, Vec3d at, double turn) {
  const KitchenPalette& m = kit.palette();
  const Mat4 base = translation(at) * rotation({0, 1, 0}, turn);
  // A leaning block: its side view, extruded across.
  const Polygon side = rounded(
      Polygon{{-0.07f, 0}, {0.06f, 0}, {0.10f, 0.075f}, {-0.015f, 0.215f}, {-0.085f, 0.16f}},
      0.006f, kit.segments(2, 1));
  kit.put(transformed(extrude(side, 0.10f, 0.003f, kit.segments(2, 1)),
                      translation({0, 0, -0.05}) * rotation({1, 0, 0}, 90)),
          base, m.walnut, "knife block");
  const MeshHandle grip = kit.add(kit.boxMesh({0.009f, 0.048f, 0.013f}, 0.005f), "knife grip"),
                   bolster =
                       kit.add(kit.boxMesh({0.007f, 0.008f, 0.011f}, 0.002f), "knife bolster");
  // The slanted face runs from (0.10, 0.075) to (-0.015, 0.215); its normal leans to +x.
  for (int row = 0; row < 2; ++row)
    for (int i = 0; i < 3; ++i) {
      const double t = row == 0 ? 0.32 : 0.72;
      const Mat4 to = base * translation({0.10 - 0.115 * t, 0.075 + 0.14 * t, -0.03 + 0.03 * i}) *
                      rotation({0, 0, 1}, -50.6);
      kit.put(bolster, to * translation({0, 0.006, 0}), m.chrome, "knife bolster");
      kit.put(grip, to * translation({0, 0.058 - 0.006 * i, 0}), m.black, "knife grip");
    }
}

void addBoards(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const int n = kit.segments(8, 3);
  // Leaning on the tiles.
  const auto lean = [&](float halfX, float height, float thick, double x, double z, double tilt,
                        MaterialHandle material) {
    const Mesh board = extrude(rounded(rectangle(halfX, height / 2), 0.025f, n), thick, 0.004f,
                               kit.segments(3, 1));
    kit.put(board,
            translation({x, kTop + 0.001, z}) * rotation({1, 0, 0}, 90 - tilt) *
                translation({0, 0, -0.5 * static_cast<double>(height)}),
            material, "board");
  };
  lean(0.15f, 0.36f, 0.020f, 2.78, 0.085, 10, m.oak);
  lean(0.12f, 0.27f, 0.018f, 2.90, 0.115, 12, m.walnut);
}

void addMills(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const auto curve = smoothCurve({{0, 0},
                                  {0.026f, 0},
                                  {0.028f, 0.006f},
                                  {0.022f, 0.035f},
                                  {0.019f, 0.070f},
                                  {0.024f, 0.105f},
                                  {0.021f, 0.122f},
                                  {0.016f, 0.130f},
                                  {0.023f, 0.150f},
                                  {0.018f, 0.172f},
                                  {0.007f, 0.178f},
                                  {0.009f, 0.188f},
                                  {0, 0.194f}});
  const MeshHandle mill = kit.add(
      revolve([curve](float t) { return t <= 0 || t >= 1 ? Vec2f(0, curve(t).y) : curve(t); },
              kit.segments(48, 14), kit.segments(36, 10)),
      "mill");
  kit.put(mill, translation({1.20, kTop, 0.15}), m.walnut, "mill");
  kit.put(mill, translation({1.135, kTop, 0.12}) * scaling({1, 0.85, 1}), m.oak, "mill");
}

void addToaster(KitchenKit& kit, Vec3d at, double turn) {
  const KitchenPalette& m = kit.palette();
  const Mat4 base = translation(at) * rotation({0, 1, 0}, turn);
  kit.put(superellipsoid({0.15f, 0.09f, 0.085f}, 0.35f, 0.35f, kit.segments(36, 10),
                         kit.segments(64, 16)),
          base * translation({0, 0.105, 0}), m.chrome, "toaster");
  kit.put(kit.boxMesh({0.135f, 0.012f, 0.075f}, 0.006f), base * translation({0, 0.012, 0}), m.black,
          "toaster foot");
  for (const double z : {-0.028, 0.028})
    kit.put(kit.boxMesh({0.10f, 0.0025f, 0.013f}, 0.001f), base * translation({0, 0.194, z}),
            m.black, "toaster slot");
  kit.put(kit.boxMesh({0.012f, 0.007f, 0.018f}, 0.003f), base * translation({0.158, 0.135, 0}),
          m.black, "toaster lever");
  kit.put(cylinder(0.012f, 0.012f, 0.002f, 2, kit.segments(24, 8)),
          base * translation({0.145, 0.06, 0}) * rotation({0, 0, 1}, -90), m.black, "toaster dial");
}

void addSpoonPot(KitchenKit& kit, Vec3d at) {
  const KitchenPalette& m = kit.palette();
  kit.put(lathe({{0, 0},
                 {0.050f, 0},
                 {0.055f, 0.005f},
                 {0.058f, 0.08f},
                 {0.055f, 0.150f},
                 {0.053f, 0.152f},
                 {0.051f, 0.150f},
                 {0.053f, 0.08f},
                 {0.050f, 0.010f},
                 {0, 0.010f}},
                kit.segments(48, 12)),
          translation(at), m.enamel, "spoon pot");
  const Mesh stem =
      tube(roundedPath({{0, 0.012f, 0}, {0, 0.26f, 0}}, 0), 0.005f, 1, kit.segments(10, 6));
  const Mesh spoon =
      merged({stem, transformed(superellipsoid({0.024f, 0.036f, 0.006f}, 1, 1, kit.segments(12, 6),
                                               kit.segments(20, 8)),
                                translation({0, 0.285, 0}))});
  const Mesh turner =
      merged({stem, translated(kit.boxMesh({0.022f, 0.040f, 0.0035f}, 0.002f), {0, 0.29f, 0})});
  const MeshHandle shapes[2] = {kit.add(spoon, "wooden spoon"), kit.add(turner, "wooden turner")};
  for (int i = 0; i < 6; ++i) {
    const double angle = 60.0 * i + 15;
    kit.put(shapes[i % 2],
            translation(at) * rotation({0, 1, 0}, angle) * translation({0.018, 0, 0}) *
                rotation({0, 0, 1}, -8 - 2 * (i % 3)) * rotation({0, 1, 0}, 50.0 * i),
            i % 3 == 0 ? m.walnut : m.oak, "wooden spoon");
  }
}

// Hangs over the oven's handle.
void addTowel(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  constexpr float kHalf = 0.10f, kRadius = 0.014f, kFrontLength = 0.30f, kBackLength = 0.20f;
  const float total = kFrontLength + kBackLength + kPi * kRadius;
  Mesh mesh =
      heightfield(1, 1, kit.segments(20, 6), kit.segments(60, 16), [](Vec2f) { return 0.f; });
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec2f uv = mesh.uvs[i];
    const float s = uv.y * total, x = (2 * uv.x - 1) * kHalf;
    float y, z, out = 0;
    if (s < kBackLength) {
      y = -(kBackLength - s), z = -kRadius;
    } else if (s < kBackLength + kPi * kRadius) {
      const float a = (s - kBackLength) / kRadius;
      y = kRadius * std::sin(a), z = -kRadius * std::cos(a);
    } else {
      y = -(s - kBackLength - kPi * kRadius), z = kRadius;
      out = std::min(-y / 0.1f, 1.f);
    }
    mesh.positions[i] = {x * (1 - 0.05f * out), y,
                         z + out * 0.006f * (1 + std::sin(kTwoPi * 2.2f * uv.x + 0.6f))};
  }
  kit.put(creased(std::move(mesh), -1),
          translation(
              {0.5 * static_cast<double>(kStoveLeft + kStoveRight) - 0.24, 0.690, 0.669 + 0.050}),
          m.cloth, "tea towel");
}

void addCanisters(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const int around = kit.segments(48, 12);
  const MeshHandle body = kit.add(cylinder(0.055f, 0.15f, 0.006f, 3, around), "canister"),
                   lid = kit.add(lathe({{0, 0},
                                        {0.057f, 0},
                                        {0.057f, 0.014f},
                                        {0.052f, 0.020f},
                                        {0.012f, 0.023f},
                                        {0.010f, 0.030f},
                                        {0.015f, 0.040f},
                                        {0, 0.044f}},
                                       around),
                                 "canister lid");
  double x = 3.10;
  for (const double s : {1.15, 0.95, 0.78}) {
    const Mat4 at = translation({x, kTop, 0.14}) * scaling(Vec3d(s));
    kit.put(body, at, m.enamel, "canister");
    kit.put(lid, at * translation({0, 0.149, 0}), m.oak, "canister lid");
    x += 0.135 * s;
  }
}

}  // namespace

void addTools(KitchenKit& kit) {
  addKnifeBlock(kit, {0.92, kTop, 0.22}, -60);
  addBoards(kit);
  addMills(kit);
  addToaster(kit, {0.33, kTop, 0.36}, 45);
  addSpoonPot(kit, {2.56, kTop, 0.14});
  addTowel(kit);
  addCanisters(kit);
}

}  // namespace lobelia::builtin::kitchen
