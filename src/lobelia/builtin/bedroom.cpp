// `bedroom`: a bedroom in daylight through its window and with a lamp, of the size of the bedroom
// in [P004 figure 9] (105,000 vertices). All lights are local: a spot and a point stand outside the
// window, a point in the lamp. Here: the room and its furniture.
#include "lobelia/builtin/bedroom.h"

#include <cmath>

#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/refine.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"
#include "lobelia/builtin/textures.h"

namespace lobelia::builtin {

Scene Bedroom::make() {
  addMaterials();
  addShell();
  addWindow();
  addCurtains();
  addBed();
  addCover();
  addPillows();
  addCupboard();
  addNightstands();
  addLights();
  refine(scene(), 0.16f / detail());
  addCamera("door", {1.75, 1.62, 2.05}, {-0.35, 0.78, -0.85}, 64, 800, 600);
  addCamera("bed", {-1.2, 1.35, 0.9}, {-0.1, 0.6, -1.1}, 50, 800, 600);
  scene().integrator = "path";
  scene().maxDepth = 12;
  return take();
}

Mesh Bedroom::block(Vec3f half, float radius) const {
  return withProjectedUvs(roundedBox(half, radius, segments(2, 1)));
}

void Bedroom::put(Mesh mesh, Vec3f at, MaterialHandle material, const std::string& name) {
  place(add(std::move(mesh), name), moving(at), material, name);
}

MaterialHandle Bedroom::bothSides(MaterialHandle material, const std::string& name) {
  Material both;
  both.type = MaterialType::twoSided;
  both.a = material;
  return add(both, name);
}

void Bedroom::addMaterials() {
  Wood ash;
  ash.planks = 8, ash.seed = 31;
  ash.light = {0.40f, 0.27f, 0.15f}, ash.dark = {0.22f, 0.13f, 0.065f};
  const SurfaceImages planks = builtin::wood(ash, 512);
  floor_ = add(coated(addBitmap(planks.color, {0.8f, 0.8f}, "floor-colour"),
                      addBitmap(planks.roughness, {0.8f, 0.8f}, "floor-roughness")),
               "floor");
  Wood cherry;
  cherry.planks = 1, cherry.seed = 17, cherry.roughness = 0.14f;
  cherry.light = {0.34f, 0.15f, 0.065f}, cherry.dark = {0.17f, 0.065f, 0.03f};
  const SurfaceImages board = builtin::wood(cherry, 512);
  wood_ = add(coated(addBitmap(board.color, {1, 1}, "cherry-colour"),
                     addBitmap(board.roughness, {1, 1}, "cherry-roughness")),
              "cherry");
  wall_ = add(diffuse(Rgb(0.58f, 0.58f, 0.52f)), "wall");
  white_ = add(coated(Rgb(0.70f, 0.69f, 0.66f), 0.20f), "white paint");
  sheet_ = add(diffuse(Rgb(0.74f, 0.72f, 0.68f)), "sheet");
  const SurfaceImages weave = fabric(Rgb(0.16f, 0.24f, 0.36f), Rgb(0.24f, 0.33f, 0.45f), 32, 256);
  cover_ = bothSides(add(diffuse(addBitmap(weave.color, {12, 12}, "cover")), "cover, one side"),
                     "cover");
  blanket_ = add(diffuse(Rgb(0.50f, 0.30f, 0.16f)), "cushion");
  curtain_ = bothSides(add(diffuse(Rgb(0.55f, 0.42f, 0.24f)), "curtain, one side"), "curtain");
  brass_ = add(metal({{0.444f, 0.527f, 1.094f}, {3.695f, 2.765f, 1.829f}}, 0.16f), "brass");
  shade_ = add(diffuse(Rgb(0.72f, 0.64f, 0.50f)), "shade");
  glaze_ = add(coated(Rgb(0.06f, 0.16f, 0.18f), 0.08f), "glaze");
  red_ = add(coated(Rgb(0.33f, 0.05f, 0.04f), 0.25f), "book");
}

void Bedroom::addShell() {
  const auto flat = [](float x, float z) {
    return heightfield(x, z, 1, 1, [](Vec2f) { return 0.f; });
  };
  const float width = kRight - kLeft, depth = kFront - kBack, midZ = (kFront + kBack) / 2;
  const auto wall = [&](Mesh mesh, Vec3f at, const Mat4& turn, MaterialHandle material,
                        const char* name) {
    place(add(std::move(mesh), name), moving(at) * turn, material, name);
  };
  const Mat4 none, facingZ = rotation({1, 0, 0}, 90),
                   facingX = rotation({0, 0, 1}, -90);  // z stays, up becomes +x
  wall(flat(width, depth), {0, 0, midZ}, none, floor_, "floor");
  wall(flat(width, depth), {0, kHeight, midZ}, rotation({1, 0, 0}, 180), white_, "ceiling");
  wall(flat(width, kHeight), {0, kHeight / 2, kBack}, facingZ, wall_, "back wall");
  wall(flat(width, kHeight), {0, kHeight / 2, kFront}, rotation({0, 1, 0}, 180) * facingZ, wall_,
       "front wall");
  wall(flat(kHeight, depth), {kRight, kHeight / 2, midZ}, rotation({0, 0, 1}, 90), wall_,
       "right wall");
  // Around the window.
  const auto strip = [&](float low, float high, float back, float front, const char* name) {
    wall(flat(high - low, front - back), {kLeft, (low + high) / 2, (back + front) / 2}, facingX,
         wall_, name);
  };
  strip(0, kSill, kBack, kFront, "wall below the window");
  strip(kLintel, kHeight, kBack, kFront, "wall above the window");
  strip(kSill, kLintel, kBack, kWindowBack, "wall behind the window");
  strip(kSill, kLintel, kWindowFront, kFront, "wall before the window");
  put(block({width / 2 - 0.001f, 0.05f, 0.009f}), {0, 0.051f, kBack + 0.010f}, white_,
      "back skirting");
  put(block({0.009f, 0.05f, depth / 2 - 0.03f}), {kLeft + 0.010f, 0.051f, midZ + 0.01f}, white_,
      "left skirting");
  put(block({1.0f, 0.008f, 0.65f}, 0.007f), {0.55f, 0.0085f, 1.05f}, blanket_, "rug");
}

void Bedroom::addWindow() {
  const float midY = (kSill + kLintel) / 2, midZ = (kWindowBack + kWindowFront) / 2,
              halfY = (kLintel - kSill) / 2, halfZ = (kWindowFront - kWindowBack) / 2;
  // The frame closes the depth of the wall; bars stand in its middle.
  const float x = kLeft - 0.06f;
  for (const float s : {-1.f, 1.f}) {
    put(block({0.085f, 0.03f, halfZ + 0.06f}), {x, midY + s * (halfY + 0.02f), midZ}, white_,
        s < 0 ? "window, below" : "window, above");
    put(block({0.080f, halfY - 0.011f, 0.03f}), {x, midY, midZ + s * (halfZ + 0.02f)}, white_,
        s < 0 ? "window, back" : "window, front");
  }
  put(block({0.02f, halfY - 0.011f, 0.022f}), {x, midY, midZ}, white_, "mullion");
  put(block({0.016f, 0.014f, halfZ - 0.011f}), {x, midY + 0.22f, midZ}, white_, "transom");
  put(block({0.11f, 0.014f, halfZ + 0.12f}), {kLeft + 0.075f, kSill - 0.040f, midZ}, white_,
      "sill");
  place(add(heightfield(4.4f, 5.0f, 1, 1, [](Vec2f) { return 0.f; }), "sky card"),
        moving({kLeft - 3.2f, midY + 0.2f, midZ - 0.8f}) * rotation({0, 0, 1}, -90),
        add(diffuse(Rgb(0.60f, 0.68f, 0.78f)), "sky card"), "sky card");
}

void Bedroom::addCurtains() {
  const int columns = segments(100, 20), rows = segments(34, 3);
  for (const float z : {kWindowBack - 0.22f, kWindowFront + 0.22f}) {
    const float phase = z < 0 ? 0.f : 1.7f;
    Mesh mesh = heightfield(0.62f, 2.08f, columns, rows, [phase](Vec2f uv) {
      return 0.038f * std::sin(kTwoPi * 7 * uv.x + phase + 1.3f * std::sin(4 * uv.y)) *
             (0.5f + 0.5f * uv.y);
    });
    const std::string name = z < 0 ? "back curtain" : "front curtain";
    place(add(std::move(mesh), name),
          moving({kLeft + 0.14f, 1.26f, z}) * rotation({0, 1, 0}, 90) * rotation({1, 0, 0}, 90),
          curtain_, name);
  }
  put(tube([](float t) { return Vec3f(0, 0, 2.3f * (t - 0.5f)); }, 0.014f, segments(20, 2),
           segments(16, 6)),
      {kLeft + 0.14f, 2.325f, (kWindowBack + kWindowFront) / 2}, brass_, "curtain rod");
}

void Bedroom::addCupboard() {
  const float x = 1.62f, z = kBack + 0.34f;
  put(block({0.43f, 0.96f, 0.29f}), {x, 1.06f, z}, wood_, "cupboard");
  put(block({0.45f, 0.045f, 0.31f}), {x, 0.052f, z}, wood_, "cupboard base");
  put(block({0.46f, 0.03f, 0.32f}, 0.015f), {x, 2.051f, z}, wood_, "cupboard top");
  for (const float s : {-1.f, 1.f}) {
    const std::string side = s < 0 ? "left" : "right";
    const float middle = x + 0.212f * s;
    put(block({0.205f, 0.915f, 0.011f}), {middle, 1.06f, z + 0.302f}, wood_, side + " door");
    for (const float y : {0.62f, 1.52f}) {
      const std::string name = side + (y < 1 ? " lower panel" : " upper panel");
      put(block({0.145f, y < 1 ? 0.40f : 0.38f, 0.012f}, 0.011f), {middle, y, z + 0.316f}, wood_,
          name);
    }
    put(ball(0.016f, segments(14, 5), segments(24, 8)), {x + 0.035f * s, 1.06f, z + 0.336f}, brass_,
        side + " knob");
  }
}

void Bedroom::addNightstands() {
  for (const float x : {kBedX - kBedHalf - 0.30f, kBedX + kBedHalf + 0.25f}) {
    const std::string side = x < kBedX ? "left" : "right";
    const float z = kBack + 0.25f;
    put(block({0.20f, 0.20f, 0.18f}), {x, 0.34f, z}, wood_, side + " nightstand");
    put(block({0.22f, 0.014f, 0.20f}), {x, 0.555f, z}, wood_, side + " nightstand top");
    put(block({0.175f, 0.075f, 0.009f}), {x, 0.44f, z + 0.19f}, wood_, side + " drawer");
    put(ball(0.013f, segments(12, 5), segments(20, 8)), {x, 0.44f, z + 0.211f}, brass_,
        side + " pull");
    for (int i = 0; i < 4; ++i)
      put(cylinder(0.018f, 0.138f, 0.003f, 2, segments(18, 6)),
          {x + (i % 2 == 0 ? -0.16f : 0.16f), 0, z + (i < 2 ? -0.14f : 0.14f)}, wood_,
          side + " foot " + std::to_string(i + 1));
    if (x < kBedX) {
      for (int i = 0; i < 3; ++i) {
        const float y = 0.586f + 0.033f * static_cast<float>(i);
        place(add(block({0.085f, 0.0155f, 0.12f}, 0.004f), "book " + std::to_string(i + 1)),
              moving({x + 0.03f, y, z}) * rotation({0, 1, 0}, 14.0 * i - 10),
              i == 1 ? glaze_ : red_, "book " + std::to_string(i + 1));
      }
      continue;
    }
    put(revolve(smoothCurve({{0, 0},
                             {0.06f, 0},
                             {0.068f, 0.01f},
                             {0.05f, 0.03f},
                             {0.075f, 0.09f},
                             {0.082f, 0.13f},
                             {0.05f, 0.20f},
                             {0.02f, 0.235f},
                             {0.018f, 0.25f},
                             {0, 0.25f}}),
                segments(46, 10), segments(48, 10)),
        {x, 0.570f, z}, glaze_, "lamp base");
    put(lathe({{0.135f, 0}, {0.137f, 0}, {0.085f, 0.19f}, {0.083f, 0.19f}, {0.135f, 0}},
              segments(56, 12)),
        {x, 0.80f, z}, shade_, "lamp shade");
    addPoint({static_cast<double>(x), 0.90, static_cast<double>(z)}, Rgb(2.2f, 1.55f, 0.9f),
             "lamp");
  }
}

void Bedroom::addLights() {
  addSpot({-4.6, 2.9, 0.35}, {-0.6, 0.75, -0.45}, Rgb(260, 236, 200), 16, 24, "sun");
  addPoint({-3.4, 2.3, -0.2}, Rgb(26, 29, 34), "sky");
}

Scene makeBedroom(float detail) { return Bedroom(detail).make(); }

}  // namespace lobelia::builtin
