#include "lobelia/builtin/treasure_items.h"

#include <cmath>

#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin {
namespace {

// A grid of points that closes around y; at(i, angle) gives the i-th row's.
Mesh around(int rows, int segments, float creaseDegrees,
            const std::function<Vec3f(int, float)>& at) {
  Mesh mesh;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j <= segments; ++j) {
      const float f = fraction(j, segments);
      mesh.positions.push_back(at(i, kTwoPi * (j == segments ? 0.f : f)));
      mesh.uvs.push_back({f, fraction(i, rows)});
    }
  addGrid(mesh, 0, rows, segments);
  return creased(std::move(mesh), creaseDegrees);
}

Vec3f onCircle(float radius, float angle, float y) {
  return {radius * std::cos(angle), y, -radius * std::sin(angle)};
}

// Height of a crown's wall: points between arcs.
float crownHeight(float angle, int points) {
  const float lap = angle * static_cast<float>(points) / kTwoPi, f = lap - std::floor(lap);
  const float side = std::abs(2 * f - 1);  // 1 at a point, 0 between
  return 0.42f + 0.50f * std::pow(side, 2.2f) + 0.10f * std::max(0.f, 1 - 6 * (1 - side));
}

}  // namespace

Mesh coin(const Fineness& fine, int rays) {
  constexpr float kHalf = 0.08f;
  // Radius, height as part of the half thickness, share of the relief.
  struct Row {
    float radius, height, relief;
  };
  // Up the outside from the plain lower face to the middle of the upper one.
  const std::vector<Row> rows{{0, -0.45f, 0},       {0.78f, -0.45f, 0},   {0.84f, -0.95f, 0},
                              {1, -0.70f, 0},       {1, 0.70f, 0},        {0.96f, 0.95f, 0},
                              {0.83f, 0.95f, 0},    {0.78f, 0.45f, 0},    {0.66f, 0.45f, 1},
                              {0.36f, 0.45f, 0.5f}, {0.30f, 0.75f, 0.5f}, {0, 0.75f, 0}};
  return around(static_cast<int>(rows.size()) - 1, fine(34, 9), 35, [&](int i, float angle) {
    const Row& row = rows[static_cast<size_t>(i)];
    const float lift =
        0.45f * row.relief * std::max(0.f, std::cos(static_cast<float>(rays) * angle));
    return onCircle(row.radius, angle, kHalf * (row.height + lift));
  });
}

Mesh goblet(const Fineness& fine) {
  const auto profile = smoothCurve(
      {{0, 0},          {0.22f, 0},      {0.30f, 0.015f}, {0.29f, 0.05f},   {0.16f, 0.085f},
       {0.07f, 0.13f},  {0.055f, 0.22f}, {0.065f, 0.27f}, {0.125f, 0.31f},  {0.125f, 0.35f},
       {0.065f, 0.39f}, {0.06f, 0.43f},  {0.10f, 0.47f},  {0.24f, 0.53f},   {0.32f, 0.64f},
       {0.335f, 0.80f}, {0.36f, 0.97f},  {0.38f, 1.0f},   {0.365f, 1.005f}, {0.34f, 0.96f},
       {0.315f, 0.80f}, {0.30f, 0.65f},  {0.22f, 0.56f},  {0.10f, 0.51f},   {0, 0.50f}});
  const int rows = fine(110, 25);
  // Gadroons around the bowl.
  return around(rows, fine(96, 12), 60, [&](int i, float angle) {
    const Vec2f p = profile(fraction(i, rows));
    const bool outside = i < rows * 16 / 24;
    const float bowl = std::max(0.f, 1 - std::abs(p.y - 0.60f) / 0.13f);
    const float lobes = outside && p.x > 0.12f ? 0.06f * bowl * std::abs(std::cos(9 * angle)) : 0.f;
    return onCircle(i == 0 || i == rows ? 0.f : std::max(p.x, 0.f) * (1 + lobes), angle, p.y);
  });
}

