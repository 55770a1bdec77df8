// `glasses`: drinking vessels of five glossy materials close together on a glossy table, in the
// light of an environment, after the Glasses scene of [P002], whose point is the vessels'
// reflections in the table and in each other. Phong exponents 32 to 512.
#include <cmath>

#include "lobelia/builtin/hall_light.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/refine.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"

namespace lobelia::builtin {
namespace {

class Glasses : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make() {
    const MaterialHandle table = add(phong(Rgb(0.09f, 0.08f, 0.075f), Rgb(0.55f), 256), "table");
    place(add(refined(roundedBox({2.4f, 0.06f, 1.7f}, 0.02f, segments(6, 1)), 0.14f / detail()),
              "table"),
          translation({0, -0.06, 0}), table, "table");
    addVessels();
    addHallLight(*this, 70);
    addCamera("front", {0.25, 1.75, 3.9}, {0, 0.52, 0}, 36, 800, 600);
    scene().integrator = "path";
    scene().maxDepth = 10;
    return take();
  }

 private:
  MeshHandle vessel(const std::vector<Vec2f>& profile, const char* name) {
    return add(revolve(centripetalCurve(profile),
                       segments(62, static_cast<int>(profile.size()) - 1), segments(72, 12)),
               name);
  }

  void addVessels() {
    const MeshHandle wine =
        vessel({{0, 0},          {0.24f, 0},      {0.27f, 0.012f}, {0.24f, 0.03f},   {0.08f, 0.06f},
                {0.032f, 0.12f}, {0.026f, 0.30f}, {0.03f, 0.45f},  {0.07f, 0.52f},   {0.20f, 0.60f},
                {0.275f, 0.74f}, {0.265f, 0.92f}, {0.215f, 1.10f}, {0.205f, 1.115f}, {0.20f, 1.10f},
                {0.25f, 0.92f},  {0.26f, 0.74f},  {0.19f, 0.615f}, {0.06f, 0.54f},   {0, 0.53f}},
               "wine glass");
    const MeshHandle flute = vessel({{0, 0},
                                     {0.19f, 0},
                                     {0.215f, 0.012f},
                                     {0.19f, 0.028f},
                                     {0.06f, 0.055f},
                                     {0.026f, 0.11f},
                                     {0.024f, 0.30f},
                                     {0.045f, 0.40f},
                                     {0.105f, 0.55f},
                                     {0.135f, 0.80f},
                                     {0.130f, 1.10f},
                                     {0.118f, 1.28f},
                                     {0.112f, 1.29f},
                                     {0.106f, 1.28f},
                                     {0.118f, 1.10f},
                                     {0.122f, 0.80f},
                                     {0.092f, 0.56f},
                                     {0.03f, 0.42f},
                                     {0, 0.405f}},
                                    "flute");
    const MeshHandle coupe = vessel({{0, 0},
                                     {0.21f, 0},
                                     {0.24f, 0.012f},
                                     {0.21f, 0.03f},
                                     {0.07f, 0.06f},
                                     {0.03f, 0.12f},
                                     {0.027f, 0.28f},
                                     {0.035f, 0.42f},
                                     {0.09f, 0.47f},
                                     {0.26f, 0.53f},
                                     {0.36f, 0.63f},
                                     {0.385f, 0.70f},
                                     {0.378f, 0.71f},
                                     {0.37f, 0.70f},
                                     {0.345f, 0.64f},
                                     {0.25f, 0.55f},
                                     {0.08f, 0.49f},
                                     {0, 0.48f}},
                                    "coupe");
    const MeshHandle tumbler = vessel({{0, 0},
                                       {0.19f, 0},
                                       {0.215f, 0.015f},
                                       {0.222f, 0.05f},
                                       {0.235f, 0.25f},
                                       {0.25f, 0.50f},
                                       {0.25f, 0.53f},
                                       {0.238f, 0.535f},
                                       {0.232f, 0.50f},
                                       {0.216f, 0.25f},
                                       {0.205f, 0.09f},
                                       {0.17f, 0.06f},
                                       {0, 0.06f}},
                                      "tumbler");
    const MaterialHandle ruby = add(phong(Rgb(0.20f, 0.02f, 0.03f), Rgb(0.62f, 0.42f, 0.40f), 128),
                                    "ruby"),
                         blue = add(phong(Rgb(0.02f, 0.06f, 0.22f), Rgb(0.42f, 0.50f, 0.64f), 256),
                                    "cobalt"),
                         gold = add(phong(Rgb(0.20f, 0.12f, 0.03f), Rgb(0.70f, 0.54f, 0.26f), 64),
                                    "gilt"),
                         green = add(phong(Rgb(0.03f, 0.14f, 0.06f), Rgb(0.44f, 0.60f, 0.46f), 32),
                                     "green"),
                         silver = add(phong(Rgb(0.08f), Rgb(0.80f, 0.79f, 0.77f), 512), "silver");
    const auto put = [&](MeshHandle mesh, double x, double z, MaterialHandle material,
                         const char* name) {
      place(mesh, translation({x, 0, z}), material, name);
    };
    put(wine, -0.52, -0.10, ruby, "ruby wine glass");
    put(wine, 0.12, -0.48, silver, "silver wine glass");
    put(flute, 0.60, -0.22, blue, "cobalt flute");
    put(coupe, -0.02, 0.24, gold, "gilt coupe");
    put(tumbler, 0.66, 0.42, green, "green tumbler");
  }
};

}  // namespace

Scene makeGlasses(float detail) { return Glasses(detail).make(); }

}  // namespace lobelia::builtin
