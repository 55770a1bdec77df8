// `cornell`: a glossy variant of the Cornell box (C. M. Goral et al., "Modeling the Interaction of
// Light Between Diffuse Surfaces", SIGGRAPH 1984). A box of 2 x 2 x 2 with red and green walls, but
// on a polished chequered floor stand a golden torus knot on a lacquered block, a glazed vase, a
// glass ball and a copper ball, under a warm lamp that is somewhat larger than the original's.
//
// x right, y up, z to the viewer; the floor is y = 0, the open side z = 1.
#include <algorithm>
#include <cmath>

#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia::builtin {
namespace {

class Box : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make() {
    addRoom();
    addLamp();
    addBlockAndKnot();
    addVase();
    addBalls();
    addCamera();
    scene().integrator = "path";
    scene().maxDepth = 12;
    return take();
  }

 private:
  Mesh ball() const {
    return revolve(
        [](float t) { return Vec2f(t <= 0 || t >= 1 ? 0 : std::sin(kPi * t), -std::cos(kPi * t)); },
        segments(40, 8), segments(80, 12));
  }
  void addRoom() {
    Texture tiles;
    tiles.type = TextureType::checkerboard;
    tiles.a = add(Rgb(0.60f, 0.56f, 0.50f)), tiles.b = add(Rgb(0.14f, 0.13f, 0.13f));
    tiles.uvMatrix[0][0] = tiles.uvMatrix[1][1] = 4;  // 8 x 8 tiles
    const MaterialHandle floor = add(coated(add(tiles), 0.13f), "polished tiles");
    const MaterialHandle white = add(diffuse(Rgb(0.74f, 0.71f, 0.66f)), "white wall");
    const MaterialHandle red = add(diffuse(Rgb(0.60f, 0.055f, 0.045f)), "red wall");
    const MaterialHandle green = add(diffuse(Rgb(0.105f, 0.42f, 0.095f)), "green wall");
    square_ = add(io::unitRectangle(), "square");
    const Vec3d x{1, 0, 0}, y{0, 1, 0};
    place(square_, rotation(x, -90), floor, "floor");
    place(square_, translation({0, 2, 0}) * rotation(x, 90), white, "ceiling");
    place(square_, translation({0, 1, -1}), white, "back wall");
    place(square_, translation({-1, 1, 0}) * rotation(y, 90), red, "left wall");
    place(square_, translation({1, 1, 0}) * rotation(y, -90), green, "right wall");
  }

  void addLamp() {
    constexpr double kHalfX = 0.36, kHalfZ = 0.30, kDrop = 0.03;
    Emitter emitter;
    emitter.type = EmitterType::area;
    emitter.radiance = Rgb(21.f, 16.5f, 11.4f);
    const EmitterHandle lamp = add(emitter, "lamp");
    const MaterialHandle black = add(diffuse(Rgb(0.f)), "lamp glass");
    place(
        square_,
        translation({0, 2 - kDrop / 2, 0}) * rotation({1, 0, 0}, 90) * scaling({kHalfX, kHalfZ, 1}),
        black, "lamp", lamp);
    const MaterialHandle frame = add(metal(kSteel, 0.3f), "lamp frame");
    const double bar = 0.02;
    const auto barMesh = [&](double half) {
      return roundedBox(
          {static_cast<float>(half), static_cast<float>(kDrop / 2), static_cast<float>(bar)},
          0.008f, segments(3, 1));
    };
    const MeshHandle longBar = add(barMesh(kHalfX + 2 * bar), "long bar"),
                     shortBar = add(barMesh(kHalfZ), "short bar");
    const double height = 2 - kDrop / 2 - 1e-3;
    place(longBar, translation({0, height, kHalfZ + bar}), frame, "lamp frame, front");
    place(longBar, translation({0, height, -kHalfZ - bar}), frame, "lamp frame, back");
    const Mat4 turn = rotation({0, 1, 0}, 90);
    place(shortBar, translation({-kHalfX - bar, height, 0}) * turn, frame, "lamp frame, left");
    place(shortBar, translation({kHalfX + bar, height, 0}) * turn, frame, "lamp frame, right");
  }