Mesh dish(const Fineness& fine) {
  const auto profile = smoothCurve({{0, 0},
                                    {0.45f, 0},
                                    {0.52f, 0.02f},
                                    {0.56f, 0.05f},
                                    {0.72f, 0.10f},
                                    {0.95f, 0.155f},
                                    {1.0f, 0.175f},
                                    {0.99f, 0.20f},
                                    {0.93f, 0.19f},
                                    {0.72f, 0.135f},
                                    {0.56f, 0.08f},
                                    {0.48f, 0.045f},
                                    {0.30f, 0.04f},
                                    {0, 0.05f}});
  const int rows = fine(56, 14);
  return around(rows, fine(128, 16), 60, [&](int i, float angle) {
    const Vec2f p = profile(fraction(i, rows));
    const float flute = std::clamp((p.x - 0.60f) / 0.40f, 0.f, 1.f);
    const float wave = flute * std::cos(20 * angle);
    const float boss = 0.035f * std::max(0.f, 1 - p.x / 0.22f) * (i > rows / 2 ? 1.f : 0.f);
    return onCircle(i == 0 || i == rows ? 0.f : std::max(p.x, 0.f) * (1 + 0.025f * wave), angle,
                    p.y + 0.022f * wave + boss);
  });
}

Mesh crownBand(const Fineness& fine, int points) {
  // Around the section of the wall, from the lower edge inside to outside and up: distance from
  // the middle of the wall, share of the height. Mouldings run above and below the jewels.
  std::vector<Vec2f> section{{-0.02f, 0.02f}, {0.00f, 0},      {0.045f, 0.01f},  {0.055f, 0.04f},
                             {0.045f, 0.07f}, {0.025f, 0.09f}, {0.022f, 0.30f},  {0.045f, 0.32f},
                             {0.052f, 0.35f}, {0.045f, 0.38f}, {0.022f, 0.40f},  {0.020f, 0.70f},
                             {0.018f, 0.97f}, {0, 1},          {-0.016f, 0.97f}, {-0.02f, 0.5f},
                             {-0.02f, 0.02f}};
  const int rows = static_cast<int>(section.size()) - 1;
  return around(rows, fine(240, 6 * points), 50, [&](int i, float angle) {
    const Vec2f p = section[static_cast<size_t>(i)];
    // Only what is above the mouldings follows the points.
    const float full = crownHeight(angle, points);
    const float y = p.y <= 0.40f ? p.y * 0.92f : 0.368f + (p.y - 0.40f) / 0.60f * (full - 0.368f);
    return onCircle(0.93f + p.x + 0.14f * sqr(y), angle, y);
  });
}

Mesh crownArches(const Fineness& fine) {
  const std::vector<Vec2f> band = rounded(rectangle(0.07f, 0.025f), 0.02f, 2);
  std::vector<Mesh> parts;
  for (int i = 0; i < 2; ++i) {
    const float angle = kPi / 2 * static_cast<float>(i), c = std::cos(angle), s = std::sin(angle);
    const auto at = [&](float r, float y) { return Vec3f(r * c, y, r * s); };
    SweepOptions options;
    options.sideHint = Vec3f(-s, 0, c);
    const Curve arch = smoothCurve3({at(-1.02f, 0.85f), at(-1.0f, 1.20f), at(-0.62f, 1.45f),
                                     at(0, 1.30f + 0.01f * static_cast<float>(i)), at(0.62f, 1.45f),
                                     at(1.0f, 1.20f), at(1.02f, 0.85f)});
    parts.push_back(sweep(band, arch, fine(72, 12), options));
    for (int k = 1; k < 16; ++k)  // beads
      parts.push_back(translated(ball(0.045f, fine(8, 4), fine(14, 6)),
                                 arch(fraction(k, 16)) + Vec3f(0, 0.035f, 0)));
  }
  parts.push_back(translated(ball(0.15f, fine(28, 6), fine(48, 10)), {0, 1.46f, 0}));
  const auto bar = [&](Vec3f half, Vec3f at) {
    parts.push_back(translated(roundedBox(half, 0.02f, fine(3, 1)), at));
  };
  bar({0.035f, 0.16f, 0.035f}, {0, 1.74f, 0});
  bar({0.12f, 0.035f, 0.035f}, {0, 1.76f, 0});
  return merged(parts);
}

