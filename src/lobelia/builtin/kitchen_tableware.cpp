// Plates, bowls, cups, glasses, bottles and jars on the kitchen's shelves and island.
#include <cmath>

#include "lobelia/base/random.h"
#include "lobelia/builtin/kitchen_kit.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin::kitchen {
namespace {

Mesh turned(const KitchenKit& kit, std::vector<Vec2f> points, int rows, int around) {
  const auto curve = smoothCurve(std::move(points));
  return revolve([curve](float t) { return t <= 0 || t >= 1 ? Vec2f(0, curve(t).y) : curve(t); },
                 kit.segments(rows, rows / 3 + 2), kit.segments(around, 12));
}

class Tableware {
 public:
  explicit Tableware(KitchenKit& kit) : kit_(kit), m_(kit.palette()) {
    plate_ = kit.add(turned(kit,
                            {{0, 0},
                             {0.055f, 0},
                             {0.075f, 0.002f},
                             {0.098f, 0.010f},
                             {0.128f, 0.019f},
                             {0.132f, 0.021f},
                             {0.128f, 0.022f},
                             {0.098f, 0.014f},
                             {0.075f, 0.0065f},
                             {0.055f, 0.0055f},
                             {0, 0.0055f}},
                            22, 56),
                     "plate");
    bowl_ = kit.add(turned(kit,
                           {{0, 0},
                            {0.032f, 0},
                            {0.037f, 0.006f},
                            {0.055f, 0.022f},
                            {0.072f, 0.050f},
                            {0.077f, 0.068f},
                            {0.075f, 0.070f},
                            {0.070f, 0.052f},
                            {0.052f, 0.026f},
                            {0.030f, 0.012f},
                            {0, 0.010f}},
                           22, 48),
                    "bowl");
    cup_ = kit.add(turned(kit,
                          {{0, 0},
                           {0.030f, 0},
                           {0.038f, 0.003f},
                           {0.041f, 0.020f},
                           {0.041f, 0.070f},
                           {0.0415f, 0.094f},
                           {0.040f, 0.096f},
                           {0.0385f, 0.092f},
                           {0.038f, 0.070f},
                           {0.037f, 0.020f},
                           {0.030f, 0.008f},
                           {0, 0.006f}},
                          24, 44),
                   "cup");
    ear_ = kit.add(tube(smoothCurve3({{0.039f, 0.078f, 0},
                                      {0.060f, 0.082f, 0},
                                      {0.072f, 0.062f, 0},
                                      {0.064f, 0.036f, 0},
                                      {0.039f, 0.024f, 0}}),
                        0.0048f, kit.segments(20, 6), kit.segments(10, 6)),
                   "cup handle");
    tumbler_ = kit.add(turned(kit,
                              {{0, 0},
                               {0.026f, 0},
                               {0.030f, 0.003f},
                               {0.033f, 0.050f},
                               {0.037f, 0.108f},
                               {0.0362f, 0.110f},
                               {0.035f, 0.107f},
                               {0.031f, 0.050f},
                               {0.027f, 0.014f},
                               {0.018f, 0.011f},
                               {0, 0.010f}},
                              24, 44),
                       "tumbler");
    wineGlass_ = kit.add(turned(kit,
                                {{0, 0},
                                 {0.030f, 0.0003f},
                                 {0.0365f, 0.0015f},
                                 {0.035f, 0.003f},
                                 {0.015f, 0.007f},
                                 {0.005f, 0.015f},
                                 {0.0038f, 0.045f},
                                 {0.0045f, 0.082f},
                                 {0.014f, 0.093f},
                                 {0.034f, 0.115f},
                                 {0.041f, 0.145f},
                                 {0.037f, 0.185f},
                                 {0.0325f, 0.208f},
                                 {0.0318f, 0.2088f},
                                 {0.0313f, 0.208f},
                                 {0.0358f, 0.185f},
                                 {0.0396f, 0.145f},
                                 {0.0325f, 0.1165f},
                                 {0.014f, 0.0965f},
                                 {0.004f, 0.0925f},
                                 {0, 0.092f}},
                                52, 44),
                         "wine glass");
    bottle_ = kit.add(
        turned(kit, {{0, 0.012f},       {0.018f, 0.008f},  {0.030f, 0.0005f}, {0.035f, 0.003f},
                     {0.0372f, 0.012f}, {0.0375f, 0.09f},  {0.0375f, 0.165f}, {0.034f, 0.190f},
                     {0.020f, 0.215f},  {0.0140f, 0.240f}, {0.0135f, 0.285f}, {0.0150f, 0.288f},
                     {0.0150f, 0.296f}, {0.0128f, 0.299f}, {0.0098f, 0.297f}, {0.0096f, 0.285f},
                     {0.0100f, 0.240f}, {0.0165f, 0.213f}, {0.031f, 0.188f},  {0.0345f, 0.163f},
                     {0.0345f, 0.09f},  {0.0342f, 0.016f}, {0.030f, 0.008f},  {0.018f, 0.012f},
                     {0, 0.016f}},
               54, 44),
        "bottle");
    cork_ = kit.add(cylinder(0.0085f, 0.03f, 0.0015f, 2, kit.segments(20, 8)), "cork");
    jar_ = kit.add(turned(kit,
                          {{0, 0},
                           {0.040f, 0},
                           {0.047f, 0.004f},
                           {0.048f, 0.016f},
                           {0.048f, 0.120f},
                           {0.046f, 0.138f},
                           {0.040f, 0.146f},
                           {0.040f, 0.155f},
                           {0.0385f, 0.156f},
                           {0.0375f, 0.155f},
                           {0.0375f, 0.145f},
                           {0.0432f, 0.136f},
                           {0.0452f, 0.120f},
                           {0.0452f, 0.016f},
                           {0.042f, 0.006f},
                           {0, 0.0055f}},
                          36, 44),
                   "jar");
    filling_ = kit.add(turned(kit,
                              {{0, 0.0065f},
                               {0.040f, 0.0070f},
                               {0.0440f, 0.018f},
                               {0.0442f, 0.060f},
                               {0.0440f, 0.094f},
                               {0.040f, 0.100f},
                               {0.015f, 0.104f},
                               {0, 0.104f}},
                              14, 32),
                       "filling");
    lid_ = kit.add(lathe({{0, 0.146f},
                          {0.0365f, 0.146f},
                          {0.0365f, 0.157f},
                          {0.043f, 0.157f},
                          {0.043f, 0.172f},
                          {0.040f, 0.175f},
                          {0, 0.175f}},
                         kit.segments(40, 10)),
                   "jar lid");
  }

