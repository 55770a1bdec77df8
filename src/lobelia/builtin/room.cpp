// `room` and `dining`: a dining room in the evening, lit by its own lamps, as the dining room of
// [P004], whose lights are local too: a table laid for six, a sideboard, a lamp over the table, two
// at the wall and candles. All of our own make.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/builtin/dining_room.h"
#include "lobelia/builtin/flowers.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/refine.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"
#include "lobelia/builtin/textures.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia::builtin {

Scene DiningRoom::make() {
  addMaterials();
  addShell();
  addTable();
  addChairs();
  addPlaces();
  addCentre();
  addSideboard();
  addMirror();
  addLamps();
  if (light_ == DiningLight::points) addPoints();
  addCurtains();
  addCamera("door", {1.85, 1.55, 2.45}, {-0.25, 0.88, -0.35}, 62, 800, 600);
  addCamera("table", {-1.0, 1.30, 1.55}, {0.15, 0.80, -0.1}, 45, 800, 600);
  scene().integrator = "path";
  scene().maxDepth = 12;
  return take();
}

Mesh DiningRoom::block(Vec3f half, float radius) const {
  return withProjectedUvs(roundedBox(half, radius, segments(3, 1)));
}

void DiningRoom::put(Mesh mesh, Vec3d at, MaterialHandle material, const std::string& name) {
  place(add(std::move(mesh), name), translation(at), material, name);
}

EmitterHandle DiningRoom::glow(Rgb radiance, const std::string& name) {
  if (light_ == DiningLight::points) return {};
  Emitter emitter;
  emitter.type = EmitterType::area;
  emitter.radiance = radiance;
  return add(emitter, name);
}

void DiningRoom::addMaterials() {
  Wood oak;
  oak.planks = 8;
  oak.seed = 4;
  const SurfaceImages planks = builtin::wood(oak, 512);
  const TextureHandle plankColor = addBitmap(planks.color, {2.5f, 2.5f}, "floor-colour"),
                      plankRoughness = addBitmap(planks.roughness, {2.5f, 2.5f}, "floor-roughness");
  floor_ = add(coated(plankColor, plankRoughness), "oak floor");
  Wood walnut;
  walnut.light = {0.23f, 0.115f, 0.055f}, walnut.dark = {0.095f, 0.042f, 0.02f};
  walnut.planks = 1, walnut.seed = 9, walnut.roughness = 0.12f;
  const SurfaceImages board = builtin::wood(walnut, 512);
  wood_ = add(coated(addBitmap(board.color, {1, 1}, "walnut-colour"), 0.14f), "walnut");
  wall_ = add(diffuse(Rgb(0.52f, 0.50f, 0.42f)), "wall");
  panel_ = add(coated(Rgb(0.16f, 0.24f, 0.22f), 0.25f), "panelling");
  ceiling_ = add(diffuse(Rgb(0.74f, 0.72f, 0.68f)), "ceiling");
  brass_ = add(metal({{0.444f, 0.527f, 1.094f}, {3.695f, 2.765f, 1.829f}}, 0.16f), "brass");
  silver_ = add(metal(kSilver, 0.12f), "silver");
  porcelain_ = add(coated(Rgb(0.76f, 0.75f, 0.72f), 0.08f), "porcelain");
  glaze_ = add(coated(Rgb(0.05f, 0.12f, 0.30f), 0.08f), "blue glaze");
  leather_ = add(coated(Rgb(0.26f, 0.055f, 0.035f), 0.28f), "leather");
  // Cuts of visibility know no refraction.
  crystal_ =
      light_ == DiningLight::glow ? add(glass(), "crystal") : add(metal(kSilver, 0.18f), "pewter");
  linen_ = add(diffuse(Rgb(0.70f, 0.66f, 0.58f)), "linen");
  curtain_ = add(diffuse(Rgb(0.34f, 0.075f, 0.06f)), "curtain");
  wax_ = add(diffuse(Rgb(0.75f, 0.70f, 0.58f)), "wax");
  black_ = light_ == DiningLight::glow ? add(diffuse(Rgb(0.f)), "light")
                                       : add(diffuse(Rgb(0.8f, 0.74f, 0.62f)), "milk glass");
}