Mesh ringHoop(const Fineness& fine) {
  const int n = fine(20, 6);
  // Flat inside, and stronger towards the setting.
  Mesh hoop = around(n, fine(72, 12), 60, [&](int i, float angle) {
    const float a = kTwoPi * fraction(i % n, n), strength = 0.13f + 0.07f * std::cos(angle);
    const float r = 1 + strength * 0.5f * std::cos(a);
    return Vec3f(r * std::sin(angle), r * std::cos(angle), -strength * std::sin(a));
  });
  const Mesh setting = lathe({{0, 0.98f},
                              {0.22f, 1.0f},
                              {0.34f, 1.20f},
                              {0.42f, 1.30f},
                              {0.40f, 1.34f},
                              {0.30f, 1.28f},
                              {0, 1.24f}},
                             fine(28, 8));
  return merged({hoop, setting});
}

Mesh cutGem(int sides) {
  return lathe({{0, -0.75f},
                {0.55f, -0.40f},
                {1, 0},
                {1, 0.06f},
                {0.78f, 0.32f},
                {0.52f, 0.42f},
                {0, 0.42f}},
               sides, 5);
}

Mesh swordBlade(const Fineness& fine) {
  // A flat diamond with a fuller on each side.
  const std::vector<Vec2f> section{{-0.030f, 0},       {-0.010f, -0.0065f}, {-0.006f, -0.0035f},
                                   {0.006f, -0.0035f}, {0.010f, -0.0065f},  {0.030f, 0},
                                   {0.010f, 0.0065f},  {0.006f, 0.0035f},   {-0.006f, 0.0035f},
                                   {-0.010f, 0.0065f}};
  SweepOptions options;
  options.creaseDegrees = 12;
  options.scale = [](float t) { return (1 - 0.35f * t) * std::min(1.f, 0.02f + 7 * (1 - t)); };
  return sweep(
      section, [](float t) { return Vec3f(0, t, 0); }, fine(80, 24), options);
}

Mesh swordHilt(const Fineness& fine) {
  SweepOptions thinEnds;
  thinEnds.scale = [](float t) { return 0.6f + 0.6f * sqr(2 * t - 1); };
  const Mesh guard = tube(smoothCurve3({{-0.15f, 0.035f, 0},
                                        {-0.09f, 0.002f, 0},
                                        {0, -0.005f, 0},
                                        {0.09f, 0.002f, 0},
                                        {0.15f, 0.035f, 0}}),
                          0.017f, fine(48, 8), fine(16, 6), thinEnds);
  const int rows = fine(120, 20);
  // Wound with wire.
  const Mesh grip = around(rows, fine(28, 8), 60, [&](int i, float angle) {
    const float t = fraction(i, rows), body = 0.0175f + 0.004f * std::sin(kPi * t);
    const float wire = 0.0016f * std::cos(angle - 130 * t);
    const float r = i == 0 || i == rows ? 0 : body + wire;
    return onCircle(r, angle, -0.22f + 0.22f * t);
  });
  const Mesh pommel = translated(ball(0.034f, fine(24, 6), fine(40, 8)), {0, -0.245f, 0});
  const Mesh collar = translated(cylinder(0.024f, 0.014f, 0.004f, 2, fine(32, 8)), {0, -0.222f, 0});
  return merged({guard, grip, pommel, collar});
}

}  // namespace lobelia::builtin
