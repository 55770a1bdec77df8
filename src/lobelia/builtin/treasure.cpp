// `treasure`: a king's treasure after figures 1 and 6 of [P000]: crowns, goblets, dishes, rings, a
// sword and heaps of coins with Phong exponents of 20 to 200, in the light of an environment and
// one point light. The paper's environment is a captured kitchen; ours is a generated hall
// (hall_light.h), and --environment takes captured ones. All metal is Phong, as in the paper.
//
// y is up, the floor y = 0, the viewer at +z. Coins, rings, pearls and gems settle one by one on
// the height of what lies already (pile.h). Meshes are added where they are first placed: the order
// in which a file of the scene has them.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/builtin/hall_light.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/noise.h"
#include "lobelia/builtin/pile.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/treasure_items.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia::builtin {
namespace {

constexpr float kCoinRadius = 0.05f;

// The heap without its coins.
float mound(Vec2f at) {
  const auto bump = [&](float x, float z, float wide, float deep, float high) {
    return high * std::exp(-sqr((at.x - x) / wide) - sqr((at.y - z) / deep));
  };
  return bump(-0.05f, -0.35f, 0.78f, 0.62f, 0.46f) + bump(0.95f, -0.55f, 0.45f, 0.45f, 0.20f) +
         bump(-0.95f, -0.30f, 0.40f, 0.42f, 0.18f) + bump(0.30f, 0.45f, 0.45f, 0.30f, 0.10f) -
         0.02f;
}

class Treasure : SceneBuilder {
 public:
  explicit Treasure(float detail)
      : SceneBuilder(detail),
        pile_(1.8f, 450, [](Vec2f at) { return std::max(mound(at), 0.f); }),
        fine_([this](int atDetailOne, int least) { return segments(atDetailOne, least); }) {}

  Scene make() {
    addMaterials();
    addGround();
    addCoins(650);
    addItems();
    addCoins(140);
    addSmallThings();
    addLights();
    addCamera("front", {0.05, 1.32, 2.95}, {0.02, 0.36, -0.1}, 42, 800, 600);
    addCamera("crown", {-0.55, 0.95, 1.25}, {0.0, 0.58, -0.25}, 38, 800, 600);
    scene().integrator = "path";
    scene().maxDepth = 10;
    return take();
  }

 private:
  void addMaterials() {
    gold_ = add(phong(Rgb(0.24f, 0.135f, 0.025f), Rgb(0.70f, 0.50f, 0.20f), 80), "gold");
    oldGold_ = add(phong(Rgb(0.26f, 0.14f, 0.03f), Rgb(0.60f, 0.42f, 0.16f), 30), "old gold");
    polished_ =
        add(phong(Rgb(0.18f, 0.10f, 0.02f), Rgb(0.78f, 0.57f, 0.24f), 200), "polished gold");
    silver_ = add(phong(Rgb(0.16f), Rgb(0.72f, 0.71f, 0.68f), 100), "silver");
    copper_ = add(phong(Rgb(0.26f, 0.10f, 0.05f), Rgb(0.62f, 0.34f, 0.22f), 20), "copper");
    steel_ = add(phong(Rgb(0.10f), Rgb(0.75f, 0.76f, 0.78f), 150), "steel");
    ruby_ = add(phong(Rgb(0.38f, 0.01f, 0.03f), Rgb(0.50f), 200), "ruby");
    emerald_ = add(phong(Rgb(0.01f, 0.28f, 0.09f), Rgb(0.50f), 200), "emerald");
    sapphire_ = add(phong(Rgb(0.02f, 0.05f, 0.40f), Rgb(0.50f), 200), "sapphire");
    pearl_ = add(phong(Rgb(0.62f, 0.58f, 0.52f), Rgb(0.30f), 60), "pearl");
  }

  void addGround() {
    const MaterialHandle stone = add(phong(Rgb(0.14f, 0.10f, 0.075f), Rgb(0.30f), 40), "floor");
    place(add(io::unitRectangle(), "floor"), rotation({1, 0, 0}, -90) * scaling(Vec3d(6)), stone,
          "floor");
    // Below the coins; it dips under the floor at its border.
    const int n = segments(90, 12);
    constexpr float kSize = 3.6f;
    place(add(heightfield(kSize, kSize, n, n,
                          [](Vec2f uv) {
                            const Vec2f at = (uv - Vec2f(0.5f, 0.5f)) * kSize;
                            return mound(at) - 0.012f +
                                   0.012f * noise(Vec3f(at.x * 22, 0, at.y * 22), 3);
                          }),
              "heap"),
          Mat4(), oldGold_, "heap");
  }

  Mat4 disc(const Mat4& at, float radius) const {
    return at * scaling(Vec3d(static_cast<double>(radius)));
  }