void DiningRoom::addShell() {
  const MeshHandle square = add(io::unitRectangle(), "square");
  const Vec3d x{1, 0, 0}, y{0, 1, 0};
  const double halfX = (kRight - kLeft) / 2, halfZ = (kFront - kBack) / 2,
               midZ = (kFront + kBack) / 2;
  place(square, translation({0, 0, midZ}) * rotation(x, -90) * scaling({halfX, halfZ, 1}), floor_,
        "floor");
  place(square, translation({0, kHeight, midZ}) * rotation(x, 90) * scaling({halfX, halfZ, 1}),
        ceiling_, "ceiling");
  const double mid = kHeight / 2;
  place(square, translation({0, mid, kBack}) * scaling({halfX, mid, 1}), wall_, "back wall");
  place(square, translation({0, mid, kFront}) * rotation(y, 180) * scaling({halfX, mid, 1}), wall_,
        "front wall");
  place(square, translation({kLeft, mid, midZ}) * rotation(y, 90) * scaling({halfZ, mid, 1}), wall_,
        "left wall");
  place(square, translation({kRight, mid, midZ}) * rotation(y, -90) * scaling({halfZ, mid, 1}),
        wall_, "right wall");
  // Panelling to the height of a chair, rails, and a cornice.
  addPanels(translation({0, 0, kBack}), halfX, "back");
  addPanels(translation({kLeft, 0, midZ}) * rotation(y, 90), halfZ, "left");
  addPanels(translation({kRight, 0, midZ}) * rotation(y, -90), halfZ, "right");
  // A rug of flowers.
  const Image rug = colorImage(512, 512, [](Vec2f uv) {
    float tone = 0;
    const float edge = std::min(std::min(uv.x, 1 - uv.x) * 1.5f, std::min(uv.y, 1 - uv.y));
    if (edge < 0.035f || (edge > 0.08f && edge < 0.095f)) return Rgb(0.42f, 0.30f, 0.13f);
    const Rgb ground = edge < 0.08f ? Rgb(0.05f, 0.06f, 0.13f) : Rgb(0.26f, 0.04f, 0.035f);
    switch (flowersAt({uv.x * 2, uv.y * 1.4f}, &tone)) {
      case FlowerPart::ground:
        return ground;
      case FlowerPart::stem:
        return Rgb(0.30f, 0.22f, 0.10f);
      case FlowerPart::leaf:
        return Rgb(0.08f, 0.13f, 0.07f);
      case FlowerPart::petal:
        return lerp(Rgb(0.45f, 0.36f, 0.22f), Rgb(0.30f, 0.18f, 0.10f), tone);
      case FlowerPart::heart:
        break;
    }
    return Rgb(0.06f, 0.09f, 0.20f);
  });
  place(add(roundedBox({1.7f, 0.006f, 1.15f}, 0.005f, 1), "rug"), translation({0, 0.006, 0.1}),
        add(diffuse(addBitmap(rug, {1, 1}, "rug")), "rug"), "rug");
}

void DiningRoom::addPanels(const Mat4& wall, double half, const char* side) {
  const auto rail = [&](double y, double height, double depth, const char* what) {
    place(
        add(block({static_cast<float>(half), static_cast<float>(height), static_cast<float>(depth)},
                  0.006f),
            fmt::format("{} {}", side, what)),
        wall * translation({0, y, depth}), panel_, fmt::format("{} {}", side, what));
  };
  rail(0.07, 0.07, 0.012, "skirting");
  rail(0.93, 0.025, 0.02, "dado rail");
  rail(kHeight - 0.05, 0.05, 0.035, "cornice");
  rail(0.5, 0.43, 0.004, "board");
  const int count = static_cast<int>(std::lround(half * 2 / 0.75));
  const double pitch = 2 * half / count;
  const MeshHandle frameH =
                       add(block({static_cast<float>(pitch / 2 - 0.09), 0.015f, 0.012f}, 0.005f),
                           fmt::format("{} moulding, level", side)),
                   frameV = add(block({0.015f, 0.30f, 0.012f}, 0.005f),
                                fmt::format("{} moulding, upright", side));
  for (int i = 0; i < count; ++i) {
    const double x = -half + pitch * (i + 0.5);
    for (const int s : {-1, 1}) {
      place(frameH, wall * translation({x, 0.52 + 0.285 * s, 0.012}), panel_,
            fmt::format("{} panel {}, {}", side, i + 1, s < 0 ? "lower" : "upper"));
      place(frameV, wall * translation({x + s * (pitch / 2 - 0.09), 0.52, 0.012}), panel_,
            fmt::format("{} panel {}, {}", side, i + 1, s < 0 ? "left" : "right"));
    }
  }
}

