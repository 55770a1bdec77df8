// Materials of the built-in kitchen. As in its model [P000 section 7], glossy things are Phong
// materials with exponents from 20 to 200; metals are GGX conductors, the brushed ones anisotropic
// [P003 section 4]; tiles and floor are GGX coats whose gloss varies.
#include "lobelia/builtin/kitchen_kit.h"

#include <fmt/format.h>

#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/textures.h"

namespace lobelia::builtin {
namespace {

// So that detail 1 makes the 180,000 triangles of [P000].
constexpr float kFineness = 0.62f;

// Pixels of a texture of which there are `most` from detail 1/2 on; coarse scenes have coarse ones.
int pixels(float detail, int most) {
  int size = most;
  for (float d = detail; d < 0.5f && size > most / 8; d *= 2) size /= 2;
  return size;
}

Material twoSided(MaterialHandle front) {
  Material m;
  m.type = MaterialType::twoSided;
  m.a = front;
  return m;
}

}  // namespace

KitchenKit::KitchenKit(float detail, KitchenLighting lighting)
    : SceneBuilder(detail * kFineness),
      lighting_(lighting),
      large_(pixels(detail, 1024)),
      small_(large_ / 2) {
  addMetals();
  addMinerals();
  addWoodsAndPaints();
  addFood();
}

void KitchenKit::addMetals() {
  KitchenPalette& m = palette_;
  // Brushed along u: smooth along the grooves, rough across.
  const TextureHandle along = addBitmap(brushed(0.10f, 0.03f, small_, 1)),
                      across = addBitmap(brushed(0.30f, 0.09f, small_, 2));
  m.steel = add(metal(kSteel, along, across), "brushed steel");
  m.steelUpright = add(metal(kSteel, across, along), "brushed steel, upright");
  m.steelDark = add(metal(kSteel, 0.25f), "steel");
  m.chrome = add(metal(kSteel, 0.03f), "polished steel");
  m.brass = add(metal({{0.444f, 0.527f, 1.094f}, {3.695f, 2.765f, 1.829f}}, 0.18f), "brass");
  m.copper = add(metal(kCopper, 0.12f), "copper");
  m.tin = add(metal(kAluminium, 0.22f), "tin");
  m.iron = add(phong(Rgb(0.025f), Rgb(0.08f), 20.f), "cast iron");
}

void KitchenKit::addMinerals() {
  KitchenPalette& m = palette_;
  Tiles floor;
  floor.color = {0.56f, 0.52f, 0.45f}, floor.second = {0.115f, 0.125f, 0.13f};
  floor.grout = {0.22f, 0.21f, 0.19f};
  floor.columns = floor.rows = 4;
  floor.groutWidth = 0.016f, floor.edge = 0.012f;
  floor.toneSpread = 0.10f, floor.mottle = 0.16f;
  floor.roughness = 0.14f, floor.roughnessSpread = 0.05f;
  const SurfaceImages floorImages = tiles(floor, large_);
  const Vec2f floorScale{1 / 1.6f, 1 / 1.6f};  // tiles of 40 cm
  m.floor = addBumped(coated(addBitmap(floorImages.color, floorScale),
                             addBitmap(floorImages.roughness, floorScale)),
                      addBitmap(floorImages.height, floorScale), 0.0025f, "floor tiles");
  Tiles wall;
  wall.color = {0.74f, 0.73f, 0.68f}, wall.grout = {0.42f, 0.40f, 0.37f};
  wall.columns = 6, wall.rows = 12, wall.aspect = 2, wall.brickBond = true;
  wall.groutWidth = 0.045f, wall.edge = 0.09f;
  wall.toneSpread = 0.045f, wall.mottle = 0.03f;
  wall.roughness = 0.09f, wall.roughnessSpread = 0.03f;
  const SurfaceImages wallImages = tiles(wall, large_);
  const Vec2f wallScale{1 / 0.9f, 1 / 0.9f};  // tiles of 15 x 7.5 cm
  m.wallTiles = addBumped(
      coated(addBitmap(wallImages.color, wallScale), addBitmap(wallImages.roughness, wallScale)),
      addBitmap(wallImages.height, wallScale), 0.0025f, "wall tiles");
  Marble counter;
  counter.vein = {0.16f, 0.165f, 0.18f}, counter.sharpness = 2.2f;
  m.marble = add(phong(addBitmap(marble(counter, large_), {1 / 1.3f, 1 / 1.3f}), Rgb(0.10f), 150.f),
                 "marble");
  m.porcelain = add(phong(Rgb(0.74f, 0.73f, 0.69f), Rgb(0.10f), 200.f), "porcelain");
  m.blueGlaze = add(phong(Rgb(0.045f, 0.12f, 0.22f), Rgb(0.12f), 180.f), "blue glaze");
  m.clay = add(phong(Rgb(0.42f, 0.17f, 0.085f), Rgb(0.03f), 20.f), "terracotta");
  m.enamel = add(phong(Rgb(0.68f, 0.65f, 0.56f), Rgb(0.12f), 160.f), "cream enamel");
  m.redEnamel = add(phong(Rgb(0.42f, 0.030f, 0.022f), Rgb(0.14f), 200.f), "red enamel");
  m.blackGlass = add(coated(Rgb(0.012f), 0.05f), "black glass");
  m.glass = add(glass(), "glass");
  Material green = glass();
  green.transmittance = Rgb(0.42f, 0.66f, 0.30f);
  m.greenGlass = add(green, "green glass");
}

void KitchenKit::addWoodsAndPaints() {
  KitchenPalette& m = palette_;
  const auto board = [&](Rgb light, Rgb dark, uint64_t seed) {
    Wood w;
    w.light = light, w.dark = dark, w.planks = 1, w.seed = seed;
    return addBitmap(wood(w, small_).color, {1 / 0.7f, 1 / 0.35f});
  };
  m.oak =
      add(phong(board({0.46f, 0.28f, 0.13f}, {0.27f, 0.145f, 0.06f}, 3), Rgb(0.05f), 40.f), "oak");
  m.walnut = add(phong(board({0.20f, 0.105f, 0.05f}, {0.085f, 0.04f, 0.02f}, 5), Rgb(0.06f), 50.f),
                 "walnut");
  m.paint = add(diffuse(Rgb(0.72f, 0.68f, 0.58f)), "wall paint");
  m.ceiling = add(diffuse(Rgb(0.82f, 0.81f, 0.78f)), "ceiling");
  m.trim = add(phong(Rgb(0.72f, 0.71f, 0.67f), Rgb(0.06f), 60.f), "white lacquer");
  m.lacquer = add(phong(Rgb(0.025f, 0.072f, 0.076f), Rgb(0.11f), 130.f), "teal lacquer");
  m.pale = add(phong(Rgb(0.62f, 0.60f, 0.53f), Rgb(0.08f), 100.f), "pale lacquer");
  m.carcass = add(diffuse(Rgb(0.06f)), "carcass");
  m.black = add(diffuse(Rgb(0.03f)), "matt black");
  // Dark, as they are so near to the lamps' points of light that they would outshine the sun.
  m.bulb = add(diffuse(Rgb(0.04f)), "lamp glass");
  m.lining = add(diffuse(Rgb(0.26f, 0.20f, 0.12f)), "pendant lining");
  const SurfaceImages weave = fabric({0.66f, 0.62f, 0.52f}, {0.60f, 0.55f, 0.45f}, 48, small_, 4);
  m.curtain = add(twoSided(add(diffuse(addBitmap(weave.color, {4, 4})), "linen, front")), "linen");
  const TextureHandle stripe =
      addBitmap(stripes({0.70f, 0.67f, 0.60f}, {0.06f, 0.14f, 0.22f}, 6, 0.7f, small_), {2, 2});
  m.cloth = add(twoSided(add(diffuse(stripe), "tea towel, front")), "tea towel");
  m.paper = add(
      diffuse(addBitmap(marble({{0.50f, 0.36f, 0.20f}, {0.10f, 0.16f, 0.22f}, 2, 1, 9}, small_))),
      "print");
}

void KitchenKit::addFood() {
  KitchenPalette& m = palette_;
  const auto skin = [&](Rgb color, Rgb gloss, float exponent, const char* name) {
    return add(phong(color, gloss, exponent), name);
  };
  m.orange = skin({0.72f, 0.25f, 0.025f}, Rgb(0.05f), 30.f, "orange");
  m.lemon = skin({0.75f, 0.55f, 0.05f}, Rgb(0.05f), 30.f, "lemon");
  Marble stripesOfApple{{0.45f, 0.045f, 0.03f}, {0.52f, 0.33f, 0.06f}, 3, 1.2f, 11};
  m.apple =
      add(phong(addBitmap(marble(stripesOfApple, small_ / 2), {2, 1}), Rgb(0.08f), 90.f), "apple");
  m.pear = skin({0.42f, 0.44f, 0.07f}, Rgb(0.05f), 40.f, "pear");
  m.stalk = add(diffuse(Rgb(0.09f, 0.05f, 0.025f)), "stalk");
  m.bread = add(diffuse(addBitmap(
                    marble({{0.42f, 0.20f, 0.07f}, {0.62f, 0.45f, 0.25f}, 6, 1.2f, 21}, small_))),
                "crust");
  m.pasta = skin({0.62f, 0.42f, 0.14f}, Rgb(0.02f), 20.f, "pasta");
  m.coffee = skin({0.06f, 0.028f, 0.014f}, Rgb(0.05f), 40.f, "coffee beans");
  m.leaf =
      add(twoSided(add(phong(Rgb(0.085f, 0.22f, 0.035f), Rgb(0.05f), 30.f), "leaf, upper side")),
          "leaf");
}

void KitchenKit::put(MeshHandle mesh, const Mat4& toWorld, MaterialHandle material,
                     const std::string& name, EmitterHandle emitter) {
  const int number = ++names_[name];
  place(mesh, toWorld, material, number == 1 ? name : fmt::format("{} {}", name, number), emitter);
}

void KitchenKit::put(Mesh mesh, const Mat4& toWorld, MaterialHandle material,
                     const std::string& name) {
  put(add(std::move(mesh), name), toWorld, material, name);
}

Mesh KitchenKit::boxMesh(Vec3f halfExtent, float radius) const {
  return withProjectedUvs(roundedBox(halfExtent, radius, segments(1, 1)));
}

void KitchenKit::box(Vec3f low, Vec3f high, MaterialHandle material, const std::string& name,
                     float radius) {
  const Vec3f c = (low + high) * 0.5f;
  // Texture coordinates of the room, so that textures run on across boxes.
  put(withProjectedUvs(translated(roundedBox((high - low) * 0.5f, radius, segments(1, 1)), c)),
      Mat4(), material, name);
}

}  // namespace lobelia::builtin