  void addCoins(int count) {
    for (int i = 0; i < count; ++i) {
      // Of a few places on the heap the lowest that is free.
      Vec2f best;
      float lowest = 1e9f;
      for (int k = 0; k < 4; ++k) {
        const float r = 1.45f * std::sqrt(rng_.next1D()), angle = kTwoPi * rng_.next1D();
        const Vec2f at{r * std::cos(angle), 0.72f * r * std::sin(angle) - 0.12f};
        // Fewer far from the heap.
        const float depth = pile_.heightAt(at) - mound(at);
        const float cost =
            depth + (mound(at) < 0.02f ? 0.03f : 0.f) + (pile_.isBlocked(at) ? 1.f : 0.f);
        if (cost < lowest) lowest = cost, best = at;
      }
      const float kind = rng_.next1D(), radius = kCoinRadius * (0.85f + 0.3f * rng_.next1D());
      const MaterialHandle metal = kind < 0.55f   ? gold_
                                   : kind < 0.75f ? polished_
                                   : kind < 0.93f ? silver_
                                                  : copper_;
      constexpr int kRays[] = {8, 12, 5};
      const auto design = static_cast<size_t>(rng_.next1D() * 2.999f);
      MeshHandle& mesh = coins_[design];
      if (!mesh.valid())
        mesh = add(coin(fine_, kRays[design]), fmt::format("coin of {} rays", kRays[design]));
      const Mat4 at = pile_.settle(best, radius, 0.08f * radius, 0.12f, rng_);
      place(mesh, disc(at, radius), metal, fmt::format("coin {}", ++coinCount_));
    }
  }

  // A placement at the height of the heap: leaning, turned, and sunk in a little.
  Mat4 stood(Vec2f at, float footprint, double sink, Vec3d leanAxis, double lean, double turn,
             double size) {
    const float y = pile_.meanHeight(at, footprint);
    pile_.block(at, footprint);
    return translation({static_cast<double>(at.x), static_cast<double>(y) - sink,
                        static_cast<double>(at.y)}) *
           rotation(leanAxis, lean) * rotation({0, 1, 0}, turn) * scaling(Vec3d(size));
  }

  void addCrown(const Mat4& at, MaterialHandle metal, int points, bool arches,
                const std::string& name) {
    const MeshHandle band = add(crownBand(fine_, points), name);
    place(band, at, metal, name);
    if (arches) place(add(crownArches(fine_), name + ", arches"), at, metal, name + ", arches");
    if (!gem_.valid()) {
      gem_ = add(cutGem(10), "cut gem");
      bead_ = add(ball(1, segments(14, 4), segments(24, 8)), "bead");
    }
    const MaterialHandle stones[] = {ruby_, emerald_, sapphire_};
    for (int i = 0; i < points; ++i) {
      const double turn = 360.0 * i / points;
      const Mat4 around = at * rotation({0, 1, 0}, turn);
      // On the band below each point, its table outwards; between them pearls; a pearl on each tip.
      place(gem_,
            around * translation({0.965, 0.20, 0}) * rotation({0, 0, 1}, -90) *
                scaling({0.085, 0.085, 0.065}),
            stones[i % 3], name + fmt::format(", stone {}", i + 1));
      const Mat4 between = around * rotation({0, 1, 0}, 180.0 / points);
      place(bead_, between * translation({0.965, 0.20, 0}) * scaling(Vec3d(0.045)), pearl_,
            name + fmt::format(", pearl {}", i + 1));
      place(bead_, around * translation({1.08, 1.03, 0}) * scaling(Vec3d(0.062)), pearl_,
            name + fmt::format(", tip {}", i + 1));
    }
  }

