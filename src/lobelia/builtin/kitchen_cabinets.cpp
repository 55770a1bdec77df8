// The kitchen's cabinets with framed doors and drawers, worktops of brushed steel with a sink let
// in, wall cabinets and open shelves.
#include <cmath>

#include "lobelia/builtin/kitchen_kit.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin::kitchen {
namespace {

constexpr float kFront = 0.60f, kThick = 0.022f, kGap = 0.0035f;
constexpr float kPlinth = 0.11f, kTop = kWorktop - 0.04f;

// A panel in a frame, facing +z, its back at z = 0, around the origin.
Mesh framedPanel(const KitchenKit& kit, float width, float height) {
  const float x = width / 2 - kGap / 2, y = height / 2 - kGap / 2,
              rail = std::min(0.058f, 0.28f * height);
  const auto part = [&](float hx, float hy, float hz, float cx, float cy) {
    return translated(kit.boxMesh({hx, hy, hz}, 0.0025f), {cx, cy, hz});
  };
  return merged({part(x, rail / 2, kThick / 2, 0, y - rail / 2),
                 part(x, rail / 2, kThick / 2, 0, -y + rail / 2),
                 part(rail / 2, y - rail, kThick / 2, x - rail / 2, 0),
                 part(rail / 2, y - rail, kThick / 2, -x + rail / 2, 0),
                 part(x - rail + 0.002f, y - rail + 0.002f, kThick * 0.27f, 0, 0)});
}

// A bar on two feet, along x, around the origin at z = 0.
Mesh handleMesh(const KitchenKit& kit, float length) {
  const float h = length / 2, out = 0.034f;
  return tube(roundedPath({{-h, 0, 0}, {-h, 0, out}, {h, 0, out}, {h, 0, 0}}, 0.012f), 0.0055f,
              kit.segments(22, 8), kit.segments(12, 6));
}

// Where fronts are mounted: x to the right along the cabinets, y up, z out of them.
class Fronts {
 public:
  Fronts(KitchenKit& kit, const Mat4& at, MaterialHandle material)
      : kit_(kit),
        at_(at),
        material_(material),
        handle_(kit.add(handleMesh(kit, 0.14f), "handle")) {}

  enum class Handle { top, leftUpper, rightUpper, leftLower, rightLower };
  void add(float x0, float x1, float y0, float y1, Handle handle, MaterialHandle material) {
    const double x = mid(x0, x1), y = mid(y0, y1);
    kit_.put(framedPanel(kit_, x1 - x0, y1 - y0), at_ * translation({x, y, 0}), material, "front");
    const double side = 0.5 * static_cast<double>(x1 - x0) - 0.031,
                 end = 0.5 * static_cast<double>(y1 - y0);
    const Mat4 upright = rotation({0, 0, 1}, 90);
    const double out = static_cast<double>(kThick) - 0.001;
    const auto mount = [&](double dx, double dy, const Mat4& turn) {
      kit_.put(handle_, at_ * translation({x + dx, y + dy, out}) * turn, kit_.palette().brass,
               "handle");
    };
    switch (handle) {
      case Handle::top:
        return mount(0, end - 0.031, Mat4());
      case Handle::leftUpper:
        return mount(-side, end - 0.16, upright);
      case Handle::rightUpper:
        return mount(side, end - 0.16, upright);
      case Handle::leftLower:
        return mount(-side, -end + 0.16, upright);
      case Handle::rightLower:
        return mount(side, -end + 0.16, upright);
    }
  }
  void add(float x0, float x1, float y0, float y1, Handle handle) {
    add(x0, x1, y0, y1, handle, material_);
  }
  void drawers(float x0, float x1, float y0, float y1) {
    const float h = y1 - y0;
    add(x0, x1, y1 - 0.24f * h, y1, Handle::top);
    add(x0, x1, y0 + 0.38f * h, y1 - 0.24f * h, Handle::top);
    add(x0, x1, y0, y0 + 0.38f * h, Handle::top);
  }
  void doors(float x0, float x1, float y0, float y1, bool handlesBelow) {
    const float x = 0.5f * (x0 + x1);
    add(x0, x, y0, y1, handlesBelow ? Handle::rightLower : Handle::rightUpper);
    add(x, x1, y0, y1, handlesBelow ? Handle::leftLower : Handle::leftUpper);
  }

