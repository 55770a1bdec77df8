// The kitchen's lamps, sun and sky.
//
// Day: sun and sky through the window and twenty point lights in eight spots at the ceiling, seven
// below shelves and cabinets, two in the hood and three pendants over the island. The points sit in
// open housings that are black inside, as real spots have it. Stove: only the two lamps in the
// hood, as small areas. Evening: glowing bulbs in the pendants, the lamps in the hood, a darker
// sky.
#include <cmath>

#include "lobelia/builtin/kitchen_kit.h"
#include "lobelia/builtin/noise.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin::kitchen {
namespace {

double toDouble(float v) { return static_cast<double>(v); }

float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

// A sky that brightens to the horizon, soft clouds, hills and a meadow; horizon at the middle row.
Image skyImage(Rgb zenith, Rgb horizon, Rgb cloud, Rgb ground) {
  constexpr int kRows = 256;
  Image image;
  image.width = 2 * kRows, image.height = kRows;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float phi = kTwoPi * (static_cast<float>(x) + 0.5f) / static_cast<float>(image.width);
      const float theta = kPi * (static_cast<float>(y) + 0.5f) / kRows;
      const Vec3f d{std::sin(theta) * std::cos(phi), std::cos(theta),
                    std::sin(theta) * std::sin(phi)};
      // Hills far away, a row of trees before them.
      const Vec3f around{d.x, 0, d.z};
      const float hills = 0.045f + 0.05f * fbm(around * 4.f, 4, 3);
      const float trees = 0.01f + 0.07f * std::max(0.f, fbm(around * 14.f, 5, 11, 0.65f) + 0.15f);
      const float up = std::max(d.y, 0.f);
      const Rgb sky = lerp(horizon, zenith, std::pow(up, 0.55f));
      const float cover = smoothstep(0.0f, 0.45f, fbm(Vec3f(d.x, 2.5f * d.y, d.z) * 3.f, 5, 8));
      Rgb c = lerp(sky, cloud, 0.75f * cover * smoothstep(0.02f, 0.2f, up));
      const Rgb far = lerp(ground, horizon * 0.5f, 0.35f), grove = ground * 0.45f;
      const float rough = 0.75f + 0.5f * fbm(d * 24.f, 4, 5);
      const float pixel = 0.6f * kPi / kRows;
      c = lerp(c, far * rough, smoothstep(-pixel, pixel, hills - d.y));
      c = lerp(c, grove * rough, smoothstep(-pixel, pixel, trees - d.y));
      c = lerp(c, ground * (1.1f * rough), smoothstep(-pixel, pixel, -0.02f - d.y));
      for (int k = 0; k < 3; ++k) image.pixels.push_back(c[k]);
    }
  return image;
}

void addSky(KitchenKit& kit, const Image& image, float scale) {
  Emitter sky;
  sky.type = EmitterType::environment;
  sky.radiance = Rgb(0.f);
  sky.image = kit.add(image);
  sky.scale = scale;
  kit.add(sky, "sky");
}

void addDaylight(KitchenKit& kit) {
  addSky(kit,
         skyImage({0.16f, 0.32f, 0.70f}, {0.75f, 0.88f, 1.0f}, {1.15f, 1.12f, 1.08f},
                  {0.065f, 0.085f, 0.035f}),
         5);
  Emitter sun;
  sun.type = EmitterType::directional;
  sun.radiance = Rgb(52.f, 44.f, 33.f);
  sun.direction = normalize(Vec3f(0.86f, -0.41f, 0.27f));
  kit.add(sun, "sun");
}

void addPoint(KitchenKit& kit, Vec3d at, Rgb intensity, const char* name) {
  if (kit.lighting() == KitchenLighting::day) kit.addPoint(at, intensity, name);
}

const Rgb kWarm(1.0f, 0.78f, 0.50f);

// Open below, black inside; the light is in the opening.
struct Spot {
  MeshHandle outside, inside;
  double height;
};
Spot makeSpot(KitchenKit& kit, float radius, float height, const char* name) {
  const int around = kit.segments(36, 10);
  const float in = radius - 0.003f;
  Spot spot;
  spot.height = toDouble(height);
  spot.outside = kit.add(
      lathe(
          {{in, 0}, {radius, 0}, {radius, height - 0.003f}, {radius - 0.003f, height}, {0, height}},
          around),
      name);
  spot.inside =
      kit.add(lathe({{0, height - 0.005f}, {in, height - 0.005f}, {in, 0}}, around), name);
  return spot;
}
void putSpot(KitchenKit& kit, const Spot& spot, Vec3d underside, MaterialHandle material,
             float intensity, const char* name) {
  const Mat4 at = translation({underside.x, underside.y - spot.height, underside.z});
  kit.put(spot.outside, at, material, name);
  kit.put(spot.inside, at, kit.palette().black, name);
  addPoint(kit, {underside.x, underside.y - 0.72 * spot.height, underside.z}, kWarm * intensity,
           name);
}

void addSpots(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const Spot large = makeSpot(kit, 0.055f, 0.11f, "ceiling spot");
  for (const double z : {0.95, 2.0, 3.5, 4.8})
    for (const double x : {1.15, 3.55})
      putSpot(kit, large, {x, toDouble(kHeight), z}, m.trim, 1.6f, "ceiling spot");
  const Spot small = makeSpot(kit, 0.030f, 0.016f, "puck light");
  for (const double x : {0.30, 0.62, 0.94, 1.26})
    putSpot(kit, small, {x, toDouble(kShelfLow) - 0.034, 0.15}, m.chrome, 0.20f, "puck light");
  for (const double x : {2.82, 3.13, 3.44})
    putSpot(kit, small, {x, 1.50, 0.18}, m.chrome, 0.24f, "puck light");
}

