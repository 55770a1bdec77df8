// Fruit in a bowl, bread on a board, herbs in pots in the kitchen.
#include <cmath>

#include "lobelia/base/random.h"
#include "lobelia/builtin/kitchen_kit.h"
#include "lobelia/builtin/noise.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin::kitchen {
namespace {

struct Fruits {
  MeshHandle orange, apple, pear, lemon, stalk;
};

Fruits makeFruits(KitchenKit& kit) {
  const int fine = kit.segments(24, 8), around = kit.segments(36, 10);
  const auto turned = [&](std::vector<Vec2f> points) {
    const auto curve = smoothCurve(std::move(points));
    return revolve([curve](float t) { return t <= 0 || t >= 1 ? Vec2f(0, curve(t).y) : curve(t); },
                   fine, around);
  };
  const int level = kit.detail() < 0.4f ? 2 : kit.detail() < 2.2f ? 3 : 4;
  Fruits f;
  f.orange = kit.add(icosphere(level,
                               [](Vec3f d) {
                                 const float poles = std::exp(-40 * (1 - std::abs(d.y)));
                                 return 0.040f * (1 - 0.03f * poles + 0.006f * noise(d * 14.f, 1));
                               }),
                     "orange");
  f.apple = kit.add(turned({{0, 0.006f},
                            {0.010f, 0.002f},
                            {0.022f, 0.003f},
                            {0.034f, 0.020f},
                            {0.0385f, 0.042f},
                            {0.032f, 0.063f},
                            {0.018f, 0.070f},
                            {0.007f, 0.066f},
                            {0, 0.058f}}),
                    "apple");
  f.pear = kit.add(turned({{0, 0.004f},
                           {0.012f, 0.001f},
                           {0.029f, 0.012f},
                           {0.036f, 0.034f},
                           {0.030f, 0.058f},
                           {0.019f, 0.078f},
                           {0.014f, 0.094f},
                           {0.007f, 0.102f},
                           {0, 0.101f}}),
                   "pear");
  f.lemon = kit.add(icosphere(level,
                              [](Vec3f d) {
                                const float nipple = std::exp(-60 * (1 - std::abs(d.x)));
                                return 0.027f * (1 + 0.28f * d.x * d.x + 0.16f * nipple +
                                                 0.01f * noise(d * 12.f, 2));
                              }),
                    "lemon");
  f.stalk = kit.add(tube(smoothCurve3({{0, 0, 0}, {0.001f, 0.010f, 0}, {0.005f, 0.020f, 0.002f}}),
                         0.0014f, kit.segments(5, 3), kit.segments(6, 4)),
                    "stalk");
  return f;
}

void addFruitBowl(KitchenKit& kit, const Fruits& f, Vec3d at) {
  const KitchenPalette& m = kit.palette();
  const auto curve = smoothCurve({{0, 0},
                                  {0.055f, 0},
                                  {0.062f, 0.006f},
                                  {0.095f, 0.028f},
                                  {0.140f, 0.062f},
                                  {0.165f, 0.095f},
                                  {0.162f, 0.098f},
                                  {0.135f, 0.068f},
                                  {0.090f, 0.036f},
                                  {0.045f, 0.016f},
                                  {0, 0.012f}});
  kit.put(revolve([curve](float t) { return t <= 0 || t >= 1 ? Vec2f(0, curve(t).y) : curve(t); },
                  kit.segments(40, 12), kit.segments(80, 16)),
          translation(at), m.tin, "fruit bowl");
  const auto put = [&](MeshHandle mesh, MaterialHandle material, const char* name, double x,
                       double y, double z, Vec3d axis, double turn) {
    kit.put(mesh, translation(at + Vec3d(x, y, z)) * rotation(axis, turn), material, name);
  };
  const auto apple = [&](double x, double y, double z, Vec3d axis, double turn) {
    const Mat4 to = translation(at + Vec3d(x, y, z)) * rotation(axis, turn);
    kit.put(f.apple, to, m.apple, "apple");
    kit.put(f.stalk, to * translation({0, 0.058, 0}), m.stalk, "stalk");
  };
  const auto pear = [&](double x, double y, double z, Vec3d axis, double turn) {
    const Mat4 to = translation(at + Vec3d(x, y, z)) * rotation(axis, turn);
    kit.put(f.pear, to, m.pear, "pear");
    kit.put(f.stalk, to * translation({0, 0.098, 0}), m.stalk, "stalk");
  };
  put(f.orange, m.orange, "orange", -0.065, 0.074, -0.035, {1, 0, 0}, 20);
  put(f.orange, m.orange, "orange", 0.02, 0.062, -0.065, {1, 0, 1}, 70);
  put(f.orange, m.orange, "orange", -0.025, 0.066, 0.055, {0, 0, 1}, 110);
  apple(0.082, 0.048, -0.005, {0, 0, 1}, -14);
  apple(0.048, 0.044, 0.070, {1, 0, 0}, 16);
  apple(0.0, 0.098, 0.0, {1, 0, 1}, 12);
  pear(-0.092, 0.058, 0.055, {0.5, 0, 1}, 24);
  put(f.lemon, m.lemon, "lemon", 0.075, 0.112, 0.035, {0, 1, 0.3}, 40);
  put(f.lemon, m.lemon, "lemon", -0.055, 0.122, 0.018, {0.2, 1, 0}, 120);
  put(f.orange, m.orange, "orange", 0.032, 0.128, -0.052, {1, 0, 1}, 140);
}

void addBread(KitchenKit& kit, const Fruits& f) {
  const KitchenPalette& m = kit.palette();
  const double y = static_cast<double>(kIsland.y);
  const Mat4 at = translation({2.34, y, 2.66}) * rotation({0, 1, 0}, 18);
  kit.put(extrude(rounded(rectangle(0.21f, 0.13f), 0.03f, kit.segments(6, 2)), 0.022f, 0.004f,
                  kit.segments(3, 1)),
          at, m.oak, "board");
  const int level = kit.detail() < 0.4f ? 3 : kit.detail() < 2.2f ? 4 : 5;
  const Mesh loaf = icosphere(level, [](Vec3f d) {
    const float cuts =
        std::pow(std::abs(std::sin(9 * d.x + 0.8f * d.z)), 12.f) * std::max(d.y, 0.f);
    return 1 + 0.05f * fbm(d * 3.f, 4, 7) - 0.06f * cuts;
  });
  // A flat underside.
  Mesh shaped = transformed(loaf, scaling({0.125, 0.062, 0.068}));
  for (Vec3f& p : shaped.positions) p.y = std::max(p.y, -0.030f);
  for (Vec2f& uv : shaped.uvs) uv = {uv.x, uv.y * 0.5f};
  kit.put(creased(std::move(shaped), 60),
          at * translation({-0.04, 0.052, -0.02}) * rotation({0, 1, 0}, 12), m.bread, "bread");
  kit.put(f.lemon, at * translation({0.14, 0.0495, 0.06}) * rotation({0, 1, 0}, 70), m.lemon,
          "lemon");
  // Bread knife.
  const Mat4 knife = at * translation({0.135, 0.022, -0.05}) * rotation({0, 1, 0}, 82);
  kit.put(extrude({{-0.09f, -0.012f},
                   {0.08f, -0.014f},
                   {0.10f, -0.004f},
                   {0.09f, 0.014f},
                   {-0.09f, 0.014f}},
                  0.0018f),
          knife, m.chrome, "knife");
  kit.put(kit.boxMesh({0.055f, 0.009f, 0.013f}, 0.005f), knife * translation({-0.145, 0.009, 0}),
          m.walnut, "knife handle");
}

// A leaf along +x from the origin, bent down, its upper side up.
Mesh leafMesh(const KitchenKit& kit) {
  Mesh mesh = heightfield(1, 1, kit.segments(6, 3), kit.segments(4, 2), [](Vec2f) { return 0.f; });
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec2f uv = mesh.uvs[i];
    const float t = uv.x, side = 2 * uv.y - 1;
    const float width =
        0.34f * std::pow(std::sin(kPi * (0.04f + 0.94f * t)), 0.8f) * (1.15f - 0.5f * t);
    mesh.positions[i] = {
        t, 0.16f * std::sin(2.2f * t) - 0.32f * t * t + 0.10f * std::abs(side) * (1 - 0.5f * t),
        side * width};
  }
  return creased(std::move(mesh), -1);
}

