// The wheels of the motorcycle, with tyres, spokes and brakes; its mudguards and its chain.
#include <algorithm>
#include <cmath>

#include "lobelia/builtin/machine.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"

namespace lobelia::builtin {
namespace {

// Around the axis y; the tread has grooves that meet in the middle.
Mesh tyre(float radius, float width, int around, int across) {
  const float half = width / 2, centre = radius - half;
  constexpr int kBlocks = 36;
  Mesh mesh;
  for (int i = 0; i <= across; ++i)
    for (int j = 0; j <= around; ++j) {
      const Vec2f c = circle(i, across), turn = circle(j, around);
      // Flattened to the rim.
      const float out = c.x > -0.6f ? c.x : -0.6f;
      const float on = std::clamp((out - 0.25f) / 0.25f, 0.f, 1.f);  // the tread
      const float groove =
          std::sin(kTwoPi * (fraction(j % around, around) * kBlocks + 1.4f * std::abs(c.y)));
      const float edge = std::clamp(2.5f * groove + 0.9f, 0.f, 1.f);
      const float middle = std::clamp(std::abs(c.y) / 0.12f - 0.3f, 0.f, 1.f);
      const float depth = 0.006f * on * (1 - std::min(edge, middle));
      const float r = centre + out * half - depth;
      mesh.positions.push_back({r * turn.x, c.y * (half - 0.4f * depth), -r * turn.y});
      mesh.uvs.push_back({fraction(j, around), fraction(i, across)});
    }
  addGrid(mesh, 0, across, around);
  return creased(std::move(mesh), 50);
}

// A link of the chain along x around the pins at +-half, with rollers; z across.
Mesh chainLink(float half, bool isOuter, int corners) {
  const float gap = isOuter ? 0.0095f : 0.0065f;
  std::vector<Mesh> parts;
  const Polygon outline = rounded(rectangle(half + 0.0065f, 0.0072f), 0.0071f, corners);
  for (const float z : {-1.f, 1.f})
    parts.push_back(transformed(
        extrude(outline, 0.0022f, 0.0006f, 1),
        translation({0, 0, static_cast<double>(z * gap) - 0.0011}) * rotation({1, 0, 0}, 90)));
  if (!isOuter)
    for (const float x : {-half, half})
      parts.push_back(
          transformed(cylinder(0.0045f, 0.011f, 0.0005f, 1, 2 * corners),
                      translation({static_cast<double>(x), 0, -0.0055}) * rotation({1, 0, 0}, 90)));
  return merged(parts);
}

Polygon sprocket(float radius, int teeth) {
  Polygon outline;
  for (int i = 0; i < 4 * teeth; ++i)
    outline.push_back(circle(i, 4 * teeth) * (radius + (i % 4 < 2 ? 0.007f : -0.004f)));
  return outline;
}

}  // namespace

void Machine::addWheel(Vec3f axle, float radius, float width, const std::string& name) {
  const Mat4 turned = moving(axle) * rotation({1, 0, 0}, 90);
  const bool isFront = axle.x > 0;
  put(tyre(radius, width, segments(324, 36), segments(28, 8)), rubber_, name + ", tyre", turned);
  const float rim = radius - 0.80f * width, half = 0.36f * width;
  put(lathed({{rim - 0.012f, -0.5f * half},
              {rim + 0.012f, -half},
              {rim + 0.019f, -half},
              {rim + 0.021f, -0.9f * half},
              {rim + 0.006f, -0.45f * half},
              {rim + 0.006f, 0.45f * half},
              {rim + 0.021f, 0.9f * half},
              {rim + 0.019f, half},
              {rim + 0.012f, half},
              {rim - 0.012f, 0.5f * half},
              {rim - 0.016f, 0.2f * half},
              {rim - 0.016f, -0.2f * half},
              {rim - 0.012f, -0.5f * half}},
             120),
      chrome_, name + ", rim", turned);
  put(lathed({{0, -0.075f},
              {0.020f, -0.075f},
              {0.022f, -0.052f},
              {0.055f, -0.048f},
              {0.058f, -0.040f},
              {0.030f, -0.034f},
              {0.026f, 0},
              {0.030f, 0.034f},
              {0.058f, 0.040f},
              {0.055f, 0.048f},
              {0.022f, 0.052f},
              {0.020f, 0.075f},
              {0, 0.075f}},
             48),
      aluminium_, name + ", hub", turned);
  std::vector<Mesh> spokes;
  constexpr int kSpokes = 36;
  for (int i = 0; i < kSpokes; ++i) {  // they leave the hub sideways, to both sides in turn
    const float side = i % 2 == 0 ? 1.f : -1.f, lean = i % 4 < 2 ? 1.f : -1.f;
    const float a = kTwoPi * fraction(i, kSpokes), b = a + lean * 1.15f;
    const Vec3f outer{(rim - 0.012f) * std::cos(a), side * 0.010f, (rim - 0.012f) * std::sin(a)},
        inner{0.053f * std::cos(b), side * (0.044f + 0.004f * lean), 0.053f * std::sin(b)};
    spokes.push_back(bar({inner, outer}, 0.0024f, 0, 8, 7));
  }
  put(merged(spokes), chrome_, name + ", spokes", turned);
  put(bar({axle - Vec3f(0, 0, 0.155f), axle + Vec3f(0, 0, 0.155f)}, 0.011f, 0, 10), steel_,
      name + ", axle");
  if (!isFront) return;
  // Brake discs beside the hub, with callipers at the fork.
  for (const float z : {-0.066f, 0.066f}) {
    const char* side = z < 0 ? "left" : "right";
    put(lathed({{0.062f, -0.0025f},
                {0.145f, -0.0025f},
                {0.145f, 0.0025f},
                {0.062f, 0.0025f},
                {0.062f, -0.0025f}},
               96),
        steel_, std::string(side) + " brake disc", moving({0, 0, z}) * turned);
    put(lathed({{0.021f, -0.004f},
                {0.068f, -0.004f},
                {0.072f, 0.004f},
                {0.021f, 0.004f},
                {0.021f, -0.004f}},
               40),
        aluminium_, std::string(side) + " disc carrier", moving({0, 0, 0.985f * z}) * turned);
    put(withProjectedUvs(roundedBox({0.030f, 0.045f, 0.018f}, 0.010f, segments(3, 1))), iron_,
        std::string(side) + " calliper",
        moving({axle.x - 0.125f, axle.y + 0.045f, z}) * rotation({0, 0, 1}, 20));
  }
}

void Machine::addMudguards() {
  // A shell of a crescent, carried around the wheel between two angles (degrees from ahead).
  const auto guard = [&](Vec3f axle, float radius, float width, float from, float to) {
    constexpr int kHalf = 9;
    Polygon crescent;
    for (int i = 0; i <= kHalf; ++i)
      crescent.push_back({(fraction(i, kHalf) - 0.5f) * 2 * width,
                          0.035f * (1 - sqr(2 * fraction(i, kHalf) - 1))});
    for (int i = kHalf; i >= 0; --i) {
      const Vec2f p = crescent[static_cast<size_t>(i)];
      crescent.push_back({p.x * 0.97f, p.y - 0.004f});
    }
    std::reverse(crescent.begin(), crescent.end());
    SweepOptions options;
    options.sideHint = {0, 0, 1};
    return sweep(
        crescent,
        [=](float t) {
          const float a = lerp(from, to, t) * kPi / 180;
          return axle + Vec3f(std::cos(a), std::sin(a), 0) * radius;
        },
        segments(56, 10), options);
  };
  put(guard(kFrontAxle, 0.352f, 0.062f, 28, 165), paint_, "front mudguard");
  put(guard(kRearAxle, 0.355f, 0.078f, 38, 178), paint_, "rear mudguard");
  putPair(bar({{0.665f, 0.55f, 0.085f}, {0.66f, 0.655f, 0.058f}}, 0.006f, 0, 6, 8), chrome_,
          "mudguard stay");
  putPair(bar({{-0.775f, 0.335f, 0.125f}, {-1.0f, 0.525f, 0.074f}}, 0.006f, 0, 12, 8), chrome_,
          "rear mudguard stay");
}

void Machine::addChain() {
  const auto spread = [&](float radius, int teeth, Vec3f centre, const char* name) {
    put(extrude(sprocket(radius, teeth), 0.006f, 0.001f, 1), steel_, name,
        moving({centre.x, centre.y, kChainZ - 0.003f}) * rotation({1, 0, 0}, 90));
  };
  spread(kRearSprocket, 40, kRearAxle, "rear sprocket");
  spread(kFrontSprocket, 17, kGearbox, "front sprocket");
  // Around both sprockets: two tangents and two arcs, by length.
  const Vec3f line = kGearbox - kRearAxle;
  const float distance = length(line), R = kRearSprocket, r = kFrontSprocket;
  const float tilt = std::atan2(line.y, line.x), open = std::asin((R - r) / distance);
  const float straight = distance * std::cos(open);
  const float around[] = {straight, r * (kPi - 2 * open), straight, R * (kPi + 2 * open)};
  const float total = around[0] + around[1] + around[2] + around[3];
  const auto along = [&](float s, float* angle) {
    // The upper tangent leaves the rear sprocket at tilt + 90 degrees - open.
    const float up = tilt + kPi / 2 - open, down = tilt - kPi / 2 + open;
    const auto on = [](Vec3f c, float radius, float a) {
      return c + Vec3f(std::cos(a), std::sin(a), 0) * radius;
    };
    if (s < around[0]) {
      *angle = up - kPi / 2;
      return lerp(on(kRearAxle, R, up), on(kGearbox, r, up), s / around[0]);
    }
    if ((s -= around[0]) < around[1]) {
      *angle = up - s / r - kPi / 2;
      return on(kGearbox, r, up - s / r);
    }
    if ((s -= around[1]) < around[2]) {
      *angle = down - kPi / 2;
      return lerp(on(kGearbox, r, down), on(kRearAxle, R, down), s / around[2]);
    }
    s -= around[2];
    *angle = down - s / R - kPi / 2;
    return on(kRearAxle, R, down - s / R);
  };
  const int count = 2 * static_cast<int>(total / (2 * 0.0225f));
  const float pitch = total / static_cast<float>(count);
  const MeshHandle links[] = {add(chainLink(pitch / 2, false, segments(4, 2)), "inner link"),
                              add(chainLink(pitch / 2, true, segments(4, 2)), "outer link")};
  for (int i = 0; i < count; ++i) {
    float angle = 0;
    const Vec3f p = along((static_cast<float>(i) + 0.5f) * pitch, &angle);
    place(links[i % 2],
          translation(
              {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(kChainZ)}) *
              rotation({0, 0, 1}, static_cast<double>(angle) * 180 / static_cast<double>(kPi)),
          steel_, "link " + std::to_string(i + 1));
  }
}

}  // namespace lobelia::builtin