  void addBlockAndKnot() {
    const Vec3d at{0.38, 0, -0.05};
    const Vec3f half{0.31f, 0.23f, 0.31f};
    const MaterialHandle lacquer = add(coated(Rgb(0.035f, 0.14f, 0.42f), 0.08f), "blue lacquer");
    place(add(roundedBox(half, 0.025f, segments(6, 1)), "block"),
          translation(at + Vec3d(0, static_cast<double>(half.y), 0)) * rotation({0, 1, 0}, -18),
          lacquer, "block");
    const MaterialHandle gold = add(metal(kGold, 0.2f), "gold");
    TorusKnot knot;
    knot.ring = 0.215f, knot.wind = 0.092f, knot.tube = 0.056f;
    const Mesh mesh = torusKnot(knot, segments(360, 48), segments(28, 8));
    // Upright, seen a little from the side.
    const Mat4 turn = rotation({0, 1, 0}, -28) * rotation({1, 0, 0}, 90) * rotation({0, 1, 0}, 30);
    place(add(mesh, "torus knot"),
          standing(mesh, turn, at + Vec3d(0, 2 * static_cast<double>(half.y), 0)), gold,
          "golden knot");
  }

  void addVase() {
    const MaterialHandle glaze = add(coated(Rgb(0.80f, 0.76f, 0.68f), 0.06f), "glaze");
    // From the middle of the foot up the outside, over the lip and down the inside.
    const auto profile = smoothCurve(
        {{0, 0},           {0.10f, 0},       {0.165f, 0.012f}, {0.185f, 0.06f},  {0.245f, 0.25f},
         {0.305f, 0.48f},  {0.290f, 0.70f},  {0.195f, 0.90f},  {0.118f, 1.04f},  {0.110f, 1.15f},
         {0.150f, 1.245f}, {0.168f, 1.262f}, {0.158f, 1.270f}, {0.125f, 1.225f}, {0.090f, 1.14f},
         {0.098f, 1.03f},  {0.170f, 0.90f},  {0.265f, 0.70f},  {0.280f, 0.48f},  {0.222f, 0.26f},
         {0.160f, 0.09f},  {0.09f, 0.05f},   {0, 0.045f}});
    const Mesh mesh = revolve(profile, segments(100, 23), segments(72, 12));
    place(add(mesh, "vase"), standing(mesh, Mat4(), {-0.46, 0, -0.40}), glaze, "vase");
  }

  void addBalls() {
    const MaterialHandle clear = add(glass(), "glass");
    const MaterialHandle copper = add(metal(kCopper, 0.2f), "copper");
    const MeshHandle mesh = add(ball(), "ball");
    const auto put = [&](double radius, double x, double z, MaterialHandle material,
                         const char* name) {
      place(mesh, translation({x, radius, z}) * scaling(Vec3d(radius)), material, name);
    };
    put(0.19, -0.20, 0.42, clear, "glass ball");
    put(0.14, -0.68, 0.36, copper, "copper ball");
  }

  void addCamera() {
    Camera camera;
    camera.name = "front";
    camera.toWorld = Transform(*lookAt({0, 1, 4.9}, {0, 1, 0}, {0, 1, 0}));
    // The open side, at a distance of 3.9, with a margin of 2.5 %.
    camera.fovX = 2 * std::atan(1.025f / 3.9f);
    camera.nearClip = 0.1f, camera.farClip = 100;
    camera.focusDistance = 4.9f;
    camera.width = camera.height = 640;
    camera.spp = 64;
    scene().cameras.push_back(camera);
  }

  MeshHandle square_;
};

}  // namespace

Scene makeCornell(float detail) { return Box(detail).make(); }

}  // namespace lobelia::builtin
