// `teapot-lamp`: a teapot with cups on a table in the corner of a room, lit by a spot and a point
// light, of the size of the teapot in [P004 figure 9] (86,000 vertices), which has local light,
// too.
#include <cmath>

#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/refine.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"
#include "lobelia/builtin/teapot.h"
#include "lobelia/builtin/textures.h"

namespace lobelia::builtin {
namespace {

// The teapot is 1 high, as in the scene `teapot`; x right, y up, z to the viewer.
class TeapotLamp : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make() {
    addMaterials();
    addCorner();
    const Fineness fine = [this](int atDetailOne, int least) {
      return segments(atDetailOne * 12 / 10, least);
    };
    place(add(teapot(fine), "teapot"), rotation({0, 1, 0}, 24), glaze_, "teapot");
    addCups();
    addTray();
    refine(scene(), 0.15f / detail());
    addSpot({-2.2, 3.6, 2.6}, {0.05, 0.25, 0}, Rgb(62, 54, 44), 15, 28, "spot");
    addPoint({1.9, 2.3, 1.3}, Rgb(5.5f, 6.2f, 7.4f), "lamp");
    addCamera("front", {0.55, 1.75, 4.3}, {0.10, 0.42, 0}, 38, 800, 600);
    scene().integrator = "path";
    scene().maxDepth = 10;
    return take();
  }

 private:
  void put(Mesh mesh, const Mat4& to, MaterialHandle material, const std::string& name) {
    place(add(std::move(mesh), name), to, material, name);
  }

  void addMaterials() {
    Wood board;
    board.planks = 4, board.seed = 13, board.roughness = 0.15f;
    board.light = {0.30f, 0.17f, 0.08f}, board.dark = {0.13f, 0.065f, 0.03f};
    const SurfaceImages planks = builtin::wood(board, 512);
    wood_ = add(coated(addBitmap(planks.color, {0.28f, 0.28f}, "table-colour"),
                       addBitmap(planks.roughness, {0.28f, 0.28f}, "table-roughness")),
                "table");
    const Image paper = stripes(Rgb(0.52f, 0.48f, 0.36f), Rgb(0.44f, 0.42f, 0.31f), 1, 0.5f, 64);
    wall_ = add(diffuse(addBitmap(paper, {9, 1}, "wallpaper")), "wall");
    glaze_ = add(coated(Rgb(0.34f, 0.055f, 0.035f), 0.07f), "red glaze");
    white_ = add(coated(Rgb(0.72f, 0.70f, 0.66f), 0.09f), "porcelain");
    silver_ = add(metal(kSilver, 0.14f), "silver");
    tea_ = add(coated(Rgb(0.16f, 0.045f, 0.012f), 0.03f), "tea");
    sugar_ = add(diffuse(Rgb(0.78f, 0.77f, 0.74f)), "sugar");
  }

  void addCorner() {
    put(extrude(rounded(rectangle(3.2f, 1.9f), 0.08f, segments(8, 2)), 0.14f, 0.03f, 3),
        translation({0.2, -0.14, 0}), wood_, "table");
    const auto wall = [&](float width, const char* name, const Mat4& to) {
      put(heightfield(width, 5, segments(static_cast<int>(width * 9), 4), segments(45, 4),
                      [](Vec2f) { return 0.f; }),
          to * rotation({1, 0, 0}, 90), wall_, name);
    };
    wall(7.4f, "back wall", translation({0.6, 1.3, -2.0}));
    wall(5.2f, "left wall", translation({-3.1, 1.3, 0.6}) * rotation({0, 1, 0}, 90));
    SweepOptions rail;
    rail.sideHint = {0, 0, 1};
    put(sweep(
            {{0, -0.05f}, {0.035f, -0.05f}, {0.05f, -0.02f}, {0.03f, 0.05f}, {0, 0.05f}},
            [](float t) { return Vec3f(-3.07f + 7.3f * t, 2.35f, -1.995f); }, segments(90, 6),
            rail),
        Mat4{}, wood_, "picture rail");
  }

