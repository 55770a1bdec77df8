// `box`: a Cornell box of glossy things, after figure 4 of [P000]: spheres of Phong exponent 10, 40
// and 80, a dragon of 80, a floor of 200 and a folding screen whose gloss varies over a pattern of
// yellow flowers; one point light. The paper's dragon is a scan, ours is a sculpture.
//
// x right, y up, z to the viewer; the room spans [-1.3, 1.3] x [0, 2] x [-1, 1], as wide as
// the picture.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/builtin/creatures.h"
#include "lobelia/builtin/flowers.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/textures.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia::builtin {
namespace {

class GlossyBox : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make() {
    addRoom();
    addScreen();
    addDragon();
    addSpheres();
    Emitter lamp;
    lamp.type = EmitterType::point;
    lamp.radiance = Rgb(2.2f, 2.0f, 1.7f);
    lamp.toWorld = Transform(translation({-0.125, 1.8125, 0.375}));
    add(lamp, "lamp");
    addCamera("front", {0.03, 1.02, 4.75}, {0.01, 0.97, 0}, 2 * 180 / kPi * std::atan(1.36 / 3.75),
              800, 600);
    scene().integrator = "path";
    scene().maxDepth = 10;
    return take();
  }

 private:
  TextureHandle times(TextureHandle a, float factor) {
    Texture texture;
    texture.type = TextureType::scale;
    texture.a = a;
    texture.scale = factor;
    return add(texture);
  }

  void addRoom() {
    const MaterialHandle floor = add(phong(Rgb(0.22f, 0.20f, 0.18f), Rgb(0.45f), 200), "floor");
    const MaterialHandle white = add(diffuse(Rgb(0.72f, 0.70f, 0.66f)), "white wall");
    const MaterialHandle red = add(diffuse(Rgb(0.60f, 0.06f, 0.05f)), "red wall");
    const MaterialHandle green = add(diffuse(Rgb(0.11f, 0.42f, 0.10f)), "green wall");
    square_ = add(io::unitRectangle(), "square");
    const Vec3d x{1, 0, 0}, y{0, 1, 0};
    constexpr double kHalf = 1.3;
    const Mat4 wide = scaling({kHalf, 1, 1});
    place(square_, rotation(x, -90) * wide, floor, "floor");
    place(square_, translation({0, 2, 0}) * rotation(x, 90) * wide, white, "ceiling");
    place(square_, translation({0, 1, -1}) * wide, white, "back wall");
    place(square_, translation({-kHalf, 1, 0}) * rotation(y, 90), red, "left wall");
    place(square_, translation({kHalf, 1, 0}) * rotation(y, -90), green, "right wall");
  }

  // Flowers of polished gold leaf on dark lacquer that is less and less polished downwards.
  MaterialHandle flowerMaterial() {
    constexpr int kSize = 512;
    const auto pick = [](Vec2f uv, Rgb ground, Rgb stem, Rgb leaf, Rgb petal, Rgb heart) {
      float tone = 0;
      switch (flowersAt(uv, &tone)) {
        case FlowerPart::ground:
          return ground;
        case FlowerPart::stem:
          return stem;
        case FlowerPart::leaf:
          return leaf * (0.6f + 0.4f * tone);
        case FlowerPart::petal:
          return petal * (0.55f + 0.45f * tone);
        case FlowerPart::heart:
          return heart;
      }
      return ground;
    };
    const auto base = [&](Vec2f uv) {
      return pick(uv, {0.022f, 0.026f, 0.045f}, {0.20f, 0.16f, 0.03f}, {0.03f, 0.12f, 0.05f},
                  {0.42f, 0.30f, 0.03f}, {0.30f, 0.08f, 0.02f});
    };
    const auto gloss = [&](Vec2f uv) {
      return pick(uv, Rgb(0.14f), {0.40f, 0.32f, 0.12f}, {0.10f, 0.25f, 0.12f},
                  {0.50f, 0.40f, 0.14f}, {0.45f, 0.20f, 0.10f});
    };
    const auto exponent = [&](Vec2f uv) {  // of 200
      return pick(uv, Rgb(0.08f + 0.16f * uv.y), Rgb(0.5f), Rgb(0.25f), Rgb(1.f), Rgb(0.4f)).x;
    };
    const Vec2f kPanels(1, 2);  // twice as high as wide
    const TextureHandle color = addBitmap(colorImage(kSize, kSize, base), kPanels, "screen-colour"),
                        specular =
                            addBitmap(colorImage(kSize, kSize, gloss), kPanels, "screen-gloss"),
                        sharpness = times(addBitmap(dataImage(kSize, kSize, exponent), kPanels,
                                                    "screen-exponent"),
                                          200);
    return add(phong(color, specular, sharpness), "flowered lacquer");
  }

