// `bird`: a wren with its tail cocked on a glossy table, in the light of an environment, after the
// Bird scene of [P002]: smooth curved bodies of Phong exponents 64 to 256 that reflect themselves.
// The tail stands over back and nape, the wings lie along the flanks, the beak points away from the
// breast: what each reflects of the others takes one, two and more bounces.
#include <cmath>

#include "lobelia/builtin/hall_light.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/sculpture.h"
#include "lobelia/builtin/solids.h"

namespace lobelia::builtin {
namespace {

constexpr float kDegree = kPi / 180;

// The bird looks along +x, its feet on y = 0, about 1.2 high; parts mirror in z.
Mesh body(int cells) {
  Sculpture s;
  s.ellipsoid({0, 0.56f, 0}, {0.46f, 0.33f, 0.32f}, 0, {0, 0, 22});          // trunk
  s.ellipsoid({0.17f, 0.58f, 0}, {0.29f, 0.31f, 0.30f}, 0.20f, {0, 0, 10});  // breast
  s.cone({0.20f, 0.74f, 0}, {0.31f, 0.93f, 0}, 0.22f, 0.19f, 0.16f);         // neck
  s.ellipsoid({0.35f, 0.98f, 0}, {0.225f, 0.20f, 0.195f}, 0.10f);            // head
  s.cone({-0.30f, 0.42f, 0}, {-0.46f, 0.50f, 0}, 0.16f, 0.09f, 0.16f);       // rump
  const size_t first = s.partCount();
  s.ellipsoid({0.06f, 0.36f, 0.15f}, {0.15f, 0.17f, 0.11f}, 0.10f, {0, 0, -20});  // thigh
  s.ball({0.455f, 1.025f, 0.172f}, 0.042f, 0.03f).carved = true;  // socket of the eye
  s.mirror(first, 2);
  return s.mesh(cells);
}

// A fan of feathers, up and back over the rump; outer ones lie behind.
Mesh tail(int cells) {
  Sculpture s;
  const Vec3f root{-0.36f, 0.44f, 0};
  constexpr float kLift = 113;  // degrees from straight ahead
  const float up = kLift * kDegree;
  for (int i = -3; i <= 3; ++i) {
    const float side = static_cast<float>(i), out = std::abs(side), fan = 6.5f * side * kDegree;
    const float half = 0.40f - 0.018f * out;
    const Vec3f along{std::cos(up), std::sin(up) * std::cos(fan), std::sin(up) * std::sin(fan)};
    const Vec3f behind = Vec3f(-std::sin(up), std::cos(up), 0) * (0.014f * out);
    s.ellipsoid(root + along * half + behind, {half, 0.030f, 0.062f}, 0.008f,
                {6.5f * side, 0, kLift});
  }
  return s.mesh(cells);
}

// Coverts over two rows of feathers that taper towards the tail's root.
Mesh wings(int cells) {
  Sculpture s;
  struct Feather {
    Vec3f centre;
    float half, width, pitch, yaw;
  };
  constexpr Feather kFeathers[] = {{{-0.30f, 0.430f, 0.205f}, 0.30f, 0.050f, 14, -20},
                                   {{-0.27f, 0.480f, 0.222f}, 0.29f, 0.052f, 17, -20},
                                   {{-0.24f, 0.530f, 0.232f}, 0.27f, 0.054f, 21, -20},
                                   {{-0.20f, 0.580f, 0.240f}, 0.25f, 0.056f, 25, -20},
                                   {{-0.10f, 0.490f, 0.282f}, 0.23f, 0.055f, 15, -12},
                                   {{-0.08f, 0.550f, 0.294f}, 0.22f, 0.058f, 19, -12},
                                   {{-0.05f, 0.610f, 0.298f}, 0.21f, 0.060f, 24, -12},
                                   {{-0.02f, 0.665f, 0.290f}, 0.19f, 0.058f, 30, -12}};
  for (const Feather& f : kFeathers)
    s.ellipsoid(f.centre, {f.half, f.width, 0.034f}, 0.012f, {0, f.yaw, f.pitch});
  s.ellipsoid({0.115f, 0.615f, 0.300f}, {0.17f, 0.135f, 0.055f}, 0.03f, {0, -3, 30});
  s.mirror(0, 2);
  return s.mesh(cells);
}

Mesh beak(int cells) {
  Sculpture s;
  s.chain({{0.52f, 0.985f, 0}, {0.64f, 0.985f, 0}, {0.80f, 0.945f, 0}}, {0.062f, 0.040f, 0.006f}, 8,
          0);
  s.chain({{0.52f, 0.945f, 0}, {0.63f, 0.935f, 0}, {0.77f, 0.922f, 0}}, {0.050f, 0.030f, 0.006f}, 8,
          0.008f);
  return s.mesh(cells);
}

Mesh legs(int cells) {
  Sculpture s;
  const Vec3f ankle{0.10f, 0.035f, 0.17f};
  s.chain({{0.07f, 0.30f, 0.15f}, {0.02f, 0.16f, 0.165f}, ankle}, {0.045f, 0.026f, 0.028f}, 8, 0);
  for (const Vec3f toe : {Vec3f(0.30f, 0.022f, 0.17f), Vec3f(0.26f, 0.022f, 0.28f),
                          Vec3f(0.26f, 0.022f, 0.07f), Vec3f(-0.06f, 0.022f, 0.18f)})
    s.chain({ankle, (ankle + toe) * 0.5f + Vec3f(0, 0.022f, 0), toe}, {0.030f, 0.024f, 0.014f}, 6,
            0.02f);
  s.mirror(0, 2);
  s.standOn(0);
  return s.mesh(cells);
}

class Bird : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make() {
    const MaterialHandle
        plumage = add(phong(Rgb(0.05f, 0.075f, 0.13f), Rgb(0.46f, 0.55f, 0.68f), 128), "plumage"),
        quills = add(phong(Rgb(0.10f, 0.05f, 0.025f), Rgb(0.66f, 0.50f, 0.34f), 64), "quills"),
        horn = add(phong(Rgb(0.16f, 0.09f, 0.02f), Rgb(0.70f, 0.56f, 0.28f), 256), "horn"),
        jet = add(phong(Rgb(0.01f), Rgb(0.70f), 256), "jet"),
        wood = add(phong(Rgb(0.15f, 0.135f, 0.12f), Rgb(0.42f), 128), "table");
    addPart(body(segments(61, 12)), plumage, "body");
    addPart(tail(segments(50, 10)), quills, "tail");
    addPart(wings(segments(66, 16)), quills, "wings");
    addPart(beak(segments(28, 8)), horn, "beak");
    addPart(legs(segments(44, 20)), horn, "legs");
    const MeshHandle eye = add(ball(0.042f, segments(18, 6), segments(28, 8)), "eye");
    for (const double z : {0.168, -0.168}) {
      place(eye, translation({0.452, 1.025, z}), jet, z > 0 ? "left eye" : "right eye");
    }
    place(add(roundSlab(1.5f, 0.10f, 0.03f, segments(4, 1), segments(60, 4)), "table"),
          translation({0, -0.10, 0}), wood, "table");
    addHallLight(*this, 75);
    addCamera("front", {1.55, 1.45, 2.75}, {0, 0.50, 0}, 36, 800, 600);
    addCamera("back", {-2.1, 1.75, 2.0}, {-0.05, 0.55, 0}, 36, 800, 600);
    scene().integrator = "path";
    scene().maxDepth = 10;
    return take();
  }

 private:
  void addPart(Mesh mesh, MaterialHandle material, const char* name) {
    place(add(std::move(mesh), name), Mat4{}, material, name);
  }
};

}  // namespace

Scene makeBird(float detail) { return Bird(detail).make(); }

}  // namespace lobelia::builtin
