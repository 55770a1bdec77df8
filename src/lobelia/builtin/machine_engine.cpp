// The engine of the motorcycle: a V of two finned cylinders on a crankcase, and its exhaust.
#include <cmath>

#include "lobelia/builtin/machine.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"

namespace lobelia::builtin {

// A cylinder that stands on y = 0, with its head; about 0.30 high.
void Machine::addCylinder(const Mat4& base, const std::string& name) {
  put(cylinder(0.058f, 0.29f, 0.004f, 2, segments(40, 12)), iron_, name + ", barrel", base);
  std::vector<Mesh> fins;
  constexpr int kFins = 13;
  for (int i = 0; i < kFins; ++i) {
    const bool isHead = i > 8;
    const float half = isHead ? 0.092f : 0.080f + 0.008f * fraction(i, 9);
    fins.push_back(
        translated(extrude(rounded(rectangle(half, 0.92f * half), 0.030f, segments(7, 2)), 0.0055f,
                           0.0015f, 1),
                   {0, 0.030f + 0.0165f * static_cast<float>(i), 0}));
  }
  put(merged(fins), aluminium_, name + ", fins", base);
  put(extrude(rounded(rectangle(0.075f, 0.062f), 0.028f, segments(8, 2)), 0.050f, 0.014f,
              segments(5, 2)),
      chrome_, name + ", rocker cover", base * translation({0, 0.252, 0}));
  const MeshHandle bolt = add(cylinder(0.0085f, 0.016f, 0.002f, 1, 6), name + ", bolt");
  for (int i = 0; i < 4; ++i)
    place(bolt, base * translation({i % 2 == 0 ? -0.048 : 0.048, 0.296, i < 2 ? -0.036 : 0.036}),
          steel_, name + ", bolt " + std::to_string(i + 1));
}

void Machine::addEngine() {
  const Vec3d crank{0.07, 0.31, 0};
  put(hull({{-0.33f, 0.33f, 0.02f, 0.02f},
            {-0.32f, 0.33f, 0.070f, 0.060f},
            {-0.22f, 0.325f, 0.105f, 0.088f},
            {-0.05f, 0.305f, 0.120f, 0.095f},
            {0.10f, 0.300f, 0.130f, 0.098f},
            {0.20f, 0.300f, 0.095f, 0.085f},
            {0.235f, 0.300f, 0.05f, 0.05f},
            {0.24f, 0.300f, 0.015f, 0.015f}},
           0.62f, 48, 56),
      aluminium_, "crankcase");
  put(hull({{-0.16f, 0.19f, 0.012f, 0.03f},
            {-0.15f, 0.19f, 0.035f, 0.075f},
            {0.12f, 0.19f, 0.035f, 0.080f},
            {0.13f, 0.19f, 0.012f, 0.03f}},
           0.5f, 20, 36),
      iron_, "sump");
  // Covers on both sides: clutch and gearbox, ignition.
  const auto cover = [&](float radius, float depth) {
    return lathed({{0, 0},
                   {radius, 0},
                   {radius, 0.6f * depth},
                   {0.92f * radius, 0.9f * depth},
                   {0.62f * radius, depth},
                   {0.55f * radius, 0.86f * depth},
                   {0.20f * radius, 0.82f * depth},
                   {0.14f * radius, depth},
                   {0, depth}},
                  56);
  };
  const auto put2 = [&](float x, float y, float radius, float depth, bool right, const char* name) {
    put(cover(radius, depth), right ? chrome_ : aluminium_, name,
        moving({x, y, right ? 0.075f : -0.075f}) * rotation({1, 0, 0}, right ? 90 : -90));
    const MeshHandle bolt =
        add(cylinder(0.006f, 0.008f, 0.001f, 1, 6), std::string(name) + " bolt");
    for (int i = 0; i < 8; ++i) {
      const Vec2f c = circle(i, 8) * (0.80f * radius);
      const float out = 0.91f * depth + 0.072f;
      place(bolt,
            translation(
                {static_cast<double>(x + c.x), static_cast<double>(y + c.y), right ? out : -out}) *
                rotation({1, 0, 0}, right ? 90 : -90),
            steel_, std::string(name) + " bolt " + std::to_string(i + 1));
    }
  };
  put2(0.09f, 0.305f, 0.105f, 0.055f, true, "timing cover");
  put2(-0.13f, 0.325f, 0.085f, 0.048f, true, "clutch cover");
  put2(0.09f, 0.305f, 0.095f, 0.045f, false, "ignition cover");
  addCylinder(translation(crank + Vec3d(0.045, 0.075, 0)) * rotation({0, 0, 1}, -24),
              "front cylinder");
  addCylinder(translation(crank + Vec3d(-0.075, 0.075, 0)) * rotation({0, 0, 1}, 24),
              "rear cylinder");
  // Air cleaner and carburettor between the cylinders, push rods.
  put(lathed({{0, 0},
              {0.070f, 0},
              {0.076f, 0.006f},
              {0.076f, 0.034f},
              {0.068f, 0.044f},
              {0.045f, 0.047f},
              {0.04f, 0.042f},
              {0, 0.042f}},
             64),
      chrome_, "air cleaner", translation({0.055, 0.60, 0.10}) * rotation({1, 0, 0}, 90));
  put(bar({{0.055f, 0.60f, -0.06f}, {0.055f, 0.60f, 0.115f}}, 0.030f, 0, 12, 24), brass_,
      "carburettor");
  put(cylinder(0.026f, 0.06f, 0.006f, 2, segments(28, 8)), brass_, "float bowl",
      translation({0.055, 0.535, 0.03}));
  for (int i = 0; i < 4; ++i) {
    const float lean = i < 2 ? 1.f : -1.f, shift = i % 2 == 0 ? 0.014f : -0.014f;
    put(bar({{0.055f + lean * 0.055f + shift, 0.385f, 0.083f},
             {0.055f + lean * 0.165f + shift, 0.635f, 0.083f}},
            0.0085f, 0, 16, 12),
        chrome_, "push rod " + std::to_string(i + 1));
  }
}

void Machine::addExhaust() {
  put(bar({{0.215f, 0.575f, 0.055f},
           {0.335f, 0.585f, 0.085f},
           {0.365f, 0.40f, 0.135f},
           {0.27f, 0.215f, 0.150f},
           {-0.10f, 0.205f, 0.160f},
           {-0.30f, 0.215f, 0.175f}},
          0.0215f, 0.13f, 90, 20),
      chrome_, "front pipe");
  put(bar({{-0.16f, 0.575f, 0.055f},
           {-0.235f, 0.575f, 0.125f},
           {-0.23f, 0.40f, 0.165f},
           {-0.30f, 0.295f, 0.175f},
           {-0.42f, 0.285f, 0.175f}},
          0.0215f, 0.08f, 60, 20),
      chrome_, "rear pipe");
  // Mufflers: open at the end, with a wall.
  const Mesh muffler = transformed(lathed({{0, 0},
                                           {0.022f, 0},
                                           {0.026f, 0.01f},
                                           {0.045f, 0.10f},
                                           {0.047f, 0.14f},
                                           {0.047f, 0.46f},
                                           {0.043f, 0.52f},
                                           {0.034f, 0.56f},
                                           {0.031f, 0.56f},
                                           {0.031f, 0.50f},
                                           {0, 0.49f}},
                                          48),
                                   rotation({0, 0, 1}, 86));
  put(muffler, chrome_, "lower muffler", translation({-0.28, 0.213, 0.178}));
  put(muffler, chrome_, "upper muffler", translation({-0.40, 0.285, 0.178}));
  put(bar({{-0.62f, 0.345f, 0.13f}, {-0.62f, 0.30f, 0.165f}}, 0.009f, 0, 6), black_,
      "muffler bracket");
}

}  // namespace lobelia::builtin