  void addItems() {
    const Vec3d x{1, 0, 0}, z{0, 0, 1};
    addCrown(stood({-0.02f, -0.28f}, 0.24f, -0.02, x, 10, 20, 0.255), gold_, 8, true,
             "king's crown");
    addCrown(stood({0.66f, 0.10f}, 0.17f, -0.05, Vec3d(0.6, 0, -1), 24, 10, 0.175), polished_, 10,
             false, "queen's crown");
    addCrown(stood({-0.62f, 0.30f}, 0.14f, -0.05, Vec3d(1, 0, 0.6), 30, 0, 0.145), silver_, 6,
             false, "prince's crown");

    const MeshHandle cup = add(goblet(fine_), "goblet");
    place(cup, stood({-0.56f, -0.18f}, 0.10f, 0.02, z, 6, 0, 0.46), silver_, "goblet 1");
    place(cup, stood({0.47f, -0.42f}, 0.10f, 0.02, z, -8, 40, 0.50), gold_, "goblet 2");
    place(cup, stood({0.98f, -0.32f}, 0.10f, 0.02, x, -6, 70, 0.42), polished_, "goblet 3");
    // Two have fallen over.
    place(cup, stood({0.20f, 0.46f}, 0.12f, -0.11, Vec3d(0.35, 0, 1), 82, 10, 0.40), polished_,
          "goblet 4");
    place(cup, stood({-1.02f, 0.12f}, 0.12f, -0.10, Vec3d(0.8, 0, 1), -80, 0, 0.38), silver_,
          "goblet 5");

    const MeshHandle plate = add(dish(fine_), "dish");
    place(plate, stood({-0.20f, 0.42f}, 0.20f, 0.01, x, 16, 0, 0.24), silver_, "dish 1");
    place(plate, stood({0.95f, 0.42f}, 0.2f, -0.01, Vec3d(1, 0, 0.2), 6, 30, 0.22), gold_,
          "dish 2");
    // Leaning against the heap, upright.
    place(plate, stood({-0.88f, -0.45f}, 0.12f, -0.18, Vec3d(1, 0, -0.3), 68, 0, 0.34), polished_,
          "dish 3");
    place(plate, stood({0.62f, -0.78f}, 0.12f, -0.22, Vec3d(1, 0, 0.25), 72, 0, 0.36), silver_,
          "dish 4");

    // The sword stands in the heap behind the crown.
    const Mat4 sword = translation({0.46, 1.10, -0.30}) * rotation(z, -24) * rotation(x, -6) *
                       rotation({0, 1, 0}, 25) * scaling({1.15, -1.15, 1.15});
    const Mat4 upright = sword * scaling({1, 1, -1});  // a rotation by 180 degrees in all
    place(add(swordBlade(fine_), "blade"), upright, steel_, "blade");
    place(add(swordHilt(fine_), "hilt"), upright, oldGold_, "hilt");
    place(gem_, upright * translation({0, -0.275, 0}) * rotation(x, 180) * scaling(Vec3d(0.022)),
          ruby_, "pommel stone");
  }

  void addSmallThings() {
    const MeshHandle hoop = add(ringHoop(fine_), "ring");
    const MaterialHandle stones[] = {ruby_, emerald_, sapphire_};
    const auto place2 = [&](float radius, float spread) {
      const float r = spread * std::sqrt(rng_.next1D()), angle = kTwoPi * rng_.next1D();
      Vec2f at{r * std::cos(angle), 0.6f * r * std::sin(angle) + 0.18f};
      for (int k = 0; k < 8 && pile_.isBlocked(at); ++k)
        at = {spread * (2 * rng_.next1D() - 1), 0.6f * spread * (2 * rng_.next1D() - 1) + 0.18f};
      return pile_.settle(at, radius, radius * 0.5f, 0.2f, rng_);
    };
    for (int i = 0; i < 26; ++i) {
      const float radius = 0.034f;
      // Lying on the hoop's side: its axis z is up.
      const Mat4 at = place2(radius, 1.2f) * scaling(Vec3d(static_cast<double>(radius))) *
                      rotation({1, 0, 0}, 82);
      const std::string name = fmt::format("ring {}", i + 1);
      place(hoop, at, i % 3 == 0 ? silver_ : gold_, name);
      place(gem_, at * translation({0, 1.34, 0}) * scaling(Vec3d(0.36)), stones[i % 3],
            name + ", stone");
    }
    for (int i = 0; i < 60; ++i) {
      const float radius = 0.016f + 0.020f * rng_.next1D();
      const Mat4 at = place2(radius, 1.3f);
      place(gem_,
            at * rotation({0, 0, 1}, 60 * static_cast<double>(rng_.next1D())) *
                scaling(Vec3d(static_cast<double>(radius))),
            stones[i % 3], fmt::format("gem {}", i + 1));
    }
    // Strings of pearls down the front.
    for (int s = 0; s < 2; ++s)
      for (int i = 0; i < 34; ++i) {
        const float t = fraction(i, 34);
        const Vec2f at{(s == 0 ? -0.36f : 0.40f) + 0.16f * std::sin(5 * t + static_cast<float>(s)),
                       0.02f + 0.66f * t};
        constexpr double kRadius = 0.0125;
        const Vec3d p{static_cast<double>(at.x),
                      static_cast<double>(pile_.heightAt(at)) + 0.7 * kRadius,
                      static_cast<double>(at.y)};
        place(bead_, translation(p) * scaling(Vec3d(kRadius)), pearl_,
              fmt::format("string {}, pearl {}", s + 1, i + 1));
      }
  }

  void addLights() {
    addHallLight(*this, 65);  // no window behind the crown
    Emitter lamp;
    lamp.type = EmitterType::point;
    lamp.radiance = Rgb(7.0f, 5.6f, 3.8f);
    lamp.toWorld = Transform(translation({-1.125, 2.0, 1.375}));
    add(lamp, "lamp");
  }

  Pile pile_;
  Fineness fine_;
  Rng rng_{2016};
  int coinCount_ = 0;
  MeshHandle coins_[3];
  MeshHandle gem_, bead_;
  MaterialHandle gold_, oldGold_, polished_, silver_, copper_, steel_, ruby_, emerald_, sapphire_,
      pearl_;
};

}  // namespace

Scene makeTreasure(float detail) { return Treasure(detail).make(); }

}  // namespace lobelia::builtin
