// The kitchen's stove with grates and oven, the extractor hood, the fridge.
#include <cmath>

#include "lobelia/builtin/kitchen_kit.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin::kitchen {
namespace {

constexpr float kMiddle = 0.5f * (kStoveLeft + kStoveRight);
double toDouble(float v) { return static_cast<double>(v); }

// Along x between two feet at z = 0.
Mesh barHandle(const KitchenKit& kit, float length, float out, float radius) {
  const float h = length / 2;
  return merged({tube(roundedPath({{-h, 0, out}, {h, 0, out}}, 0), radius, 1, kit.segments(24, 8)),
                 tube(roundedPath({{-h + 0.06f, 0, 0}, {-h + 0.06f, 0, out}}, 0), radius * 0.75f, 1,
                      kit.segments(16, 6)),
                 tube(roundedPath({{h - 0.06f, 0, 0}, {h - 0.06f, 0, out}}, 0), radius * 0.75f, 1,
                      kit.segments(16, 6))});
}

void addBurners(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const int around = kit.segments(40, 12);
  const MeshHandle bowl = kit.add(lathe({{0, 0},
                                         {0.055f, 0},
                                         {0.06f, 0.004f},
                                         {0.052f, 0.012f},
                                         {0.038f, 0.014f},
                                         {0.038f, 0.022f},
                                         {0.034f, 0.026f},
                                         {0, 0.028f}},
                                        around),
                                  "burner");
  // A square grate: a frame on feet with fingers towards the middle.
  std::vector<Mesh> parts;
  constexpr float kHalf = 0.135f, kBar = 0.005f, kUp = 0.042f;
  const auto bar = [&](Vec3f a, Vec3f b) {
    const Vec3f c = (a + b) * 0.5f, h = max((b - a) * 0.5f, Vec3f(kBar));
    parts.push_back(translated(kit.boxMesh(h, 0.002f), c));
  };
  for (const float s : {-kHalf, kHalf}) {
    bar({-kHalf - kBar, kUp - kBar, s}, {kHalf + kBar, kUp - kBar, s});
    bar({s, kUp - kBar, -kHalf}, {s, kUp - kBar, kHalf});
    for (const float r : {-kHalf, kHalf}) bar({s, 0, r}, {s, kUp - kBar, r});
  }
  bar({-kHalf, kUp - kBar, 0}, {-0.035f, kUp - kBar, 0});
  bar({0.035f, kUp - kBar, 0}, {kHalf, kUp - kBar, 0});
  bar({0, kUp - kBar, -kHalf}, {0, kUp - kBar, -0.035f});
  bar({0, kUp - kBar, 0.035f}, {0, kUp - kBar, kHalf});
  const MeshHandle grate = kit.add(merged(parts), "grate");
  const double top = toDouble(kWorktop) + 0.006;
  for (const double dx : {-0.295, 0.0, 0.295})
    for (const double z : {0.185, 0.475}) {
      const Mat4 at = translation({toDouble(kMiddle) + dx, top, z});
      kit.put(bowl, at, m.iron, "burner");
      kit.put(grate, at, m.iron, "grate");
    }
}

void addStove(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const float left = kStoveLeft + 0.002f, right = kStoveRight - 0.002f, front = 0.645f;
  kit.box({left, 0.10f, 0.01f}, {right, kWorktop, front}, m.steel, "stove", 0.004f);
  kit.box({left + 0.02f, kWorktop - 0.01f, 0.03f},
          {right - 0.02f, kWorktop + 0.005f, front - 0.02f}, m.blackGlass, "hob", 0.003f);
  kit.box({left, kWorktop - 0.02f, 0.008f}, {right, kWorktop + 0.07f, 0.035f}, m.steel, "upstand",
          0.004f);
  for (const float x : {left + 0.05f, right - 0.05f})
    for (const double z : {0.10, 0.56})
      kit.put(cylinder(0.022f, 0.105f, 0.003f, 2, kit.segments(24, 8)),
              translation({toDouble(x), 0, z}), m.chrome, "stove foot");
  addBurners(kit);

  // Oven doors, one wide and one narrow, each with a pane and a bar.
  const auto door = [&](float x0, float x1, float y0, float y1) {
    const float z = front + 0.026f;
    kit.box({x0, y0, front - 0.004f}, {x1, y1, z}, m.steel, "oven door", 0.005f);
    kit.box({x0 + 0.07f, y0 + 0.07f, z - 0.01f}, {x1 - 0.07f, y1 - 0.12f, z + 0.002f}, m.blackGlass,
            "oven window", 0.002f);
    kit.put(barHandle(kit, x1 - x0 - 0.06f, 0.05f, 0.011f),
            translation({0.5 * toDouble(x0 + x1), toDouble(y1) - 0.055, toDouble(z) - 0.002}),
            m.chrome, "oven handle");
  };
  door(left + 0.012f, right - 0.330f, 0.15f, 0.745f);
  door(right - 0.318f, right - 0.012f, 0.15f, 0.745f);
  kit.box({left + 0.012f, 0.765f, front - 0.004f}, {right - 0.012f, 0.895f, front + 0.014f},
          m.steel, "control panel", 0.006f);
  const MeshHandle knob = kit.add(lathe({{0, 0},
                                         {0.026f, 0},
                                         {0.026f, 0.008f},
                                         {0.020f, 0.010f},
                                         {0.018f, 0.032f},
                                         {0.016f, 0.034f},
                                         {0, 0.034f}},
                                        kit.segments(40, 10)),
                                  "knob");
  const MeshHandle pointer = kit.add(kit.boxMesh({0.0015f, 0.001f, 0.008f}, 0.0004f), "pointer");
  for (int i = 0; i < 8; ++i) {
    const Mat4 at =
        translation({toDouble(left) + 0.085 + 0.106 * i, 0.83, toDouble(front) + 0.013}) *
        rotation({0, 0, 1}, i % 3 == 0 ? -40 : 0) * rotation({1, 0, 0}, 90);
    kit.put(knob, at, m.brass, "knob");
    kit.put(pointer, at * translation({0, 0.0345, -0.009}), m.black, "knob pointer");
  }
}

void addHood(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const double back = 0.26;
  const Polygon lip = rectangle(0.455f, 0.25f), flue = rectangle(0.15f, 0.14f);
  const auto shifted = [](Polygon p, float by) {
    for (Vec2f& v : p) v.y += by;
    return p;
  };
  const Mat4 at = translation({toDouble(kMiddle), toDouble(kHoodLow), back});
  // The outside; inside a recess with filters and lamps.
  Mesh skin = loft({{lip, 0},
                    {lip, 0.055f},
                    {shifted(flue, 0.11f), 0.30f},
                    {shifted(flue, 0.11f), kHeight - kHoodLow + 0.01f}},
                   false, false, 10);
  kit.put(std::move(skin), at, m.steelUpright, "hood");
  kit.put(loft({{rectangle(0.435f, 0.23f), 0.02f}, {rectangle(0.435f, 0.23f), 0.0f}, {lip, 0.0f}},
               false, false, 10),
          at * scaling({1, 1, 1}), m.steelDark, "hood lip");
  kit.box({kMiddle - 0.44f, kHoodLow + 0.018f, 0.02f}, {kMiddle + 0.44f, kHoodLow + 0.03f, 0.50f},
          m.iron, "hood ceiling", 0.001f);
  std::vector<Mesh> slats;
  for (int i = 0; i < 13; ++i)
    slats.push_back(translated(kit.boxMesh({0.19f, 0.003f, 0.006f}, 0.001f),
                               {0, 0, 0.024f * static_cast<float>(i)}));
  const MeshHandle filter = kit.add(merged(slats), "filter");
  for (const double dx : {-0.215, 0.215})
    kit.put(filter, translation({toDouble(kMiddle) + dx, toDouble(kHoodLow) + 0.015, 0.10}),
            m.iron, "filter");
  // A rail along the lip.
  kit.put(barHandle(kit, 0.84f, 0.035f, 0.007f),
          translation({toDouble(kMiddle), toDouble(kHoodLow) + 0.028, back + 0.249}), m.chrome,
          "hood rail");
}

void addFridge(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  constexpr float kLeft = 3.635f, kRight = 4.595f, kTop = 1.975f, kFront = 0.70f;
  kit.box({kLeft, 0.02f, 0.02f}, {kRight, kTop, kFront - 0.07f}, m.steelDark, "fridge", 0.004f);
  const float middle = 0.5f * (kLeft + kRight);
  const auto door = [&](float x0, float x1, float y0, float y1) {
    kit.box({x0, y0, kFront - 0.066f}, {x1, y1, kFront}, m.steelUpright, "fridge door", 0.010f);
  };
  door(kLeft + 0.003f, middle - 0.003f, 0.66f, kTop - 0.003f);
  door(middle + 0.003f, kRight - 0.003f, 0.66f, kTop - 0.003f);
  door(kLeft + 0.003f, kRight - 0.003f, 0.06f, 0.652f);
  const Mesh handle = barHandle(kit, 0.80f, 0.05f, 0.011f);
  const MeshHandle shape = kit.add(handle, "fridge handle");
  for (const double s : {-1.0, 1.0})
    kit.put(shape,
            translation({toDouble(middle) + 0.05 * s, 1.22, toDouble(kFront) - 0.002}) *
                rotation({0, 0, 1}, 90),
            m.chrome, "fridge handle");
  kit.put(shape, translation({toDouble(middle), 0.60, toDouble(kFront) - 0.002}), m.chrome,
          "fridge handle");
}

}  // namespace

void addAppliances(KitchenKit& kit) {
  addStove(kit);
  addHood(kit);
  addFridge(kit);
}

}  // namespace lobelia::builtin::kitchen