  void addScreen() {
    constexpr float kHalfWidth = 0.33f, kHalfHeight = 0.66f, kBar = 0.022f;
    const MaterialHandle flowers = flowerMaterial();
    const MaterialHandle frame = add(phong(Rgb(0.10f, 0.05f, 0.02f), Rgb(0.30f), 60), "frame");
    const int bevel = segments(3, 1);
    const MeshHandle post = add(roundedBox({kBar, kHalfHeight + kBar, kBar}, 0.01f, bevel), "post"),
                     rail = add(roundedBox({kHalfWidth - kBar, kBar, 0.8f * kBar}, 0.01f, bevel),
                                "rail");
    // Folded like a letter: each panel turns the other way.
    double x = -0.95, z = -0.72;
    constexpr double kFold = 17;
    for (int i = 0; i < 3; ++i) {
      const double turn = i % 2 == 0 ? kFold : -kFold,
                   radians = turn * static_cast<double>(kPi) / 180;
      const Vec3d along{std::cos(radians), 0, -std::sin(radians)};
      const double w = static_cast<double>(kHalfWidth), h = static_cast<double>(kHalfHeight);
      const Vec3d middle = Vec3d(x, h + 0.06, z) + along * w;
      const Mat4 at = translation(middle) * rotation({0, 1, 0}, turn);
      const std::string panel = fmt::format("screen, panel {}", i + 1);
      place(square_, at * scaling({w, h, 1}), flowers, panel);
      place(post, at * translation({-w, 0, 0}), frame, panel + ", left post");
      place(post, at * translation({w, 0, 0}), frame, panel + ", right post");
      place(rail, at * translation({0, -h, 0}), frame, panel + ", lower rail");
      place(rail, at * translation({0, h, 0}), frame, panel + ", upper rail");
      x += 2 * w * along.x, z += 2 * w * along.z;
    }
  }

  void addDragon() {
    const MaterialHandle jade = add(phong(Rgb(0.18f, 0.34f, 0.22f), Rgb(0.50f), 80), "dragon");
    const MeshHandle dragon = add(dragonStatue(segments(125, 24)), "dragon");
    place(dragon, translation({0.12, 0, -0.12}) * rotation({0, 1, 0}, 24) * scaling(Vec3d(0.68)),
          jade, "dragon");
  }

  void addSpheres() {
    const MeshHandle mesh = add(ball(1, segments(64, 8), segments(110, 12)), "sphere");
    const auto put = [&](double radius, double x, double z, Rgb base, float exponent,
                         const char* name) {
      const MaterialHandle material = add(phong(base, Rgb(0.50f), exponent), name);
      place(mesh, translation({x, radius, z}) * scaling(Vec3d(radius)), material, name);
    };
    put(0.23, -0.80, 0.30, {0.30f, 0.06f, 0.04f}, 10, "sphere of exponent 10");
    put(0.18, -0.18, 0.64, {0.05f, 0.10f, 0.30f}, 40, "sphere of exponent 40");
    put(0.22, 0.86, 0.36, {0.30f, 0.22f, 0.05f}, 80, "sphere of exponent 80");
  }

  MeshHandle square_;
};

}  // namespace

Scene makeBox(float detail) { return GlossyBox(detail).make(); }

}  // namespace lobelia::builtin
