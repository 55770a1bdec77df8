// `machine`: a motorcycle in a studio, of the size of the one in [P004 figure 9] (112,000
// vertices): spokes, fins and a chain for shadows of many scales, metals, paint, rubber, leather.
// Here: its body and controls.
#include "lobelia/builtin/machine.h"

#include <cmath>

#include "lobelia/builtin/environment.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/refine.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"

namespace lobelia::builtin {

Scene Machine::make() {
  addMaterials();
  addWheel(kRearAxle, 0.32f, 0.130f, "rear wheel");
  addWheel(kFrontAxle, 0.33f, 0.105f, "front wheel");
  addMudguards();
  addChain();
  addFrame();
  addSuspension();
  addEngine();
  addExhaust();
  addBody();
  addControls();
  put(heightfield(6, 5, segments(88, 4), segments(74, 4), [](Vec2f) { return 0.f; }), floor_,
      "floor");
  refine(scene(), 0.11f / detail());
  addStudioLight(*this, 0);
  addCamera("side", {0.75, 0.95, 3.3}, {0.03, 0.55, 0}, 38, 800, 600);
  addCamera("engine", {-0.25, 0.75, 1.25}, {-0.02, 0.42, 0}, 42, 800, 600);
  addCamera("chain", {-1.0, 0.75, -2.3}, {-0.15, 0.48, 0}, 38, 800, 600);
  scene().integrator = "path";
  scene().maxDepth = 10;
  return take();
}

Mesh Machine::hull(const std::vector<Station>& stations, float squareness, int along,
                   int around) const {
  std::vector<Vec2f> places, sizes;
  for (const Station& s : stations) {
    places.push_back({s.x, s.y});
    sizes.push_back({s.halfY, s.halfZ});
  }
  const auto place = smoothCurve(places), size = smoothCurve(sizes);
  const auto power = [squareness](float v) {
    return std::copysign(std::pow(std::abs(v), squareness), v);
  };
  const int n = segments(around, 8), rows = segments(along, static_cast<int>(stations.size()));
  std::vector<Ring> rings;
  for (int i = 0; i <= rows; ++i) {
    const Vec2f at = place(fraction(i, rows)), half = size(fraction(i, rows));
    Ring ring{{}, at.x};
    for (int k = 0; k < n; ++k) {
      const Vec2f c = circle(k, n);
      ring.outline.push_back({power(c.x) * half.x - at.y, power(c.y) * half.y});
    }
    rings.push_back(std::move(ring));
  }
  // Rings lie one above the other: y becomes x, and -x becomes y.
  return transformed(loft(rings, true, true), rotation({0, 0, 1}, -90));
}

Mesh Machine::bar(const std::vector<Vec3f>& points, float radius, float bend, int along,
                  int around) const {
  return tube(roundedPath(points, bend), radius, segments(along, 2), segments(around, 6));
}

Mesh Machine::lathed(const std::vector<Vec2f>& profile, int around) const {
  return lathe(profile, segments(around, 8));
}

void Machine::put(Mesh mesh, MaterialHandle material, const std::string& name, const Mat4& to) {
  place(add(std::move(mesh), name), to, material, name);
}

void Machine::putPair(const Mesh& mesh, MaterialHandle material, const std::string& name) {
  put(mesh, material, "right " + name);
  put(transformed(mesh, scaling({1, 1, -1})), material, "left " + name);
}

void Machine::addMaterials() {
  paint_ = add(coated(Rgb(0.30f, 0.018f, 0.022f), 0.05f), "paint");
  chrome_ = add(metal({{3.1f, 3.18f, 2.32f}, {3.3f, 3.33f, 3.14f}}, 0.09f), "chrome");
  steel_ = add(metal(kSteel, 0.22f), "steel");
  aluminium_ = add(metal(kAluminium, 0.28f), "aluminium");
  iron_ = add(coated(Rgb(0.045f, 0.045f, 0.048f), 0.38f), "cast iron");
  black_ = add(coated(Rgb(0.02f), 0.07f), "black enamel");
  rubber_ = add(coated(Rgb(0.028f), 0.5f), "rubber");
  leather_ = add(coated(Rgb(0.10f, 0.048f, 0.028f), 0.32f), "leather");
  brass_ = add(metal({{0.444f, 0.527f, 1.094f}, {3.695f, 2.765f, 1.829f}}, 0.18f), "brass");
  amber_ = add(coated(Rgb(0.55f, 0.20f, 0.01f), 0.06f), "amber lens");
  red_ = add(coated(Rgb(0.42f, 0.01f, 0.01f), 0.06f), "red lens");
  lens_ = add(coated(Rgb(0.50f, 0.52f, 0.54f), 0.04f), "lens");
  floor_ = add(coated(Rgb(0.20f, 0.195f, 0.19f), 0.22f), "floor");
}

void Machine::addBody() {
  put(hull({{-0.14f, 0.775f, 0.012f, 0.02f},
            {-0.13f, 0.775f, 0.045f, 0.055f},
            {-0.06f, 0.785f, 0.075f, 0.095f},
            {0.10f, 0.815f, 0.105f, 0.128f},
            {0.28f, 0.840f, 0.105f, 0.135f},
            {0.40f, 0.850f, 0.080f, 0.105f},
            {0.455f, 0.850f, 0.045f, 0.060f},
            {0.465f, 0.850f, 0.012f, 0.02f}},
           0.80f, 60, 56),
      paint_, "tank");
  put(lathed(
          {{0, 0}, {0.036f, 0}, {0.038f, 0.006f}, {0.034f, 0.020f}, {0.012f, 0.024f}, {0, 0.024f}},
          36),
      chrome_, "tank cap", translation({0.22, 0.935, 0}));
  put(hull({{-0.78f, 0.800f, 0.012f, 0.03f},
            {-0.77f, 0.800f, 0.030f, 0.075f},
            {-0.66f, 0.790f, 0.038f, 0.105f},
            {-0.50f, 0.775f, 0.040f, 0.118f},
            {-0.36f, 0.755f, 0.036f, 0.128f},
            {-0.22f, 0.755f, 0.036f, 0.095f},
            {-0.145f, 0.775f, 0.032f, 0.055f},
            {-0.135f, 0.778f, 0.012f, 0.03f}},
           0.72f, 60, 44),
      leather_, "seat");
  for (int i = 0; i < 7; ++i) {  // the seams of the seat
    const float x = -0.67f + 0.062f * static_cast<float>(i), y = 0.826f - 0.052f * fraction(i, 7);
    put(tube(smoothCurve3({{x, y - 0.036f, -0.092f},
                           {x, y - 0.004f, -0.055f},
                           {x, y + 0.003f, 0},
                           {x, y - 0.004f, 0.055f},
                           {x, y - 0.036f, 0.092f}}),
             0.006f, segments(24, 6), segments(8, 5)),
        leather_, "seam " + std::to_string(i + 1));
  }
  putPair(transformed(
              superellipsoid({0.12f, 0.10f, 0.022f}, 0.7f, 0.6f, segments(22, 8), segments(36, 12)),
              translation({-0.36, 0.585, 0.105}) * rotation({0, 0, 1}, -18)),
          paint_, "side cover");
  put(withProjectedUvs(roundedBox({0.11f, 0.085f, 0.075f}, 0.012f, segments(3, 1))), black_,
      "battery", translation({-0.36, 0.575, 0}));
  // Lamp and plate at the end.
  put(hull({{-0.855f, 0.735f, 0.006f, 0.006f},
            {-0.85f, 0.735f, 0.030f, 0.042f},
            {-0.815f, 0.735f, 0.040f, 0.055f},
            {-0.79f, 0.735f, 0.036f, 0.050f},
            {-0.785f, 0.735f, 0.01f, 0.01f}},
           0.8f, 14, 28),
      red_, "tail lamp");
  put(withProjectedUvs(roundedBox({0.003f, 0.065f, 0.10f}, 0.002f, 2)), lens_, "plate",
      translation({-0.905, 0.60, 0}) * rotation({0, 0, 1}, -12));
  put(bar({{-0.79f, 0.745f, 0}, {-0.86f, 0.69f, 0}, {-0.895f, 0.60f, 0}}, 0.012f, 0.03f, 14),
      black_, "plate holder");
}

void Machine::addControls() {
  put(bar({{0.38f, 1.055f, -0.40f},
           {0.44f, 1.085f, -0.24f},
           {0.485f, 1.02f, -0.075f},
           {0.485f, 1.02f, 0.075f},
           {0.44f, 1.085f, 0.24f},
           {0.38f, 1.055f, 0.40f}},
          0.0115f, 0.07f, 70, 14),
      chrome_, "handlebar");
  putPair(bar({{0.475f, 0.985f, 0.055f}, {0.485f, 1.022f, 0.055f}}, 0.015f, 0, 3), aluminium_,
          "riser");
  putPair(bar({{0.376f, 1.053f, 0.41f}, {0.420f, 1.0755f, 0.285f}}, 0.0175f, 0, 14, 18), rubber_,
          "grip");
  putPair(bar({{0.45f, 1.068f, 0.255f}, {0.475f, 1.055f, 0.29f}, {0.425f, 1.035f, 0.42f}}, 0.006f,
              0.03f, 20, 8),
          aluminium_, "lever");
  putPair(bar({{0.433f, 1.083f, 0.245f}, {0.42f, 1.12f, 0.28f}, {0.40f, 1.155f, 0.315f}}, 0.006f,
              0.04f, 16, 8),
          chrome_, "mirror stem");
  putPair(transformed(
              superellipsoid({0.014f, 0.045f, 0.07f}, 0.8f, 1, segments(16, 6), segments(32, 10)),
              translation({0.40, 1.175, 0.33}) * rotation({0, 1, 0}, 12)),
          chrome_, "mirror");
  // Head lamp: a shell, its rim and the glass.
  const Mat4 ahead = translation({0.58, 0.90, 0}) * rotation({0, 0, 1}, -94);
  put(lathed({{0, -0.10f},
              {0.035f, -0.094f},
              {0.07f, -0.065f},
              {0.088f, -0.02f},
              {0.092f, 0.03f},
              {0.088f, 0.032f},
              {0, 0.032f}},
             56),
      paint_, "head lamp", ahead);
  put(lathed({{0.080f, 0.034f},
              {0.095f, 0.028f},
              {0.099f, 0.038f},
              {0.095f, 0.048f},
              {0.084f, 0.050f},
              {0.080f, 0.034f}},
             56),
      chrome_, "lamp rim", ahead);
  put(lathed({{0, 0.034f},
              {0.083f, 0.034f},
              {0.080f, 0.044f},
              {0.055f, 0.056f},
              {0.03f, 0.061f},
              {0, 0.063f}},
             48),
      lens_, "lamp glass", ahead);
  putPair(bar({{0.555f, 0.885f, 0.10f}, {0.59f, 0.895f, 0.09f}}, 0.012f, 0, 3), black_, "lamp ear");
  for (const float z : {-0.05f, 0.05f})
    put(lathed({{0, 0},
                {0.038f, 0},
                {0.042f, 0.01f},
                {0.042f, 0.045f},
                {0.038f, 0.052f},
                {0.034f, 0.046f},
                {0, 0.046f}},
               36),
        black_, z < 0 ? "speedometer" : "rev counter",
        moving({0.535f, 0.995f, z}) * rotation({0, 0, 1}, 35));
  putPair(transformed(
              superellipsoid({0.03f, 0.026f, 0.026f}, 0.9f, 1, segments(14, 6), segments(24, 8)),
              translation({0.545, 0.86, 0.165})),
          amber_, "front indicator");
  putPair(bar({{0.535f, 0.86f, 0.10f}, {0.545f, 0.86f, 0.15f}}, 0.007f, 0, 4), chrome_,
          "indicator stem");
  putPair(transformed(
              superellipsoid({0.03f, 0.026f, 0.026f}, 0.9f, 1, segments(14, 6), segments(24, 8)),
              translation({-0.78, 0.715, 0.15})),
          amber_, "rear indicator");
  putPair(bar({{-0.77f, 0.735f, 0.07f}, {-0.78f, 0.715f, 0.135f}}, 0.007f, 0, 4), chrome_,
          "rear indicator stem");
  putPair(bar({{0.45f, 1.06f, 0.26f},
               {0.60f, 1.08f, 0.17f},
               {0.62f, 0.95f, 0.12f},
               {0.60f, 0.75f, 0.115f},
               {0.70f, 0.46f, 0.118f}},
              0.0045f, 0.12f, 50, 7),
          rubber_, "brake line");
  put(bar({{0.44f, 1.07f, -0.26f},
           {0.55f, 1.06f, -0.16f},
           {0.48f, 0.88f, -0.14f},
           {0.30f, 0.70f, -0.11f},
           {0.05f, 0.45f, -0.14f}},
          0.0045f, 0.12f, 50, 7),
      rubber_, "clutch cable");
}

// The numbers of segments round the paper's number of vertices from below.
Scene makeMachine(float detail) { return Machine(1.075f * detail).make(); }

}  // namespace lobelia::builtin