// Two lamps let into the hood.
void addHoodLamps(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const double y = toDouble(kHoodLow) + 0.012, z = 0.30;
  const bool on = kit.lighting() != KitchenLighting::day;
  EmitterHandle lamp;
  if (on) {
    Emitter area;
    area.type = EmitterType::area;
    area.radiance =
        Rgb(1.0f, 0.83f, 0.60f) * (kit.lighting() == KitchenLighting::stove ? 900.f : 260.f);
    lamp = kit.add(area, "stove lamp");
  }
  const int around = kit.segments(32, 10);
  const MeshHandle
      glow = kit.add(disc(0.030f, around), "stove lamp"),
      rim = kit.add(
          lathe({{0.040f, 0.006f}, {0.040f, -0.004f}, {0.031f, -0.004f}, {0.031f, 0.006f}}, around),
          "stove lamp, rim");
  for (const double dx : {-0.27, 0.27}) {
    const double x = 0.5 * toDouble(kStoveLeft + kStoveRight) + dx;
    // The outside of the rim's wall is on its right as it runs: down outside, up inside.
    kit.put(glow, translation({x, y, z}) * rotation({1, 0, 0}, 180), m.bulb, "stove lamp", lamp);
    kit.put(rim, translation({x, y, z}) * rotation({1, 0, 0}, 180), m.chrome, "stove lamp, rim");
    addPoint(kit, {x, y - 0.05, z}, kWarm * 0.55f, "stove lamp");
  }
}

void addPendants(KitchenKit& kit) {
  const KitchenPalette& m = kit.palette();
  const int around = kit.segments(64, 14), rows = kit.segments(16, 5);
  // A bell: outside from the rim up, inside from the top down.
  std::vector<Vec2f> outside, inside;
  for (int i = 0; i <= rows; ++i) {
    const float t = fraction(i, rows);
    outside.push_back(
        {0.028f + 0.127f * std::cos(kPi / 2 * t), 0.17f * std::pow(std::sin(kPi / 2 * t), 1.2f)});
  }
  for (const Vec2f p : outside) inside.push_back({std::max(p.x - 0.002f, 0.f), p.y - 0.002f});
  outside.push_back({0, 0.172f});
  outside.insert(outside.begin(), inside.front());
  std::reverse(inside.begin(), inside.end());
  inside.insert(inside.begin(), Vec2f(0, inside.front().y));
  const MeshHandle shell = kit.add(lathe(outside, around), "pendant"),
                   lining = kit.add(lathe(inside, around), "pendant, lining");
  const MeshHandle bulb = kit.add(ball(0.032f, kit.segments(16, 6), kit.segments(28, 8)), "bulb");
  const MeshHandle socket =
      kit.add(cylinder(0.018f, 0.05f, 0.003f, 2, kit.segments(24, 8)), "socket");
  const double low = 1.86, top = toDouble(kHeight);
  const MeshHandle cord =
      kit.add(tube(roundedPath({{0, 0, 0}, {0, static_cast<float>(top - low - 0.16), 0}}, 0),
                   0.0035f, 1, kit.segments(8, 4)),
              "cord");
  const MeshHandle rose =
      kit.add(cylinder(0.045f, 0.02f, 0.004f, 2, kit.segments(32, 8)), "ceiling rose");
  EmitterHandle glow;
  if (kit.lighting() == KitchenLighting::evening) {
    Emitter area;
    area.type = EmitterType::area;
    area.radiance = kWarm * 130.f;
    glow = kit.add(area, "pendant");
  }
  for (const double dx : {-0.62, 0.0, 0.62}) {
    const Vec3d at{toDouble(kIsland.x) + dx, low, toDouble(kIsland.z)};
    kit.put(shell, translation(at), m.copper, "pendant");
    kit.put(lining, translation(at), m.lining, "pendant, lining");
    kit.put(socket, translation({at.x, low + 0.10, at.z}), m.brass, "socket");
    kit.put(bulb, translation({at.x, low + 0.075, at.z}), m.bulb, "bulb", glow);
    kit.put(cord, translation({at.x, low + 0.165, at.z}), m.black, "cord");
    kit.put(rose, translation({at.x, top - 0.018, at.z}), m.copper, "ceiling rose");
    addPoint(kit, {at.x, low + 0.01, at.z}, kWarm * 0.7f, "pendant");
  }
}

}  // namespace

void addLamps(KitchenKit& kit) {
  addSpots(kit);
  addHoodLamps(kit);
  addPendants(kit);
  switch (kit.lighting()) {
    case KitchenLighting::day:
      return addDaylight(kit);
    case KitchenLighting::evening:
      return addSky(kit,
                    skyImage({0.045f, 0.085f, 0.22f}, {0.85f, 0.42f, 0.22f}, {0.42f, 0.24f, 0.24f},
                             {0.015f, 0.02f, 0.015f}),
                    2.2f);
    case KitchenLighting::stove:
      return;
  }
}

}  // namespace lobelia::builtin::kitchen
