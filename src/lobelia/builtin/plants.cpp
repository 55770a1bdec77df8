// `plants`: a table with potted plants and fruit in the light of a hall, of the size of the table
// with plants in [P004 figure 9] (114,000 vertices): many thin leaves and their fine shadows. Here:
// the table and its fruit.
#include "lobelia/builtin/plants.h"

#include <cmath>

#include "lobelia/builtin/hall_light.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/refine.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/textures.h"

namespace lobelia::builtin {

Scene Plants::make() {
  addTable();
  addFig({-0.42f, kTop, -0.14f});
  addFern({0.10f, kTop, -0.22f});
  addDracaena({0.53f, kTop, -0.12f});
  addIvy({-0.16f, kTop, 0.27f});
  addDaisies({0.38f, kTop, 0.20f});
  addFruit({0.08f, kTop, 0.16f});
  refine(scene(), 0.068f / detail());
  addHallLight(*this, 75);
  addCamera("front", {0.25, 1.42, 1.85}, {0.03, 0.90, -0.02}, 42, 800, 600);
  addCamera("leaves", {-0.75, 1.30, 0.75}, {-0.20, 0.93, 0}, 42, 800, 600);
  scene().integrator = "path";
  scene().maxDepth = 10;
  return take();
}

void Plants::put(Mesh mesh, Vec3f at, MaterialHandle material, const std::string& name) {
  place(add(std::move(mesh), name), moving(at), material, name);
}

float Plants::random(float low, float high) { return lerp(low, high, rng_.next1D()); }

void Plants::addTable() {
  Wood oak;
  oak.planks = 5, oak.seed = 21, oak.roughness = 0.16f;
  const SurfaceImages board = builtin::wood(oak, 512);
  const MaterialHandle wood = add(coated(addBitmap(board.color, {0.9f, 0.9f}, "oak-colour"),
                                         addBitmap(board.roughness, {0.9f, 0.9f}, "oak-roughness")),
                                  "oak");
  soil_ = add(diffuse(Rgb(0.045f, 0.028f, 0.018f)), "soil");
  stem_ = add(coated(Rgb(0.10f, 0.13f, 0.035f), 0.35f), "stem");
  clay_ = add(coated(Rgb(0.42f, 0.15f, 0.07f), 0.45f), "clay");
  glaze_ = add(coated(Rgb(0.04f, 0.11f, 0.22f), 0.07f), "blue glaze");
  white_ = add(coated(Rgb(0.70f, 0.68f, 0.62f), 0.10f), "white glaze");
  put(extrude(rounded(rectangle(0.88f, 0.48f), 0.07f, segments(10, 2)), 0.034f, 0.008f, 3),
      {0, kTop - 0.034f, 0}, wood, "table top");
  const Mesh rail = withProjectedUvs(roundedBox({0.70f, 0.04f, 0.014f}, 0.004f, 2)),
             end = withProjectedUvs(roundedBox({0.014f, 0.04f, 0.30f}, 0.004f, 2)),
             foot = withProjectedUvs(roundedBox({0.032f, 0.357f, 0.032f}, 0.005f, 2));
  for (const float s : {-1.f, 1.f}) {
    put(rail, {0, kTop - 0.0755f, 0.335f * s}, wood, s < 0 ? "back rail" : "front rail");
    put(end, {0.735f * s, kTop - 0.0755f, 0}, wood, s < 0 ? "left rail" : "right rail");
    for (const float z : {-0.335f, 0.335f})
      put(foot, {0.735f * s, 0.357f, z}, wood,
          std::string(s < 0 ? "left" : "right") + (z < 0 ? " back leg" : " front leg"));
  }
  put(heightfield(4, 3.4f, segments(52, 4), segments(44, 4), [](Vec2f) { return 0.f; }), {},
      add(coated(Rgb(0.20f, 0.17f, 0.14f), 0.3f), "floor"), "floor");
}

void Plants::addFruit(Vec3f at) {
  put(revolve(smoothCurve({{0, 0},
                           {0.06f, 0},
                           {0.075f, 0.004f},
                           {0.11f, 0.014f},
                           {0.142f, 0.030f},
                           {0.144f, 0.033f},
                           {0.139f, 0.034f},
                           {0.108f, 0.020f},
                           {0.07f, 0.010f},
                           {0, 0.009f}}),
              segments(36, 9), segments(72, 12)),
      at, white_, "plate");
  const Mesh apple = revolve(smoothCurve({{0, -0.026f},
                                          {0.012f, -0.031f},
                                          {0.026f, -0.025f},
                                          {0.038f, 0.002f},
                                          {0.033f, 0.026f},
                                          {0.017f, 0.033f},
                                          {0.006f, 0.026f},
                                          {0, 0.022f}}),
                             segments(28, 7), segments(40, 8));
  const MaterialHandle red = add(coated(Rgb(0.40f, 0.025f, 0.02f), 0.10f), "red apple"),
                       green = add(coated(Rgb(0.24f, 0.32f, 0.03f), 0.10f), "green apple");
  const MeshHandle mesh = add(apple, "apple"),
                   stalk = add(
                       tube(smoothCurve3(
                                {{0, 0.022f, 0}, {0.001f, 0.032f, 0}, {0.005f, 0.042f, 0.002f}}),
                            0.0014f, segments(6, 2), segments(6, 4)),
                       "stalk");
  for (int i = 0; i < 6; ++i) {
    const float a = 2.51f * static_cast<float>(i) / 2, r = i < 5 ? 0.066f : 0;
    const Mat4 to = moving(at + Vec3f(r * std::cos(a), i < 5 ? 0.041f : 0.088f, r * std::sin(a))) *
                    rotation({0.3 * i, 0, 1}, i < 5 ? 14.0 : -9.0);
    const std::string name = "apple " + std::to_string(i + 1);
    place(mesh, to, i % 2 == 0 ? red : green, name);
    place(stalk, to, stem_, name + ", stalk");
  }
}

Scene makePlants(float detail) { return Plants(detail).make(); }

}  // namespace lobelia::builtin