void DiningRoom::addLamps() {
  // Over the table: a shade of brass, open above and below, with a bulb in it.
  const double y = 1.52;
  put(lathe({{0.235f, 0},
             {0.24f, 0.004f},
             {0.17f, 0.12f},
             {0.09f, 0.19f},
             {0.05f, 0.20f},
             {0.046f, 0.196f},
             {0.085f, 0.185f},
             {0.165f, 0.115f},
             {0.235f, 0}},
            segments(96, 12), 30),
      {0, y, 0}, brass_, "lamp shade");
  put(cylinder(0.006f, static_cast<float>(kHeight - y - 0.19), 0.001f, 1, segments(16, 6)),
      {0, y + 0.19, 0}, brass_, "lamp rod");
  put(cylinder(0.06f, 0.025f, 0.008f, 2, segments(40, 8)), {0, kHeight - 0.025, 0}, brass_,
      "lamp rose");
  const MeshHandle bulb = add(ball(0.045f, segments(24, 6), segments(36, 8)), "bulb");
  place(bulb, translation({0, y + 0.10, 0}), black_, "bulb", glow(Rgb(150, 108, 62), "table lamp"));
  // At the wall beside the mirror.
  const EmitterHandle shine = glow(Rgb(26, 18, 10), "wall lamp");
  const MeshHandle arm =
      add(tube(smoothCurve3(
                   {{0, -0.10f, 0}, {0, -0.13f, 0.06f}, {0, -0.10f, 0.11f}, {0, -0.03f, 0.12f}}),
               0.008f, segments(28, 6), segments(12, 6)),
          "arm");
  const MeshHandle cup =
      add(lathe({{0, -0.05f}, {0.03f, -0.045f}, {0.04f, -0.02f}, {0.036f, -0.018f}, {0, -0.03f}},
                segments(40, 8)),
          "cup");
  const MeshHandle globe = add(
      superellipsoid({0.045f, 0.07f, 0.045f}, 0.9f, 1, segments(24, 6), segments(36, 8)), "globe");
  for (const double x : {-0.85, 1.05}) {
    const char* side = x < 0 ? "left" : "right";
    const Mat4 at = translation({x, 1.78, kBack});
    place(arm, at, brass_, fmt::format("{} wall lamp, arm", side));
    place(cup, at * translation({0, 0, 0.12}), brass_, fmt::format("{} wall lamp, cup", side));
    place(globe, at * translation({0, 0.052, 0.12}), black_, fmt::format("{} wall lamp", side),
          shine);
  }
}

void DiningRoom::addPoints() {
  addSpot({0, 1.50, 0}, {0, 0, 0}, Rgb(7.5f, 5.6f, 3.5f), 40, 68, "table lamp");
  for (const double x : {-0.85, 1.05})
    addPoint({x, 1.86, kBack + 0.26}, Rgb(1.0f, 0.72f, 0.42f),
             x < 0 ? "left wall lamp" : "right wall lamp");
  addPoint({0, 2.15, 0.4}, Rgb(1.3f, 1.1f, 0.85f), "ceiling");
}

void DiningRoom::addCurtains() {
  const int columns = segments(150, 20), rows = segments(16, 3);
  Mesh mesh = heightfield(1.0f, 2.3f, columns, rows, [](Vec2f uv) {
    return 0.035f * std::sin(kTwoPi * 11 * uv.x + 1.2f * std::sin(5 * uv.y)) *
           (0.55f + 0.45f * uv.y);
  });
  const MeshHandle curtain = add(std::move(mesh), "curtain");
  Material twoSided;
  twoSided.type = MaterialType::twoSided;
  twoSided.a = curtain_;
  for (int i = 0; i < 2; ++i)
    place(curtain,
          translation({kLeft + 0.10, 1.19, -0.55 + 1.02 * i}) * rotation({0, 1, 0}, 90) *
              rotation({1, 0, 0}, 90),
          add(twoSided, fmt::format("curtain {}", i + 1)), fmt::format("curtain {}", i + 1));
  put(tube([](float t) { return Vec3f(0, 0, 2.5f * (t - 0.5f)); }, 0.014f, 1, segments(20, 6)),
      {kLeft + 0.10, 2.37, -0.04}, brass_, "curtain rod");
}

// The numbers of segments are for a closer look; a room of the paper's size needs fewer.
Scene makeRoom(float detail) { return DiningRoom(0.62f * detail, DiningLight::glow).make(); }

// Of the paper's number of vertices with those that walls and floor need, too.
Scene makeDining(float detail) {
  Scene scene = DiningRoom(0.475f * detail, DiningLight::points).make();
  refine(scene, 0.37f / detail);
  return scene;
}

}  // namespace lobelia::builtin
