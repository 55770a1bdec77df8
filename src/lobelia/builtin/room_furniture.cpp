// The furniture of the dining room: table, chairs, sideboard, mirror.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/builtin/dining_room.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"
#include "lobelia/builtin/teapot.h"

namespace lobelia::builtin {

Mesh DiningRoom::leg(float height, float thick) const {
  std::vector<Vec2f> profile{{0, 0},         {0.35f, 0},     {0.42f, 0.02f}, {0.36f, 0.06f},
                             {0.48f, 0.10f}, {0.40f, 0.13f}, {0.55f, 0.30f}, {0.80f, 0.55f},
                             {0.92f, 0.66f}, {0.55f, 0.70f}, {0.80f, 0.73f}, {0.55f, 0.76f},
                             {1.0f, 0.80f},  {1.0f, 0.99f},  {0.9f, 1.0f},   {0, 1.0f}};
  for (Vec2f& p : profile) p = {p.x * thick, p.y * height};
  return turned(profile, segments(60, 15), segments(28, 8));
}

Mesh DiningRoom::turned(const std::vector<Vec2f>& profile, int rows, int around) const {
  const auto curve = smoothCurve(profile);
  if (light_ == DiningLight::glow) return revolve(curve, rows, around);
  std::vector<Vec2f> points;
  for (int i = 0; i <= rows; ++i) {
    const Vec2f p = curve(fraction(i, rows));
    points.push_back({std::max(p.x, 0.f), p.y});
  }
  return lathe(points, around, 60);
}

void DiningRoom::addTable() {
  put(extrude(rounded(rectangle(1.05f, 0.52f), 0.12f, segments(10, 2)), 0.035f, 0.012f,
              segments(4, 1)),
      {0, kTableTop - 0.035, 0}, wood_, "table top");
  put(block({0.90f, 0.04f, 0.38f}, 0.005f), {0, kTableTop - 0.076, 0}, wood_, "table apron");
  const MeshHandle mesh = add(leg(kTable - 0.036f, 0.045f), "table leg");
  for (int i = 0; i < 4; ++i)
    place(mesh, translation({i % 2 == 0 ? -0.88 : 0.88, 0, i < 2 ? -0.36 : 0.36}), wood_,
          fmt::format("table leg {}", i + 1));
  put(block({0.95f, 0.0015f, 0.17f}, 0.001f), {0, kTableTop + 0.0015, 0}, linen_, "runner");
}

void DiningRoom::addChairs() {
  // Its back at -z.
  std::vector<Mesh> frame;
  for (const float x : {-0.19f, 0.19f}) {
    frame.push_back(translated(leg(0.44f, 0.024f), {x, 0, 0.19f}));
    SweepOptions options;
    options.sideHint = {1, 0, 0};
    frame.push_back(sweep(rounded(rectangle(0.016f, 0.020f), 0.008f, 2),
                          smoothCurve3({{x, 0, -0.24f},
                                        {x, 0.24f, -0.19f},
                                        {x, 0.46f, -0.185f},
                                        {x * 1.02f, 0.75f, -0.22f},
                                        {x * 1.05f, 1.02f, -0.30f}}),
                          segments(36, 8), options));
    frame.push_back(
        translated(withProjectedUvs(roundedBox({0.012f, 0.025f, 0.18f}, 0.005f, segments(2, 1))),
                   {x, 0.415f, 0}));
  }
  for (const float z : {-0.19f, 0.19f})
    frame.push_back(
        translated(withProjectedUvs(roundedBox({0.18f, 0.025f, 0.012f}, 0.005f, segments(2, 1))),
                   {0, 0.415f, z}));
  for (int i = 0; i < 3; ++i) {  // bowed slats
    const float y = 0.62f + 0.16f * static_cast<float>(i),
                z = -0.20f - 0.042f * static_cast<float>(i);
    SweepOptions options;
    options.sideHint = {0, 1, 0};
    frame.push_back(
        sweep(rounded(rectangle(i == 2 ? 0.045f : 0.026f, 0.008f), 0.007f, 2),
              smoothCurve3({{-0.195f, y, z}, {0, y + 0.012f, z - 0.035f}, {0.195f, y, z}}),
              segments(24, 6), options));
  }
  const MeshHandle wood = add(merged(frame), "chair");
  const MeshHandle seat =
      add(superellipsoid({0.225f, 0.042f, 0.225f}, 0.55f, 0.35f, segments(20, 6), segments(48, 12)),
          "seat");
  const struct {
    double x, z, turn;
  } places[] = {{-0.55, -0.72, 0}, {0.52, -0.74, 3},  {-0.50, 0.78, 183},
                {0.58, 0.86, 168}, {-1.38, 0.02, 91}, {1.36, -0.06, -86}};
  for (int i = 0; i < 6; ++i) {
    const Mat4 at =
        translation({places[i].x, 0, places[i].z}) * rotation({0, 1, 0}, places[i].turn);
    place(wood, at, wood_, fmt::format("chair {}", i + 1));
    place(seat, at * translation({0, 0.46, 0}), leather_, fmt::format("chair {}, seat", i + 1));
  }
}

void DiningRoom::addSideboard() {
  const double z = kBack + 0.26;
  put(block({0.95f, 0.36f, 0.22f}, 0.01f), {0.1, 0.52, z}, wood_, "sideboard");
  put(block({0.99f, 0.016f, 0.245f}, 0.01f), {0.1, 0.896, z}, wood_, "sideboard top");
  const MeshHandle door = add(block({0.215f, 0.31f, 0.012f}, 0.008f), "door"),
                   knob = add(ball(0.016f, segments(12, 5), segments(20, 8)), "knob"),
                   foot = add(leg(0.17f, 0.035f), "foot");
  for (int i = 0; i < 4; ++i) {
    const double x = 0.1 - 0.6975 + 0.465 * i;
    place(door, translation({x, 0.52, z + 0.226}), wood_, fmt::format("door {}", i + 1));
    place(knob, translation({x + (i % 2 == 0 ? 0.18 : -0.18), 0.55, z + 0.252}), brass_,
          fmt::format("knob {}", i + 1));
    place(foot, translation({i % 2 == 0 ? -0.78 : 0.98, 0, z + (i < 2 ? -0.17 : 0.17)}), wood_,
          fmt::format("foot {}", i + 1));
  }
  const Fineness coarse = [this](int atDetailOne, int least) {
    return segments(atDetailOne * 5 / 9, least);
  };
  const double top = 0.912;
  place(add(teapot(coarse), "teapot"),
        translation({-0.45, top, z}) * rotation({0, 1, 0}, 25) * scaling(Vec3d(0.20)), porcelain_,
        "teapot");
  put(revolve(smoothCurve({{0, 0},
                           {0.06f, 0},
                           {0.07f, 0.01f},
                           {0.11f, 0.10f},
                           {0.12f, 0.19f},
                           {0.07f, 0.29f},
                           {0.045f, 0.34f},
                           {0.07f, 0.39f},
                           {0.066f, 0.392f},
                           {0.04f, 0.34f},
                           {0.062f, 0.29f},
                           {0.11f, 0.19f},
                           {0.06f, 0.03f},
                           {0, 0.02f}}),
              segments(65, 13), segments(64, 10)),
      {0.86, top, z}, glaze_, "vase");
  candle({0.45, top, z}, 0.18, "candle 3");
  candle({0.60, top, z - 0.05}, 0.14, "candle 4");
}

// In a frame of brass.
void DiningRoom::addMirror() {
  Material mirror;  // of old silver, where mirrors cannot be followed
  mirror.type =
      light_ == DiningLight::glow ? MaterialType::conductor : MaterialType::roughConductor;
  mirror.eta = kSilver.eta, mirror.k = kSilver.k;
  put(extrude(ellipse(0.40f, 0.53f, segments(96, 16)), 0.01f), {0, 0, 0}, add(mirror, "mirror"),
      "mirror");
  scene().instances.back().toWorld =
      Transform(translation({0.1, 1.66, kBack + 0.005}) * rotation({1, 0, 0}, 90));
  SweepOptions closed;
  closed.closed = true, closed.capped = false;
  closed.sideHint = {0, 0, 1};
  std::vector<Vec3f> oval;
  for (int i = 0; i < 16; ++i) {
    const Vec2f c = circle(i, 16);
    oval.push_back({0.415f * c.x, 0.545f * c.y, 0});
  }
  put(tube(smoothCurve3(oval, true), 0.024f, segments(144, 24), segments(16, 6), closed),
      {0.1, 1.66, kBack + 0.02}, brass_, "mirror frame");
}

}  // namespace lobelia::builtin
