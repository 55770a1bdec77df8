// The potted plants of the scene `plants`, each grown by a rule of its own.
#include <cmath>

#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/plants.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/textures.h"

namespace lobelia::builtin {
namespace {

constexpr float kGoldenAngle = 137.50776f;  // degrees: where the next leaf grows

}  // namespace

MaterialHandle Plants::leafMaterial(Rgb color, Rgb vein, float alpha, const std::string& name) {
  const Image image = colorImage(128, 128, [&](Vec2f uv) {
    const float side = std::abs(2 * uv.y - 1), across = uv.x * 9 - 2.2f * side;
    const float rib = std::exp(-sqr(side / 0.05f));
    const float veins = std::exp(-sqr((across - std::round(across)) / 0.09f)) * (1 - side);
    return lerp(color, vein, std::max(rib, 0.45f * veins));
  });
  Material both;
  both.type = MaterialType::twoSided;
  both.a = add(coated(addBitmap(image, {1, 1}, name), alpha), name + ", one side");
  return add(both, name);
}

float Plants::addPot(Vec3f at, float radius, float height, MaterialHandle material,
                     const std::string& name) {
  const float r = radius, h = height;
  put(lathe({{0, 0},
             {0.68f * r, 0},
             {0.72f * r, 0.02f * h},
             {0.90f * r, 0.80f * h},
             {0.98f * r, 0.81f * h},
             {r, 0.84f * h},
             {r, 0.97f * h},
             {0.97f * r, h},
             {0.90f * r, h},
             {0.87f * r, 0.97f * h},
             {0.84f * r, 0.80f * h},
             {0, 0.80f * h}},
            segments(64, 12)),
      at, material, name + ", pot");
  put(lathe({{0.855f * r, 0.86f * h}, {0.5f * r, 0.885f * h}, {0, 0.89f * h}}, segments(48, 10)),
      at, soil_, name + ", soil");
  return 0.885f * h;
}

void Plants::putPlant(const Foliage& plant, MaterialHandle leaves, const std::string& name) {
  put(plant.leaves(), {}, leaves, name + ", leaves");
  put(plant.stems(), {}, stem_, name + ", stems");
}

// Upright shoots with large leaves around them.
void Plants::addFig(Vec3f at) {
  const float root = addPot(at, 0.115f, 0.19f, clay_, "fig");
  const Mesh shape = leaf({0.50f, 0.42f, 0.32f, 0.22f, 0.05f}, segments(9, 3), segments(4, 2));
  Foliage plant;
  for (int k = 0; k < 11; ++k) {
    const float azimuth = 360 * fraction(k, 11) + random(-12, 12);
    const float tall = random(0.30f, 0.52f);
    const Vec3f from = at + Vec3f(random(-0.03f, 0.03f), root - 0.02f, random(-0.03f, 0.03f));
    const Curve shoot = Foliage::arch(from, azimuth, random(62, 84), tall, 0.12f);
    plant.addStem(shoot, 0.0055f, segments(14, 4), segments(7, 4));
    constexpr int kLeaves = 22;
    for (int i = 0; i < kLeaves; ++i) {
      const float t = 0.22f + 0.78f * fraction(i, kLeaves - 1);
      plant.addLeaf(shape, shoot(t), azimuth + kGoldenAngle * static_cast<float>(i),
                    lerp(4.f, 52.f, t) + random(-10, 10), random(-20, 20),
                    random(0.075f, 0.105f) * (1.15f - 0.45f * t));
    }
  }
  putPlant(plant, leafMaterial({0.045f, 0.12f, 0.03f}, {0.17f, 0.25f, 0.08f}, 0.16f, "fig leaf"),
           "fig");
}

// Arching fronds of two rows of leaflets.
void Plants::addFern(Vec3f at) {
  const float root = addPot(at, 0.10f, 0.15f, white_, "fern");
  const Mesh shape = leaf({0.30f, 0.35f, 0.22f, 0.10f, 0}, segments(6, 2), segments(2, 2));
  Foliage plant;
  for (int k = 0; k < 34; ++k) {
    const float azimuth = kGoldenAngle * static_cast<float>(k), inner = fraction(k, 34);
    const Vec3f from = at + Vec3f(0, root - 0.015f, 0);
    const Curve frond = Foliage::arch(from, azimuth, lerp(48.f, 82.f, inner) + random(-5, 5),
                                      random(0.27f, 0.37f), lerp(0.85f, 0.55f, inner));
    plant.addStem(frond, 0.0022f, segments(14, 4), segments(5, 3));
    constexpr int kPairs = 17;
    for (int i = 0; i < kPairs; ++i) {
      const float t = 0.16f + 0.84f * fraction(i, kPairs - 1);
      const Vec3f way = normalize(frond(t) - frond(t - 0.02f));
      const float slope = std::asin(way.y) * 180 / kPi;
      const float size = 0.062f * std::sqrt(std::sin(kPi * (0.12f + 0.86f * t)));
      for (const float side : {-1.f, 1.f})
        plant.addLeaf(shape, frond(t), azimuth + 68 * side, 0.35f * slope + random(-6, 6),
                      -0.55f * slope * side, size);
    }
  }
  putPlant(plant, leafMaterial({0.07f, 0.17f, 0.035f}, {0.14f, 0.24f, 0.07f}, 0.25f, "fern leaf"),
           "fern");
}

// Long blades that bend over.
void Plants::addDracaena(Vec3f at) {
  const float root = addPot(at, 0.095f, 0.17f, glaze_, "dracaena");
  const Mesh shape = leaf({0.085f, 0.30f, 0.42f, 0.5f, 0}, segments(16, 4), segments(2, 2));
  Foliage plant;
  for (int k = 0; k < 3; ++k) {
    const float tall = 0.10f + 0.10f * static_cast<float>(k);
    const Vec3f from = at + Vec3f(0.022f * std::cos(2.1f * static_cast<float>(k)), root - 0.015f,
                                  0.022f * std::sin(2.1f * static_cast<float>(k)));
    const Curve trunk = Foliage::arch(from, 120 * static_cast<float>(k), 80, tall, 0);
    plant.addStem(trunk, 0.010f, segments(10, 3), segments(12, 5));
    constexpr int kBlades = 44;
    for (int i = 0; i < kBlades; ++i) {
      const float t = fraction(i, kBlades);
      plant.addLeaf(shape, trunk(0.62f + 0.38f * t), kGoldenAngle * static_cast<float>(i),
                    lerp(12.f, 82.f, t) + random(-6, 6), random(-15, 15), random(0.20f, 0.30f));
    }
  }
  putPlant(plant,
           leafMaterial({0.08f, 0.15f, 0.05f}, {0.30f, 0.32f, 0.14f}, 0.14f, "dracaena leaf"),
           "dracaena");
}

// Vines that lie on the table and hang over its edge.
void Plants::addIvy(Vec3f at) {
  const float root = addPot(at, 0.075f, 0.12f, glaze_, "ivy");
  const Mesh shape = leaf({0.85f, 0.30f, 0.18f, 0.18f, 0.10f}, segments(6, 3), segments(4, 2));
  Foliage plant;
  for (int k = 0; k < 13; ++k) {
    const float azimuth = 180 + 360 * fraction(k, 13) + random(-8, 8), a = azimuth * kPi / 180;
    const Vec3f out{std::cos(a), 0, -std::sin(a)}, rim = at + Vec3f(0, root + 0.025f, 0);
    const float far = random(0.14f, 0.22f);
    // Those to the front fall below the table's top.
    const bool hangs = out.z > 0.45f;
    const Vec3f down = at + out * far;
    const Curve vine =
        smoothCurve3({at + Vec3f(0, root - 0.01f, 0), rim + out * 0.065f + Vec3f(0, 0.025f, 0),
                      at + out * 0.115f + Vec3f(0, 0.07f, 0),
                      hangs ? Vec3f(down.x, kTop + 0.015f, 0.505f) : down + Vec3f(0, 0.018f, 0),
                      hangs ? Vec3f(down.x + 0.02f, kTop - random(0.10f, 0.26f), 0.52f)
                            : at + out * (far + 0.06f) + Vec3f(0.02f, 0.014f, 0.02f)});
    plant.addStem(vine, 0.0024f, segments(36, 8), segments(6, 4));
    constexpr int kLeaves = 19;
    for (int i = 0; i < kLeaves; ++i) {
      const float t = 0.12f + 0.88f * fraction(i, kLeaves - 1);
      const bool below = vine(t).y < kTop;
      plant.addLeaf(shape, vine(t), azimuth + (i % 2 == 0 ? 65.f : -65.f) + random(-25, 25),
                    below ? random(-30, -5) : random(8, 40), random(-15, 15),
                    random(0.036f, 0.052f) * (1.1f - 0.5f * t));
    }
  }
  putPlant(plant, leafMaterial({0.03f, 0.085f, 0.03f}, {0.22f, 0.28f, 0.14f}, 0.18f, "ivy leaf"),
           "ivy");
}

void Plants::addDaisies(Vec3f at) {
  const float root = addPot(at, 0.08f, 0.12f, clay_, "daisies");
  const Mesh petal = leaf({0.30f, 0.65f, 0.12f, 0.10f, 0}, segments(5, 2), segments(2, 2)),
             shape = leaf({0.26f, 0.6f, 0.4f, 0.2f, 0.2f}, segments(8, 3), segments(4, 2));
  const MeshHandle heart = add(
      superellipsoid({0.0085f, 0.005f, 0.0085f}, 1, 1, segments(8, 4), segments(16, 6)), "heart");
  const MaterialHandle yellow = add(coated(Rgb(0.55f, 0.33f, 0.02f), 0.4f), "heart");
  Foliage plant, flowers;
  for (int i = 0; i < 46; ++i)
    plant.addLeaf(shape, at + Vec3f(0, root - 0.004f, 0), kGoldenAngle * static_cast<float>(i),
                  random(18, 70), random(-20, 20), random(0.07f, 0.12f));
  for (int k = 0; k < 17; ++k) {
    const float azimuth = kGoldenAngle * static_cast<float>(k), inner = fraction(k, 17);
    const Curve stalk = Foliage::arch(at + Vec3f(0, root - 0.01f, 0), azimuth,
                                      lerp(88.f, 60.f, inner), random(0.14f, 0.22f), 0.10f);
    plant.addStem(stalk, 0.0019f, segments(10, 3), segments(6, 4));
    const Vec3f top = stalk(1);
    for (int i = 0; i < 17; ++i)
      flowers.addLeaf(petal, top + Vec3f(0, 0.0006f * static_cast<float>(i % 3), 0),
                      360 * fraction(i, 17), random(2, 16), random(-6, 6), 0.026f);
    place(heart, moving(top + Vec3f(0, 0.002f, 0)), yellow, "heart " + std::to_string(k + 1));
  }
  putPlant(plant, leafMaterial({0.06f, 0.13f, 0.04f}, {0.13f, 0.20f, 0.08f}, 0.3f, "daisy leaf"),
           "daisies");
  put(flowers.leaves(), {},
      leafMaterial({0.75f, 0.74f, 0.72f}, {0.68f, 0.66f, 0.60f}, 0.35f, "petal"), "petals");
}

}  // namespace lobelia::builtin
