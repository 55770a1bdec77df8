// `tableau`: three complex glossy shapes on a floor, lit by three distant lights, after figure 5 of
// [P000] (Phong exponents 40 to 80; the floor's gloss constant, in stripes, or captured "card" and
// "satin") and the Tableau of [P003] (a floor of anisotropic Ward reflectance, alpha 0.03 and 0.3).
// The papers' shapes are scans and models of others; ours are sculptures. About 220,000 triangles,
// 800,000 with a detail of 1.9.
//
// y is up, the floor y = 0, the viewer at +z.
#include <cmath>

#include "lobelia/builtin/captured_materials.h"
#include "lobelia/builtin/creatures.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/textures.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia::builtin {
namespace {

class Tableau : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make(TableauFloor floor) {
    constexpr double kHalf = 5;
    place(add(io::unitRectangle(), "floor"),
          translation({0, 0, 1.5}) * rotation({1, 0, 0}, -90) * scaling(Vec3d(kHalf)),
          floorMaterial(floor), "floor");
    addShapes();
    addLights();
    addCamera("front", {0.1, 2.35, 5.3}, {-0.05, 0.66, 0}, 44, 800, 600);
    scene().integrator = "path";
    scene().maxDepth = 10;
    return take();
  }

 private:
  MaterialHandle floorMaterial(TableauFloor floor) {
    switch (floor) {
      case TableauFloor::constant:
        return add(phong(Rgb(0.10f, 0.095f, 0.09f), Rgb(0.55f), 60), "floor");
      case TableauFloor::stripes: {
        // Of 200: bands of exponent 200 and of 15.
        Image exponent = stripes(Rgb(1.f), Rgb(0.075f), 12, 0.5f, 512);
        exponent.name = "floor-exponent";
        Texture bands, scaled;
        bands.type = TextureType::bitmap;
        bands.image = add(std::move(exponent));
        scaled.type = TextureType::scale;
        scaled.a = add(bands);
        scaled.scale = 200;
        Image color = stripes({0.11f, 0.105f, 0.10f}, {0.055f, 0.05f, 0.05f}, 12, 0.5f, 512);
        color.name = "floor-colour";
        bands.image = add(std::move(color));
        return add(phong(add(bands), Rgb(0.60f), add(scaled)), "striped floor");
      }
      case TableauFloor::card: {
        CardStyle style;
        style.repeats = 8;
        return addCard(*this, style);
      }
      case TableauFloor::satin: {
        SatinStyle style;
        style.repeats = 8;
        return addSatin(*this, style);
      }
      case TableauFloor::ward:
        break;
    }
    Material ward;
    ward.type = MaterialType::ward;
    ward.diffuse = Rgb(0.03f);
    ward.specular = Rgb(0.65f, 0.64f, 0.62f);
    ward.alphaU = 0.3f, ward.alphaV = 0.03f;
    return add(ward, "brushed floor");
  }

  void addShapes() {
    const MaterialHandle red = add(phong(Rgb(0.20f, 0.035f, 0.02f), Rgb(0.62f, 0.50f, 0.40f), 60),
                                   "dragon"),
                         gold = add(phong(Rgb(0.22f, 0.13f, 0.03f), Rgb(0.66f, 0.52f, 0.26f), 40),
                                    "monkey"),
                         blue = add(phong(Rgb(0.03f, 0.08f, 0.20f), Rgb(0.45f, 0.52f, 0.62f), 80),
                                    "hare");
    const MeshHandle dragon = add(dragonStatue(segments(131, 24)), "dragon"),
                     monkey = add(monkeyHead(segments(117, 20)), "monkey"),
                     hare = add(hareStatue(segments(110, 20)), "hare");
    const Vec3d y{0, 1, 0};
    place(dragon, translation({-0.98, 0, 0.1}) * rotation(y, 28), red, "dragon");
    place(monkey, translation({0.95, 0, -0.55}) * rotation(y, -14) * scaling(Vec3d(0.92)), gold,
          "monkey");
    place(hare, translation({0.78, 0, 0.95}) * rotation(y, -38) * scaling(Vec3d(0.58)), blue,
          "hare");
  }

  // Directions that stay the same to the bit when they are normalised again, as readers do.
  void addLights() {
    const auto sun = [&](Vec3f from, Rgb irradiance, const char* name) {
      Emitter light;
      light.type = EmitterType::directional;
      light.direction = normalize(-from);
      light.radiance = irradiance;
      add(light, name);
    };
    sun({-0.75f, 1.1f, 0.75f}, Rgb(2.6f, 2.4f, 2.1f), "key light");
    sun({0.9f, 0.8f, 0.4f}, Rgb(0.9f, 1.1f, 1.4f), "fill light");
    sun({0.15f, 0.72f, -1.0f}, Rgb(1.0f, 0.95f, 0.9f), "back light");
  }
};

}  // namespace

Scene makeTableau(float detail, TableauFloor floor) { return Tableau(detail).make(floor); }

}  // namespace lobelia::builtin
