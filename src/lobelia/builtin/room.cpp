// `room`: a dining room in the evening, lit by its own lamps, as the dining room of [P004], whose
// lights are local too: a table laid for six, a sideboard, a lamp over the table, two at the wall
// and candles. All of our own make.
//
// Metres; x right, y up, z to the viewer. The room spans [-2.6, 2.6] x [0, 2.7] x [-2.2, 2.6].
#include <fmt/format.h>

#include <cmath>

#include "lobelia/builtin/flowers.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"
#include "lobelia/builtin/teapot.h"
#include "lobelia/builtin/textures.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia::builtin {
namespace {

constexpr double kLeft = -2.6, kRight = 2.6, kBack = -2.2, kFront = 2.6, kHeight = 2.7;
constexpr float kTable = 0.76f;  // height of the table's top
constexpr double kTableTop = 0.76;

class DiningRoom : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make() {
    addMaterials();
    addShell();
    addTable();
    addChairs();
    addPlaces();
    addCentre();
    addSideboard();
    addLamps();
    addCurtains();
    addCamera("door", {1.85, 1.55, 2.45}, {-0.25, 0.88, -0.35}, 62, 800, 600);
    addCamera("table", {-1.0, 1.30, 1.55}, {0.15, 0.80, -0.1}, 45, 800, 600);
    scene().integrator = "path";
    scene().maxDepth = 12;
    return take();
  }

 private:
  TextureHandle bitmap(Image image, const char* name, float scaleU, float scaleV) {
    image.name = name;
    Texture texture;
    texture.type = TextureType::bitmap;
    texture.image = add(std::move(image));
    texture.uvMatrix[0][0] = scaleU, texture.uvMatrix[1][1] = scaleV;
    return add(texture);
  }

  void addMaterials() {
    Wood oak;
    oak.planks = 8;
    oak.seed = 4;
    const SurfaceImages planks = builtin::wood(oak, 512);
    const TextureHandle plankColor = bitmap(planks.color, "floor-colour", 2.5f, 2.5f),
                        plankRoughness = bitmap(planks.roughness, "floor-roughness", 2.5f, 2.5f);
    floor_ = add(coated(plankColor, plankRoughness), "oak floor");
    Wood walnut;
    walnut.light = {0.23f, 0.115f, 0.055f}, walnut.dark = {0.095f, 0.042f, 0.02f};
    walnut.planks = 1, walnut.seed = 9, walnut.roughness = 0.12f;
    const SurfaceImages board = builtin::wood(walnut, 512);
    wood_ = add(coated(bitmap(board.color, "walnut-colour", 1, 1), 0.14f), "walnut");
    wall_ = add(diffuse(Rgb(0.52f, 0.50f, 0.42f)), "wall");
    panel_ = add(coated(Rgb(0.16f, 0.24f, 0.22f), 0.25f), "panelling");
    ceiling_ = add(diffuse(Rgb(0.74f, 0.72f, 0.68f)), "ceiling");
    brass_ = add(metal({{0.444f, 0.527f, 1.094f}, {3.695f, 2.765f, 1.829f}}, 0.16f), "brass");
    silver_ = add(metal(kSilver, 0.12f), "silver");
    porcelain_ = add(coated(Rgb(0.76f, 0.75f, 0.72f), 0.08f), "porcelain");
    glaze_ = add(coated(Rgb(0.05f, 0.12f, 0.30f), 0.08f), "blue glaze");
    leather_ = add(coated(Rgb(0.26f, 0.055f, 0.035f), 0.28f), "leather");
    crystal_ = add(glass(), "crystal");
    linen_ = add(diffuse(Rgb(0.70f, 0.66f, 0.58f)), "linen");
    curtain_ = add(diffuse(Rgb(0.34f, 0.075f, 0.06f)), "curtain");
    wax_ = add(diffuse(Rgb(0.75f, 0.70f, 0.58f)), "wax");
    black_ = add(diffuse(Rgb(0.f)), "light");
  }

