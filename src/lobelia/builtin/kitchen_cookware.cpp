// Pots, pans and a kettle on the stove; copper pans and tools that hang on a rail.
#include <cmath>

#include "lobelia/builtin/kitchen_kit.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin::kitchen {
namespace {

constexpr double kGrate = 0.968;  // height of the grates' upper side

// An open vessel: outside from the foot up, over the rim, inside down to the bottom.
std::vector<Vec2f> vessel(float foot, float rim, float height, float wall, float round, int fine) {
  std::vector<Vec2f> p{{0, 0}};
  for (int i = 0; i <= fine; ++i) {
    const float a = kPi / 2 * fraction(i, fine);
    p.push_back({foot - round * (1 - std::sin(a)), round * (1 - std::cos(a))});
  }
  for (int i = 0; i <= fine; ++i) {
    const float a = kPi * fraction(i, fine);
    p.push_back({rim - wall / 2 + wall / 2 * std::cos(a), height + wall / 2 * std::sin(a)});
  }
  for (int i = fine; i >= 0; --i) {
    const float a = kPi / 2 * fraction(i, fine);
    p.push_back({foot - wall - round * (1 - std::sin(a)), wall + round * (1 - std::cos(a))});
  }
  p.push_back({0, wall});
  return p;
}

Mesh loopHandle(const KitchenKit& kit, float radius, float y) {
  return tube(smoothCurve3({{radius - 0.004f, y, -0.045f},
                            {radius + 0.025f, y + 0.004f, -0.042f},
                            {radius + 0.042f, y + 0.008f, 0},
                            {radius + 0.025f, y + 0.004f, 0.042f},
                            {radius - 0.004f, y, 0.045f}}),
              0.006f, kit.segments(24, 8), kit.segments(12, 6));
}

void addStockPot(KitchenKit& kit, Vec3d at, double turn) {
  const KitchenPalette& m = kit.palette();
  const int around = kit.segments(72, 16), fine = kit.segments(8, 3);
  const Mat4 base = translation(at) * rotation({0, 1, 0}, turn);
  constexpr float kRadius = 0.115f, kHigh = 0.15f;
  kit.put(lathe(vessel(kRadius, kRadius, kHigh, 0.003f, 0.012f, fine), around), base, m.chrome,
          "stock pot");
  std::vector<Vec2f> lid{{0, -0.002f}, {kRadius - 0.001f, -0.002f}, {kRadius + 0.002f, 0.001f}};
  for (int i = 0; i <= fine; ++i) {
    const float t = fraction(i, fine);
    lid.push_back({(kRadius - 0.004f) * (1 - t), 0.004f + 0.022f * std::sin(kPi / 2 * t)});
  }
  const Mat4 top = base * translation({0, static_cast<double>(kHigh) + 0.005, 0});
  kit.put(lathe(lid, around), top, m.chrome, "pot lid");
  kit.put(lathe({{0, 0.024f},
                 {0.010f, 0.025f},
                 {0.008f, 0.035f},
                 {0.018f, 0.045f},
                 {0.016f, 0.050f},
                 {0, 0.052f}},
                kit.segments(32, 10), 60),
          top, m.black, "lid knob");
  const Mesh handle = loopHandle(kit, kRadius, 0.11f);
  kit.put(merged({handle, transformed(handle, rotation({0, 1, 0}, 180))}), base, m.chrome,
          "pot handles");
}

// A pan with a long handle along +x; its rim at `height`.
struct Pan {
  MeshHandle body, handle;
  MaterialHandle bodyMaterial, handleMaterial;
};
Pan makePan(KitchenKit& kit, float foot, float rim, float height, float handle, MaterialHandle body,
            MaterialHandle grip, const char* name) {
  const Mesh bowl =
      lathe(vessel(foot, rim, height, 0.003f, std::min(0.02f, 0.4f * height), kit.segments(7, 3)),
            kit.segments(64, 14));
  const Polygon flat = rounded(rectangle(0.011f, 0.004f), 0.003f, kit.segments(2, 1));
  SweepOptions options;
  options.scale = [](float t) { return 0.75f + 0.45f * t * t; };
  options.sideHint = {0, 0, 1};
  const Mesh bar = sweep(flat,
                         smoothCurve3({{rim - 0.006f, height - 0.012f, 0},
                                       {rim + 0.05f, height + 0.006f, 0},
                                       {rim + 0.6f * handle, height + 0.032f, 0},
                                       {rim + handle, height + 0.036f, 0}}),
                         kit.segments(20, 6), options);
  return {kit.add(bowl, name), kit.add(bar, std::string(name) + ", handle"), body, grip};
}
void putPan(KitchenKit& kit, const Pan& pan, const Mat4& at, const char* name) {
  kit.put(pan.body, at, pan.bodyMaterial, name);
  kit.put(pan.handle, at, pan.handleMaterial, name);
}

void addKettle(KitchenKit& kit, Vec3d at, double turn) {
  const KitchenPalette& m = kit.palette();
  const int around = kit.segments(80, 16), fine = kit.segments(36, 10);
  const Mat4 base = translation(at) * rotation({0, 1, 0}, turn);
  const auto profile = smoothCurve({{0, 0},
                                    {0.085f, 0.0f},
                                    {0.108f, 0.010f},
                                    {0.116f, 0.035f},
                                    {0.108f, 0.075f},
                                    {0.085f, 0.115f},
                                    {0.055f, 0.138f},
                                    {0.045f, 0.142f},
                                    {0, 0.146f}});
  std::vector<Vec2f> body;
  for (int i = 0; i <= fine; ++i) body.push_back(profile(fraction(i, fine)));
  body.front().x = body.back().x = 0;
  for (Vec2f& p : body) p.x = std::max(p.x, 0.f);
  kit.put(lathe(body, around), base, m.redEnamel, "kettle");
  SweepOptions taper;
  taper.scale = [](float t) { return 1.25f - 0.6f * t; };
  kit.put(
      tube(
          smoothCurve3(
              {{0.085f, 0.055f, 0}, {0.125f, 0.075f, 0}, {0.150f, 0.115f, 0}, {0.178f, 0.145f, 0}}),
          0.017f, kit.segments(20, 6), kit.segments(20, 8), taper),
      base, m.redEnamel, "kettle spout");
  kit.put(tube(smoothCurve3({{0.075f, 0.118f, 0},
                             {0.092f, 0.165f, 0},
                             {0.072f, 0.215f, 0},
                             {0, 0.238f, 0},
                             {-0.072f, 0.215f, 0},
                             {-0.092f, 0.165f, 0},
                             {-0.075f, 0.118f, 0}}),
               0.0055f, kit.segments(48, 12), kit.segments(12, 6)),
          base, m.chrome, "kettle handle");
  kit.put(tube(smoothCurve3({{0.060f, 0.223f, 0}, {0, 0.2385f, 0}, {-0.060f, 0.223f, 0}}), 0.0115f,
               kit.segments(16, 5), kit.segments(16, 8)),
          base, m.walnut, "kettle grip");
  kit.put(lathe({{0.047f, 0.139f},
                 {0.047f, 0.145f},
                 {0.012f, 0.151f},
                 {0.008f, 0.160f},
                 {0.015f, 0.170f},
                 {0.011f, 0.176f},
                 {0, 0.177f}},
                kit.segments(40, 10), 50),
          base, m.redEnamel, "kettle lid");
}

// Hangs from (0, 0, 0) down; faces +z.
Mesh ladle(const KitchenKit& kit) {
  const Mesh stem = tube(
      smoothCurve3({{0, 0, 0}, {0, -0.10f, 0.004f}, {0, -0.22f, 0.004f}, {0, -0.255f, 0.012f}}),
      0.004f, kit.segments(16, 5), kit.segments(10, 6));
  const int n = kit.segments(10, 4);
  std::vector<Vec2f> cup;
  for (int i = 0; i <= n; ++i)
    cup.push_back({0.042f * std::sin(kPi / 2 * fraction(i, n)),
                   -0.042f * std::cos(kPi / 2 * fraction(i, n))});
  for (int i = n; i >= 0; --i)
    cup.push_back({0.040f * std::sin(kPi / 2 * fraction(i, n)),
                   -0.040f * std::cos(kPi / 2 * fraction(i, n))});
  return merged({stem, transformed(lathe(cup, kit.segments(36, 10)),
                                   translation({0, -0.262, 0.05}) * rotation({1, 0, 0}, 25))});
}
Mesh spatula(const KitchenKit& kit) {
  const Mesh stem = tube(smoothCurve3({{0, 0, 0}, {0, -0.12f, 0.003f}, {0, -0.24f, 0.0f}}), 0.004f,
                         kit.segments(12, 4), kit.segments(10, 6));
  const Mesh blade = extrude(
      rounded(Polygon{{-0.025f, -0.045f}, {0.025f, -0.045f}, {0.037f, 0.045f}, {-0.037f, 0.045f}},
              0.008f, kit.segments(3, 1)),
      0.0016f);
  return merged(
      {stem, transformed(blade, translation({0, -0.28, 0.002}) * rotation({1, 0, 0}, 90))});
}
Mesh whisk(const KitchenKit& kit) {
  std::vector<Mesh> parts{
      tube(roundedPath({{0, 0, 0}, {0, -0.13f, 0}}, 0), 0.008f, 1, kit.segments(14, 6))};
  for (int i = 0; i < 5; ++i) {
    const Vec2f d = circle(i, 10);
    const auto at = [&](float r, float y) { return Vec3f(r * d.x, y, r * d.y); };
    parts.push_back(
        tube(smoothCurve3({at(0.006f, -0.12f), at(0.022f, -0.19f), at(0.033f, -0.25f),
                           at(0.018f, -0.295f), at(0, -0.30f), at(-0.018f, -0.295f),
                           at(-0.033f, -0.25f), at(-0.022f, -0.19f), at(-0.006f, -0.12f)}),
             0.0013f, kit.segments(32, 10), kit.segments(5, 4)));
  }
  return merged(parts);
}

void addRail(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  constexpr float kY = 1.345f, kZ = 0.05f;
  kit.put(
      tube(roundedPath({{0.30f, kY, 0}, {0.30f, kY, kZ}, {1.36f, kY, kZ}, {1.36f, kY, 0}}, 0.015f),
           0.006f, kit.segments(24, 10), kit.segments(14, 6)),
      Mat4(), m.brass, "rail");
  const MeshHandle hook = kit.add(tube(smoothCurve3({{0, -0.022f, -0.011f},
                                                     {0, 0.004f, -0.0095f},
                                                     {0, 0.0085f, 0},
                                                     {0, 0.002f, 0.009f},
                                                     {0, -0.030f, 0.009f},
                                                     {0, -0.044f, 0.015f},
                                                     {0, -0.036f, 0.023f}}),
                                       0.0018f, kit.segments(24, 8), kit.segments(8, 4)),
                                  "hook");
  const MeshHandle scoop = kit.add(ladle(kit), "ladle"), turner = kit.add(spatula(kit), "spatula"),
                   beater = kit.add(whisk(kit), "whisk");
  const Pan small =
                makePan(kit, 0.055f, 0.06f, 0.055f, 0.14f, m.copper, m.brass, "small copper pan"),
            large = makePan(kit, 0.07f, 0.076f, 0.065f, 0.15f, m.copper, m.brass, "copper pan");
  const auto hang = [&](double x) {
    kit.put(hook, translation({x, static_cast<double>(kY), static_cast<double>(kZ)}), m.chrome,
            "hook");
    return translation({x, static_cast<double>(kY) - 0.035, static_cast<double>(kZ) + 0.012});
  };
  kit.put(scoop, hang(0.42), m.chrome, "ladle");
  kit.put(turner, hang(0.54), m.chrome, "spatula");
  kit.put(beater, hang(0.65), m.chrome, "whisk");
  // Handle up, bottom to the room.
  const auto pan = [&](const Pan& p, double x, double rim, double handle) {
    putPan(kit, p,
           hang(x) * translation({0, -rim - handle + 0.012, 0.03}) * rotation({0, 0, 1}, 90) *
               rotation({1, 0, 0}, -90),
           "copper pan, hanging");
  };
  pan(small, 0.83, 0.06, 0.14);
  pan(large, 1.02, 0.076, 0.15);
  pan(small, 1.21, 0.06, 0.14);
}

}  // namespace

void addCookware(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const double middle = 0.5 * static_cast<double>(kStoveLeft + kStoveRight);
  addStockPot(kit, {middle - 0.295, kGrate, 0.185}, 20);
  addKettle(kit, {middle + 0.295, kGrate, 0.20}, 155);
  const Pan saucepan = makePan(kit, 0.078f, 0.08f, 0.095f, 0.17f, m.copper, m.brass, "saucepan");
  putPan(kit, saucepan, translation({middle, kGrate, 0.185}) * rotation({0, 1, 0}, -60),
         "saucepan");
  const Pan frying = makePan(kit, 0.105f, 0.135f, 0.042f, 0.19f, m.iron, m.iron, "frying pan");
  putPan(kit, frying, translation({middle + 0.27, kGrate, 0.475}) * rotation({0, 1, 0}, -38),
         "frying pan");
  addRail(kit);
}

}  // namespace lobelia::builtin::kitchen