  void plates(Vec3d at, int count, MaterialHandle material) {
    for (int i = 0; i < count; ++i)
      kit_.put(plate_, translation({at.x, at.y + 0.0085 * i, at.z}), material, "plate");
  }
  void bowls(Vec3d at, int count, MaterialHandle material) {
    for (int i = 0; i < count; ++i)
      kit_.put(bowl_, translation({at.x, at.y + 0.021 * i, at.z}), material, "bowl");
  }
  // On edge against the wall, its face to the room.
  void standingPlate(Vec3d at, MaterialHandle material) {
    kit_.put(plate_, translation({at.x, at.y + 0.130, at.z}) * rotation({1, 0, 0}, 78), material,
             "plate");
  }
  void cup(Vec3d at, double turn, MaterialHandle material) {
    const Mat4 to = translation(at) * rotation({0, 1, 0}, turn);
    kit_.put(cup_, to, material, "cup");
    kit_.put(ear_, to, material, "cup handle");
  }
  void tumbler(Vec3d at) { kit_.put(tumbler_, translation(at), m_.glass, "tumbler"); }
  void wineGlass(Vec3d at) { kit_.put(wineGlass_, translation(at), m_.glass, "wine glass"); }
  void bottle(Vec3d at, MaterialHandle material, double scale = 1) {
    const Mat4 to = translation(at) * scaling(Vec3d(scale));
    kit_.put(bottle_, to, material, "bottle");
    kit_.put(cork_, to * translation({0, 0.284, 0}), m_.oak, "cork");
  }
  void jar(Vec3d at, MaterialHandle filling, double high = 1) {
    const Mat4 to = translation(at) * scaling({1, high, 1});
    kit_.put(jar_, to, m_.glass, "jar");
    kit_.put(filling_, to, filling, "filling");
    kit_.put(lid_, to, m_.oak, "jar lid");
  }

 private:
  KitchenKit& kit_;
  const KitchenPalette& m_;
  MeshHandle plate_, bowl_, cup_, ear_, tumbler_, wineGlass_, bottle_, cork_, jar_, filling_, lid_;
};

}  // namespace

void addTableware(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  Tableware all(kit);
  const double low = static_cast<double>(kShelfLow), high = static_cast<double>(kShelfHigh),
               top = high + 0.40;
  const double island = static_cast<double>(kIsland.y), worktop = static_cast<double>(kWorktop);
  // Lower shelf: jars, cups, plates.
  all.jar({0.16, low, 0.14}, m.pasta, 1.35);
  all.jar({0.275, low, 0.15}, m.coffee, 1.1);
  all.jar({0.385, low, 0.13}, m.pasta, 0.9);
  double turn = 35;
  for (const double x : {0.56, 0.68, 0.80}) all.cup({x, low, 0.13}, turn -= 17, m.blueGlaze);
  all.plates({1.01, low, 0.14}, 8, m.porcelain);
  all.bowls({1.27, low, 0.14}, 4, m.blueGlaze);
  // Upper shelf: glasses, bowls, plates on edge.
  for (int i = 0; i < 5; ++i) all.wineGlass({0.15 + 0.095 * i, high, i % 2 ? 0.17 : 0.11});
  for (int i = 0; i < 6; ++i) all.tumbler({0.66 + 0.085 * (i % 3), high, i < 3 ? 0.10 : 0.19});
  all.bowls({1.00, high, 0.14}, 5, m.porcelain);
  all.standingPlate({1.24, high, 0.062}, m.blueGlaze);
  // Top shelf.
  all.plates({0.28, top, 0.14}, 5, m.blueGlaze);
  all.bowls({0.52, top, 0.14}, 3, m.porcelain);
  all.jar({0.75, top, 0.14}, m.coffee, 1.2);
  all.jar({0.87, top, 0.14}, m.pasta, 1.2);
  all.standingPlate({1.14, top, 0.062}, m.porcelain);
  // Worktops: oil beside the stove, tumblers beside the sink.
  all.bottle({1.40, worktop, 0.13}, m.greenGlass);
  all.bottle({1.31, worktop, 0.10}, m.glass, 0.85);
  all.tumbler({0.30, worktop, 2.36});
  all.tumbler({0.39, worktop, 2.30});
  all.cup({0.34, worktop, 2.62}, 60, m.porcelain);
  // Island: wine, two plates.
  all.bottle({3.12, island, 2.62}, m.greenGlass, 1.08);
  all.wineGlass({2.98, island, 2.78});
  all.wineGlass({3.13, island, 2.86});
  all.plates({1.83, island, 2.92}, 2, m.porcelain);
  all.cup({2.10, island, 2.93}, 140, m.blueGlaze);
}

}  // namespace lobelia::builtin::kitchen