  void addCups() {
    const MeshHandle saucer = add(revolve(smoothCurve({{0, 0},
                                                       {0.15f, 0},
                                                       {0.17f, 0.012f},
                                                       {0.27f, 0.035f},
                                                       {0.34f, 0.068f},
                                                       {0.343f, 0.076f},
                                                       {0.333f, 0.078f},
                                                       {0.26f, 0.052f},
                                                       {0.16f, 0.030f},
                                                       {0, 0.028f}}),
                                          segments(40, 9), segments(64, 12)),
                                  "saucer");
    const Mesh bowl = revolve(smoothCurve({{0, 0.005f},
                                           {0.09f, 0},
                                           {0.105f, 0.01f},
                                           {0.10f, 0.03f},
                                           {0.15f, 0.08f},
                                           {0.195f, 0.18f},
                                           {0.215f, 0.29f},
                                           {0.228f, 0.315f},
                                           {0.220f, 0.322f},
                                           {0.205f, 0.29f},
                                           {0.183f, 0.18f},
                                           {0.135f, 0.085f},
                                           {0, 0.05f}}),
                              segments(48, 12), segments(64, 12));
    const Mesh handle = tube(smoothCurve3({{0.19f, 0.26f, 0},
                                           {0.27f, 0.275f, 0},
                                           {0.315f, 0.21f, 0},
                                           {0.27f, 0.13f, 0},
                                           {0.165f, 0.105f, 0}}),
                             0.018f, segments(40, 8), segments(14, 6));
    const MeshHandle cup = add(merged({bowl, handle}), "cup"),
                     tea = add(lathe({{0.200f, 0}, {0, 0}}, segments(64, 12)), "tea");
    const struct { double x, z, turn; } places[] = {{1.12, 0.42, -35}, {-0.72, 0.95, 200}};
    for (int i = 0; i < 2; ++i) {
      const Mat4 at =
          translation({places[i].x, 0, places[i].z}) * rotation({0, 1, 0}, places[i].turn);
      const std::string number = std::to_string(i + 1);
      place(saucer, at, white_, "saucer " + number);
      place(cup, at * translation({0, 0.030, 0}), white_, "cup " + number);
      place(tea, at * translation({0, 0.265, 0}), tea_, "tea " + number);
    }
    // A spoon on the second saucer's rim.
    SweepOptions flat;
    flat.sideHint = {0, 0, 1};
    flat.scale = [](float t) { return 0.55f + 0.6f * t * t; };
    put(merged({sweep(ellipse(0.022f, 0.009f, 16),
                      smoothCurve3({{0.075f, 0.004f, 0},
                                    {0.16f, 0.022f, 0},
                                    {0.34f, 0.034f, 0},
                                    {0.54f, 0.012f, 0}}),
                      segments(30, 8), flat),
                superellipsoid({0.095f, 0.014f, 0.055f}, 1, 1, segments(14, 6), segments(32, 8))}),
        translation({0.33, 0.016, 1.08}) * rotation({0, 1, 0}, 24), silver_, "spoon");
  }

  // Sugar lumps in a silver bowl.
  void addTray() {
    const Vec3d at{-1.30, 0, -0.55};
    put(revolve(smoothCurve({{0, 0},
                             {0.16f, 0},
                             {0.18f, 0.012f},
                             {0.15f, 0.04f},
                             {0.22f, 0.10f},
                             {0.33f, 0.24f},
                             {0.345f, 0.25f},
                             {0.33f, 0.258f},
                             {0.21f, 0.125f},
                             {0, 0.075f}}),
                segments(50, 9), segments(88, 12)),
        translation(at), silver_, "sugar bowl");
    const MeshHandle lump =
        add(withProjectedUvs(roundedBox({0.055f, 0.040f, 0.055f}, 0.010f, segments(3, 1))), "lump");
    const struct {
      double x, y, z, turn;
    } lumps[] = {{-0.09, 0.145, 0.05, 20},
                 {0.08, 0.148, 0.06, 65},
                 {0.01, 0.148, -0.10, 40},
                 {-0.02, 0.232, 0.00, 5},
                 {0.16, 0.205, -0.06, 33}};
    for (int i = 0; i < 5; ++i)
      place(lump,
            translation(at + Vec3d(lumps[i].x, lumps[i].y, lumps[i].z)) *
                rotation({0.1, 1, 0.05}, lumps[i].turn),
            sugar_, "lump " + std::to_string(i + 1));
  }

  MaterialHandle wood_, wall_, glaze_, white_, silver_, tea_, sugar_;
};

}  // namespace

Scene makeTeapotLamp(float detail) { return TeapotLamp(detail).make(); }

}  // namespace lobelia::builtin