  Mesh block(Vec3f half, float radius) const {
    return withProjectedUvs(roundedBox(half, radius, segments(3, 1)));
  }
  void put(Mesh mesh, Vec3d at, MaterialHandle material, const std::string& name) {
    place(add(std::move(mesh), name), translation(at), material, name);
  }
  Emitter lamp(Rgb radiance) const {
    Emitter emitter;
    emitter.type = EmitterType::area;
    emitter.radiance = radiance;
    return emitter;
  }

  void addShell() {
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
    place(square, translation({0, mid, kFront}) * rotation(y, 180) * scaling({halfX, mid, 1}),
          wall_, "front wall");
    place(square, translation({kLeft, mid, midZ}) * rotation(y, 90) * scaling({halfZ, mid, 1}),
          wall_, "left wall");
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
          add(diffuse(bitmap(rug, "rug", 1, 1)), "rug"), "rug");
  }

  // Along a wall of the given half length whose frame has x along and z out of it.
  void addPanels(const Mat4& wall, double half, const char* side) {
    const auto rail = [&](double y, double height, double depth, const char* what) {
      place(add(block({static_cast<float>(half), static_cast<float>(height),
                       static_cast<float>(depth)},
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

  // A turned leg from the floor up.
  Mesh leg(float height, float thick) const {
    std::vector<Vec2f> profile{{0, 0},         {0.35f, 0},     {0.42f, 0.02f}, {0.36f, 0.06f},
                               {0.48f, 0.10f}, {0.40f, 0.13f}, {0.55f, 0.30f}, {0.80f, 0.55f},
                               {0.92f, 0.66f}, {0.55f, 0.70f}, {0.80f, 0.73f}, {0.55f, 0.76f},
                               {1.0f, 0.80f},  {1.0f, 0.99f},  {0.9f, 1.0f},   {0, 1.0f}};
    for (Vec2f& p : profile) p = {p.x * thick, p.y * height};
    return revolve(smoothCurve(profile), segments(60, 15), segments(28, 8));
  }

  void addTable() {
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

  void addChairs() {
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
    const MeshHandle seat = add(
        superellipsoid({0.225f, 0.042f, 0.225f}, 0.55f, 0.35f, segments(20, 6), segments(48, 12)),
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

  void addPlaces() {
    const MeshHandle plate = add(revolve(smoothCurve({{0, 0},
                                                      {0.07f, 0},
                                                      {0.078f, 0.004f},
                                                      {0.10f, 0.010f},
                                                      {0.135f, 0.020f},
                                                      {0.137f, 0.023f},
                                                      {0.133f, 0.024f},
                                                      {0.10f, 0.014f},
                                                      {0.075f, 0.008f},
                                                      {0, 0.007f}}),
                                         segments(27, 9), segments(56, 12)),
                                 "plate");
    const MeshHandle goblet = add(revolve(smoothCurve({{0, 0},
                                                       {0.030f, 0},
                                                       {0.034f, 0.003f},
                                                       {0.012f, 0.010f},
                                                       {0.0045f, 0.022f},
                                                       {0.0045f, 0.08f},
                                                       {0.014f, 0.092f},
                                                       {0.034f, 0.115f},
                                                       {0.040f, 0.145f},
                                                       {0.034f, 0.195f},
                                                       {0.0333f, 0.197f},
                                                       {0.0325f, 0.195f},
                                                       {0.0385f, 0.145f},
                                                       {0.0325f, 0.116f},
                                                       {0.012f, 0.095f},
                                                       {0, 0.094f}}),
                                          segments(45, 15), segments(40, 10)),
                                  "wine glass");
    const MeshHandle knife = add(block({0.010f, 0.0018f, 0.11f}, 0.0015f), "knife");
    const MeshHandle handle =
        add(superellipsoid({0.008f, 0.005f, 0.05f}, 0.8f, 0.6f, segments(8, 4), segments(16, 6)),
            "handle");
    const MeshHandle napkin = add(block({0.05f, 0.006f, 0.09f}, 0.005f), "napkin");
    const double y = kTableTop;
    const struct {
      double x, z, turn;
    } seats[] = {{-0.55, -0.34, 0}, {0.52, -0.34, 0}, {-0.52, 0.34, 180},
                 {0.55, 0.34, 180}, {-0.86, 0, 90},   {0.86, 0, -90}};
    for (int i = 0; i < 6; ++i) {
      // x to the guest's left, z to the middle of the table.
      const Mat4 at = translation({seats[i].x, y, seats[i].z}) * rotation({0, 1, 0}, seats[i].turn);
      const auto name = [&](const char* what) { return fmt::format("place {}, {}", i + 1, what); };
      place(plate, at, porcelain_, name("plate"));
      place(plate, at * translation({0, 0.0215, 0}) * scaling({0.72, 0.9, 0.72}), glaze_,
            name("small plate"));
      place(goblet, at * translation({-0.13, 0, 0.15}), crystal_, name("glass"));
      place(goblet, at * translation({-0.05, 0, 0.185}) * scaling(Vec3d(0.85)), crystal_,
            name("small glass"));
      for (const int s : {-1, 1}) {
        const char* side = s < 0 ? "right" : "left";
        place(knife, at * translation({0.165 * s, 0.002, 0.03}), silver_,
              fmt::format("place {}, {} blade", i + 1, side));
        place(handle, at * translation({0.165 * s, 0.005, -0.07}), silver_,
              fmt::format("place {}, {} handle", i + 1, side));
      }
      place(napkin, at * translation({0.22, 0.006, -0.01}), linen_, name("napkin"));
    }
  }

  void candle(Vec3d at, double height, const std::string& name) {
    if (!stick_.valid()) {
      stick_ = add(revolve(smoothCurve({{0, 0},
                                        {0.045f, 0},
                                        {0.05f, 0.008f},
                                        {0.03f, 0.02f},
                                        {0.012f, 0.04f},
                                        {0.018f, 0.07f},
                                        {0.010f, 0.10f},
                                        {0.010f, 0.15f},
                                        {0.020f, 0.175f},
                                        {0.012f, 0.19f},
                                        {0.024f, 0.21f},
                                        {0.022f, 0.216f},
                                        {0, 0.214f}}),
                           segments(60, 12), segments(36, 8)),
                   "candlestick");
      candle_ = add(cylinder(0.0105f, 1, 0.003f, 2, segments(24, 6)), "candle");
      flame_ = add(
          superellipsoid({0.0065f, 0.020f, 0.0065f}, 1.25f, 1, segments(14, 4), segments(16, 6)),
          "flame");
      glow_ = add(lamp(Rgb(320, 190, 75)), "candle light");
    }
    place(stick_, translation(at), silver_, name + ", stick");
    place(candle_, translation(at + Vec3d(0, 0.213, 0)) * scaling({1, height, 1}), wax_, name);
    place(flame_, translation(at + Vec3d(0, 0.213 + height + 0.024, 0)), black_, name + ", flame",
          glow_);
  }

  void addCentre() {
    candle({-0.32, kTableTop + 0.003, 0.01}, 0.16, "candle 1");
    candle({0.33, kTableTop + 0.003, -0.02}, 0.13, "candle 2");
    put(revolve(smoothCurve({{0, 0},
                             {0.05f, 0},
                             {0.06f, 0.006f},
                             {0.05f, 0.02f},
                             {0.09f, 0.045f},
                             {0.145f, 0.085f},
                             {0.165f, 0.10f},
                             {0.16f, 0.105f},
                             {0.13f, 0.085f},
                             {0.08f, 0.052f},
                             {0, 0.042f}}),
                segments(50, 10), segments(72, 12)),
        {0, kTableTop + 0.003, 0}, silver_, "bowl");
    const MeshHandle fruit = add(ball(1, segments(24, 6), segments(40, 8)), "fruit");
    const MaterialHandle orange = add(coated(Rgb(0.62f, 0.22f, 0.02f), 0.3f), "orange"),
                         apple = add(coated(Rgb(0.42f, 0.03f, 0.02f), 0.12f), "apple"),
                         pear = add(coated(Rgb(0.38f, 0.40f, 0.05f), 0.2f), "pear");
    const MaterialHandle kinds[] = {orange, apple, pear};
    for (int i = 0; i < 7; ++i) {
      const double a = 60.0 * i * static_cast<double>(kPi) / 180, r = i < 6 ? 0.075 : 0;
      place(fruit,
            translation({r * std::cos(a), kTableTop + (i < 6 ? 0.115 : 0.165), r * std::sin(a)}) *
                scaling({0.037, 0.035, 0.037}),
            kinds[i % 3], fmt::format("fruit {}", i + 1));
    }
  }

  void addSideboard() {
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
    // A mirror in a frame of brass.
    Material mirror;
    mirror.type = MaterialType::conductor;
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

  void addLamps() {
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
    place(bulb, translation({0, y + 0.10, 0}), black_, "bulb",
          add(lamp(Rgb(150, 108, 62)), "table lamp"));
    // At the wall beside the mirror.
    const EmitterHandle glow = add(lamp(Rgb(26, 18, 10)), "wall lamp");
    const MeshHandle arm =
        add(tube(smoothCurve3(
                     {{0, -0.10f, 0}, {0, -0.13f, 0.06f}, {0, -0.10f, 0.11f}, {0, -0.03f, 0.12f}}),
                 0.008f, segments(28, 6), segments(12, 6)),
            "arm");
    const MeshHandle cup =
        add(lathe({{0, -0.05f}, {0.03f, -0.045f}, {0.04f, -0.02f}, {0.036f, -0.018f}, {0, -0.03f}},
                  segments(40, 8)),
            "cup");
    const MeshHandle globe =
        add(superellipsoid({0.045f, 0.07f, 0.045f}, 0.9f, 1, segments(24, 6), segments(36, 8)),
            "globe");
    for (const double x : {-0.85, 1.05}) {
      const char* side = x < 0 ? "left" : "right";
      const Mat4 at = translation({x, 1.78, kBack});
      place(arm, at, brass_, fmt::format("{} wall lamp, arm", side));
      place(cup, at * translation({0, 0, 0.12}), brass_, fmt::format("{} wall lamp, cup", side));
      place(globe, at * translation({0, 0.052, 0.12}), black_, fmt::format("{} wall lamp", side),
            glow);
    }
  }

  // Drawn curtains on the left wall, and a rod.
  void addCurtains() {
    const int columns = segments(150, 20), rows = segments(16, 3);
    Mesh mesh = heightfield(1.0f, 2.3f, columns, rows, [](Vec2f uv) {
      return 0.035f * std::sin(kTwoPi * 11 * uv.x + 1.2f * std::sin(5 * uv.y)) *
             (0.55f + 0.45f * uv.y);
    });
    const MeshHandle curtain = add(std::move(mesh), "curtain");
    for (int i = 0; i < 2; ++i)
      place(curtain,
            translation({kLeft + 0.10, 1.19, -0.55 + 1.02 * i}) * rotation({0, 1, 0}, 90) *
                rotation({1, 0, 0}, 90),
            add(twoSided(curtain_), fmt::format("curtain {}", i + 1)),
            fmt::format("curtain {}", i + 1));
    put(tube([](float t) { return Vec3f(0, 0, 2.5f * (t - 0.5f)); }, 0.014f, 1, segments(20, 6)),
        {kLeft + 0.10, 2.37, -0.04}, brass_, "curtain rod");
  }
  static Material twoSided(MaterialHandle front) {
    Material m;
    m.type = MaterialType::twoSided;
    m.a = front;
    return m;
  }

  MaterialHandle floor_, wood_, wall_, panel_, ceiling_, brass_, silver_, porcelain_, glaze_,
      leather_, crystal_, linen_, curtain_, wax_, black_;
  MeshHandle stick_, candle_, flame_;
  EmitterHandle glow_;
};

}  // namespace

// The numbers of segments above are for a closer look; a room of the paper's size needs fewer.
Scene makeRoom(float detail) { return DiningRoom(0.62f * detail).make(); }

}  // namespace lobelia::builtin