void addHerbs(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const MeshHandle leaf = kit.add(leafMesh(kit), "leaf");
  const int around = kit.segments(44, 12);
  const MeshHandle pot = kit.add(lathe({{0, 0},
                                        {0.042f, 0},
                                        {0.056f, 0.078f},
                                        {0.062f, 0.078f},
                                        {0.064f, 0.100f},
                                        {0.062f, 0.102f},
                                        {0.056f, 0.100f},
                                        {0.053f, 0.085f},
                                        {0, 0.085f}},
                                       around),
                                 "flower pot");
  const MeshHandle soil = kit.add(disc(0.0535f, around), "soil");
  const double sill = static_cast<double>(kWindowLow) + 0.005;
  Rng rng(7);
  const auto random = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(rng.next1D());
  };
  struct Herb {
    Vec3d at;
    int stems, leaves;
    double height, leaf;
  };
  for (const Herb& h :
       {Herb{{0.035, sill, 1.22}, 6, 9, 0.15, 0.055}, Herb{{0.03, sill, 1.52}, 8, 11, 0.12, 0.034},
        Herb{{0.035, sill, 2.36}, 6, 9, 0.17, 0.060}}) {
    kit.put(pot, translation(h.at), m.clay, "flower pot");
    kit.put(soil, translation({h.at.x, h.at.y + 0.088, h.at.z}), m.stalk, "soil");
    for (int s = 0; s < h.stems; ++s) {
      const double angle = 2 * M_PI * (s + random(0, 0.7)) / h.stems,
                   lean = random(0.2, 1.0) * 0.075, high = h.height * random(0.7, 1.1);
      const auto along = [&](double t) {
        return Vec3d(lean * t * t * std::cos(angle) + 0.012 * std::cos(angle), 0.086 + high * t,
                     lean * t * t * std::sin(angle) + 0.012 * std::sin(angle));
      };
      std::vector<Vec3f> stem;
      for (int i = 0; i < 4; ++i) {
        const Vec3d p = along(i / 3.0);
        stem.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
      }
      kit.put(tube(smoothCurve3(stem), 0.0014f, kit.segments(5, 3), kit.segments(5, 3)),
              translation(h.at), m.leaf, "stem");
      for (int i = 0; i < h.leaves; ++i) {
        const double t = 0.35 + 0.65 * (i + 1) / h.leaves;
        kit.put(leaf,
                translation(h.at + along(t)) *
                    rotation({0, 1, 0}, 137.5 * i + 40 * s + random(0, 30)) *
                    rotation({0, 0, 1}, random(-10, 40)) *
                    scaling(Vec3d(h.leaf * random(0.7, 1.15) * (1.25 - 0.5 * t))),
                m.leaf, "leaf");
      }
    }
  }
}

}  // namespace

void addFood(KitchenKit& kit) {
  const Fruits fruits = makeFruits(kit);
  addFruitBowl(kit, fruits, {2.74, static_cast<double>(kIsland.y), 2.58});
  addBread(kit, fruits);
  addHerbs(kit);
}

}  // namespace lobelia::builtin::kitchen