 private:
  static double mid(float a, float b) { return 0.5 * static_cast<double>(a + b); }
  KitchenKit& kit_;
  Mat4 at_;
  MaterialHandle material_;
  MeshHandle handle_;
};

void addBaseCabinets(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const auto carcass = [&](Vec3f low, Vec3f high) { kit.box(low, high, m.carcass, "carcass"); };
  carcass({0.02f, kPlinth, 0.02f}, {kStoveLeft - 0.01f, kTop, kFront - 0.002f});
  carcass({0.02f, kPlinth, 0.30f}, {kFront - 0.002f, kTop, 3.50f});
  carcass({kStoveRight + 0.01f, kPlinth, 0.02f}, {3.60f, kTop, kFront - 0.002f});
  const auto plinth = [&](Vec3f low, Vec3f high) { kit.box(low, high, m.steelDark, "plinth"); };
  plinth({0.5f, -0.01f, kFront - 0.07f}, {kStoveLeft - 0.01f, kPlinth, kFront - 0.05f});
  plinth({kFront - 0.07f, -0.01f, 0.5f}, {kFront - 0.05f, kPlinth, 3.50f});
  plinth({kStoveRight + 0.01f, -0.01f, kFront - 0.07f}, {3.60f, kPlinth, kFront - 0.05f});
  kit.box({0.01f, 0, 3.50f}, {kFront + kThick, kTop, 3.522f}, m.lacquer, "end panel");
  kit.box({3.60f, 0, 0.01f}, {3.622f, 2.36f, 0.66f}, m.lacquer, "end panel");

  using Handle = Fronts::Handle;
  Fronts back(kit, translation({0, 0, static_cast<double>(kFront)}), m.lacquer);
  back.drawers(0.645f, 1.09f, kPlinth, kTop);
  back.add(1.09f, kStoveLeft - 0.012f, kPlinth, kTop, Handle::leftUpper);
  back.drawers(kStoveRight + 0.012f, 3.03f, kPlinth, kTop);
  back.add(3.03f, 3.598f, kPlinth, kTop, Handle::leftUpper);
  // Along the left wall x runs from the front to the back.
  const double front = 3.5;
  Fronts left(kit, translation({static_cast<double>(kFront), 0, front}) * rotation({0, 1, 0}, 90),
              m.lacquer);
  left.drawers(0.002f, 0.55f, kPlinth, kTop);
  left.doors(0.55f, 1.15f, kPlinth, kTop - 0.14f, false);
  left.add(0.55f, 1.15f, kTop - 0.14f, kTop, Handle::top);
  left.doors(1.15f, 2.15f, kPlinth, kTop, false);
  left.add(2.15f, 2.852f, kPlinth, kTop, Handle::rightUpper);
}

void addSink(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const int n = kit.segments(8, 3);
  const auto outline = [&](float in) {
    return rounded(rectangle(0.36f - in, 0.205f - in), 0.055f, n);
  };
  // From the rim inwards and down; seen from above.
  std::vector<Ring> rings{
      {outline(-0.012f), 0.0f}, {outline(-0.010f), 0.0025f}, {outline(-0.001f), 0.0025f}};
  for (int i = 0; i <= n; ++i) {
    const float a = kPi / 2 * fraction(i, n);
    rings.push_back({outline(0.006f * std::sin(a)), 0.0025f - 0.006f * (1 - std::cos(a))});
  }
  constexpr float kDeep = 0.19f, kRound = 0.035f;
  for (int i = 0; i <= n; ++i) {
    const float a = kPi / 2 * fraction(i, n);
    rings.push_back(
        {outline(0.012f + kRound * (1 - std::cos(a))), -kDeep + kRound * (1 - std::sin(a))});
  }
  Mesh basin = loft(rings, false, true, 60);
  const Mat4 at =
      translation({0.325, static_cast<double>(kWorktop), 1.80}) * rotation({0, 1, 0}, 90);
  kit.put(std::move(basin), at, m.steelDark, "sink");
  kit.put(
      lathe({{0.045f, 0}, {0.042f, 0.004f}, {0.03f, 0.002f}, {0.0f, 0.001f}}, kit.segments(32, 10)),
      at * translation({0, -0.19, 0}), m.chrome, "drain");

  // Tap.
  const Mat4 foot = translation({0.085, static_cast<double>(kWorktop), 1.80});
  const int around = kit.segments(32, 10);
  kit.put(lathe({{0, 0},
                 {0.028f, 0},
                 {0.028f, 0.006f},
                 {0.022f, 0.010f},
                 {0.020f, 0.05f},
                 {0.016f, 0.056f},
                 {0, 0.056f}},
                around),
          foot, m.chrome, "tap, foot");
  std::vector<Vec3f> neck{{0, 0.05f, 0}, {0, 0.15f, 0}, {0, 0.25f, 0}};
  for (int i = 0; i <= 12; ++i) {
    const float a = kPi * fraction(i, 12);
    neck.push_back({0.085f * (1 - std::cos(a)), 0.29f + 0.085f * std::sin(a), 0});
  }
  neck.push_back({0.172f, 0.25f, 0});
  kit.put(tube(smoothCurve3(neck), 0.0115f, kit.segments(64, 16), kit.segments(24, 8)), foot,
          m.chrome, "tap");
  kit.put(tube(roundedPath({{0, 0.035f, 0}, {0, 0.035f, 0.05f}, {0, 0.085f, 0.065f}}, 0.012f),
               0.006f, kit.segments(20, 6), kit.segments(14, 6)),
          foot, m.chrome, "tap, lever");
}

void addWorktops(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  constexpr float kEdge = 0.645f, kBevel = 0.004f;
  const auto slab = [&](float x0, float z0, float x1, float z1, MaterialHandle material) {
    kit.box({x0, kTop, z0}, {x1, kWorktop, z1}, material, "worktop", kBevel);
  };
  // Brushed lengthwise.
  slab(0.005f, 0.005f, kStoveLeft - 0.004f, kEdge, m.steel);
  slab(kStoveRight + 0.004f, 0.005f, 3.598f, kEdge, m.steel);
  // Around the sink.
  constexpr float kSink0 = 1.44f, kSink1 = 2.16f, kIn = 0.12f, kOut = 0.53f;
  slab(0.005f, kEdge, kEdge, kSink0, m.steelUpright);
  slab(0.005f, kSink1, kEdge, 3.53f, m.steelUpright);
  slab(0.005f, kSink0, kIn, kSink1, m.steelUpright);
  slab(kOut, kSink0, kEdge, kSink1, m.steelUpright);
  addSink(kit);
}

void addWallCabinets(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  constexpr float kLow = 1.50f, kHigh = 2.36f, kDeep = 0.36f;
  kit.box({2.66f, kLow, 0.005f}, {3.60f, kHigh, kDeep - 0.002f}, m.pale, "wall cabinet");
  kit.box({3.62f, 1.99f, 0.005f}, {kWidth + 0.01f, kHigh, 0.638f}, m.lacquer,
          "cabinet above the fridge");
  Fronts wall(kit, translation({0, 0, static_cast<double>(kDeep)}), m.pale);
  wall.doors(2.66f, 3.60f, kLow, kHigh, true);
  Fronts high(kit, translation({0, 0, 0.64}), m.lacquer);
  high.doors(3.625f, 4.60f, 1.99f, kHigh, true);
  kit.box({4.602f, 0, 0.4f}, {kWidth + 0.01f, kHigh, 0.662f}, m.lacquer, "filler");
  // Closed up to the ceiling.
  kit.box({2.66f, kHigh + 0.002f, 0.005f}, {3.61f, kHeight + 0.01f, kDeep - 0.015f}, m.paint,
          "soffit", 1e-3f);
  kit.box({3.60f, kHigh + 0.002f, 0.005f}, {kWidth + 0.01f, kHeight + 0.01f, 0.63f}, m.paint,
          "soffit", 1e-3f);
  kit.box({2.64f, kHigh - 0.004f, 0.005f}, {3.61f, kHigh + 0.03f, kDeep + 0.035f}, m.pale,
          "cornice", 0.008f);
}

void addShelves(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const Mesh bracket =
      tube(roundedPath({{0, -0.16f, 0}, {0, -0.03f, 0}, {0, -0.006f, 0.03f}, {0, -0.006f, 0.22f}},
                       0.02f),
           0.006f, kit.segments(20, 6), kit.segments(10, 6));
  const MeshHandle shape = kit.add(bracket, "bracket");
  for (const float y : {kShelfLow, kShelfHigh, kShelfHigh + 0.40f}) {
    kit.box({0.06f, y - 0.034f, 0.008f}, {1.40f, y, 0.265f}, m.oak, "shelf", 0.003f);
    for (const double x : {0.22, 0.73, 1.24})
      kit.put(shape, translation({x, static_cast<double>(y) - 0.034, 0.012}), m.brass, "bracket");
  }
}

}  // namespace

void addCabinets(KitchenKit& kit) {
  addBaseCabinets(kit);
  addWorktops(kit);
  addWallCabinets(kit);
  addShelves(kit);
}

}  // namespace lobelia::builtin::kitchen
